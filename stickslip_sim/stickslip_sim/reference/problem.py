# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""One axis, its start and its inputs in multiple precision.

Every number is taken as the binary double it is: mpf(float).
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, field, replace
from decimal import Decimal
from typing import NamedTuple

from mpmath import cos, inf, mp, mpf, pi, sin

from ..axis import parameters as product
from ..core import input_profile as profiles
from ..core.input_profile import InputProfile
from ..friction import ExcessTable, KineticTable, Scatter
from .series import Series, series, to_decimal
from .statics import StaticLaw


@dataclass(frozen=True)
class Line:
    """One straight segment of a table: offset + slope * w."""

    offset: mpf
    slope: mpf

    def at(self, w: mpf) -> mpf:
        """Return the value at a speed."""
        return self.offset + self.slope * w


@dataclass(frozen=True)
class Table:
    """Piecewise-linear function of speed; `end_slope` beyond the last breakpoint."""

    speeds: tuple[mpf, ...]
    values: tuple[mpf, ...]
    end_slope: mpf

    def segment_above(self, w: mpf) -> Line:
        """Return the straight segment that starts at, or contains, the speed w."""
        i = sum(1 for k in self.speeds if k <= w) - 1
        slope = self.end_slope
        if i + 1 < len(self.speeds):
            slope = (self.values[i + 1] - self.values[i]) / (self.speeds[i + 1] - self.speeds[i])
        return Line(self.values[i] - slope * self.speeds[i], slope)


@dataclass(frozen=True)
class SideOfProblem:
    """The friction of one direction; names as in docs/model.md."""

    static: StaticLaw
    kinetic: Table
    excess: Table | None

    def breakpoints(self) -> list[mpf]:
        """Return the speeds above zero at which a friction table bends."""
        speeds = set(self.kinetic.speeds) | set(self.excess.speeds if self.excess else ())
        return sorted(k for k in speeds if k > 0)


@dataclass(frozen=True)
class Problem:
    """Everything the automaton needs; names as in docs/model.md.

    `normal` is the normal force over time.
    """

    mass: mpf
    stiffness: mpf
    damping: mpf
    feed_damping: mpf
    contact: str
    contact_stiffness: mpf
    contact_damping: mpf
    undeflected: bool
    by_drive: bool
    forward: SideOfProblem
    backward: SideOfProblem
    scatter: Scatter | None
    drive: profiles.InputProfile
    force: profiles.InputProfile
    normal: profiles.InputProfile
    position: mpf
    velocity: mpf
    rest_time: mpf
    stretch: mpf
    deflection: mpf

    @property
    def inputs(self) -> tuple[profiles.InputProfile, ...]:
        """v(t), F(t) and N(t)."""
        return self.drive, self.force, self.normal


def problem(axis: product.Axis, initial: product.InitialState, drive: profiles.InputProfile,
            force: profiles.InputProfile, load: profiles.InputProfile | None = None) -> Problem:
    """Return the problem in multiple precision; raises InputError when the start has no finite static friction.

    The normal force under a load is the sum in doubles, as everything given is taken as the double that it is.
    """
    product.check_start(axis, initial, load.value_at(0.0) if load else 0.0)
    contact = axis.contact if isinstance(axis.contact, product.CompliantContact) else None
    return Problem(
        mass=mpf(axis.mass),
        stiffness=mpf(axis.drive_stiffness),
        damping=mpf(axis.drive_damping),
        feed_damping=mpf(0 if axis.damper_on_slideway else axis.drive_damping),
        contact='compliant' if contact else 'rigid',
        contact_stiffness=mpf(contact.stiffness if contact else 0.0),
        contact_damping=mpf(contact.damping if contact else 0.0),
        undeflected=contact is not None and contact.undeflected,
        by_drive=contact is None or contact.ends_by_drive,
        forward=_side(axis.friction),
        backward=_side(axis.friction.backward or axis.friction),
        scatter=axis.friction.static.scatter,
        drive=drive,
        force=force,
        normal=load.plus(axis.normal_force) if load else profiles.constant(axis.normal_force),
        position=mpf(initial.position),
        velocity=mpf(initial.velocity),
        rest_time=mpf(initial.rest_time),
        stretch=mpf(initial.stretch),
        deflection=mpf(initial.deflection),
    )


def _side(friction: product.Friction) -> SideOfProblem:
    static = friction.static
    law = StaticLaw(static.kind.name.lower(), mpf(static.initial), mpf(static.limit), mpf(static.time_constant),
                    mpf(static.exponent), mpf(static.delay))
    return SideOfProblem(law, _kinetic(friction.kinetic), _excess(friction.excess))


def _kinetic(table: KineticTable) -> Table:
    return Table(_exact(table.velocities), _exact(table.coefficients), mpf(table.end_slope))


def _excess(table: ExcessTable | None) -> Table | None:
    return Table(_exact(table.velocities), _exact(table.fractions), mpf(0)) if table else None


def _exact(numbers: tuple[float, ...]) -> tuple[mpf, ...]:
    return tuple(mpf(number) for number in numbers)


# The friction of one direction: its static law, and its tables as straight lines over the speed.

@dataclass
class Side:
    """mu_s, mu_k and psi of motion, or against a force, in one direction."""

    given: SideOfProblem
    breakpoints: list[mpf] = field(init=False)   # above zero
    static: StaticLaw = field(init=False)        # of the present stick

    def __post_init__(self) -> None:
        self.breakpoints = self.given.breakpoints()
        self.static = self.given.static

    def begin_stick(self, factor: float) -> None:
        """Let mu_s be that of a stick with a factor of its own, in doubles, as all that is given."""
        law = self.given.static
        initial = max(factor * float(law.initial), float(self.at_rest))
        self.static = replace(law, initial=mpf(initial), limit=mpf(max(factor * float(law.limit), initial)))

    @property
    def at_rest(self) -> mpf:
        """mu_k(0)."""
        return self.given.kinetic.values[0]

    @property
    def highest(self) -> mpf:
        """The largest coefficient that stands in the data."""
        return max(max(self.given.kinetic.values), self.static.initial, self.static.limit)

    def lower_breakpoint(self, segment: int) -> mpf:
        """Return the speed at which a segment begins."""
        return self.breakpoints[segment - 1] if segment else mpf(0)

    def upper_breakpoint(self, segment: int) -> mpf | None:
        """Return the speed at which a segment ends; None for the last one."""
        return self.breakpoints[segment] if segment < len(self.breakpoints) else None

    def locate(self, speed: mpf, rising: bool) -> int:
        """Return the segment of a speed; on a breakpoint the sign of the acceleration decides."""
        tiny = mpf(10) ** (18 - mp.dps)
        side = tiny if rising else -tiny
        return sum(1 for k in self.breakpoints if speed >= k * (1 - side))

    def kinetic_line(self, segment: int) -> Line:
        """Return mu_k(w) on a segment."""
        return self.given.kinetic.segment_above(self.lower_breakpoint(segment))

    def psi_line(self, segment: int) -> Line:
        """Return psi(w) on a segment."""
        if self.given.excess is None:
            return Line(mpf(0), mpf(0))
        return self.given.excess.segment_above(self.lower_breakpoint(segment))

    def kinetic_at(self, speed: mpf) -> mpf:
        """Return mu_k(w)."""
        return self.kinetic_line(self.locate(speed, True)).at(speed)

    def psi_at(self, speed: mpf) -> mpf:
        """Return psi(w)."""
        return self.psi_line(self.locate(speed, True)).at(speed)

    def excess_at(self, static: mpf, speed: mpf) -> mpf:
        """E with mu_k(w) + E psi(w) = mu_b; 0 where psi = 0; never negative."""
        psi = self.psi_at(speed)
        return max(mpf(0), (static - self.kinetic_at(speed)) / psi) if psi > 0 else mpf(0)


# An input profile in multiple precision: its segments one after the other, with periods and sinusoids.

class Segment(NamedTuple):
    """A straight segment from one instant on: value + slope (t - start)."""

    start: mpf
    value: mpf
    slope: mpf


class Turn(NamedTuple):
    """A sinusoid seen from an instant: amplitude sin(φ + ω τ), kept as sine and cosine of φ."""

    amplitude: mpf
    omega: mpf
    sine: mpf
    cosine: mpf

    def add_to(self, terms: Series) -> None:
        """Add the terms of the sinusoid to a power series in τ, as many as it has."""
        size, omega = to_decimal(self.amplitude), to_decimal(self.omega)
        cycle = [to_decimal(c) for c in (self.sine, self.cosine, -self.sine, -self.cosine)]
        for k in range(len(terms)):
            terms[k] += size * cycle[k % 4]
            size = size * omega / (k + 1)


class Signal(NamedTuple):
    """An input from an instant on, until the next segment begins."""

    value: mpf
    offset: mpf
    slope: mpf
    turns: tuple[Turn, ...]

    def series(self, order: int) -> Series:
        """Return its power series in the time since that instant: two terms, and up to `order` with sinusoids."""
        terms = series(self.offset, self.slope)
        if self.turns:
            terms += [Decimal(0)] * max(order - 1, 0)
            for turn in self.turns:
                turn.add_to(terms)
        return terms

    @property
    def rate(self) -> mpf:
        """Return the highest circular frequency in it."""
        return max((turn.omega for turn in self.turns), default=mpf(0))

    @property
    def is_constant(self) -> bool:
        """Return whether it keeps its value."""
        return not self.slope and not self.turns

    @property
    def reach(self) -> mpf:
        """Return a size that its value does not exceed now, at any phases."""
        return abs(self.offset) + sum((abs(turn.amplitude) for turn in self.turns), mpf(0))


class Input:
    """An input profile v(t), F(t) or N(t), followed in time; right-continuous.

    `until` is the instant at which the next segment begins (infinite behind the last).
    """

    def __init__(self, profile: InputProfile) -> None:
        self._sinusoids = profile.sinusoids
        self._segments = _segments(profile)
        self._here = next(self._segments)
        self._next = next(self._segments, None)

    @property
    def until(self) -> mpf:
        """Return the end of the segment that holds."""
        return self._next.start if self._next else inf

    def enter(self, t: mpf) -> None:
        """Let the segment hold that begins at or before `t`; t never goes back."""
        while self._next and self._next.start <= t:
            self._here, self._next = self._next, next(self._segments, None)

    def at(self, t: mpf) -> Signal:
        """Return the input from an instant of the present segment on; sinusoids run over absolute time."""
        here = self._here
        offset = here.value + here.slope * (t - here.start)
        turns = tuple(_turn(t, *map(mpf, sinusoid)) for sinusoid in self._sinusoids)
        value = offset + sum((turn.amplitude * turn.sine for turn in turns), mpf(0))
        return Signal(value, offset, here.slope, turns)


def _turn(t: mpf, amplitude: mpf, frequency: mpf, phase: mpf) -> Turn:
    omega = 2 * pi * frequency
    angle = omega * t + phase
    return Turn(amplitude, omega, sin(angle), cos(angle))


def _segments(profile: InputProfile) -> Iterator[Segment]:
    """Yield the segments in the order of time, without end when the input profile is periodic."""
    turn = 0
    segments = [Segment(*map(mpf, segment)) for segment in zip(profile.starts, profile.values, profile.rates)]
    while True:
        begin = turn * mpf(profile.period) if turn else mpf(0)
        for segment in segments:
            yield segment._replace(start=begin + segment.start)
        if math.isinf(profile.period):
            return
        turn += 1
