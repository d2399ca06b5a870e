# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Motion of a linear mode as a power series of the time τ since a state.

    y'' = q(τ) - γ y' - ω² y - N(τ) (a + b y') / m,    q a power series (inputs), y the travel since the state, u = y'

so that y_{k+1} = u_k / (k + 1) and u_{k+1} = (q_k - γ u_k - ω² y_k - (a N_k + b Σ_j N_j u_{k-j}) / m) / (k + 1).  The
series is taken to the order at which (ρ τ)^k / k! drops below the working precision, ρ >= every |eigenvalue|, those of
the inputs included.  Where b N varies, Cauchy's estimate takes its place: |u_k| τ^k is at most R^-k times the largest
|u| on the circle |t| = R τ, which is exp ∫ ρ(s) ds up to there, ρ(s) with N's own bound on |t| = s (`_growth`).
"""

from __future__ import annotations

import math
import operator
from collections.abc import Callable
from dataclasses import dataclass
from decimal import Decimal
from typing import NamedTuple

from mpmath import mp, mpf, sqrt

from .problem import Signal
from .series import Series, combine, integral, series, to_decimal, value

SPAN = 4  # a step is at most SPAN / ρ: longer ones need more terms, shorter ones are more
_UNHEARD = 4  # digits of rounding in the amplitude of a ringing contact
_CIRCLES = 1.5, 2.0, 3.0, 4.0, 6.0, 8.0, 12.0, 16.0  # radii of Cauchy's estimate
_MOST_TERMS = 2.4  # of a series, for each digit: a shorter step is cheaper
_ZERO, _ONE = mpf(0), mpf(1)


class State(NamedTuple):
    """The axis at an instant, and its inputs from there on."""

    stretch: mpf  # w = s - x, m
    velocity: mpf  # u, m/s
    deflection: mpf  # d, m
    position: mpf  # x, m
    drive: Signal  # v, m/s
    force: Signal  # F_e, N
    normal: Signal  # N, N

    @property
    def rate(self) -> mpf:
        """Return the highest circular frequency of the inputs."""
        return max(self.drive.rate, self.force.rate, self.normal.rate)


class Expansion(NamedTuple):
    """Power series in τ of the motion: travel y, velocity u, deflection, drive travel ∫v, and the inputs."""

    travel: Series
    velocity: Series
    deflection: Series
    drive_travel: Series
    drive: Series
    force: Series
    normal: Series


@dataclass(frozen=True)
class Flow:
    """How the slider moves in a mode.

    Free: m y'' = c (w + ∫v) + h v + F - c_c d - N (`grip` + `fall` y') - m γ y' - m ω² y.  Otherwise its velocity stays
    as it is.  A contact that yields has the force `grip` N, its deflection follows that with its rate.
    """

    rate: mpf = _ZERO  # ρ of the slider; 0 where the velocity stays as it is
    mass: mpf = _ONE
    stiffness: mpf = _ZERO
    damping: mpf = _ZERO
    gamma: mpf = _ZERO
    omega2: mpf = _ZERO
    grip: mpf = _ZERO
    fall: mpf = _ZERO
    contact: mpf = _ZERO  # c_c where the contact sticks and gives
    yields: tuple[mpf, mpf] | None = None  # c_c and h_c of a contact that yields
    free: bool = False

    def pace(self, state: State) -> mpf:
        """Return ρ of the slider under the largest normal force of the present segment of its profile, but a slope."""
        return self.rate + abs(self.fall) * state.normal.reach / self.mass

    def longest_step(self, state: State, limit: mpf) -> mpf:
        """Return the longest step not above `limit` on which the series is used."""
        rate = self.pace(state) + state.rate
        if not rate or self._settled(state):
            return limit
        h = min(limit, SPAN / rate)
        while self._order(state, h) > _MOST_TERMS * mp.dps:
            h /= 2
        return h

    def _order(self, state: State, h: mpf) -> int:
        rate = self.pace(state) + state.rate
        if not self.fall or state.normal.is_constant:
            return order(rate * h)
        return order_by_growth(lambda circle: self._growth(state, circle * h))

    def _growth(self, state: State, radius: mpf) -> float:
        """Return ∫ ρ(s) ds from 0 to the radius of a circle: |N| <= |offset| + |slope| s + Σ A e^{ω s} on it."""
        normal, r = state.normal, float(radius)
        load = abs(float(normal.offset)) * r + abs(float(normal.slope)) * r * r / 2 + sum(
            abs(float(turn.amplitude)) * math.expm1(float(turn.omega) * r) / float(turn.omega) for turn in normal.turns)
        return float(self.rate + state.rate) * r + abs(float(self.fall)) / float(self.mass) * load

    def expand(self, state: State, h: mpf) -> Expansion:
        """Return the power series from a state on, exact to the working precision on [0, h]."""
        settled = self._settled(state)
        n = order(state.rate * h) if settled else self._order(state, h)
        drive, force, normal = state.drive.series(n), state.force.series(n), state.normal.series(n)
        travelled = integral(drive)
        if not self.free:
            settled = series(_ZERO, state.velocity), series(state.velocity)
        travel, velocity = settled or self._solve(state, travelled, drive, force, normal, n)
        return Expansion(travel, velocity, self._deflection(state, travel, normal, n), travelled, drive, force, normal)

    def _deflection(self, state: State, travel: Series, normal: Series, n: int) -> Series:
        """Return d, which in a contact that yields obeys h_c d' = `grip` N - c_c d."""
        if self.contact:
            return combine((state.deflection, [Decimal(1)]), (_ONE, travel))
        if self.yields is None:
            return series(state.deflection)
        stiffness, damping = map(to_decimal, self.yields)
        grip, out = to_decimal(self.grip), series(state.deflection)
        if not damping:
            return combine((self.grip / self.yields[0], normal))
        for k in range(n):
            pull = grip * normal[k] if k < len(normal) else 0
            out.append((pull - stiffness * out[k]) / (damping * (k + 1)))
        return out

    def _settled(self, state: State) -> tuple[Series, Series] | None:
        """Return y and u of a sticking contact that no longer rings to the working precision, or None.

        Under v = v_0 + a τ and F = F_0 + G τ they are polynomials, so that a long rest is one step.
        """
        if not self.contact or state.rate:
            return None
        c, h = self.stiffness / self.mass, self.damping / self.mass
        drive, force = state.drive, state.force
        held = (self.contact * state.deflection - force.value) / self.mass
        bend = c * drive.slope / (2 * self.omega2)
        slope = (c * drive.value + h * drive.slope + force.slope / self.mass - 2 * self.gamma * bend) / self.omega2
        offset = (c * state.stretch + h * drive.value - held - self.gamma * slope - 2 * bend) / self.omega2
        rings = abs(offset) + abs(state.velocity - slope) / sqrt(self.omega2)
        if rings > (abs(state.stretch) + abs(state.deflection)) * mpf(10) ** (_UNHEARD - mp.dps):
            return None
        return series(_ZERO, slope, bend), series(slope, 2 * bend)

    def _solve(self, state: State, travelled: Series, drive: Series, force: Series, normal: Series, n: int
               ) -> tuple[Series, Series]:
        share = 1 / self.mass
        push = combine((self.stiffness * share, travelled), (self.damping * share, drive), (share, force),
                       (-self.grip * share, normal))
        push[0] += to_decimal((self.stiffness * state.stretch - self.contact * state.deflection) * share)
        y, u = series(_ZERO), series(state.velocity)
        omega2, given = to_decimal(self.omega2), len(push)
        drag = combine((self.fall * share, normal)) if self.fall else []
        drag[:1] = [to_decimal(self.gamma) + sum(drag[:1])]
        while not drag[-1] and len(drag) > 1:
            drag.pop()
        for k in range(n):
            change = -sum(map(operator.mul, drag, reversed(u)), omega2 * y[k])
            y.append(u[k] / (k + 1))
            u.append((change + push[k] if k < given else change) / (k + 1))
        return y, u


class Place(NamedTuple):
    """Where the slider and the drive are after a step; the inputs there are read off the clock."""

    stretch: mpf
    velocity: mpf
    deflection: mpf
    position: mpf


def after(state: State, flow: Flow, motion: Expansion, tau: mpf) -> Place:
    """Return the place at τ."""
    y = value(motion.travel, tau)
    return Place(
        state.stretch + value(motion.drive_travel, tau) - y,
        value(motion.velocity, tau),
        value(motion.deflection, tau),
        state.position + y,
    )


def order_by_growth(growth: Callable[[float], float]) -> int:
    """Return the least K >= 4 with exp(growth(R)) R^-K < 10^-(dps + 5) for one of the circles R."""
    digits = (mp.dps + 5) * math.log(10.0)
    terms: int = min(math.ceil((digits + growth(circle)) / math.log(circle)) for circle in _CIRCLES)
    return max(4, terms)


def order(z: mpf) -> int:
    """Return the least K >= 4 with z^K / K! < 10^-(dps + 5)."""
    bound, k, x = 1.0, 0, float(z)
    log_limit = 10.0 ** -(mp.dps + 5)
    while bound > log_limit or k < 4:
        k += 1
        bound *= x / k
    return k
