# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""One feed axis: its parameters, checked, and as the flat array that the compiled code reads."""

import math
from collections.abc import Sequence
from dataclasses import dataclass

from ..core import ranges
from ..core.errors import InputError
from ..friction import ExcessTable, KineticTable, StaticLaw
from ..friction.kinetic import merged_breakpoints


@dataclass(frozen=True, slots=True)
class RigidContact:
    """The slider stands still in stick (Fig. 7 of the paper)."""


@dataclass(frozen=True, slots=True)
class CompliantContact:
    """Tangential contact spring c_c `stiffness` (N/m) and damper h_c `damping` (N s/m), in stick only (Fig. 8).

    A stick begins with the deflection that goes on with the friction force, or `undeflected`.  It ends where the force
    of the contact reaches the static limit, or F_d + F_e: `judges_drive`.
    """

    stiffness: float
    damping: float
    undeflected: bool = False
    judges_drive: bool = False

    def __post_init__(self) -> None:
        ranges.CONTACT_STIFFNESS.check_meaning('contact.stiffness', self.stiffness, 'N/m',
                                               'use contact.model: rigid for a contact that does not yield')
        ranges.DAMPING.check_meaning('contact.damping', self.damping, 'N s/m', 'use 0 for no damping')


@dataclass(frozen=True, slots=True)
class Friction:
    """Static law, kinetic table, and the acceleration dependence (`excess`, or None for the conventional Fig. 3)."""

    static: StaticLaw
    kinetic: KineticTable
    excess: ExcessTable | None

    def __post_init__(self) -> None:
        at_rest = self.kinetic.coefficients[0]
        if at_rest > self.static.initial:
            raise InputError('friction.kinetic.' + ('initial' if self.kinetic.law else 'coefficients[0]'), at_rest,
                             f'<= friction.static.initial ({self.static.initial!r})',
                             'kinetic friction at rest cannot exceed static friction: lower it or raise static.initial')


@dataclass(frozen=True, slots=True)
class Axis:
    """m ẍ = c (s − x) + h (v − ẋ) + F_e − F: equation (1) of the paper, signs as in docs/model.md.

    mass kg, drive_stiffness N/m, drive_damping N s/m, normal_force N.  With `damper_on_slideway` h is no part of F_d
    but acts between slider and slideway, −h ẋ.  Raises InputError on values without a meaning.
    """

    mass: float
    drive_stiffness: float
    drive_damping: float
    normal_force: float
    contact: RigidContact | CompliantContact
    friction: Friction
    damper_on_slideway: bool = False

    def __post_init__(self) -> None:
        ranges.MASS.check_meaning('axis.mass', self.mass, 'kg', 'give the mass of the slider')
        for name, within, unit in (('drive_stiffness', ranges.STIFFNESS, 'N/m'),
                                   ('drive_damping', ranges.DAMPING, 'N s/m'),
                                   ('normal_force', ranges.NORMAL_FORCE, 'N')):
            within.check_meaning(f'axis.{name}', getattr(self, name), unit, 'use 0 to leave it out')

    @property
    def feed_share(self) -> float:
        """The share of the drive's velocity with which the far end of the damper moves."""
        return 0.0 if self.damper_on_slideway else 1.0


@dataclass(frozen=True, slots=True)
class InitialState:
    """Start: position m, velocity m/s, rest_time s (infinite: prolonged rest), and displacements of the springs.

    `stretch` m of the drive spring, s₀ of the paper; `deflection` m of a compliant contact.  A slider that moves slips,
    unless the contact is deflected: then it rings in stick.
    """

    position: float = 0.0
    velocity: float = 0.0
    rest_time: float = math.inf
    stretch: float = 0.0
    deflection: float = 0.0

    def __post_init__(self) -> None:
        for name, unit in (('position', 'm'), ('velocity', 'm/s'), ('stretch', 'm'), ('deflection', 'm')):
            if not math.isfinite(getattr(self, name)):
                raise InputError(f'initial.{name}', getattr(self, name), f'finite, in {unit}', 'use 0')
        if not self.rest_time >= 0.0:
            raise InputError('initial.rest_time', self.rest_time, '>= 0 s (.inf: prolonged rest)', 'use .inf or 0')


def check_start(axis: Axis, initial: InitialState, load: float = 0.0) -> None:
    """Raise InputError when the start asks for an infinite static friction, or for more than the contact holds.

    A `load` is on top of the normal force of the axis, N.
    """
    if math.isinf(initial.rest_time) and not axis.friction.static.bounded:
        raise InputError('initial.rest_time', initial.rest_time, 'finite with the logarithmic static law',
                         'its coefficient grows without bound; give the seconds of rest before the start')
    if initial.deflection == 0.0:
        return
    if not isinstance(axis.contact, CompliantContact):
        raise InputError('initial.deflection', initial.deflection, '0 with a rigid contact',
                         'leave it out, or use contact.type: compliant')
    force = axis.contact.stiffness * initial.deflection + axis.contact.damping * initial.velocity
    limit = (axis.normal_force + load) * axis.friction.static.coefficient(initial.rest_time)
    if not abs(force) <= limit:
        raise InputError('initial.deflection', initial.deflection,
                         f'such that the contact carries at most N mu_s = {limit:g} N; it would carry {force:g} N',
                         'lower it, or lengthen initial.rest_time')


def pack(axis: Axis) -> Sequence[float]:
    """Return the parameters in the order of `layout`."""
    contact = axis.contact if isinstance(axis.contact, CompliantContact) else None
    static, kinetic, excess = axis.friction.static, axis.friction.kinetic, axis.friction.excess
    breakpoints = merged_breakpoints(kinetic, excess)
    return [axis.mass, axis.drive_stiffness, axis.drive_damping, axis.feed_share, axis.normal_force,
            float(contact is not None), contact.stiffness if contact else 0.0, contact.damping if contact else 0.0,
            0.0 if contact is not None and contact.undeflected else 1.0,
            float(contact is not None and contact.judges_drive),
            float(static.kind), static.initial, static.limit, static.time_constant, static.exponent,
            static.delay,
            float(excess is not None), kinetic.end_slope, float(len(breakpoints)),
            *(number for breakpoint in breakpoints for number in breakpoint)]
