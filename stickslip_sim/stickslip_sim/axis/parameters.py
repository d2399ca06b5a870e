# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""One feed axis: its parameters, checked, and as the flat array that the compiled code reads."""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

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
    of the contact reaches the static limit, or F_d + F_e: `ends_by_drive`.
    """

    stiffness: float
    damping: float
    undeflected: bool = False
    ends_by_drive: bool = False

    def __post_init__(self) -> None:
        ranges.CONTACT_STIFFNESS.check_meaning('contact.stiffness', self.stiffness, 'N/m',
                                               'use contact.model: rigid for a contact that does not yield')
        ranges.DAMPING.check_meaning('contact.damping', self.damping, 'N s/m', 'use 0 for no damping')


@dataclass(frozen=True, slots=True)
class Friction:
    """Static law, kinetic table, and the acceleration dependence (`excess`, or None for the conventional Fig. 3).

    `backward` is the friction of motion along −x where that differs, None where both directions have the same.  The law
    of static friction, and whether friction depends on the acceleration, must be the same both ways.
    """

    static: StaticLaw
    kinetic: KineticTable
    excess: ExcessTable | None
    backward: 'Friction | None' = None

    def __post_init__(self) -> None:
        _check_at_rest(self, '')
        back = self.backward
        if back is None:
            return
        if back.backward is not None:
            raise InputError('friction.backward', 'friction of two directions', 'the friction of one direction',
                             'give it without a backward of its own')
        if back.static.kind != self.static.kind:
            raise InputError('friction.static.backward', back.static.kind.name.lower(),
                             f'the same law as forwards, {self.static.kind.name.lower()}', 'its numbers may differ')
        if back.static.delay != self.static.delay:
            raise InputError('friction.static.backward.delay', back.static.delay,
                             f'{self.static.delay!r} s, as forwards', 'the rest of a contact has no direction')
        if back.static.scatter != self.static.scatter:
            raise InputError('friction.static.backward.scatter', back.static.scatter,
                             f'{self.static.scatter!r}, as forwards', 'a stick has one draw for both directions')
        if (back.excess is None) != (self.excess is None):
            raise InputError('friction.excess.backward', back.excess, 'given in both directions or in none',
                             'friction.acceleration_dependence is for both')
        _check_at_rest(back, 'backward.')

    def along(self, direction: float) -> 'Friction':
        """Return the friction of motion, or against a force, in a direction: its sign, 0 as forwards."""
        return self.backward if direction < 0.0 and self.backward is not None else self

    @property
    def sides(self) -> 'tuple[Friction, ...]':
        """The friction of each direction, forwards first: one where both have the same."""
        return (self,) if self.backward is None else (replace(self, backward=None), self.backward)

    def with_tables(self, change: Callable[[KineticTable], KineticTable]) -> 'Friction':
        """Return this friction with another table of mu_k in each direction."""
        return replace(self, kinetic=change(self.kinetic),
                       backward=self.backward and self.backward.with_tables(change))

    @property
    def mirrored(self) -> 'Friction':
        """The friction of the same axis with x turned round."""
        return self if self.backward is None else replace(self.backward, backward=replace(self, backward=None))


def _check_at_rest(friction: Friction, side: str) -> None:
    """Raise InputError when the friction of a side ('' or 'backward.') falls as motion stops."""
    kinetic, static = friction.kinetic, friction.static
    if kinetic.coefficients[0] > static.initial:
        raise InputError(f'friction.kinetic.{side}' + ('initial' if kinetic.law else 'coefficients[0]'),
                         kinetic.coefficients[0], f'<= friction.static.{side}initial ({static.initial!r})',
                         f'kinetic friction at rest cannot exceed static friction: lower it or raise '
                         f'static.{side}initial')


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

    @property
    def slideway_damping(self) -> float:
        """What is h beside F_d in the balance of forces, N s/m: m ẍ = F_d + F_e − F − this ẋ."""
        return self.drive_damping if self.damper_on_slideway else 0.0


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
    friction = axis.friction.along(force)
    static = friction.static.of_stick(0, friction.kinetic.coefficients[0])   # of a run that begins with a stick
    limit = (axis.normal_force + load) * static.coefficient(initial.rest_time)
    if not abs(force) <= limit:
        raise InputError('initial.deflection', initial.deflection,
                         f'such that the contact carries at most N mu_s = {limit:g} N; it would carry {force:g} N',
                         'lower it, or lengthen initial.rest_time')


def pack(axis: Axis) -> Sequence[float]:
    """Return the parameters in the order of `layout`."""
    contact = axis.contact if isinstance(axis.contact, CompliantContact) else None
    friction = axis.friction
    static, back = friction.static, friction.along(-1.0).static
    tables = [merged_breakpoints(side.kinetic, side.excess) for side in friction.sides]
    return [axis.mass, axis.drive_stiffness, axis.drive_damping, axis.feed_share, axis.normal_force,
            float(contact is not None), contact.stiffness if contact else 0.0, contact.damping if contact else 0.0,
            0.0 if contact is not None and contact.undeflected else 1.0,
            float(contact is not None and contact.ends_by_drive),
            float(static.kind), static.initial, static.limit, static.time_constant, static.exponent,
            static.delay,
            float(friction.excess is not None), friction.kinetic.end_slope, float(sum(map(len, tables))),
            float(friction.backward is not None), back.initial, back.limit, back.time_constant, back.exponent,
            float(len(tables[0])) if friction.backward is not None else 0.0, 0.0,
            *((scatter.key, scatter.deviation, scatter.of_run) if (scatter := static.scatter) else (0.0, 0.0, 0.0)),
            0.0, static.initial, static.limit, back.initial, back.limit,
            *(number for table in tables for breakpoint in table for number in breakpoint)]
