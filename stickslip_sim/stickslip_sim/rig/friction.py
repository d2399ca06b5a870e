# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Friction of an axis scaled as a whole, as when lubrication changes."""

from dataclasses import replace

from ..axis import Axis
from ..friction import SmoothKinetic


def with_friction_scaled(axis: Axis, factor: float) -> Axis:
    """Return the axis with all its friction coefficients times a factor."""
    if factor == 1.0:
        return axis
    static, kinetic, law = axis.friction.static, axis.friction.kinetic, axis.friction.kinetic.law
    return replace(axis, friction=replace(
        axis.friction,
        static=replace(static, initial=factor * static.initial, limit=factor * static.limit),
        kinetic=replace(kinetic, coefficients=tuple(factor * value for value in kinetic.coefficients),
                        end_slope=factor * kinetic.end_slope, law=law and _scaled(law, factor),
                        error=factor * kinetic.error)))


def _scaled(law: SmoothKinetic, factor: float) -> SmoothKinetic:
    return replace(law, initial=factor * law.initial, limit=factor * law.limit, viscous=factor * law.viscous)
