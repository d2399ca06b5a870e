# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Friction of trial values: smooth laws by tables of which the shape stays the same, and static not below kinetic.

A table that is made anew for each trial has other breakpoints, a step of the motion that no derivative should see.
Here the breakpoints of the start move with the scale of the speed, and their coefficients with those of the law.
"""

from collections.abc import Sequence

from ..friction.shapes import Decay, Shape
from ..friction.smooth import SmoothKinetic
from ..friction.tables import kinetic_table
from ..scene import Scene

_LAW = 'friction.kinetic.'
_EXCESS = 'friction.excess.'
_SMOOTH = 'initial', 'limit', 'stribeck_velocity', 'viscous', 'exponent', 'tolerance'
_DROPPED = frozenset(_LAW + name for name in _SMOOTH)
_FALLEN = 0.01       # as `SmoothKinetic.limit_velocity`


class SameTables:
    """The tables of the smooth law of a scene, for trial values of its parameters `names`."""

    def __init__(self, scene: Scene, names: Sequence[str]) -> None:
        law = scene.axis.friction.kinetic.law
        self._law = law
        self._free_shape = _LAW + 'exponent' in names
        self._breakpoints = [] if law is None else _shape_of(law.shape, self._share(scene, law))
        self._share_of_falling = 0.0 if law is None else self._share(scene, law)

    def applied(self, values: dict[str, object]) -> dict[str, object]:
        """Return values of a scene with a table in place of its smooth kinetic law, if it has one."""
        if self._law is None:
            return values
        initial, limit, scale, viscous = (float(str(values[_LAW + name])) for name in _SMOOTH[:4])
        shape, points = self._law.shape, self._breakpoints
        if self._free_shape:
            shape = Decay(float(str(values[_LAW + 'exponent'])))
            points = _shape_of(shape, self._share_of_falling)
        table = {name: value for name, value in values.items() if name not in _DROPPED}
        speeds = tuple(scale * z for z, _ in points)
        table[_LAW + 'law'] = 'table'
        table[_LAW + 'velocities'] = speeds
        table[_LAW + 'coefficients'] = tuple(limit + (initial - limit) * p + viscous * speed
                                             for speed, (_, p) in zip(speeds, points))
        table[_LAW + 'end_slope'] = viscous
        end = scale * shape.reach(_FALLEN)
        if values.get('friction.acceleration_dependence'):
            if values.get(_EXCESS + 'law', 'table') != 'table':
                table.setdefault(_EXCESS + 'limit_velocity', end)
            elif _EXCESS + 'velocities' not in values:
                table[_EXCESS + 'velocities'], table[_EXCESS + 'fractions'] = (0.0, end), (1.0, 0.0)
        return table

    @staticmethod
    def _share(scene: Scene, law: SmoothKinetic) -> float:
        """Return the tolerance of the table of a scene as a share of the falling part."""
        falling = abs(law.initial - law.limit) or 1.0
        return float(str(scene.values[_LAW + 'tolerance'])) / falling


def put_in_order(values: dict[str, object]) -> None:
    """Raise static friction to kinetic friction at rest, and its limit to its start, where trial values have it lower.

    So the border of what a scene may be has a motion on both of its sides, which a fit can follow.
    """
    kinetic = values.get(_LAW + 'initial')
    if kinetic is None:
        coefficients = values[_LAW + 'coefficients']
        assert isinstance(coefficients, tuple)
        kinetic = coefficients[0]
    initial = max(float(str(values['friction.static.initial'])), float(str(kinetic)))
    values['friction.static.initial'] = initial
    if 'friction.static.limit' in values:
        values['friction.static.limit'] = max(float(str(values['friction.static.limit'])), initial)


def _shape_of(shape: Shape, share: float) -> list[tuple[float, float]]:
    """Return the breakpoints (z, p) of the falling part of a law, within a share of it."""
    table = kinetic_table(SmoothKinetic(shape, 1.0, 0.0, 1.0), share)
    return list(zip(table.velocities, table.coefficients))
