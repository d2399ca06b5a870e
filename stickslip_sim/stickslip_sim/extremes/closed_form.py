# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Linear motions and break-away instants in closed form, in mpmath's arithmetic: the figures are measured against them.

m x″ + D x′ + K x = q(t) from rest is x = Σ Δ_i G_(k+1)(t − t_i)/m, where q's k-th derivative jumps by Δ_i at t_i, and
G_k is the k-fold integral of the impulse response (exp(λ₁t) − exp(λ₂t))/(λ₁ − λ₂).
"""

from collections.abc import Callable, Iterable
from fractions import Fraction
from typing import Any, NamedTuple

from mpmath import exp, expm1, factorial, findroot, fsum, log1p, mp, mpc, mpf, sqrt, workdps

from ..axis import Axis, CompliantContact
from ..friction import StaticLaw, StaticLawKind

CLOSED_FORM_DIGITS = 50
Number = Any   # mpf


class Jump(NamedTuple):
    """The `order`-th derivative of the load q jumps by `size` at `time`."""

    time: Number
    order: int
    size: Number


class LinearMode:
    """m x″ + D x′ + K x = q; arguments are the doubles that they are."""

    def __init__(self, mass: Number, damping: Number, stiffness: Number) -> None:
        with workdps(CLOSED_FORM_DIGITS):
            self.mass = mpf(mass)
            gamma = mpf(damping) / (2 * self.mass)
            root = sqrt(mpc(gamma * gamma - mpf(stiffness) / self.mass))
            if root == 0:   # critical to the last bit: 1e-22 beside it is the same to 22 digits
                root = mpc((abs(gamma) or 1) * mpf(10) ** -22)
            self._rates = (-gamma + root, -gamma - root)

    def integral(self, order: int, t: Number) -> Number:
        """Return G_order(t); order −1 is g′."""
        with workdps(CLOSED_FORM_DIGITS):
            one, two = (_integrated(rate, order, mpf(t)) for rate in self._rates)
            return ((one - two) / (self._rates[0] - self._rates[1])).real

    def growth(self, t: Number) -> Number:
        """Return by how much the size of a free motion has grown or shrunk at t."""
        with workdps(CLOSED_FORM_DIGITS):
            return exp(max(rate.real for rate in self._rates) * t)

    def response(self, jumps: Iterable[Jump], t: Number) -> tuple[Number, Number]:
        """Return x and x′ at t, from rest at 0."""
        with workdps(CLOSED_FORM_DIGITS):
            past = [(t - jump.time, jump) for jump in jumps if jump.time < t]
            x = fsum(jump.size * self.integral(jump.order + 1, since) for since, jump in past) / self.mass
            u = fsum(jump.size * self.integral(jump.order, since) for since, jump in past) / self.mass
            return x, u


def exact_contact_force(axis: Axis, jumps: list[Jump]) -> Callable[[Number], Number]:
    """Return F_c(t) of a compliant stick from rest, under the load q = c s + h v + F_e."""
    contact = axis.contact
    assert isinstance(contact, CompliantContact)
    mode = LinearMode(axis.mass, mpf(axis.drive_damping) + mpf(contact.damping),
                      mpf(axis.drive_stiffness) + mpf(contact.stiffness))

    def force(t: Number) -> Number:
        x, u = mode.response(jumps, t)
        return contact.stiffness * x + contact.damping * u

    return force


def exact_static_coefficient(law: StaticLaw, rest: Number) -> Number:
    """Return mu_s after a rest time, from the formulas of the laws."""
    with workdps(CLOSED_FORM_DIGITS):
        start, rise = mpf(law.initial), mpf(law.limit) - mpf(law.initial)
        if law.kind == StaticLawKind.CONSTANT:
            return start
        if rest == mp.inf:
            return mpf(law.limit)
        z = mpf(rest) / mpf(law.time_constant)
        if law.kind == StaticLawKind.HYPERBOLIC:
            return start + rise * z / (1 + z)
        if law.kind == StaticLawKind.LOGARITHMIC:
            return start + rise * log1p(z)
        power = z ** mpf(law.exponent) if law.kind == StaticLawKind.KATO else z
        return start - rise * expm1(-power)


def root_near(function: Callable[[Number], Number], low: Number, high: Number) -> Number:
    """Return the root between two instants of opposite sign."""
    with workdps(CLOSED_FORM_DIGITS):
        return findroot(function, (mpf(low), mpf(high)), solver='anderson', tol=mpf(10) ** -60, verify=False)


def exact(second: float, fraction: float) -> Number:
    """Return the instant of an event without rounding."""
    with workdps(CLOSED_FORM_DIGITS):
        time = Fraction(second) + Fraction(fraction)
        return mpf(time.numerator) / time.denominator


def _integrated(rate: Number, order: int, t: Number) -> Number:
    """Return the `order`-fold integral of exp(rate t) from 0; −1 is its derivative."""
    if order < 0:
        return rate * exp(rate * t)
    if rate == 0:
        return t ** order / factorial(order)
    if abs(rate * t) < mpf(10) ** -4:   # the difference below would lose digits
        return fsum(rate ** k * t ** (k + order) / factorial(k + order) for k in range(12))
    return (exp(rate * t) - fsum((rate * t) ** k / factorial(k) for k in range(order))) / rate ** order
