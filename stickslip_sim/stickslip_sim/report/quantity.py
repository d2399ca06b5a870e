# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Numbers in words: with their units, and counts."""

import math
from collections.abc import Sequence

_PREFIXES = ((1e3, 'k'), (1.0, ''), (1e-3, 'm'), (1e-6, 'µ'), (1e-9, 'n'))


def quantity(value: float, unit: str, digits: int = 5) -> str:
    """Return a number, and its unit with the prefix that suits it: 659.07 ms."""
    if not unit or value == 0.0 or not math.isfinite(value):
        return f'{value + 0.0:.{digits}g} {unit}'.rstrip()    # 0.0, not -0.0
    if unit == 'kg' and abs(value) < 1.0:    # it has a prefix already
        return quantity(1e3 * value, 'g', digits)
    scale, prefix = next(((s, p) for s, p in _PREFIXES if abs(value) >= s), _PREFIXES[-1])
    if unit in ('s', 'kg') and scale > 1.0:
        scale, prefix = 1.0, ''
    number = f'{value / scale:.{digits}g}'
    if abs(value / scale) < 1e3 and 'e' in number:    # 4.6e+02
        number = f'{float(number):.0f}'
    return f'{number} {prefix}{unit}'


def quantities(values: Sequence[float], unit: str, digits: int = 5) -> list[str]:
    """Return numbers that are read beside each other: all with the prefix that suits the one in the middle."""
    middle = sorted(values)[len(values) // 2]
    if unit == 'kg' and 0.0 < abs(middle) < 1.0:
        return quantities([1e3 * value for value in values], 'g', digits)
    first = quantity(middle, unit, digits).rpartition(' ')[2]
    scale = next((s for s, p in _PREFIXES if unit and first == f'{p}{unit}'), 1.0)
    if any(abs(value) >= scale * 10.0 ** digits for value in values):   # it would be written as a power of ten
        return [quantity(value, unit, digits) for value in values]
    return [f'{value / scale:.{digits}g} {first if unit else ""}'.rstrip() for value in values]


def counted(count: int, what: str) -> str:
    """Return a count of things, of one without the s."""
    return f'{count} {what}' + ('' if count == 1 else 's')
