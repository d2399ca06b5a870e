# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Writes the bag of an offline run: topics, fields and conventions of the node's, stamps are simulation time."""

import shutil
from bisect import bisect_left, bisect_right
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from itertools import islice
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..bags import topics
from ..bags.mcap_file import MessageBlock
from ..bags.message_layout import MessageRows, record_of
from ..bags.schemas import MessageCodec, flat_layout
from ..bags.topics import Topic
from ..core.arrays import Columns
from ..core.time_grid import Instants
from ..core.types import Event, EventKind, Mode, Sample
from ..runs import SimulatedRun, simulate
from ..runs.simulated import columns_of_rows
from ..simulation import RigEvent
from . import messages
from .messages import Packer, numbers_of_steps, setpoint_layout
from .run import RunFacts, open_run, receipt_file

CHANNELS = {topic: number for number, topic in enumerate(topics.RECORDED, 1)}
_BLOCK = 10_000   # samples


def write_bag(
    folder: Path | str, facts: RunFacts, samples: Iterable[Sample], events: Iterable[Event],
    receipt: Mapping[str, object],
) -> dict[str, int]:
    """Write a run with one sample a step, the first at time 0, and its events in the order of time.

    Returns the number of messages by topic.  Raises RecordingError; a folder that exists is not touched.
    """
    return write_blocks(folder, facts, _in_blocks(samples), events, receipt)


def write_blocks(folder: Path | str, facts: RunFacts, blocks: Iterable[Columns], events: Iterable[Event],
                 receipt: Mapping[str, object]) -> dict[str, int]:
    """Write a run as `write_bag` does, with samples that come as columns, block by block."""
    bag = OfflineBag(folder, facts)
    try:
        for block in message_blocks(blocks, events):
            bag.write(block)
        return bag.close(receipt)
    except BaseException:
        bag.abandon()
        raise


def write_run(folder: Path | str, run: SimulatedRun) -> None:
    """Write a run as a bag, step by step; one that was begun vanishes on any error.  Raises RecordingError."""
    step = run.scene.time.step
    if run.sample_period != step:
        again = simulate(run.scene, run.duration, step)
        run = replace(again, receipt={**run.receipt, **again.receipt})
    facts = RunFacts.of(run.scene, run.duration, run.sample_period)
    try:
        write_blocks(folder, facts, run.sample_blocks(), run.events, run.receipt)
    except BaseException:
        shutil.rmtree(folder, ignore_errors=True)
        raise


def write_steps(folder: Path | str, facts: RunFacts, samples: Columns, orders: 'Orders', receipt: Mapping[str, object],
                setpoint: Columns, joint: str) -> None:
    """Write the steps of a rig that took orders as a node records them, samples from step 0 on.

    A `setpoint` for the `joint` of the slider is written too, if there is one.  A bag that was begun vanishes on any
    error.  Raises RecordingError.
    """
    bag, steps = OfflineBag(folder, facts, [messages.SETPOINT] if setpoint else []), StepMessages(joint)
    try:
        others = steps.of_orders(orders, Instants(samples['second'], samples['fraction']).nanoseconds())
        for first in range(0, len(samples['time']), _BLOCK):
            part, wanted = ({name: column[first:first + _BLOCK] for name, column in columns.items()}
                            for columns in (samples, setpoint))
            count = bisect_left(others, first + _BLOCK, key=lambda other: other.place)
            due, others = others[:count], others[count:]
            bag.write(steps.around(first, part, [other._replace(place=other.place - first) for other in due]
                                   if first else due, wanted))
        bag.close(receipt)
    except BaseException:
        bag.abandon()
        shutil.rmtree(folder, ignore_errors=True)
        raise


def message_blocks(blocks: Iterable[Columns], events: Iterable[Event]) -> Iterator[MessageBlock]:
    """Yield the messages of a run that was sampled at each step: all that its bag holds behind the first."""
    steps = StepMessages()
    waiting = [event for event in events if event.kind != EventKind.KNOT]   # as the node does
    first = done = 0
    for block in blocks:
        end = Sample(*(block[name][-1] for name in Sample._fields)).instant
        count = bisect_right(waiting, end, done, key=lambda event: event.instant) - done
        yield steps.block(first, block, waiting[done:done + count])
        first, done = first + len(block['second']), done + count


def samples_of(columns: Mapping[str, NDArray[Any]]) -> Iterator[Sample]:
    """Yield the samples that stand in arrays named like the fields of Sample."""
    for second, fraction, mode, direction, *rest in zip(*(columns[name].tolist() for name in Sample._fields)):
        yield Sample(second, fraction, Mode(int(mode)), int(direction), *rest)


class _Other(NamedTuple):
    """A message between those of the steps: before which of them, as a record, and its log time (ns)."""

    place: int
    channel: int
    time: int
    record: bytes


class Orders(NamedTuple):
    """What came to the rig of a run and what happened in it, each with its step; velocities in m/s, forces in N."""

    commands: Sequence[tuple[int, float | None, float | None]] = ()
    events: Sequence[tuple[int, Event]] = ()
    rig_events: Sequence[tuple[int, RigEvent]] = ()


NO_ORDERS = Orders()


class OfflineBag:
    """A bag to which an offline run gives its messages."""

    def __init__(self, folder: Path | str, facts: RunFacts, more: Sequence[Topic] = ()) -> None:
        resolved = [topic.resolved() for topic in more]
        self._writer = open_run(folder, facts, [*topics.recorded_topics(), *resolved] if more else ())
        info = messages.run_info(facts, 0, 0, str(self._writer.folder))
        data = MessageCodec([topics.RUN_INFO.type]).encode(topics.RUN_INFO.type, info)
        self._writer.write(CHANNELS[topics.RUN_INFO] - 1, data, 0, 0, 0)

    def write(self, block: MessageBlock) -> None:
        """Add messages of steps."""
        self._writer.write_block(block)

    def close(self, receipt: Mapping[str, object]) -> dict[str, int]:
        """Finish the bag; return the number of messages by topic."""
        self._writer.close(receipt_file(receipt))
        return self._writer.counts

    def abandon(self) -> None:
        """Leave the bag as it is, readable but without an index."""
        self._writer.abandon()


class StepMessages:
    """Makes the messages of steps, block by block; the `joint` is that of a setpoint."""

    def __init__(self, joint: str = '') -> None:
        self._setpoint = MessageRows(len(CHANNELS) + 1, setpoint_layout(joint)) if joint else None
        self._rows = [MessageRows(CHANNELS[topic], flat_layout(topic.type))
                      for topic in (topics.SLIDER_STATE, topics.FRICTION_FORCE)]
        self._event = Packer(topics.MODE_EVENT)
        self._latest: dict[Topic, float] = {}            # the commands in force

    def block(self, first: int, samples: Columns, events: Sequence[Event]) -> MessageBlock:
        """Return the states at the ends of steps from `first` on, the transitions up to the last, and the commands.

        A command is that of the next step.
        """
        at = Instants(samples['second'], samples['fraction'])
        others = [*self._commands(first, samples, at.nanoseconds()), *self._events(first, at, events)]
        others.sort(key=lambda other: other.place)
        return self.around(first, samples, others)

    def around(self, first: int, samples: Columns, others: Sequence[_Other], setpoint: Columns | None = None
               ) -> MessageBlock:
        """Return the states at the ends of steps from `first` on, and the setpoint, with other messages in front."""
        times = Instants(samples['second'], samples['fraction']).nanoseconds()
        steps = np.arange(first, first + len(times))
        rows = [of.packed(times, times, steps, numbers_of_steps(of.names, steps, samples)) for of in self._rows]
        if self._setpoint and setpoint:
            rows.append(self._setpoint.packed(times, times, steps, setpoint))
        return interleaved(rows, times, others)

    def of_orders(self, orders: Orders, times: NDArray[np.int64]) -> list[_Other]:
        """Return the messages of orders in front of their steps, in the order of a node; `times` of steps in ns."""
        codec, begins = MessageCodec([topics.RIG_EVENT.type]), [0, *times.tolist()]
        found = []
        for step, rig_event in orders.rig_events:
            fields = messages.rig_event(step, begins[step], begins[step], rig_event)
            data = codec.encode(topics.RIG_EVENT.type, fields)
            found.append(self._other(topics.RIG_EVENT, step, begins[step], step, data))
        velocities = [(step, velocity) for step, velocity, _ in orders.commands]
        forces = [(step, force) for step, _, force in orders.commands]
        for topic, values in ((topics.DRIVE_VELOCITY, velocities), (topics.EXTERNAL_FORCE, forces)):
            pack = flat_layout(topic.type).pack
            found += [self._other(topic, step, begins[step], step, pack(begins[step], value))
                      for step, value in values if value is not None]
        for step, event in orders.events:
            if event.kind != EventKind.KNOT:
                time, number = event.instant.nanoseconds, max(step, 1)
                found.append(self._other(topics.MODE_EVENT, step, time, number, self._event.pack(time, number, event)))
        return sorted(found, key=lambda other: other.place)

    def _events(self, first: int, at: Instants, events: Sequence[Event]) -> Iterator[_Other]:
        """Yield the transitions; each belongs to the step that it fell into, counted from 1."""
        for event in events:
            place = at.before(event.instant)
            step, time = max(first + place, 1), event.instant.nanoseconds
            yield self._other(topics.MODE_EVENT, place, time, step, self._event.pack(time, step, event))

    def _commands(self, first: int, samples: Columns, times: NDArray[np.int64]) -> Iterator[_Other]:
        """Yield the commands that are new, behind the state at the start of their step."""
        for topic, name in ((topics.DRIVE_VELOCITY, 'drive_velocity'), (topics.EXTERNAL_FORCE, 'external_force')):
            values = samples[name]
            for k in np.flatnonzero(np.diff(values, prepend=np.nan) != 0.0).tolist():
                value, time = float(values[k]), int(times[k])
                if value != self._latest.get(topic):
                    self._latest[topic] = value
                    data = flat_layout(topic.type).pack(time, value)
                    yield self._other(topic, k + 1, time, first + k + 1, data)

    def _other(self, topic: Topic, place: int, time: int, step: int, data: bytes) -> _Other:
        channel = CHANNELS[topic]
        return _Other(place, channel, time, record_of(channel, step, time, time, data))


def interleaved(rows: Sequence[NDArray[Any]], times: NDArray[np.int64], others: Sequence[_Other]) -> MessageBlock:
    """Return the messages of steps, those of a step one behind the other, with others in front of their steps."""
    kinds, places = len(rows), np.array([other.place * len(rows) for other in others], np.int64)
    size = sum(of.itemsize for of in rows)
    data = np.concatenate([of.view(np.uint8).reshape(len(times), -1) for of in rows], axis=1).tobytes()
    pieces: list[bytes] = []
    done = 0
    for other in others:
        pieces += [data[done * size:other.place * size], other.record]
        done = other.place
    lengths = np.insert(np.tile([of.itemsize for of in rows], len(times)), places,
                        [len(other.record) for other in others])
    return MessageBlock(
        b''.join([*pieces, data[done * size:]]), np.cumsum(lengths) - lengths,
        np.insert(np.tile([int(of['channel'][0]) for of in rows], len(times)), places,
                  [other.channel for other in others]),
        np.insert(np.repeat(times, kinds), places, [other.time for other in others]))


def _in_blocks(samples: Iterable[Sample]) -> Iterator[Columns]:
    waiting = iter(samples)
    while block := list(islice(waiting, _BLOCK)):
        yield columns_of_rows(np.array(block))
