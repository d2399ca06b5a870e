# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Writes the bag of an offline run: topics, fields and conventions of the node's, stamps are simulation time."""

import shutil
from bisect import bisect_right
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
            bag.write(steps.around(first, part, [of.between(first, first + _BLOCK) for of in others], wanted))
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


class Others(NamedTuple):
    """Messages of a channel between those of the steps: before which of them each is, its log time (ns), its record."""

    channel: int
    places: NDArray[np.int64]
    times: NDArray[np.int64]
    records: NDArray[Any] | list[bytes]     # rows of one size, or bytes

    def between(self, first: int, last: int) -> 'Others':
        """Return those from a step on and before another, with places counted from it."""
        begin, end = np.searchsorted(self.places, (first, last)).tolist()
        return Others(self.channel, self.places[begin:end] - first, self.times[begin:end], self.records[begin:end])


class Orders(NamedTuple):
    """What came to the rig of a run and what happened in it, each with its step; velocities in m/s, forces in N."""

    commands: Sequence[tuple[int, float | None, float | None]] = ()
    events: Sequence[tuple[int, Event]] = ()
    rig_events: Sequence[tuple[int, RigEvent]] = ()

    def commanded(self) -> list[tuple[NDArray[np.int64], NDArray[np.float64]]]:
        """Return the steps from which on velocities hold, with these, and the same of forces."""
        columns = np.array(self.commands, np.float64).reshape(-1, 3)    # None is no number
        return [(columns[known, 0].astype(np.int64), columns[known, k])
                for k in (1, 2) for known in (~np.isnan(columns[:, k]),)]


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
        places = [at.before(event.instant) for event in events]
        others = [*self._commands(first, samples, at.nanoseconds()),
                  self._events(places, [max(first + place, 1) for place in places], events)]
        return self.around(first, samples, others)

    def around(self, first: int, samples: Columns, others: Sequence[Others], setpoint: Columns | None = None
               ) -> MessageBlock:
        """Return the states at the ends of steps from `first` on, and the setpoint, with other messages in front."""
        times = Instants(samples['second'], samples['fraction']).nanoseconds()
        steps = np.arange(first, first + len(times))
        rows = [of.packed(times, times, steps, numbers_of_steps(of.names, steps, samples)) for of in self._rows]
        if self._setpoint and setpoint:
            rows.append(self._setpoint.packed(times, times, steps, setpoint))
        return interleaved(rows, times, others)

    def of_orders(self, orders: Orders, times: NDArray[np.int64]) -> list[Others]:
        """Return the messages of orders in front of their steps, in the order of a node; `times` of steps in ns."""
        codec, begins = MessageCodec([topics.RIG_EVENT.type]), np.append(0, times)
        channel, steps = CHANNELS[topics.RIG_EVENT], np.array([step for step, _ in orders.rig_events], np.int64)
        records = []
        for step, time, (_, event) in zip(steps.tolist(), begins[steps].tolist(), orders.rig_events):
            data = codec.encode(topics.RIG_EVENT.type, messages.rig_event(step, time, time, event))
            records.append(record_of(channel, step, time, time, data))
        found = [Others(channel, steps, begins[steps], records)]
        for topic, (steps, values) in zip((topics.DRIVE_VELOCITY, topics.EXTERNAL_FORCE), orders.commanded()):
            found.append(_values(topic, steps, begins[steps], steps, values))
        events = [(step, event) for step, event in orders.events if event.kind != EventKind.KNOT]
        return [*found, self._events([step for step, _ in events], [max(step, 1) for step, _ in events],
                                     [event for _, event in events])]

    def _events(self, places: Sequence[int], steps: Sequence[int], events: Sequence[Event]) -> Others:
        """Return transitions; each belongs to the step that it fell into, counted from 1."""
        channel, times = CHANNELS[topics.MODE_EVENT], [event.instant.nanoseconds for event in events]
        return Others(channel, np.array(places, np.int64), np.array(times, np.int64),
                      [record_of(channel, step, time, time, self._event.pack(time, step, event))
                       for step, time, event in zip(steps, times, events)])

    def _commands(self, first: int, samples: Columns, times: NDArray[np.int64]) -> Iterator[Others]:
        """Yield the commands that are new, behind the state at the start of their step."""
        for topic, name in ((topics.DRIVE_VELOCITY, 'drive_velocity'), (topics.EXTERNAL_FORCE, 'external_force')):
            values = samples[name]
            latest, self._latest[topic] = self._latest.get(topic, np.nan), float(values[-1])
            new = np.flatnonzero(np.diff(values, prepend=latest) != 0.0)
            yield _values(topic, new + 1, times[new], first + new + 1, values[new])


def _values(topic: Topic, places: NDArray[np.int64], times: NDArray[np.int64], steps: NDArray[np.int64],
            values: NDArray[np.float64]) -> Others:
    """Return messages that are a number each."""
    layout = flat_layout(topic.type)
    rows = MessageRows(CHANNELS[topic], layout).packed(times, times, steps, {layout.names[0]: values})
    return Others(CHANNELS[topic], places, times, rows)


def interleaved(rows: Sequence[NDArray[Any]], times: NDArray[np.int64], others: Sequence[Others]) -> MessageBlock:
    """Return the messages of steps, those of a step one behind the other, with others in front of their steps."""
    every = np.arange(len(times))
    groups = [*others, *(Others(int(of['channel'][0]), every, times, of) for of in rows)]
    sizes = [np.array([*map(len, of.records)], np.int64) if isinstance(of.records, list)
             else np.full(len(of.records), of.records.itemsize) for of in groups]
    order = np.argsort(np.concatenate([of.places for of in groups]), kind='stable')
    lengths = np.concatenate(sizes)[order]
    starts = np.cumsum(lengths) - lengths
    places = np.empty_like(starts)
    places[order] = starts
    data = np.empty(int(lengths.sum()), np.uint8)
    for of, at in zip(groups, np.split(places, np.cumsum([len(size) for size in sizes[:-1]]))):
        if isinstance(of.records, list):
            for place, record in zip(at.tolist(), of.records):
                data[place:place + len(record)] = np.frombuffer(record, np.uint8)
        elif len(at):
            kind = np.dtype((np.void, of.records.itemsize))
            np.ndarray(len(data) - kind.itemsize + 1, kind, data, strides=(1,))[at] = of.records.view(kind)
    channels = np.repeat([of.channel for of in groups], [len(of.places) for of in groups])[order]
    return MessageBlock(data.tobytes(), starts, channels, np.concatenate([of.times for of in groups])[order])


def _in_blocks(samples: Iterable[Sample]) -> Iterator[Columns]:
    waiting = iter(samples)
    while block := list(islice(waiting, _BLOCK)):
        yield columns_of_rows(np.array(block))
