# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Critical feeds in closed form: from which feed on a slider no longer sticks, where the theory says it.

m ẍ = c (v t − x) + h (v − ẋ) − F, with ω = √(c/m), ζ = h/(2 √(cm)) and s = √(1 − ζ²).  Friction drops by ΔF as the slip
begins; A = ΔF/(v √(cm)) is that drop over what the feed v stands for.
"""

import math
from typing import NamedTuple

import numpy as np
from scipy.optimize import brentq

from ..axis import Axis, RigidContact
from ..friction import KineticTable, StaticLaw, StaticLawKind
from ..scene import Scene
from .points import Values, scene_at

_NO_REST = 0.9999   # damping ratio from which on no slip of a double comes to rest: A_c beyond 1e190


class SliderOnDrive(NamedTuple):
    """The slider on its drive: mass m kg, stiffness c N/m, damping h N s/m."""

    mass: float
    stiffness: float
    damping: float = 0.0

    @property
    def frequency(self) -> float:
        """The undamped angular frequency ω, rad/s."""
        return math.sqrt(self.stiffness / self.mass)

    @property
    def impedance(self) -> float:
        """√(cm), N s/m."""
        return math.sqrt(self.stiffness * self.mass)

    @property
    def damping_ratio(self) -> float:
        """The damping over the critical one, ζ."""
        return 0.5 * self.damping / self.impedance


def critical_drop(damping_ratio: float) -> float:
    """Return A_c, at which the slip only just comes to rest: A above it is stick-slip; 0 < ζ < 1.

    (ζ/s) [2π − asin ζ − atan((A − ζ)/s)] = ½ ln(1 − 2 A ζ + A²).
    """
    zeta = damping_ratio
    s = math.sqrt(1.0 - zeta * zeta)

    def beyond(a: float) -> float:
        angle = 2.0 * math.pi - math.asin(zeta) - math.atan((a - zeta) / s)
        return zeta / s * angle - 0.5 * math.log1p(a * a - 2.0 * a * zeta)

    return float(brentq(beyond, zeta, 2.0 * zeta + math.exp(2.0 * math.pi * zeta / s), xtol=1e-16, rtol=1e-15))


def critical_feed(slider: SliderOnDrive, drop: float) -> float:
    """Return the feed v_c (m/s) from which on constant friction slides: ΔF/(A_c √(cm))."""
    return drop / (critical_drop(slider.damping_ratio) * slider.impedance)


def healing_critical_feed(stiffness: float, growth: float) -> float:
    """Return v_c = 2 S′(0)/c (m/s) of friction that only grows with rest, at `growth` S′(0) N/s from the arrest on.

    For a concave growth S and h = 0.
    """
    return 2.0 * growth / stiffness


def feed_of_theory(axis: Axis) -> float | None:
    """Return the critical feed (m/s, perhaps infinite or 0) of an axis, None where no closed form is known.

    It is known for a rigid contact without acceleration dependence whose kinetic friction is constant or rises
    linearly, the same both ways: with constant static friction, where a damper N mu_k′ stands beside the drive's; and
    without any damping, where static friction begins at the kinetic one and its growth is concave.
    """
    friction, kinetic = axis.friction, axis.friction.kinetic
    if not isinstance(axis.contact, RigidContact) or friction.excess or len(kinetic.velocities) > 1 or kinetic.law:
        return None
    if friction.backward is not None:
        return None
    damped = SliderOnDrive(axis.mass, axis.drive_stiffness, axis.drive_damping + axis.normal_force * kinetic.end_slope)
    if damped.stiffness == 0.0:
        return None
    if friction.static.kind == StaticLawKind.CONSTANT:
        return _feed_of_a_drop(damped, axis.normal_force * (friction.static.initial - kinetic.coefficients[0]))
    return _feed_of_growth(damped, friction.static, kinetic, axis.normal_force)


def _feed_of_a_drop(slider: SliderOnDrive, drop: float) -> float:
    if drop == 0.0 or slider.damping_ratio >= _NO_REST:
        return 0.0
    return critical_feed(slider, drop) if slider.damping_ratio > 0.0 else math.inf


def _feed_of_growth(slider: SliderOnDrive, static: StaticLaw, kinetic: KineticTable, normal: float) -> float | None:
    convex = static.kind == StaticLawKind.KATO and static.exponent > 1.0
    if slider.damping > 0.0 or kinetic.coefficients[0] != static.initial or convex or static.delay > 0.0:
        return None
    if static.kind == StaticLawKind.KATO and static.exponent < 1.0:
        return math.inf
    return healing_critical_feed(slider.stiffness,
                                 normal * (static.limit - static.initial) / static.time_constant)


# Critical values that a given table of friction decides: by a breakpoint, or by the straight segment between two.
#
# Sliding is lost by the slope of mu_k at the drive's speed.  On a table that slope is the same all along a segment and
# jumps at a breakpoint; so a critical feed lies on a breakpoint, wherever a smooth curve through the same points would
# have it.  With a smooth law its own slope decides, and it has none of this.

_MOVING = ('drive.velocity', 'friction.kinetic.velocities', 'friction.kinetic.backward.velocities')
_CLOSE = 2.0   # times the accuracy: the value is the middle of what is left open


class TableFact(NamedTuple):
    """A critical `value` from rest or `from_sliding`: the drive's speed is that of a breakpoint, or in a segment.

    `breakpoint` counts from 0 in the velocities of friction.kinetic in the direction of the drive, None: in the segment
    from `low` to `high`, m/s.
    """

    from_sliding: bool
    value: float
    breakpoint: int | None
    low: float
    high: float
    table: str     # the parameter that has the breakpoints


def table_fact(values: Values, name: str, value: float, accuracy: float, from_sliding: bool) -> TableFact | None:
    """Return what the table of mu_k has to do with a critical value of a parameter; None where nothing.

    From rest the motion passes through many segments: there only a breakpoint counts, and only where the parameter
    moves the drive past it.
    """
    if not from_sliding and not name.startswith(_MOVING):
        return None
    scene = scene_at(values, [name], np.array([value]))
    kinetic = scene.axis.friction.along(scene.drive.values[0]).kinetic
    speeds = kinetic.velocities
    if kinetic.law is not None or len(speeds) < 2:
        return None
    speed, table = abs(scene.drive.values[0]), _table_of(scene)
    for k, at in enumerate(speeds[1:], 1):
        if abs(speed - at) <= _CLOSE * accuracy * at:
            return TableFact(from_sliding, value, k, at, at, table)
    above = sum(at <= speed for at in speeds)
    high = speeds[above] if above < len(speeds) else math.inf
    return TableFact(from_sliding, value, None, speeds[above - 1], high, table) if from_sliding else None


def _table_of(scene: Scene) -> str:
    """Return the parameter with the breakpoints of mu_k in the direction of the drive."""
    back = 'friction.kinetic.backward.velocities'
    return back if scene.drive.values[0] < 0.0 and back in scene.values else 'friction.kinetic.velocities'


def breakpoints_between(scene: Scene) -> int:
    """Return how many breakpoints, rest and the last one apart, a given table of mu_k has."""
    kinetic = scene.axis.friction.along(scene.drive.values[0]).kinetic
    return max(len(kinetic.velocities) - 2, 0) if kinetic.law is None else 0
