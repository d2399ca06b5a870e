# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""One parameter of a scene that a study varies: its name, from where to where, and how."""

import math
import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from ..core.arrays import Numbers
from ..core.errors import InputError, suggestion
from ..report.quantity import quantity
from ..scene.parameter import Parameter
from ..scene.schema import BY_NAME, PROFILES, forward_name

MOTION_SECTIONS = ('axis', 'contact', 'friction', *PROFILES, 'initial', 'solver')
GAIN = 'gain'    # the section of the arguments of a controller, beside those of a scene
_LARGEST = 1e15
_ALONG = {   # where an element of a list is
    'friction.kinetic.coefficients': 'friction.kinetic.velocities',
    'friction.excess.fractions': 'friction.excess.velocities',
    'friction.kinetic.backward.coefficients': 'friction.kinetic.backward.velocities',
    'friction.excess.backward.fractions': 'friction.excess.backward.velocities',
    'drive.velocities': 'drive.times', 'drive.positions': 'drive.times', 'drive.slopes': 'drive.times',
    'drive.amplitudes': 'drive.frequencies',
    'force.forces': 'force.times', 'force.amplitudes': 'force.frequencies',
    'normal_load.forces': 'normal_load.times', 'normal_load.amplitudes': 'normal_load.frequencies',
}
ParameterOf = Callable[[str], tuple[Parameter, int | None]]
_FORM = 'a.b=LOW:HIGH:N or a.b=LOW:HIGH:N:log'
_DRAWN_FORM = 'a.b=LOW:HIGH or a.b=LOW:HIGH:log'


@dataclass(frozen=True, slots=True)
class Variation:
    """A number of a scene from `low` to `high`, evenly or on a logarithmic scale.

    `name` is a parameter, or an element of a list, as in friction.kinetic.coefficients[1].  `count` is the number of
    values on a grid; 0: it is drawn.
    """

    name: str
    low: float
    high: float
    count: int = 0
    log: bool = False

    @property
    def unit(self) -> str:
        """Of the parameter, as in the schema."""
        return entry_of(self.name)[0].unit

    def grid(self) -> Numbers:
        """Return the values, both ends among them."""
        spread = np.geomspace if self.log else np.linspace
        return np.asarray(spread(self.low, self.high, self.count), dtype=np.float64)

    def at(self, shares: Numbers) -> Numbers:
        """Return the values at shares of the way from `low` (0) to `high` (1)."""
        if self.log:
            return self.low * (self.high / self.low) ** shares
        return self.low + (self.high - self.low) * shares


def variation(text: str, drawn: bool = False, find: ParameterOf | None = None) -> Variation:
    """Return the variation of `a.b=LOW:HIGH:N[:log]`, without N for a drawn one; raises InputError.

    `find` says which parameters may vary, as `parameter_of` does, and raises on others.
    """
    name, equals, rest = text.partition('=')
    name, words = name.strip(), rest.split(':')
    log = words[-1].strip() == 'log'
    words = words[:-1] if log else words
    if not equals or not name or len(words) != (2 if drawn else 3):
        raise InputError('--over', text, _DRAWN_FORM if drawn else _FORM,
                         'a Sobol sample has no N for each parameter' if drawn else 'N is the number of values')
    (find or parameter_of)(name)
    low, high = (_number(name, word) for word in words[:2])
    return checked(Variation(name, low, high, 0 if drawn else _count(name, words[2]), log))


def range_of(option: str, name: str, text: str) -> Variation:
    """Return the range LOW:HIGH of a parameter, on a logarithmic scale where it is above 0; raises InputError."""
    words = text.split(':')
    if len(words) != 2:
        raise InputError(option, text, 'LOW:HIGH', 'for example 1e-3:0.1')
    parameter_of(name)
    low, high = (_number(name, word) for word in words)
    return checked(Variation(name, low, high, log=low > 0.0))


def checked(wanted: Variation) -> Variation:
    """Return a variation whose range makes sense; raises InputError."""
    name, low, high = wanted.name, wanted.low, wanted.high
    if not low < high:
        raise InputError(name, f'{low:g}:{high:g}', 'a range LOW:HIGH with LOW < HIGH',
                         'swap the two' if low > high else 'use --set for a single value')
    if wanted.log and not low > 0.0:
        raise InputError(name, low, '> 0 on a logarithmic scale', 'leave :log out, or begin above 0')
    return wanted


def parameter_of(name: str, sections: Sequence[str] = MOTION_SECTIONS) -> tuple[Parameter, int | None]:
    """Return the parameter that a variation names and the index of an element; raises InputError.

    It must be a number in one of these sections: as a rule one that decides the motion.
    """
    section = name.partition('[')[0].partition('.')[0]
    if section not in sections and (name.partition('[')[0] in BY_NAME or section == GAIN):
        raise InputError('parameter', name, 'one that decides the motion: in ' + ', '.join(sections),
                         'the others do not affect the motion')
    return entry_of(name)


def entry_of(name: str) -> tuple[Parameter, int | None]:
    """Return the number that a variation names, of a scene or a controller, and the index of an element.

    Raises InputError.
    """
    if name.startswith(f'{GAIN}.') and name.removeprefix(f'{GAIN}.').isidentifier():
        return Parameter(name, 'double', None, '', 'an argument of a controller', low=-_LARGEST, high=_LARGEST), None
    found = re.fullmatch(r'([^\[\]]+)(?:\[(0|[1-9][0-9]{0,8})\])?', name)
    entry = BY_NAME.get(found[1]) if found else None
    if found is None or entry is None:
        raise InputError('parameter', name, 'a parameter of a scene (docs/scene.md)',
                         suggestion(name, BY_NAME, 'check the name'))
    if entry.type == 'double' and found[2] is None:
        return entry, None
    if entry.type == 'double_array' and found[2] is not None:
        return entry, int(found[2])
    what = 'a list of numbers' if entry.type == 'double_array' else 'no list' if found[2] else f'a {entry.type}'
    raise InputError('parameter', name, f'a number; this is {what}',
                     f'vary an element of it: {entry.name}[0]' if entry.type == 'double_array' else 'use --set for it')


def number_at(values: Mapping[str, object], name: str) -> float | None:
    """Return the number of a scene (`values`) that a variation names, None where it has none; raises InputError."""
    entry, index = entry_of(name)
    value = values.get(entry.name)
    if index is not None:
        value = value[index] if isinstance(value, tuple) and index < len(value) else None
    return value if isinstance(value, float) else None


def place_of(values: Mapping[str, object], name: str) -> str:
    """Return where the element of a list that a variation names is in a scene (`values`): '35 mm/s'; else nothing."""
    entry, index = entry_of(name)
    along = _ALONG.get(entry.name, '')
    places = values.get(along, values.get(forward_name(along)))
    if index is None or not isinstance(places, tuple) or index >= len(places):
        return ''
    return quantity(places[index], BY_NAME[along].unit, 4)


def with_place(values: Mapping[str, object], name: str) -> str:
    """Return the name of a variation, with where it is: friction.kinetic.coefficients[1] (at 35 mm/s)."""
    place = place_of(values, name)
    return f'{name} (at {place})' if place else name


def changes_at(base: Mapping[str, object], names: Sequence[str], point: Numbers) -> dict[str, object]:
    """Return the changes to the values of a scene that make a point; raises InputError.

    An element of a list must be there; a list backwards that is left out is that forwards.
    """
    changes: dict[str, object] = {}
    for name, number in zip(names, point.tolist(), strict=True):
        entry, index = entry_of(name)
        if index is None:
            changes[name] = number
            continue
        items = changes.get(entry.name, base.get(entry.name, base.get(forward_name(entry.name), ())))
        if not isinstance(items, tuple) or index >= len(items):
            count = len(items) if isinstance(items, tuple) else 0
            raise InputError('parameter', name, f'an element of {entry.name}, of which this scene has {count}',
                             'count from 0')
        changes[entry.name] = (*items[:index], number, *items[index + 1:])
    return changes


def _number(name: str, word: str) -> float:
    try:
        number = float(word)
    except ValueError:
        number = math.nan
    if not math.isfinite(number):
        raise InputError(name, word.strip(), 'a finite number at both ends of its range', 'write it as 350.0 or 6e5')
    entry, index = entry_of(name)
    entry.checked(number if index is None else (number,))
    return number


def _count(name: str, word: str) -> int:
    if not word.strip().isascii() or not word.strip().isdigit() or int(word[:40]) < 2:
        raise InputError(name, word.strip(), 'a whole number N >= 2 of values', 'use --set for a single value')
    return int(word[:40])
