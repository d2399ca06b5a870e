# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Recorded messages beside what was made again: every field, to the last bit."""

import struct
from typing import NamedTuple

from ..core.errors import RecordingError
from ..core.types import Event, Sample
from ..recording import Bag, RecordedMessage
from ..recording.messages import Packer
from ..recording.topics import FRICTION_FORCE, MODE_EVENT, SLIDER_STATE, Topic
from .recorded_steps import RecordedStep
from .remake import Made


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
            raise RecordingError(f'{self._path}: {self.name}: published at {message.publish_time} ns, which no stamp '
                                 'can say') from None
        return None if made == message.data else self._field(message.data, made, number, output.time)

    def _field(self, recorded: bytes, made: bytes, number: int, time: float) -> Difference:
        theirs, ours = self._layout.numbers(recorded), self._layout.numbers(made)
        if theirs is None or ours is None:
            raise RecordingError(f'{self._path}: {self.name}: {len(recorded)} bytes that are no message of its type')
        for name, a, b in zip(self._layout.names, theirs, ours):
            if repr(a) != repr(b):     # separates 0.0 from −0.0, and takes NaN for itself
                return Difference(number, time, self.name, name, a, b)
        a, b = (int.from_bytes(data[4:8], 'little') + 1e-9 * int.from_bytes(data[8:12], 'little')
                for data in (recorded, made))
        return Difference(number, time, self.name, 'header.stamp', a, b)
