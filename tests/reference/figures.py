# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Figures as they are printed, compared to the last of their digits."""

from typing import Any

from mpmath import mpf


def agrees(number: Any, printed: str | None) -> bool:
    """Compare with a printed figure, to a unit of its last digit (or 3e-16 where it is a double)."""
    if printed is None:
        return True
    mantissa, _, exponent = printed.partition('e')
    digits = len(mantissa.partition('.')[2])
    unit = 10.0 ** (int(exponent or 0) - digits)
    return bool(abs(number - mpf(printed)) <= max(unit, 3e-16 * abs(float(printed))))
