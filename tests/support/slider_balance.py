# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The motion of one mode by the power series of its balance of forces: exp(A t) z, summed in 80 digits.

m ẍ = F_d + F_e − F with F_d = c (s − x) + h (v − ẋ), as docs/model.md has it; F is a line over the velocity in slip,
and F_c = c_c δ + h_c ẋ in a compliant stick.  It has no formula of the package.
"""

import math
from dataclasses import dataclass
from decimal import Decimal, localcontext

X, U, S, V, F, DEFLECTION, SINE, COSINE, ONE = range(9)
_DIGITS = 80      # the terms rise to e^60 of the sum
_SMALL = Decimal('1e-40')


@dataclass(frozen=True)
class Balance:
    """A mode of an axis, with its inputs v + v_rate t and f + f_rate t; a sinusoid of `frequency` Hz on top of both.

    The slider begins at x = 0 with `velocity`, and the drive's end of the spring at `stretch`.  `friction` is F at
    standstill, N with its sign, and `viscous` its slope in N s/m; with a `contact_stiffness` the slider sticks.
    """

    mass: float = 2.0
    stiffness: float = 1024.0
    damping: float = 32.0
    is_on_slideway: bool = False
    friction: float = 0.0
    viscous: float = 0.0
    contact_stiffness: float = 0.0
    contact_damping: float = 0.0
    velocity: float = 0.0
    stretch: float = 0.0
    deflection: float = 0.0
    v: float = 0.0
    v_rate: float = 0.0
    f: float = 0.0
    f_rate: float = 0.0
    frequency: float = 0.0
    phase: float = 0.0      # turns
    v_amplitude: float = 0.0
    f_amplitude: float = 0.0

    def after(self, t: float) -> 'Motion':
        """Return the motion at a time in s."""
        rates = self._rates()
        begin = [0.0, self.velocity, self.stretch, self.v, self.f, self.deflection, sine_of(self.phase),
                 sine_of(self.phase + 0.25), 1.0]
        end = _exponential(rates, begin, t)
        change = sum(rate * number for rate, number in zip(rates[U].values(), map(end.__getitem__, rates[U])))
        return Motion(travel=float(end[X]), velocity=float(end[U]), acceleration=float(change),
                      drive_travel=float(end[S] - Decimal(self.stretch)), stretch=float(end[S] - end[X]),
                      deflection=float(end[DEFLECTION]), v=float(end[V] + Decimal(self.v_amplitude) * end[SINE]),
                      f=float(end[F] + Decimal(self.f_amplitude) * end[SINE]))

    def _rates(self) -> dict[int, dict[int, Decimal]]:
        """Return the rows of the matrix A of z′ = A z."""
        w = 2.0 * math.pi * self.frequency
        feed = 0.0 if self.is_on_slideway else self.damping
        forces = {X: -self.stiffness, S: self.stiffness, V: feed, F: 1.0, ONE: -self.friction,
                  U: -self.damping - self.viscous - self.contact_damping, DEFLECTION: -self.contact_stiffness,
                  SINE: feed * self.v_amplitude + self.f_amplitude}
        rows = {X: {U: 1.0}, DEFLECTION: {U: 1.0}, S: {V: 1.0, SINE: self.v_amplitude}, V: {ONE: self.v_rate},
                F: {ONE: self.f_rate}, SINE: {COSINE: w}, COSINE: {SINE: -w},
                U: {column: force / self.mass for column, force in forces.items()}, ONE: {}}
        return {row: {column: Decimal(rate) for column, rate in rates.items() if rate != 0.0}
                for row, rates in rows.items()}


def _exponential(rates: dict[int, dict[int, Decimal]], begin: list[float], t: float) -> list[Decimal]:
    with localcontext() as context:
        context.prec = _DIGITS
        term = [Decimal(number) for number in begin]
        total, k = term, 0
        while k < 3 or max(map(abs, term)) > _SMALL:
            k += 1
            step = Decimal(t) / k
            term = [step * sum((rate * term[column] for column, rate in rates[row].items()), Decimal(0))
                    for row in range(len(begin))]
            total = [one + more for one, more in zip(total, term)]
        return total


@dataclass(frozen=True)
class Motion:
    """Where a motion has come to: m, m/s, m/s²; the inputs at that time."""

    travel: float
    velocity: float
    acceleration: float
    drive_travel: float
    stretch: float
    deflection: float
    v: float
    f: float

    @property
    def of_slider(self) -> tuple[float, float, float]:
        """Travel, velocity and acceleration."""
        return self.travel, self.velocity, self.acceleration


def sine_of(turns: float) -> float:
    """Return the sine of a phase in turns."""
    return math.sin(2.0 * math.pi * turns)
