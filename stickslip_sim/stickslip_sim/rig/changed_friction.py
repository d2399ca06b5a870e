# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Friction of an axis scaled as a whole, as when lubrication changes."""

from dataclasses import replace

from ..axis import Axis, Friction
from ..friction import SmoothKinetic


def with_friction_scaled(axis: Axis, factor: float) -> Axis:
    """Return the axis with all its friction coefficients times a factor."""
    return axis if factor == 1.0 else replace(axis, friction=_scaled(axis.friction, factor))


def _scaled(friction: Friction, factor: float) -> Friction:
    static, kinetic, law = friction.static, friction.kinetic, friction.kinetic.law
    return replace(
        friction, static=replace(static, initial=factor * static.initial, limit=factor * static.limit),
        kinetic=replace(kinetic, coefficients=tuple(factor * value for value in kinetic.coefficients),
                        end_slope=factor * kinetic.end_slope, law=law and _scaled_law(law, factor),
                        error=factor * kinetic.error, tolerance=factor * kinetic.tolerance),
        backward=friction.backward and _scaled(friction.backward, factor))


def _scaled_law(law: SmoothKinetic, factor: float) -> SmoothKinetic:
    return replace(law, initial=factor * law.initial, limit=factor * law.limit, viscous=factor * law.viscous)
