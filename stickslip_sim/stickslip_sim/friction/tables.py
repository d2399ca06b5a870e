# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Smooth laws become the tables that the engine works on, with an error that is stated and proven."""

import math
from functools import lru_cache

from ..core import ranges
from ..core.errors import InputError
from .kinetic import MAX_BREAKPOINTS, ExcessTable, KineticTable
from .refine import Breakpoint, shape_table, table_error
from .shapes import Shape
from .smooth import SmoothExcess, SmoothKinetic


def kinetic_table(law: SmoothKinetic, tolerance: float) -> KineticTable:
    """Return the table of a law with |table − law| <= `tolerance` at every speed; it carries law and error.

    The viscous part is linear, and so exact; at rest and at infinite speed the table is that of the law.  Raises
    InputError when it takes more than MAX_BREAKPOINTS breakpoints.
    """
    name = 'friction.kinetic'
    scale = law.initial - law.limit
    breakpoints = _breakpoints(name, law.shape, tolerance, abs(scale)) if scale else [(0.0, 0.0)]
    speeds = _speeds(f'{name}.stribeck_velocity', law.stribeck_velocity, breakpoints)
    values = [law.limit + scale * p + law.viscous * w for w, (_, p) in zip(speeds, breakpoints)]
    values[0] = law.initial
    error = table_error(law.coefficient, law.slope, law.inflection, list(zip(speeds, values)))
    tail = abs(scale) * law.shape.value(breakpoints[-1][0]) if scale else 0.0
    return KineticTable(tuple(speeds), tuple(values), law.viscous, law, _checked(name, tolerance, max(error, tail)),
                        tolerance)


def excess_table(law: SmoothExcess, tolerance: float) -> ExcessTable:
    """Return the table of a psi with |table − psi| <= `tolerance`; it carries law and error.  Raises InputError."""
    name = 'friction.excess'
    breakpoints = _breakpoints(name, law.shape, tolerance, 1.0)
    speeds = _speeds(f'{name}.limit_velocity', law.limit_velocity, breakpoints)
    values = [p for _, p in breakpoints]
    error = max(table_error(law.fraction, law.slope, law.inflection, list(zip(speeds, values))),
                law.fraction(speeds[-1]))
    return ExcessTable(tuple(speeds), tuple(values), law, _checked(name, tolerance, error))


def _breakpoints(name: str, shape: Shape, tolerance: float, scale: float) -> list[Breakpoint]:
    ranges.TOLERANCE.check_meaning(f'{name}.tolerance', tolerance, '', 'give the error that the table may have')
    breakpoints = _cached_shape_table(shape, tolerance / scale)
    if breakpoints is None:
        raise InputError(f'{name}.tolerance', tolerance, f'large enough for at most {MAX_BREAKPOINTS} breakpoints',
                         f'{_fitting(shape, scale):.1e} fits')
    return breakpoints


@lru_cache(maxsize=64)
def _cached_shape_table(shape: Shape, tolerance: float) -> list[Breakpoint] | None:
    """Return `shape_table`; a change of the scale of the speed, as in a sweep, asks for the same one again."""
    return shape_table(shape, tolerance, MAX_BREAKPOINTS)


def _fitting(shape: Shape, scale: float) -> float:
    """Return a tolerance of two digits that fits, near the smallest; breakpoints go with 1/√tolerance."""
    sample = 1e-3
    breakpoints = _cached_shape_table(shape, sample) or []
    tolerance = sample * (len(breakpoints) / MAX_BREAKPOINTS) ** 2
    while _cached_shape_table(shape, float(f'{tolerance * scale:.1e}') / scale) is None:
        tolerance *= 1.1
    return float(f'{tolerance * scale:.1e}')


def _speeds(name: str, scale: float, breakpoints: list[Breakpoint]) -> list[float]:
    speeds = [scale * z for z, _ in breakpoints]
    if math.isinf(speeds[-1]) or len(set(speeds)) < len(speeds):
        raise InputError(name, scale, 'within the range of speeds', 'give it in m/s')
    return speeds


def _checked(name: str, tolerance: float, error: float) -> float:
    """Return the error of a finished table; raises InputError when rounding alone is beyond the tolerance."""
    if not error <= tolerance:
        raise InputError(f'{name}.tolerance', tolerance, 'above the rounding of the coefficients',
                         f'rounding alone makes it {error!r}: raise it, or lower viscous')
    return error
