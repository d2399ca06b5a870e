# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Static coefficient mu_s(t^-) = mu_0 + (mu_inf - mu_0) q(t), with its power series about any age.

t is the age beyond a delay, 0 before.

constant     q = 0
exponential  q = 1 - exp(-t/tau)
kato         q = 1 - exp(-(t/tau)^n)
hyperbolic   q = t / (t + tau)
logarithmic  q = ln(1 + t/tau)          (unbounded: finite rest time only)
"""

from __future__ import annotations

from dataclasses import dataclass
from decimal import Decimal

from mpmath import exp, inf, isinf, mp, mpf

from .series import Series, series, to_decimal

_LAWS = ('constant', 'exponential', 'kato', 'hyperbolic', 'logarithmic')
_ORDER = 70


@dataclass(frozen=True)
class StaticLaw:
    """One rise of the static coefficient with rest time; all of them are monotone."""

    law: str
    initial: mpf
    limit: mpf
    time_constant: mpf
    exponent: mpf
    delay: mpf

    def value(self, age: mpf) -> mpf:
        """Return mu_s at a rest time (which may be infinite)."""
        if self.law == 'constant':
            return self.initial
        if isinf(age):
            if self.law == 'logarithmic':
                raise ValueError('the logarithmic law has no limit: give a finite rest time')
            return self.limit
        return self.initial + (self.limit - self.initial) * self._rise(max(age - self.delay, mpf(0)))

    def _rise(self, age: mpf) -> mpf:
        z = age / self.time_constant
        if self.law == 'exponential':
            return -mp.expm1(-z)
        if self.law == 'kato':
            return -mp.expm1(-(z**self.exponent))
        if self.law == 'hyperbolic':
            return z / (1 + z)
        return mp.log1p(z)

    def span(self, age: mpf) -> mpf:
        """Return the longest time over which ``series`` is exact to the working precision."""
        if self._waits(age) and self.law != 'constant':
            return self.delay - age
        age = max(age - self.delay, mpf(0))
        if self.law == 'constant' or isinf(age) or self._settled(age):
            return inf
        if self.law == 'exponential':
            return 4 * self.time_constant
        if self.law == 'kato':
            z = (age / self.time_constant) ** self.exponent
            return min(age / 16, age / (self.exponent * z)) if age else mpf(0)
        return (age + self.time_constant) / 16

    def _waits(self, age: mpf) -> bool:
        """Return whether the rise is yet to begin, by more than rounding."""
        return bool(age < self.delay * (1 - mpf(10) ** (12 - mp.dps)))

    def _settled(self, age: mpf) -> bool:
        """Return whether an exponential rise is over to well below the working precision."""
        if self.law == 'exponential':
            z = age / self.time_constant
        elif self.law == 'kato':
            z = (age / self.time_constant) ** self.exponent
        else:
            return False
        return bool(z > 2.4 * mp.dps + 30)

    def series(self, age: mpf) -> Series:
        """Return the power series of mu_s(age + τ) in τ, valid on [0, span(age)]."""
        if isinf(self.span(age)) or self._waits(age):
            return series(self.value(age))
        age = max(age - self.delay, mpf(0))
        rise = {
            'exponential': self._exponential,
            'kato': self._kato,
            'hyperbolic': self._hyperbolic,
            'logarithmic': self._logarithmic,
        }[self.law](age)
        change = to_decimal(self.limit - self.initial)
        return [to_decimal(self.value(age + self.delay)), *(change * c for c in rise)]

    def _exponential(self, age: mpf) -> Series:
        c, slowness, out = to_decimal(-exp(-age / self.time_constant)), to_decimal(self.time_constant), []
        for k in range(1, _ORDER):
            c = -c / (slowness * k)
            out.append(c)
        return out

    def _kato(self, age: mpf) -> Series:
        """Series of 1 - e^{-z}, z = ((age + τ)/tau)^n: k q_k = -Σ_{j=1..k} j z_j q_{k-j} for q = e^{-z}."""
        first = (age / self.time_constant) ** self.exponent
        z, exponent, at = series(first), to_decimal(self.exponent), to_decimal(age)
        for k in range(1, _ORDER):
            z.append(z[-1] * (exponent - k + 1) / (k * at))
        q, steep = series(exp(-first)), [j * c for j, c in enumerate(z)]
        for k in range(1, _ORDER):
            q.append(-sum((steep[j] * q[k - j] for j in range(1, k + 1)), Decimal(0)) / k)
        return [-c for c in q[1:]]

    def _hyperbolic(self, age: mpf) -> Series:
        span = age + self.time_constant
        c, span, out = to_decimal(-self.time_constant / span), to_decimal(span), []
        for _ in range(1, _ORDER):
            c = -c / span
            out.append(c)
        return out

    def _logarithmic(self, age: mpf) -> Series:
        c, span, out = Decimal(-1), to_decimal(age + self.time_constant), []
        for k in range(1, _ORDER):
            c = -c / span
            out.append(c / k)
        return out
