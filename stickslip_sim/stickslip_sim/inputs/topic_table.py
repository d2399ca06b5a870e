# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Numbers of a topic of a bag over time, as a table of measured numbers."""

import re
from collections.abc import Sequence
from pathlib import Path
from typing import Any, NoReturn

import numpy as np

from ..core.arrays import Numbers
from ..core.errors import InputError
from ..recording import Bag, RecordedMessage, open_bag
from .csv_table import Wanted
from .units import all_in_si

LOG_TIME = 'log_time'
_ELEMENT = re.compile(r'(\w+)\[([^\]]+)\]')   # velocity[0], or velocity[axis_drive] of a message with names


class TopicTable:
    """The chosen fields of a topic in SI, a row a message, times from the first message on, s.

    A field is named as in `ros2 topic echo`: `velocity`, `wrench.force.x`, `velocity[0]`; an element of a JointState by
    its joint, too: `velocity[axis_drive]`.  `first` is the time of the first message, s.  Raises InputError and
    RecordingError.
    """

    def __init__(self, option: str, path: Path, topic: str, time: Wanted, wanted: Sequence[Wanted], most_rows: int
                 ) -> None:
        bag = open_bag(path)
        self._option = option
        self._name = f'{path.name}:{topic}'
        messages = self._messages(bag, bag.resolved(topic), most_rows)
        decoded = [bag.decode(message) for message in messages]
        self.columns = [self._times(time, messages, decoded), *(self._numbers(column, decoded) for column in wanted)]

    def refuse(self, row: int, value: object, allowed: str, fix: str) -> NoReturn:
        """Raise the InputError for a row of the numbers."""
        raise InputError(f'{self._name} message {row + 1}', value, allowed, fix)

    def _messages(self, bag: Bag, topic: str, most: int) -> list[RecordedMessage]:
        messages: list[RecordedMessage] = []
        for message in bag.messages([topic]):
            messages.append(message)
            if len(messages) > most:
                raise InputError(self._option, self._name, f'a topic of at most {most} messages',
                                 'take a part of the bag')
        if not messages:
            raise InputError(self._option, self._name, 'a topic with messages', 'it has none')
        return messages

    def _times(self, time: Wanted, messages: Sequence[RecordedMessage], decoded: Sequence[Any]) -> Numbers:
        if time.name == LOG_TIME:
            stamps = [message.log_time for message in messages]
        elif time.name == 'header.stamp':
            stamps = [message.header.stamp.sec * 10**9 + message.header.stamp.nanosec for message in decoded]
        else:
            numbers = self._numbers(time, decoded)
            self.first = float(numbers[0])
            since_first: Numbers = numbers - numbers[0]
            return since_first
        self.first = stamps[0] / 1e9
        return np.array([(stamp - stamps[0]) / 1e9 for stamp in stamps])

    def _numbers(self, column: Wanted, decoded: Sequence[Any]) -> Numbers:
        values = np.empty(len(decoded))
        for row, message in enumerate(decoded):
            try:
                values[row] = _value(message, column.name)
            except (AttributeError, IndexError, TypeError, ValueError):
                self.refuse(row, column.name, f'a field that is a number ({column.name_option})',
                            'name it as `ros2 topic echo` does, like velocity or wrench.force.x or velocity[0]')
        if not np.isfinite(values).all():
            row = int(np.argmin(np.isfinite(values)))
            self.refuse(row, float(values[row]), 'a finite number', 'leave such messages out')
        return all_in_si(values, column.in_si)


def _value(message: Any, path: str) -> float:
    value = message
    for part in path.split('.'):
        element = _ELEMENT.fullmatch(part)
        if element is None:
            value = getattr(value, part)
        else:
            place = element[2]
            index = int(place) if place.isdecimal() else list(value.name).index(place)
            value = getattr(value, element[1])[index]
    return float(value)
