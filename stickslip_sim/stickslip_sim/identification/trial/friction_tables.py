# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Friction of trial values: smooth laws by their tables, without a proof of their error; static not below kinetic.

The breakpoints of a table go with the falling part of its law, and so with the trial: a fit with those of the start
makes up for their error by wrong numbers, and stays there with those of its end.
"""

from functools import lru_cache

from ...core.errors import InputError
from ...friction.kinetic import MAX_BREAKPOINTS
from ...friction.refine import Breakpoint, shape_table
from ...friction.shapes import Decay, Shape
from ...scene.friction_schema import backward_name, forward_name

Breakpoints = tuple[Breakpoint, ...]

_LAW = 'friction.kinetic.'
_EXCESS = 'friction.excess.'
_SMOOTH = 'initial', 'limit', 'stribeck_velocity', 'viscous', 'exponent', 'tolerance'
_DROPPED = frozenset(_LAW + name for name in _SMOOTH)
_FALLEN = 0.01       # as `SmoothKinetic.limit_velocity`


def with_table(values: dict[str, object], shape: Shape, held: Breakpoints | None = None) -> dict[str, object]:
    """Return values of a scene with the table of its smooth kinetic law, of a shape, in place of that.

    The breakpoints are those `held`, if any are.  An exponent among the values goes before that of the shape.  Where
    friction backwards differs it has a table of its own.  Raises InputError where a table takes too many breakpoints.
    """
    forwards = {name: value for name, value in values.items() if forward_name(name) == name}
    changes = {forward_name(name): value for name, value in values.items() if name not in forwards}
    table = _with_table(forwards, shape, held)
    back = _with_table(forwards | changes, shape, held) if changes else table
    return table | {backward_name(name): value for name, value in back.items() if value != table.get(name)}


def _with_table(values: dict[str, object], shape: Shape, held: Breakpoints | None) -> dict[str, object]:
    """Return the same of the values of one direction."""
    initial, limit, scale, viscous = (float(str(values[_LAW + name])) for name in _SMOOTH[:4])
    if _LAW + 'exponent' in values:
        shape = Decay(float(str(values[_LAW + 'exponent'])))
    points = held or breakpoints_of(values, shape)
    table = {name: value for name, value in values.items() if name not in _DROPPED}
    speeds = tuple(scale * z for z, _ in points)
    table[_LAW + 'law'] = 'table'
    table[_LAW + 'velocities'] = speeds
    table[_LAW + 'coefficients'] = (initial, *(limit + (initial - limit) * p + viscous * speed
                                               for speed, (_, p) in zip(speeds[1:], points[1:])))
    table[_LAW + 'end_slope'] = viscous
    end = scale * shape.reach(_FALLEN)
    if values.get('friction.acceleration_dependence'):
        if values.get(_EXCESS + 'law', 'table') != 'table':
            table.setdefault(_EXCESS + 'limit_velocity', end)
        elif _EXCESS + 'velocities' not in values:
            table[_EXCESS + 'velocities'], table[_EXCESS + 'fractions'] = (0.0, end), (1.0, 0.0)
    return table


def breakpoints_of(values: dict[str, object], shape: Shape, coarser: float = 1.0) -> Breakpoints:
    """Return the breakpoints (z, p) of the falling part of a law; raises InputError if they are too many.

    Those of a `coarser` table are for a tolerance so many times as large.
    """
    initial, limit, tolerance = (float(str(values[_LAW + name])) for name in ('initial', 'limit', 'tolerance'))
    return _breakpoints(shape, coarser * tolerance / abs(initial - limit)) if initial != limit else ((0.0, 0.0),)


@lru_cache(maxsize=64)
def _breakpoints(shape: Shape, share: float) -> Breakpoints:
    found = shape_table(shape, share, MAX_BREAKPOINTS)
    if found is None:
        raise InputError('friction.kinetic.tolerance', share, f'large enough for {MAX_BREAKPOINTS} breakpoints',
                         'raise it')
    return tuple(found)


def put_in_order(values: dict[str, object]) -> None:
    """Raise static friction to kinetic friction at rest, and its limit to its start, where values have it lower."""
    kinetic = values.get(_LAW + 'initial')
    if kinetic is None:
        coefficients = values[_LAW + 'coefficients']
        assert isinstance(coefficients, tuple)
        kinetic = coefficients[0]
    initial = max(float(str(values['friction.static.initial'])), float(str(kinetic)))
    values['friction.static.initial'] = initial
    if 'friction.static.limit' in values:
        values['friction.static.limit'] = max(float(str(values['friction.static.limit'])), initial)
