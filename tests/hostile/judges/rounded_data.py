# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The same scene with each number of its data off by rounding: what no arithmetic in doubles can tell from it."""

import math
import zlib
from dataclasses import fields, is_dataclass, replace
from typing import Any

from ..case import Parts

SIZE = 1e-14            # of each number: 90 times what a double rounds, for the sums along 20 events
_GIVEN = {'fractions'}  # shares of one whole, which are 1 and 0


def rounded_data(parts: Parts, salt: int, size: float = SIZE) -> Parts:
    """Return the parts with each number moved by its own share of `size`; raises InputError where their order is lost.

    Equal numbers stay equal, and opposite ones opposite, since a scene means that (mu_s(0) = mu_k(0), a drive that
    comes back).  The duration stays.
    """
    return Parts(*(_moved(part, salt, size) for part in parts))._replace(duration=parts.duration)


def _moved(value: Any, salt: int, size: float) -> Any:
    if type(value) is float:
        return value * (1.0 + size * _share(abs(value), salt)) if math.isfinite(value) else value
    if isinstance(value, tuple):
        moved = [_moved(one, salt, size) for one in value]
        return type(value)(*moved) if hasattr(value, '_fields') else tuple(moved)
    if is_dataclass(value) and not isinstance(value, type):
        return replace(value, **{one.name: _moved(getattr(value, one.name), salt, size) for one in fields(value)
                                 if one.name not in _GIVEN})
    return value


def _share(value: float, salt: int) -> float:
    """Return a number between −1 and 1 that any other value has otherwise."""
    return zlib.crc32(f'{salt} {value!r}'.encode()) / 2.0 ** 31 - 1.0
