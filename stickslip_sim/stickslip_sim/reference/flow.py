# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Motion of a linear mode as a power series of the time τ since a state.

    y'' = q(τ) - γ y' - ω² y,    q a power series (inputs), y the travel since the state, u = y'

so that y_{k+1} = u_k / (k + 1) and u_{k+1} = (q_k - γ u_k - ω² y_k) / (k + 1).  The series is taken to the order at
which (ρ τ)^k / k! drops below the working precision, ρ >= every |eigenvalue|, those of the inputs included.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

from mpmath import mp, mpf, sqrt

from .inputs import Signal
from .precision import to_decimal
from .series import Series, combine, integral, series, value

SPAN = 4  # a step is at most SPAN / ρ: longer ones need more terms, shorter ones are more
_UNHEARD = 4  # digits of rounding in the amplitude of a ringing contact
_ZERO, _ONE = mpf(0), mpf(1)


class State(NamedTuple):
    """The axis at an instant, and its inputs from there on."""

    stretch: mpf  # w = s - x, m
    velocity: mpf  # u, m/s
    deflection: mpf  # d, m
    position: mpf  # x, m
    drive: Signal  # v, m/s
    force: Signal  # F_e, N

    @property
    def rate(self) -> mpf:
        """Return the highest circular frequency of the inputs."""
        return max(self.drive.rate, self.force.rate)


class Expansion(NamedTuple):
    """Power series in τ of the motion: travel y, velocity u, drive travel ∫v, and the inputs."""

    travel: Series
    velocity: Series
    drive_travel: Series
    drive: Series
    force: Series


@dataclass(frozen=True)
class Flow:
    """How the slider moves in a mode.

    Free: m y'' = c (w + ∫v) + h v + F - c_c d - `constant` - m γ y' - m ω² y.  Otherwise its velocity stays as it is.
    """

    rate: mpf = _ZERO  # ρ of the slider; 0 where the velocity stays as it is
    mass: mpf = _ONE
    stiffness: mpf = _ZERO
    damping: mpf = _ZERO
    gamma: mpf = _ZERO
    omega2: mpf = _ZERO
    constant: mpf = _ZERO
    contact: mpf = _ZERO  # c_c where the contact sticks and yields
    free: bool = False

    def longest_step(self, state: State, limit: mpf) -> mpf:
        """Return the longest step not above `limit` on which the series is used."""
        rate = self.rate + state.rate
        return min(limit, SPAN / rate) if rate and not self._settled(state) else limit

    def expand(self, state: State, h: mpf) -> Expansion:
        """Return the power series from a state on, exact to the working precision on [0, h]."""
        settled = self._settled(state)
        rate = state.rate if settled else self.rate + state.rate
        n = order(rate * h)
        drive, force = state.drive.series(n), state.force.series(n)
        travelled = integral(drive)
        if not self.free:
            settled = series(_ZERO, state.velocity), series(state.velocity)
        travel, velocity = settled or self._solve(state, travelled, drive, force, n)
        return Expansion(travel, velocity, travelled, drive, force)

    def _settled(self, state: State) -> tuple[Series, Series] | None:
        """Return y and u of a yielding contact that no longer rings to the working precision, or None.

        Under v = v_0 + a τ and F = F_0 + G τ they are polynomials, so that a long rest is one step.
        """
        if not self.contact or state.rate:
            return None
        c, h = self.stiffness / self.mass, self.damping / self.mass
        drive, force = state.drive, state.force
        held = (self.contact * state.deflection + self.constant - force.value) / self.mass
        bend = c * drive.slope / (2 * self.omega2)
        slope = (c * drive.value + h * drive.slope + force.slope / self.mass - 2 * self.gamma * bend) / self.omega2
        offset = (c * state.stretch + h * drive.value - held - self.gamma * slope - 2 * bend) / self.omega2
        rings = abs(offset) + abs(state.velocity - slope) / sqrt(self.omega2)
        if rings > (abs(state.stretch) + abs(state.deflection)) * mpf(10) ** (_UNHEARD - mp.dps):
            return None
        return series(_ZERO, slope, bend), series(slope, 2 * bend)

    def _solve(self, state: State, travelled: Series, drive: Series, force: Series, n: int) -> tuple[Series, Series]:
        share = 1 / self.mass
        push = combine((self.stiffness * share, travelled), (self.damping * share, drive), (share, force))
        held = self.contact * state.deflection + self.constant
        push[0] += to_decimal((self.stiffness * state.stretch - held) * share)
        y, u = series(_ZERO), series(state.velocity)
        gamma, omega2, given = to_decimal(self.gamma), to_decimal(self.omega2), len(push)
        for k in range(n):
            change = -gamma * u[k] - omega2 * y[k]
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
        state.deflection + y if flow.contact else state.deflection,
        state.position + y,
    )


def order(z: mpf) -> int:
    """Return the least K >= 4 with z^K / K! < 10^-(dps + 5)."""
    bound, k, x = 1.0, 0, float(z)
    log_limit = 10.0 ** -(mp.dps + 5)
    while bound > log_limit or k < 4:
        k += 1
        bound *= x / k
    return k
