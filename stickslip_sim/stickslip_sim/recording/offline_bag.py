# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Writes the bag of an offline run: topics, fields and conventions of the node's, stamps are simulation time."""

from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path
from typing import Any

from numpy.typing import NDArray

from ..core.types import Event, EventKind, Mode, Sample
from . import messages, topics
from .messages import Packer
from .run import RunFacts, open_run, receipt_file
from .schemas import MessageCodec, flat_layout
from .topics import Topic


def write_bag(
    folder: Path | str, facts: RunFacts, samples: Iterable[Sample], events: Iterable[Event],
    receipt: Mapping[str, object],
) -> dict[str, int]:
    """Write a run with one sample a step, the first at time 0, and its events in the order of time.

    Returns the number of messages by topic.  Raises RecordingError; a folder that exists is not touched.
    """
    bag = OfflineBag(folder, facts)
    try:
        waiting = iter(events)
        event = next(waiting, None)
        for step, sample in enumerate(samples):
            while event is not None and event.instant <= sample.instant:
                bag.event(max(step, 1), event)
                event = next(waiting, None)
            bag.sample(step, sample)
        return bag.close(receipt)
    except BaseException:
        bag.abandon()
        raise


def samples_of(columns: Mapping[str, NDArray[Any]]) -> Iterator[Sample]:
    """Yield the samples that stand in arrays named like the fields of Sample."""
    for second, fraction, mode, direction, *rest in zip(*(columns[name].tolist() for name in Sample._fields)):
        yield Sample(second, fraction, Mode(int(mode)), int(direction), *rest)


class OfflineBag:
    """A bag to which an offline run gives its samples and events, step by step."""

    def __init__(self, folder: Path | str, facts: RunFacts) -> None:
        self._writer = open_run(folder, facts)
        self._places = {topic.name: place for place, topic in enumerate(topics.RECORDED)}
        self._state, self._friction = Packer(topics.SLIDER_STATE), Packer(topics.FRICTION_FORCE)
        self._event = Packer(topics.MODE_EVENT)
        self._velocity: float | None = None
        self._force: float | None = None
        info = messages.run_info(facts, 0, 0, str(self._writer.folder))
        data = MessageCodec([topics.RUN_INFO.type]).encode(topics.RUN_INFO.type, info)
        self._write(topics.RUN_INFO, data, 0, 0)

    def event(self, step: int, event: Event) -> None:
        """Add a transition that fell into a step (counted from 1); none of kind knot, as the node does."""
        if event.kind != EventKind.KNOT:
            at = event.instant.nanoseconds
            self._write(topics.MODE_EVENT, self._event.pack(at, step, event), at, step)

    def sample(self, step: int, sample: Sample) -> None:
        """Add the state at the end of a step (0: the start), and the commands of the next step if they are new."""
        at = sample.instant.nanoseconds
        self._write(topics.SLIDER_STATE, self._state.pack(at, step, sample), at, step)
        self._write(topics.FRICTION_FORCE, self._friction.pack(at, step, sample), at, step)
        if sample.drive_velocity != self._velocity:
            self._velocity = sample.drive_velocity
            self._command(topics.DRIVE_VELOCITY, self._velocity, at, step + 1)
        if sample.external_force != self._force:
            self._force = sample.external_force
            self._command(topics.EXTERNAL_FORCE, self._force, at, step + 1)

    def close(self, receipt: Mapping[str, object]) -> dict[str, int]:
        """Finish the bag; return the number of messages by topic."""
        self._writer.close(receipt_file(receipt))
        return self._writer.counts

    def abandon(self) -> None:
        """Leave the bag as it is, readable but without an index."""
        self._writer.abandon()

    def _command(self, topic: Topic, value: float, at: int, step: int) -> None:
        self._write(topic, flat_layout(topic.type).pack(at, value), at, step)

    def _write(self, topic: Topic, data: bytes, at: int, step: int) -> None:
        self._writer.write(self._places[topic.name], data, at, at, step)
