# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Units of measured data: their numbers in SI, how options and headings name them, and columns that have one."""

import difflib
import math
import re
from collections.abc import Mapping, Sequence
from decimal import Decimal
from fractions import Fraction
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..core.arrays import Numbers
from ..core.errors import InputError

_MOST_EXACT = 200_000
_SCALED = re.compile(r'([+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d{1,2})?)\s*\*?\s*(.+)')   # 0.05 um
_LARGEST = 1e15    # factor

SPEEDS: Mapping[str, Fraction] = {
    'm/s': Fraction(1), 'cm/s': Fraction(1, 100), 'mm/s': Fraction(1, 1000), 'um/s': Fraction(1, 10**6),
    'm/min': Fraction(1, 60), 'mm/min': Fraction(1, 60_000), 'in/s': Fraction(254, 10**4),
    'in/min': Fraction(254, 60 * 10**4),
}
LENGTHS: Mapping[str, Fraction] = {'m': Fraction(1), 'mm': Fraction(1, 1000), 'um': Fraction(1, 10**6),
                                   'nm': Fraction(1, 10**9), 'cm': Fraction(1, 100), 'in': Fraction(254, 10**4)}
ACCELERATIONS: Mapping[str, Fraction] = {'m/s2': Fraction(1), 'mm/s2': Fraction(1, 1000),
                                         'g': Fraction(980665, 10**5)}
TIMES: Mapping[str, Fraction] = {'s': Fraction(1), 'ms': Fraction(1, 1000), 'us': Fraction(1, 10**6),
                                 'ns': Fraction(1, 10**9), 'min': Fraction(60)}
FORCES: Mapping[str, Fraction] = {'N': Fraction(1), 'mN': Fraction(1, 1000), 'kN': Fraction(1000),
                                  'lbf': Fraction(44482216152605, 10**13)}
STIFFNESSES: Mapping[str, Fraction] = {'N/m': Fraction(1), 'kN/m': Fraction(1000), 'N/mm': Fraction(1000),
                                       'kN/mm': Fraction(10**6), 'N/um': Fraction(10**6), 'MN/m': Fraction(10**6)}

# What turns, by the SI unit of what it moves; a lead (m a turn) converts it.
PERCENT = '%'
_RATED = re.compile(r'% *(?:of )?(?:the )?(?:rated|nominal)\b.*')    # "% rated", "% of rated torque"
_TURN = Fraction(2.0 * math.pi)
_TURNS = {'rad': 1 / _TURN, 'mrad': 1 / (1000 * _TURN), 'deg': Fraction(1, 360), 'rev': Fraction(1)}
_ROTARY: Mapping[str, Mapping[str, Fraction]] = {
    'm': _TURNS, 'm/s': {**{f'{unit}/s': turns for unit, turns in _TURNS.items()}, 'rpm': Fraction(1, 60),
                         '1/min': Fraction(1, 60)},
    'm/s2': {f'{unit}/s2': turns for unit, turns in _TURNS.items()},
    'N': {'N m': _TURN, 'Nm': _TURN, 'mN m': _TURN / 1000, 'mNm': _TURN / 1000},
}


class DriveUnits(NamedTuple):
    """What a drive counts in: turns of a screw without friction with a `lead` (m a turn), % of a `rated` force (N)."""

    lead: Fraction | None = None
    rated: Fraction | None = None

    def of(self, units: Mapping[str, Fraction]) -> Mapping[str, Fraction]:
        """Return units, and those that are stated: rpm, rad/s, N m, %."""
        si, lead = next(iter(units)), self.lead
        turned = {} if lead is None else {unit: turns / lead if si == 'N' else turns * lead
                                          for unit, turns in _ROTARY.get(si, {}).items()}
        return {**units, **turned, **({PERCENT: self.rated / 100} if si == 'N' and self.rated is not None else {})}


SI_ALONE = DriveUnits()


def drive_units(lead: str | None, rated: str | None) -> DriveUnits:
    """Return the units of a drive from texts as "10 mm" and "2.4 N m", or a force; raises InputError."""
    turn = None if lead is None else Fraction(stated('--lead', lead, LENGTHS))
    if turn is not None and turn <= 0:
        raise InputError('--lead', lead, '> 0 m a turn', 'for the opposite sense use a unit such as "-1 deg"')
    force = None if rated is None else Fraction(stated('--rated', rated, DriveUnits(turn).of(FORCES)))
    if force is not None and force <= 0:
        raise InputError('--rated', rated, '> 0, a torque or a force', 'for the opposite sense use the unit "-1 %"')
    return DriveUnits(turn, force)


def stated(option: str, text: str, units: Mapping[str, Fraction]) -> float:
    """Return a number with its unit, as "10 mm", in SI; raises InputError."""
    if not re.fullmatch(r'[-+.\d]\S* *[^-+.\d\s].*', text.strip()):
        raise InputError(option, text, 'a number with its unit', f'for example "10 {next(iter(units))}"')
    return float(wanted_column('', '', option, text, units).in_si)


def unit_of(option: str, word: str, units: Mapping[str, Fraction]) -> str:
    """Return a unit as it is spelled here; raises InputError on one that is not known."""
    found = _RATED.sub(PERCENT, word.strip().replace('µ', 'u').replace('μ', 'u'))
    if found in units:
        return found
    close = difflib.get_close_matches(found, units, 1)
    fix = f'did you mean {close[0]}?' if close else 'convert the column to one of them'
    raise InputError(option, word, 'one of ' + ', '.join(units), _drive_fix(found, units) or fix)


def _drive_fix(word: str, units: Mapping[str, Fraction]) -> str:
    si = next(iter(units))
    if unit_in(word, _ROTARY.get(si, {})):
        return 'it is of a turn: give --lead, as "10 mm" a turn'
    return 'it is of a rating: give --rated, as "2.4 N m" or "800 N"' if si == 'N' and PERCENT in word else ''


def named_unit(heading: str, units: Mapping[str, Fraction]) -> str | None:
    """Return the unit in the heading of a column, as in "speed [mm/s]" or "speed_mm_per_s"; None without one."""
    words = heading.replace('µ', 'u').replace('μ', 'u').replace('_per_', '/')
    for unit in sorted(units, key=len, reverse=True):
        if re.search(rf'(?<![A-Za-z/]){re.escape(unit)}(?![A-Za-z/])', words):
            return unit
    return None


def in_si(value: float, unit: Fraction) -> float:
    """Return a finite number of a unit in SI: 0.5 mm/s is 0.0005 m/s to the last bit."""
    return float(Fraction(repr(value)) * unit)


def all_in_si(values: NDArray[np.float64], unit: Fraction) -> NDArray[np.float64]:
    """Return finite numbers of a unit in SI, each as `in_si` does; of very many, to the last bit but one."""
    if unit == 1:
        return values
    if len(values) > _MOST_EXACT:
        scaled: Numbers = values * float(unit.numerator)
        scaled /= float(unit.denominator)    # one column less at once
        return scaled
    digits = len(str(unit.denominator)) - 1
    if unit == Fraction(1, 10**digits):
        return np.array([float(Decimal(repr(value)).scaleb(-digits)) for value in values.tolist()])
    return np.array([in_si(value, unit) for value in values.tolist()])


class Wanted(NamedTuple):
    """A column: its `name` and `unit`, the options that gave them, and the `units` that it may have.

    A number in it stands for so many units as `factor` says.  `is_stated`: the unit is not that of the heading;
    `is_default`: nobody said so, it is SI.
    """

    name_option: str
    name: str
    unit_option: str
    unit: str
    units: Mapping[str, Fraction]
    factor: Fraction = Fraction(1)
    is_stated: bool = True
    is_default: bool = False

    @property
    def in_si(self) -> Fraction:
        """What a 1 in the column is in SI; raises InputError on an unknown unit."""
        return self.factor * self.units[unit_of(self.unit_option, self.unit, self.units)]


def wanted_column(name_option: str, name: str, unit_option: str, unit: str | None, units: Mapping[str, Fraction],
                  takes_heading: bool = False) -> Wanted:
    """Return a column that is wanted; its unit (None: SI, the first) may have a factor before it: `0.05 um`, `-1 mm`.

    `takes_heading`: where none is stated it is that of the heading.  Raises InputError on a factor that is none.
    """
    scaled = None if unit is None else _SCALED.fullmatch(unit.strip())
    factor = Fraction(scaled[1]) if scaled else Fraction(1)
    if factor == 0 or abs(factor) > _LARGEST:
        raise InputError(unit_option, unit, 'a unit, or one with a factor that is not 0', 'for example 35.15 N')
    word = scaled[2] if scaled else unit or next(iter(units))
    return Wanted(name_option, name, unit_option, word, units, factor, not takes_heading or unit is not None,
                  unit is None)


# The unit that a heading says, or a cell of a row of units below it.

_IN_BRACKETS = re.compile(r'[\[(]\s*([^\[\]()]+?)\s*[\])]$')
_ALIKE = {'µ': 'u', 'μ': 'u', '²': '2', '^2': '2', '·': ' ', '_per_': '/', 'seconds': 's', 'second': 's', 'sec': 's'}


def unit_in(heading: str, units: Mapping[str, Fraction]) -> str | None:
    """Return the unit that ends a heading, as in "speed [mm/s]", "speed_mm_per_s" or "speed mm/s"; None without one."""
    words = heading.strip()
    for word, unit in _ALIKE.items():
        words = words.replace(word, unit)
    found = _IN_BRACKETS.search(words)
    words = _RATED.sub(PERCENT, words if found is None else found[1])
    endings = [words] if found else [words, re.split(r'[ _]', words)[-1]]
    return next((unit for unit in endings if unit in units and (found or unit != 'in')), None)


def in_unit_of(column: Wanted, heading: str, below: Sequence[str]) -> Wanted:
    """Return a column in the unit of its heading, or of the cells `below`, where none was stated.

    Raises InputError where another one was, or where it is unknown.
    """
    if column.is_stated:
        unit = None if heading == column.unit else named_unit(heading, column.units) or next(
            (unit for cell in below if (unit := unit_in(cell, column.units))), None)
        if unit is not None and unit != unit_of(column.unit_option, column.unit, column.units):
            raise InputError(column.unit_option, column.unit, f'{unit}, as the heading says: {heading}',
                             f'give {column.unit_option} as {unit}, or correct the heading')
        unknown = _IN_BRACKETS.search(heading) if column.is_default and column.name != heading else None
        if unknown and not named_unit(heading, column.units):
            raise InputError(column.unit_option, unknown[1], 'one of ' + ', '.join(column.units),
                             f'{heading} has another one: state it, or how much a 1 is, as "35.15 {column.unit}"')
        return column
    said = [cell for cell in ('' if heading in column.units else heading, *below) if unit_in(cell, column.units)]
    if said:
        return column._replace(unit=unit_in(said[-1], column.units) or column.unit)
    other = next((cell for cell in (heading[heading.find('['):] if '[' in heading else '', *below)
                  if cell.strip('[] -1')), None)
    if other is not None and not other.strip('[]').isdecimal():
        raise InputError(column.unit_option, other, 'one of ' + ', '.join(column.units),
                         _drive_fix(other, column.units)
                         or f'state how much a 1 in {column.name} is: {column.unit_option} "35.15 {column.unit}"')
    return column
