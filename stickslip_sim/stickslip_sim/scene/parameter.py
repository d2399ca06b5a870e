# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""One parameter of a scene: its name, its range, and the check of a value."""

import math
import re
import sys
from array import array
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from ..core.errors import InputError
from ..core.ranges import Range

TEXT_LIMIT = 200   # characters
LONG = 500         # numbers of a list that is checked as a whole

_PLAIN = {
    'string': f'printable text of at most {TEXT_LIMIT} characters',
    'bool': 'true or false',
    'integer': 'a whole number',
    'double': 'a number',
    'double_array': 'a list of at least one number',
    'string_array': f'a list of at least one text, each of 1 to {TEXT_LIMIT} printable characters',
}
_SEQUENCES = (list, tuple, array)
_START_OF_NAMES = re.compile(r'([a-z][\w/-]*)?', re.ASCII | re.IGNORECASE)    # as URDF, TF and ros2_control take it


@dataclass(frozen=True, slots=True)
class When:
    """A parameter has a meaning only while another one, `name`, has one of these `values`."""

    name: str
    values: tuple[object, ...]

    def holds(self, values: Mapping[str, object]) -> bool:
        """Return whether the parameter has a meaning among these values."""
        return values.get(self.name) in self.values

    def __str__(self) -> str:
        return f'{self.name}: ' + ' or '.join(map(yaml_word, self.values))


@dataclass(frozen=True, slots=True)
class Parameter:
    """A parameter of a scene; `default` is its value when it is left out but has a meaning (see `when`).

    Without a default it is `required`, or optional and then absent.  `low` and `high` bound numbers, also those of a
    list; `infinite` lets +infinity in beside them.  `live`: it may change while the node runs.  `starts_names`: it
    stands before the names of joints and frames.
    """

    name: str                       # dotted
    type: str                       # double, double_array, string, string_array, bool or integer
    default: object
    unit: str
    description: str
    low: float | None = None
    high: float | None = None
    low_open: bool = False
    infinite: bool = False
    choices: tuple[str, ...] = ()
    live: bool = False
    when: When | None = None
    required: bool = False
    starts_names: bool = False

    @property
    def range(self) -> str:
        """The bounds in words, empty without any."""
        if self.starts_names:
            return 'empty, or a letter (a to z, A to Z), then letters, digits, _, - and /'
        parts = []
        if self.low is not None:
            parts.append(f'{">" if self.low_open else ">="} {_bound(self.low)}')
        if self.high is not None:
            parts.append(f'<= {_bound(self.high)}')
        return ' and '.join(parts) + (', or .inf' if self.infinite else '')

    @property
    def allowed(self) -> str:
        """The range of a value, in words."""
        if self.choices:
            return 'one of ' + ', '.join(self.choices)
        bounds = f', {self.range}' if self.range else ''
        return _PLAIN[self.type] + bounds + (f' {self.unit}' if bounds and self.unit else '')

    def checked(self, value: object) -> object:
        """Return a value as the type of this parameter (lists as tuples); raises InputError when it is none."""
        if self.type == 'double_array':
            return self._doubles(self._items(value, '[0.0, 1.0]'))
        if self.type == 'string_array':
            return tuple(self._text(text, value) for text in self._items(value, '[one, another]'))
        if self.type == 'double':
            return self._double(value, value)
        if self.type == 'integer':
            return self._integer(value)
        if self.type == 'bool':
            if not isinstance(value, bool):
                raise InputError(self.name, value, self.allowed, 'write true or false without quotes')
            return value
        return self._string(value)

    def _items(self, value: object, example: str) -> Sequence[object]:
        if not isinstance(value, _SEQUENCES) or not value:
            raise InputError(self.name, value, self.allowed, f'write it as {example}')
        return value

    def _text(self, value: object, given: object) -> str:
        if not isinstance(value, str) or not 0 < len(value) <= TEXT_LIMIT or not value.isprintable():
            raise InputError(self.name, given, self.allowed, 'put each in quotes')
        return value

    def _doubles(self, items: Sequence[object]) -> tuple[float, ...]:
        if len(items) < LONG or set(map(type, items)) != {float}:
            return tuple(self._double(number, items) for number in items)
        import numpy as np  # costs more than a short list

        numbers = np.array(items, dtype=np.float64)
        sizes = np.abs(numbers[numbers != 0.0])
        ends = float(numbers.min()), float(numbers.max())
        if np.isnan(numbers).any() or not all(map(self._in_range, ends)) or sizes.min(initial=1.0) < sys.float_info.min:
            return tuple(self._double(number, items) for number in items)
        return tuple((numbers + 0.0).tolist())

    def _double(self, value: object, given: object) -> float:
        if isinstance(value, bool) or not isinstance(value, (int, float)):
            raise InputError(self.name, given, self.allowed, 'write it as 350.0 or 6.0e5, without quotes')
        number = float(value) if isinstance(value, float) or abs(value) < 2**1000 else math.nan
        if not self._in_range(number):
            unit = f', in {self.unit}' if self.unit else ''
            raise InputError(self.name, given, self.allowed, f'give a value in this range{unit}')
        if 0.0 < abs(number) < sys.float_info.min:
            raise InputError(self.name, given, '0 or a normal double', 'ROS reads such a number as text; use 0.0')
        return number + 0.0   # makes −0.0 the same as 0.0

    def _integer(self, value: object) -> int:
        if isinstance(value, bool) or not isinstance(value, int):
            raise InputError(self.name, value, self.allowed, 'write it without a decimal point')
        if not self._in_range(value):
            raise InputError(self.name, value, self.allowed, 'give a value in this range')
        return value

    def _string(self, value: object) -> str:
        if self.choices:
            if not isinstance(value, str) or value not in self.choices:
                raise InputError(self.name, value, self.allowed, 'choose one of these')
            return value
        if not isinstance(value, str):
            raise InputError(self.name, value, self.allowed, 'put it in quotes')
        if len(value) > TEXT_LIMIT or not value.isprintable():
            raise InputError(self.name, value, self.allowed, 'shorten it, and leave out control characters')
        if self.starts_names and not _START_OF_NAMES.fullmatch(value):
            raise InputError(self.name, value, self.allowed, 'write it like x_ or left/')
        return value

    def _in_range(self, value: float) -> bool:
        low = -math.inf if self.low is None else self.low
        high = math.inf if self.high is None or (self.infinite and value == math.inf) else self.high
        return (low < value if self.low_open else low <= value) and value <= high


def _bound(number: float) -> str:
    short = f'{number:g}'
    return short if float(short) == number else f'{number:.16g}'


def yaml_word(value: object) -> str:
    """Return a choice as it is written in a scene file."""
    return str(value).lower() if isinstance(value, bool) else str(value)


# Short ways to declare the parameters of a scene.

def number(name: str, default: float | None, unit: str, description: str, *, within: Range, above: bool = False,
           infinite: bool = False, live: bool = False, when: When | None = None, required: bool = True) -> Parameter:
    """Return a double within a range (with `above` not at its low end); required when it has no default."""
    return Parameter(name, 'double', default, unit, description, *within, above, infinite, (), live, when,
                     required and default is None)


def numbers(name: str, default: tuple[float, ...] | None, unit: str, description: str, *, within: Range,
            infinite: bool = False, live: bool = False, when: When | None = None, required: bool = True) -> Parameter:
    """Return a list of doubles."""
    return Parameter(name, 'double_array', default, unit, description, *within, infinite=infinite, live=live,
                     when=when, required=required and default is None)


def texts(name: str, description: str) -> Parameter:
    """Return a list of texts that may be left out."""
    return Parameter(name, 'string_array', None, '', description)


def choice(name: str, default: str | None, description: str, choices: tuple[str, ...], when: When | None = None
           ) -> Parameter:
    """Return a text that is one of a few."""
    return Parameter(name, 'string', default, '', description, choices=choices, when=when)
