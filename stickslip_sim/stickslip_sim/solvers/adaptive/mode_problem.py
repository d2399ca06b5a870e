# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The motion of one mode as an initial value problem, with its guards, written as in docs/model.md.

Everything counts from the state: t its time, y the slider's travel since.  The unknowns are (y, ẏ); the drive's travel
has a closed form, and so has the deflection of a contact that yields.  A guard is positive until its event, where it
falls through zero.  One that is below zero by rounding at once is lifted to zero: it fires if it falls, and never if it
rises.
"""

import math
from collections.abc import Callable, Sequence
from typing import NamedTuple, Protocol

from ...axis.codes import (
    ACCELERATE,
    ACCELERATING,
    ARREST,
    BREAKAWAY,
    COAST,
    COASTING,
    DECELERATE,
    KNOT,
    STICK,
    YIELDING,
)
from ...axis.forces import (
    ROUNDING,
    applied_force,
    breakpoint_speed,
    force_rounding,
    friction_line,
    holds_by_drive,
    is_rigid_stick,
    kinetic_at_rest,
    segment_above,
    segment_end,
    static_limit,
)
from ...axis.layout import Parameters
from ...axis.mode_entry import choose_slip
from ...axis.rows import EventRow
from ...axis.state_record import State
from ...core.input_profile import InputProfile
from ...friction.static import CONSTANT
from ...linear.waves import TURN, phase_at

_STEPS_PER_PERIOD = 8.0
_STEPS_PER_AGE = 4.0   # of the time since mu_s began to grow, and of its time constant


_Value = Callable[[float, Sequence[float]], float]   # of the time and (y, ẏ)


class ModeGuard(NamedTuple):
    """What ends a mode where its value falls below 0."""

    kind: float      # of the event
    value: _Value
    error: _Value    # of the value, by rounding and by the tolerance of a step


class Tolerance(NamedTuple):
    """The method of integration, and the tolerances of a step: relative, and absolute in m and m/s."""

    method: str
    rtol: float
    atol: float


class SmoothLaw(Protocol):
    """A smooth mu_k."""

    def coefficient(self, speed: float, /) -> float:
        """Return mu_k at a speed in m/s."""


class ModeInputs:
    """v(t), F_e(t) and the drive's travel from the time of a state on."""

    def __init__(self, s: State) -> None:
        self._sinusoids = []
        v, f = s.inputs.v, s.inputs.f
        for given in s.sinusoids[:int(s.given_sinusoids)]:
            phase = TURN * phase_at(given.frequency, given.phase, s.second, s.fraction)
            self._sinusoids.append((TURN * given.frequency, phase, given.v, given.f))
            v -= given.v * math.sin(phase)
            f -= given.f * math.sin(phase)
        self._v, self._v_rate, self._f, self._f_rate = v, float(s.given.v_rate), f, float(s.given.f_rate)

    @property
    def fastest(self) -> float:
        """The largest angular frequency, rad/s."""
        return max((omega for omega, _, _, _ in self._sinusoids), default=0.0)

    def at(self, t: float) -> tuple[float, float]:
        """Return v and F_e."""
        v, f = self._v + self._v_rate * t, self._f + self._f_rate * t
        for omega, phase, of_drive, of_force in self._sinusoids:
            sine = math.sin(omega * t + phase)
            v += of_drive * sine
            f += of_force * sine
        return v, f

    def travel(self, t: float) -> float:
        """Return the drive's travel: of a sinusoid it is A t sin(φ + ω t/2) times sin(ω t/2)/(ω t/2)."""
        travel = (self._v + 0.5 * self._v_rate * t) * t
        for omega, phase, of_drive, _ in self._sinusoids:
            half = 0.5 * omega * t
            travel += of_drive * t * math.sin(phase + half) * (math.sin(half) / half if half != 0.0 else 1.0)
        return travel


class ModeLoad:
    """N(t) from the time of a state on, as the piece that holds there goes on; without a `profile` it is `now`."""

    def __init__(self, now: float, s: State, profile: InputProfile | None) -> None:
        self._now, self._rate = now, 0.0
        self._sinusoids: list[tuple[float, float, float]] = []
        if profile is None:
            return
        self._now, self._rate, _ = profile.pieces_at(s.second + s.fraction)
        for one in profile.sinusoids:
            phase = TURN * phase_at(one.frequency, one.phase / TURN, s.second, s.fraction)
            self._sinusoids.append((TURN * one.frequency, phase, one.amplitude))

    @property
    def fastest(self) -> float:
        """The largest angular frequency, rad/s."""
        return max((omega for omega, _, _ in self._sinusoids), default=0.0)

    def at(self, t: float) -> float:
        """Return N."""
        if not self._sinusoids:
            return self._now + self._rate * t
        return self._now + self._rate * t + sum(amplitude * math.sin(omega * t + phase)
                                                for omega, phase, amplitude in self._sinusoids)

    def rate(self, t: float) -> float:
        """Return N′, N/s."""
        return self._rate + sum(omega * amplitude * math.cos(omega * t + phase)
                                for omega, phase, amplitude in self._sinusoids)

    def followed(self, begin: float, lag: float, t: float) -> float:
        """Return at t what follows N with a time constant of `lag` s from `begin` N on."""
        if lag == 0.0:
            return self.at(t)
        return self._behind(lag, t) + (begin - self._behind(lag, 0.0)) * math.exp(-t / lag)

    def _behind(self, lag: float, t: float) -> float:
        settled = self._now + self._rate * (t - lag)
        for omega, phase, amplitude in self._sinusoids:
            turn, late = omega * t + phase, omega * lag
            settled += amplitude * (math.sin(turn) - late * math.cos(turn)) / (1.0 + late * late)
        return settled


class ModeMotion:
    """One mode from a state on.

    `law` is a smooth mu_k, or None for the segment of the table that the state is on; `normal_force` is N where it
    varies.
    """

    def __init__(self, p: Parameters, s: State, law: SmoothLaw | None, normal_force: InputProfile | None,
                 tolerance: Tolerance) -> None:
        self._p, self._law = p, law
        self.tolerance = tolerance
        self.inputs, self.load = ModeInputs(s), ModeLoad(p.normal_force, s, normal_force)
        self._mass = p.mass
        self._stiffness, self._damping, self._feed_share = p.stiffness, p.damping, p.feed_share
        self._contact = (p.contact_stiffness, p.contact_damping)
        self._spring, self._u, self._deflection = s.spring, s.velocity, s.deflection
        self._mode, self._direction, self._rest = s.mode, s.direction, s.rest
        self._excess, self._residual, self._segment = s.excess, s.residual, int(s.segment)
        self._stands, self._by_drive = is_rigid_stick(p, s), holds_by_drive(p)
        self._line = friction_line(p, self._segment, 0.0)
        self._at_rest = kinetic_at_rest(p, s.direction)

    def longest_step(self, t: float) -> float:
        """Return the longest step from t on over which no guard changes faster than its samples show, s."""
        fastest = max(self.inputs.fastest, self.load.fastest)
        longest = 2.0 * math.pi / fastest / _STEPS_PER_PERIOD if fastest > 0.0 else math.inf
        if self._mode != STICK or self._p.static_law == CONSTANT:
            return longest
        age, tau = self._rest + t - self._p.static_delay, self._p.static_tau
        if self._p.sided != 0.0:
            tau = min(tau, self._p.backward_tau)
        return min(longest, -age if age < -1e-9 * tau else (max(age, 0.0) + tau) / _STEPS_PER_AGE)

    def deflection(self, t: float) -> float:
        """Return δ of a contact that yields, which follows N mu_k(0)/c_c."""
        share = self._direction * self._at_rest / self._contact[0]
        if share == 0.0:
            return self._deflection * math.exp(-t / self._lag) if self._lag > 0.0 else 0.0
        return share * self.load.followed(self._deflection / share, self._lag, t)

    @property
    def _lag(self) -> float:
        return self._contact[1] / self._contact[0]

    def rates(self, t: float, state: Sequence[float]) -> tuple[float, float]:
        """Return ẏ and ÿ."""
        y, u = state
        if self._stands:
            return 0.0, 0.0
        if self._mode == COASTING:
            return self._u, 0.0
        if self._mode == STICK:
            return u, (self._applied(t, y, u) - self._contact_force(y, u)) / self._mass
        if self._mode == YIELDING:
            return u, (self._applied(t, y, u) - self._direction * self.load.at(t) * self._at_rest) / self._mass
        residual = self._residual_of(t, y, u) - (self._band(t, u) if self._mode == ACCELERATING else 0.0)
        return u, self._direction * residual / self._mass

    def friction(self, t: float, state: Sequence[float]) -> float:
        """Return the friction force, N."""
        applied = self._applied(t, *state)
        return applied - self._mass * self.rates(t, state)[1]

    def coasting_residual(self, t: float, state: Sequence[float]) -> float:
        """Return R while it coasts, N."""
        moved = self._applied(t, *state) - self._applied(0.0, 0.0, self._u)
        pressed = (self.load.at(t) - self.load.at(0.0)) * self._coefficient(self._direction * self._u)
        return self._residual + self._direction * moved - pressed

    def guards(self) -> list[ModeGuard]:
        """Return what can end the mode."""
        if self._mode == STICK:
            found = [self._force(BREAKAWAY, self._below_limit), self._force(BREAKAWAY, self._above_limit)]
        elif self._mode == YIELDING:
            sliding = (self._force(ARREST, self._sliding) if self._contact[1] > 0.0
                       else ModeGuard(ARREST, self._sliding_undamped, self._sliding_error))   # not lifted: it may jump
            found = [sliding, self._speed(BREAKAWAY, self._backwards)]
        elif self._mode == COASTING:
            found = [self._force(ACCELERATE, self._below_upper), self._force(DECELERATE, self.coasting_residual)]
        elif self._mode == ACCELERATING:
            found = [self._force(COAST, self._pull)]
            if self._law is None and segment_end(self._p, self._segment) < math.inf:
                found.append(self._speed(KNOT, self._below_breakpoint))
        else:
            is_last = self._law is not None or breakpoint_speed(self._p, self._segment) == 0.0
            found = [self._force(COAST, self._brake), self._speed(ARREST if is_last else KNOT, self._above_breakpoint)]
        return found

    def _force(self, kind: float, value: _Value) -> ModeGuard:
        return ModeGuard(kind, _lifted(value, self._u), self._force_error)

    def _speed(self, kind: float, value: _Value) -> ModeGuard:
        return ModeGuard(kind, _lifted(value, self._u), self._speed_error)

    def _force_error(self, t: float, state: Sequence[float]) -> float:
        return self._force_rounding(t, state) + self._force_tolerance(t, state)

    def _force_tolerance(self, t: float, state: Sequence[float]) -> float:
        """Return by how much a force may be wrong as the state is, N."""
        if self._stands:
            return 0.0
        y, u = state
        of_travel, of_speed = (self.tolerance.atol + self.tolerance.rtol * abs(value) for value in (y, u))
        bends = abs(self._coefficient(abs(u) + of_speed) - self._coefficient(abs(u)))
        bends += abs(self._line[3]) * self._excess * of_speed
        return ((self._stiffness + self._contact[0]) * of_travel + (self._damping + self._contact[1]) * of_speed
                + self.load.at(t) * bends)

    def _force_rounding(self, t: float, state: Sequence[float]) -> float:
        y, u = state
        v, f = self.inputs.at(t)
        paths = abs(self._spring) + abs(self.inputs.travel(t)) + abs(y)
        sizes = self._stiffness * paths + self._damping * (abs(v) + abs(u)) + abs(f)
        sizes += self.load.at(t) * (abs(self._line[0]) + abs(self._line[1] * u) + self._p.stick_limit)
        return ROUNDING * (sizes + self._contact[0] * (abs(self._deflection) + abs(y)) + self._contact[1] * abs(u))

    def _speed_error(self, _: float, state: Sequence[float]) -> float:
        speed = abs(state[1])
        return ROUNDING * (abs(self._u) + speed) + self.tolerance.atol + self.tolerance.rtol * speed

    def _sliding_error(self, t: float, state: Sequence[float]) -> float:
        return self._contact[0] * self._speed_error(t, state)

    def _applied(self, t: float, y: float, u: float) -> float:
        v, f = self.inputs.at(t)
        stretch = self._spring + self.inputs.travel(t) - y
        return self._stiffness * stretch + self._damping * (self._feed_share * v - u) + f

    def _contact_force(self, y: float, u: float) -> float:
        return self._contact[0] * (self._deflection + y) + self._contact[1] * u

    def _residual_of(self, t: float, y: float, u: float) -> float:
        return self._direction * self._applied(t, y, u) - self.load.at(t) * self._coefficient(self._direction * u)

    def _coefficient(self, speed: float) -> float:
        if self._law is None:
            return self._line[0] + self._line[1] * speed
        if speed < 0.0:   # within a step that passes standstill: continued smoothly
            return 2.0 * self._law.coefficient(0.0) - self._law.coefficient(-speed)
        return self._law.coefficient(speed)

    def _band(self, t: float, u: float) -> float:
        speed = self._direction * u
        psi = self._line[2] + self._line[3] * speed
        if self._law is not None:
            _, _, psi, _ = friction_line(self._p, segment_above(self._p, self._direction, speed), speed)
        return self.load.at(t) * self._excess * psi

    def _held(self, t: float, state: Sequence[float]) -> float:
        return self._applied(t, *state) if self._by_drive else self._contact_force(*state)

    def _below_limit(self, t: float, state: Sequence[float]) -> float:
        return self.load.at(t) * static_limit(self._p, self._rest + t, 1.0) - self._held(t, state)

    def _above_limit(self, t: float, state: Sequence[float]) -> float:
        return self.load.at(t) * static_limit(self._p, self._rest + t, -1.0) + self._held(t, state)

    def _sliding(self, t: float, state: Sequence[float]) -> float:
        """Return the speed of the interface times h_c, N."""
        held = self._contact[0] * self.deflection(t) + self._contact[1] * state[1]
        return self._direction * held - self.load.at(t) * self._at_rest

    def _sliding_undamped(self, t: float, state: Sequence[float]) -> float:
        """Return the speed of the interface times c_c, N/s."""
        return self._direction * self._contact[0] * state[1] - self.load.rate(t) * self._at_rest

    def _backwards(self, _: float, state: Sequence[float]) -> float:
        return -self._direction * state[1]

    def _below_upper(self, t: float, state: Sequence[float]) -> float:
        return self._band(t, self._u) - self.coasting_residual(t, state)

    def _pull(self, t: float, state: Sequence[float]) -> float:
        return self._residual_of(t, *state) - self._band(t, state[1])

    def _brake(self, t: float, state: Sequence[float]) -> float:
        return -self._residual_of(t, *state)

    def _below_breakpoint(self, _: float, state: Sequence[float]) -> float:
        return segment_end(self._p, self._segment) - self._direction * state[1]

    def _above_breakpoint(self, _: float, state: Sequence[float]) -> float:
        return self._direction * state[1] - (breakpoint_speed(self._p, self._segment) if self._law is None else 0.0)


def _lifted(guard: _Value, u: float) -> _Value:
    """Return a guard that is 0 at the start, where it is below that by rounding."""
    lift = min(guard(0.0, (0.0, u)), 0.0)
    return guard if lift == 0.0 else lambda t, state: guard(t, state) - lift


# Friction at a state, with a smooth law of mu_k in place of the table of the transitions, where there is one.

def choose_sub_mode(law: SmoothLaw | None, p: Parameters, s: State) -> bool:
    """Set the sub-mode of a slip from the forces; return False when the slider comes to rest instead."""
    coefficient, psi = _coefficients(law, p, s)
    upper = coefficient + s.excess * psi
    push = s.direction * applied_force(p, s)
    return choose_slip(p, s, push - p.normal_force * upper, push - p.normal_force * coefficient,
                       force_rounding(p, s, upper))


def slip_friction_force(law: SmoothLaw | None, p: Parameters, s: State) -> float:
    """Return the friction force at the state of a slip, N."""
    if s.mode == COASTING:
        return applied_force(p, s)
    coefficient, psi = _coefficients(law, p, s)
    return s.direction * p.normal_force * (coefficient + (s.excess * psi if s.mode == ACCELERATING else 0.0))


def correct_excess(law: SmoothLaw | None, p: Parameters, s: State, event: EventRow) -> None:
    """Let E make friction continuous with the smooth law, where the transition took its table."""
    if law is None or s.mode == STICK or s.excess == 0.0:
        return
    coefficient, psi = _coefficients(law, p, s)
    limit = abs(event.friction) / p.normal_force if p.normal_force > 0.0 else event.static
    s.excess = (limit - coefficient) / psi


def find_segment(law: SmoothLaw | None, p: Parameters, s: State) -> None:
    """Set the segment for psi, which no breakpoint keeps up to date with a smooth law."""
    if law is not None:
        s.segment = float(segment_above(p, s.direction, abs(s.velocity)))


def _coefficients(law: SmoothLaw | None, p: Parameters, s: State) -> tuple[float, float]:
    """Return mu_k and psi at the speed."""
    speed = abs(s.velocity)
    coefficient, _, psi, _ = friction_line(p, segment_above(p, s.direction, speed), speed)
    return (coefficient if law is None else law.coefficient(speed)), psi
