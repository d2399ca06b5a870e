# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Whether a recorded run comes out the same when it is run again."""

import struct
from collections import deque
from collections.abc import Iterator
from typing import NamedTuple

from ..bags.topics import FRICTION_FORCE, MODE_EVENT, RUN_INFO, SLIDER_STATE, Topic
from ..core.errors import RecordingError
from ..core.time_grid import instants
from ..core.types import Event, Progress, Sample
from ..recording import Bag, RecordedMessage, RecordedRun
from ..recording.messages import Packer
from ..recording.offline_bag import CHANNELS, message_blocks
from ..runs import SimulatedRun, simulate
from .remake import Made, Maker, RecordedStep, maker_of, offline_of, steps_of

# An offline run beside its recording, byte by byte: quick, and sure where all is the same.
#
# A recording in which anything is not as this version writes it has to be compared step by step, which says what.

class Same(NamedTuple):
    """How much is the same: all of the recording, up to `end` (s)."""

    steps: int
    events: int
    end: float


def same_bytes(run: RecordedRun, again: SimulatedRun) -> Same | None:
    """Return how much is the same when all messages of steps are, None otherwise."""
    expected = _Expected(block.data for block in message_blocks(again.sample_blocks(), again.events))
    channels, counts = {topic.type: number for topic, number in CHANNELS.items()}, dict.fromkeys(CHANNELS.values(), 0)
    if any(channels.get(run.bag.topics[topic]) != number for number, topic in run.bag.channels):
        return None
    for record in run.bag.blocks():
        if not len(record.starts):
            continue
        first = int(record.channels[0] == CHANNELS[RUN_INFO])
        begin, end = int(record.starts[first:].min(initial=len(record.data))), len(record.data)
        if int(record.sizes[first:].sum()) != end - begin or record.data[begin:] != expected.take(end - begin):
            return None
        for channel in counts:
            counts[channel] += int((record.channels == channel).sum())
    steps = counts[CHANNELS[FRICTION_FORCE]]    # the latest state may lack it in a run that was cut off
    if counts[CHANNELS[RUN_INFO]] != 1 or not 0 <= counts[CHANNELS[SLIDER_STATE]] - steps <= 1 or not steps:
        return None
    at = instants(again.sample_period, steps - 1, steps) if again.sample_period else None
    return at and Same(steps, counts[CHANNELS[MODE_EVENT]], float(at.seconds[0] + at.fractions[0]))


class _Expected:
    """Bytes that come in blocks, taken in parts of other sizes."""

    def __init__(self, blocks: Iterator[bytes]) -> None:
        self._blocks, self._left = blocks, memoryview(b'')

    def take(self, count: int) -> bytes:
        """Return the next bytes, less of them at the end."""
        parts = []
        while count > 0 and (part := self._left or memoryview(next(self._blocks, b''))):
            parts.append(part[:count])
            self._left = part[count:]
            count -= len(parts[-1])
        return b''.join(parts)


# Recorded messages beside what was made again: every field, to the last bit.

class Difference(NamedTuple):
    """The first thing that is not the same; numbers are None where there is no message on one side."""

    step: int
    time: float           # s, of the step's end or of the transition
    topic: str
    field: str
    recorded: float | None
    made: float | None

    def __str__(self) -> str:
        place = f'step {self.step} (t = {self.time:.9g} s), {self.topic} {self.field}'
        if self.recorded is None or self.made is None:
            there = 're-simulated and not recorded' if self.recorded is None else 'recorded and not re-simulated'
            return f'{place}: {there}'
        return (f'{place}: recorded {self.recorded!r}, re-simulated {self.made!r}, '
                f'difference {self.made - self.recorded:.3g}')


class Comparison:
    """Compares the steps of a recording."""

    def __init__(self, bag: Bag) -> None:
        self._events = _Topic(bag, MODE_EVENT)
        self._states = [_Topic(bag, SLIDER_STATE), _Topic(bag, FRICTION_FORCE)]

    def first_difference(self, step: RecordedStep, made: Made) -> Difference | None:
        """Return the first difference in a step, in the order of its messages; None when there is none.

        Raises RecordingError on messages that this version does not know.
        """
        return self._in_events(step, made) or next(filter(None, (
            topic.difference(message, made.number, made.sample)
            for topic in self._states for message in step.outputs[topic.topic])), None)

    def _in_events(self, step: RecordedStep, made: Made) -> Difference | None:
        recorded, topic = step.outputs[MODE_EVENT], self._events
        for message, event in zip(recorded, made.events):
            if found := topic.difference(message, max(made.number, 1), event):   # step 0 has no length
                return found
        if len(recorded) > len(made.events):
            time = recorded[len(made.events)].log_time * 1e-9
            return Difference(made.number, time, topic.name, 'transition', time, None)
        if len(recorded) < len(made.events) and step.is_whole:
            time = made.events[len(recorded)].time
            return Difference(made.number, time, topic.name, 'transition', None, time)
        return None


class _Topic:
    """The messages of a topic, in the form that the recording itself describes."""

    def __init__(self, bag: Bag, topic: Topic) -> None:
        self.topic, self.name = topic, bag.name_of(topic)
        self._path = bag.path
        self._layout = bag.layout(self.name)
        self._packer = Packer(topic, self._layout)

    def difference(self, message: RecordedMessage, number: int, output: Sample | Event) -> Difference | None:
        """Return the first field that differs, None when all bytes are the same."""
        stamp = message.publish_time - message.log_time + output.instant.nanoseconds
        try:
            made = self._packer.pack(stamp, number, output)
        except AttributeError as error:
            raise RecordingError(f'{self._path}: {self.name}: its field {error.name} is unknown here; recorded by '
                                 'another version?') from None
        except struct.error:
            raise RecordingError(f'{self._path}: {self.name}: published at {message.publish_time} ns, not a valid '
                                 'stamp') from None
        return None if made == message.data else self._field(message.data, made, number, output.time)

    def _field(self, recorded: bytes, made: bytes, number: int, time: float) -> Difference:
        theirs, ours = self._layout.numbers(recorded), self._layout.numbers(made)
        if theirs is None or ours is None:
            raise RecordingError(f'{self._path}: {self.name}: {len(recorded)} bytes that are not a message of its type')
        for name, a, b in zip(self._layout.names, theirs, ours):
            if repr(a) != repr(b):     # separates 0.0 from −0.0, and takes NaN for itself
                return Difference(number, time, self.name, name, a, b)
        a, b = (int.from_bytes(data[4:8], 'little') + 1e-9 * int.from_bytes(data[8:12], 'little')
                for data in (recorded, made))
        return Difference(number, time, self.name, 'header.stamp', a, b)


_REPORTED_EVERY = 1000   # steps


class Verdict(NamedTuple):
    """What was the same: steps with their states, up to `end` (s), and transitions; then the first difference."""

    steps: int
    events: int
    missing: int          # steps before the last of those, without a recorded state
    end: float
    difference: Difference | None


def verify(run: RecordedRun, progress: Progress = None) -> Verdict:
    """Run a recording again up to its end or to the first difference.

    Raises RecordingError when there is nothing in it to compare, SolverError when the solver gives up.
    """
    if (offline := offline_of(run)) and (same := same_bytes(run, simulate(run.scene, *offline, progress))):
        return Verdict(same.steps, same.events, 0, same.end, None)
    maker = maker_of(run, run.scene, progress=progress)
    look = _Look(run.bag, maker, None if offline else progress)
    for step in steps_of(run, maker.start):
        look.at(step)
        if look.difference:
            break
    if not (look.steps or look.difference):
        raise RecordingError(f'{run.bag.path}: no step with its state; nothing can be verified')
    return Verdict(look.steps, look.events, look.missing, look.end, look.difference)


class _Look:
    """Makes and compares one recorded step after the other."""

    def __init__(self, bag: Bag, maker: Maker, progress: Progress) -> None:
        self.steps = self.events = self.missing = 0
        self.end = 0.0
        self.difference: Difference | None = None
        self._first = maker.start + 1
        self._maker, self._progress = maker, progress
        self._comparison = Comparison(bag)
        self._total = sum(bag.counts[topic] for topic, kind in bag.topics.items() if kind == SLIDER_STATE.type)

    def at(self, step: RecordedStep) -> None:
        made = deque(self._maker.make(step), 1).pop()    # those before it were not recorded
        self.difference = self._comparison.first_difference(step, made)
        if self.difference:
            return
        self.events += len(step.outputs[MODE_EVENT])
        if step.is_whole:
            self.steps += 1
            self.missing = made.number + 1 - self._first - self.steps
            self.end = made.sample.time
            if self._progress and self.steps % _REPORTED_EVERY == 0:
                self._progress(self.steps / self._total)
