# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Units of measured data, and their numbers in SI, rounded once."""

import difflib
import re
from collections.abc import Mapping
from decimal import Decimal
from fractions import Fraction

import numpy as np
from numpy.typing import NDArray

from ..core.errors import InputError

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


def unit_of(option: str, word: str, units: Mapping[str, Fraction]) -> str:
    """Return a unit as it is spelled here; raises InputError on one that is not known."""
    found = word.strip().replace('µ', 'u').replace('μ', 'u')
    if found in units:
        return found
    close = difflib.get_close_matches(found, units, 1)
    raise InputError(option, word, 'one of ' + ', '.join(units),
                     f'did you mean {close[0]}?' if close else 'convert the column to one of them')


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
    """Return finite numbers of a unit in SI, each as `in_si` does."""
    if unit == 1:
        return values
    digits = len(str(unit.denominator)) - 1
    if unit == Fraction(1, 10**digits):
        return np.array([float(Decimal(repr(value)).scaleb(-digits)) for value in values.tolist()])
    return np.array([in_si(value, unit) for value in values.tolist()])
