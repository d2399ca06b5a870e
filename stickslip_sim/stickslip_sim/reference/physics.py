# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Forces of the axis, and the sub-mode that they call for.

F_d = c w + h (v - u)                 drive force
R   = σ (F_d + F_e) - N mu_k(|u|)     driving surplus over the lower branch
B   = N E psi(|u|)                    height of the upper branch over the lower one
m σ u' = R - B (accelerating),  0 (coasting),  R (decelerating)

N(t) is part of the state, as are the other inputs.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace

from mpmath import mp, mpf, sqrt

from .flow import Expansion, Flow, State
from .modes import ACCELERATE, COAST, DECELERATE, Mode, Slip, Stick, Yield
from .problem import Line, Problem, Side
from .series import Series, combine, integral, summed_rounding, to_binary, to_decimal

_ONE = mpf(1)
_TIE_ORDER = 6  # derivatives that may decide a tie under sinusoids


@dataclass
class Physics:
    """The equations of one axis."""

    axis: Problem
    sides: tuple[Side, Side] = field(init=False)
    _highest: mpf = field(init=False)   # coefficient of friction
    _swing: mpf = field(init=False)   # circular frequency of the slider on the spring

    def __post_init__(self) -> None:
        self.sides = Side(self.axis.forward), Side(self.axis.backward)
        self._highest = max(side.highest for side in self.sides)
        self._swing = sqrt(self.axis.stiffness / self.axis.mass)

    # ---- forces -------------------------------------------------------------------------------

    def drive_force(self, state: State) -> mpf:
        """F_d = c w + h (v - u), and c w alone where the damper is on the slideway."""
        return self.axis.stiffness * state.stretch + self.axis.feed_damping * (state.drive.value - state.velocity)

    def net_force(self, state: State) -> mpf:
        """F_d + F_e, and what a damper on the slideway adds."""
        on_slideway = self.axis.damping - self.axis.feed_damping
        return self.drive_force(state) - on_slideway * state.velocity + state.force.value

    def net_series(self, state: State, series: Expansion) -> Series:
        """F_d + F_e as a power series."""
        c, h = self.axis.stiffness, self.axis.damping
        net = combine(
            (c, series.drive_travel),
            (-c, series.travel),
            (self.axis.feed_damping, series.drive),
            (-h, series.velocity),
            (_ONE, series.force),
        )
        net[0] += to_decimal(c * state.stretch)
        return net

    def stick_force_series(self, state: State, series: Expansion) -> Series:
        """Force that ends a rest as a power series: c_c d + h_c u, or F_d + F_e where that ends it (rigid: always)."""
        a = self.axis
        if a.by_drive:
            return self.net_series(state, series)
        force = combine((a.contact_stiffness, series.travel), (a.contact_damping, series.velocity))
        force[0] += to_decimal(a.contact_stiffness * state.deflection)
        return force

    def stick_force(self, state: State) -> mpf:
        """Return the force that ends a rest."""
        a = self.axis
        return self.net_force(state) if a.by_drive else a.contact_stiffness * state.deflection \
            + a.contact_damping * state.velocity

    def friction(self, mode: Mode, state: State) -> mpf:
        """Friction (slip) or contact force (stick), positive when it opposes positive motion."""
        if isinstance(mode, Stick) and self.axis.contact == 'compliant':
            return self.axis.contact_stiffness * state.deflection + self.axis.contact_damping * state.velocity
        if isinstance(mode, Yield):
            return mode.direction * state.normal.value * self.side(mode.direction).at_rest
        if isinstance(mode, Stick) or mode.phase == COAST:
            return self.net_force(state)
        line = self.branch(mode)
        return mode.direction * state.normal.value * line.at(mode.direction * state.velocity)

    def force_scale(self, state: State) -> mpf:
        """Return a force that rounding is compared with."""
        a = self.axis
        inputs = state.force.reach + a.damping * state.drive.reach
        return state.normal.reach * self._highest + abs(a.stiffness * state.stretch) + inputs

    def force_rounding(self, state: State) -> mpf:
        """Return the rounding that a force may have gathered of all it was summed from, what cancels included."""
        motion = self.axis.mass * (abs(state.velocity) + state.drive.reach) / self.time_scale(state)
        return summed_rounding(self.force_scale(state) + motion)

    def speed_rounding(self, state: State) -> mpf:
        """Return the rounding that the velocity may have gathered."""
        return self.force_rounding(state) * self.time_scale(state) / self.axis.mass

    def holds_nothing(self, state: State) -> bool:
        """Return whether N mu_s is 0 at any rest time."""
        return not any(state.normal.value * max(side.static.initial, side.static.limit) for side in self.sides)

    # ---- friction -------------------------------------------------------------------------------

    def side(self, direction: int) -> Side:
        """Return the friction of motion, or against a force, in a direction."""
        return self.sides[0 if direction > 0 else 1]

    def branch(self, slip: Slip) -> Line:
        """mu(w) of the accelerating or decelerating branch on the slip's segment."""
        side = self.side(slip.direction)
        kinetic = side.kinetic_line(slip.segment)
        if slip.phase != ACCELERATE or not slip.excess:
            return kinetic
        psi = side.psi_line(slip.segment)
        return Line(kinetic.offset + slip.excess * psi.offset, kinetic.slope + slip.excess * psi.slope)

    def surplus(self, direction: int, state: State) -> mpf:
        """R = σ (F_d + F_e) - N mu_k(|u|)."""
        mu = self.side(direction).kinetic_at(abs(state.velocity))
        return direction * self.net_force(state) - state.normal.value * mu

    def band(self, direction: int, excess: mpf, state: State) -> mpf:
        """B = N E psi(|u|)."""
        return state.normal.value * self.raised(direction, excess, state)

    def raised(self, direction: int, excess: mpf, state: State) -> mpf:
        """E psi(|u|), by which the upper branch is above the lower one."""
        return excess * self.side(direction).psi_at(abs(state.velocity))

    # ---- classification -----------------------------------------------------------------------

    def surplus_rate(self, direction: int, state: State, excess: mpf) -> mpf:
        """First non-vanishing coefficient in time of R - B, of R without an excess, at constant speed; 0 if none.

        (R - B)' = σ (c (v - u) + h v' + F') - N' (mu_k + E psi), and so on: with sinusoids the higher ones matter too.
        """
        a, time = self.axis, self.time_scale(state)
        drive = state.drive.series(_TIE_ORDER)
        slip = [drive[0] - to_decimal(state.velocity), *drive[1:]]
        mu = self.side(direction).kinetic_at(abs(state.velocity)) + self.raised(direction, excess, state)
        rates = combine((a.stiffness, integral(slip)), (a.feed_damping, drive), (_ONE, state.force.series(_TIE_ORDER)),
                        (-direction * mu, state.normal.series(_TIE_ORDER)))
        limit = self.tiny(state)
        for rate in map(to_binary, rates[1:]):
            limit = limit / time
            if abs(rate) > limit:
                return direction * rate
        return mpf(0)

    def time_scale(self, state: State) -> mpf:
        """Return a time in which forces change."""
        rate = max(state.rate, self._swing)
        return 1 / rate if rate else mpf(1)

    def tiny(self, state: State) -> mpf:
        """Return the rounding of a force at the working precision."""
        return max(self.force_scale(state) * mpf(10) ** (18 - mp.dps), self.force_rounding(state))

    def phase(self, direction: int, excess: mpf, state: State) -> str:
        """Return the sub-mode of a slip; on a border the way R moves decides."""
        surplus, tiny = self.surplus(direction, state), self.tiny(state)
        band = self.band(direction, excess, state)
        if surplus > band + tiny:
            return ACCELERATE
        if surplus < -tiny:
            return DECELERATE
        if surplus >= band - tiny and self.surplus_rate(direction, state, excess) > 0:
            return ACCELERATE
        if surplus <= tiny and self.surplus_rate(direction, state, mpf(0)) < 0:
            return DECELERATE
        return COAST

    # ---- motion -------------------------------------------------------------------------------

    def flow(self, mode: Mode) -> Flow:
        """Return the linear dynamics of a mode."""
        if isinstance(mode, Slip):
            return Flow() if mode.phase == COAST else self._slip_flow(mode)
        if isinstance(mode, Yield):
            return self._yielding_flow(mode)
        return Flow() if self.axis.contact == 'rigid' else self._ringing_flow()

    def _slip_flow(self, slip: Slip) -> Flow:
        """Return the flow of m u' = F_d + F_e - σ N (α + β σ u)."""
        line = self.branch(slip)
        flow = self._free(self.axis.damping, self.axis.stiffness)
        return replace(flow, grip=slip.direction * line.offset, fall=line.slope)

    def _yielding_flow(self, mode: Yield) -> Flow:
        """Return the flow of m u' = F_d + F_e - s N mu_k(0), and of the deflection under that force."""
        a = self.axis
        flow = self._free(a.damping, a.stiffness)
        follows = a.contact_stiffness / a.contact_damping if a.contact_damping else mpf(0)
        return replace(flow, grip=mode.direction * self.side(mode.direction).at_rest, rate=flow.rate + follows,
                       yields=(a.contact_stiffness, a.contact_damping))

    def _ringing_flow(self) -> Flow:
        """Return the flow of m u' = F_d + F_e - c_c (d + y) - h_c u; the constant c_c d comes with the state."""
        a = self.axis
        flow = self._free(a.damping + a.contact_damping, a.stiffness + a.contact_stiffness)
        return replace(flow, contact=a.contact_stiffness)

    def _free(self, damping: mpf, stiffness: mpf) -> Flow:
        a = self.axis
        gamma, omega2 = damping / a.mass, stiffness / a.mass
        return Flow(sqrt(omega2) + abs(gamma), a.mass, a.stiffness, a.feed_damping, gamma, omega2, free=True)
