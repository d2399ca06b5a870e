# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Smooth characteristics over the speed w: kinetic friction mu_k(w), and psi(w), the excess of its accelerating branch.

| law         | mu_k(w)                                          | source                                              |
|-------------|--------------------------------------------------|-----------------------------------------------------|
| stribeck    | mu_c + (mu_0 − mu_c) exp(−(w/v_s)^δ) + k_v w     | Armstrong-Hélouvry, Dupont, Canudas de Wit 1994     |
| exponential | the same with δ = 1                              | Bo and Pavelescu 1982                               |
| hyperbolic  | mu_c + (mu_0 − mu_c)/(1 + w/v_s) + k_v w         | Leine, van Campen, de Kraker, van den Steen 1998    |

The engine works on tables of them (`tables`); the error of a table is measured against the laws.
"""

from dataclasses import dataclass

from ..core import ranges
from ..core.errors import InputError
from .shapes import MAX_EXPONENT, MIN_EXPONENT, Cosine, Decay, Hyperbola, Power, Shape

_FALLEN = 0.01   # share of the falling part that is left at the limit velocity


@dataclass(frozen=True, slots=True)
class SmoothKinetic:
    """mu_k(w) = mu_c + (mu_0 − mu_c) g(w/v_s) + k_v w: `initial` mu_0, `limit` mu_c, `stribeck_velocity` v_s in m/s.

    `viscous` is k_v in s/m.  Raises InputError on values without a meaning.
    """

    shape: Shape
    initial: float
    limit: float
    stribeck_velocity: float
    viscous: float = 0.0

    def __post_init__(self) -> None:
        name = 'friction.kinetic'
        for part in ('initial', 'limit'):
            ranges.COEFFICIENT.check_meaning(f'{name}.{part}', getattr(self, part), '', 'friction opposes the motion')
        ranges.LAW_SPEED.check_meaning(f'{name}.stribeck_velocity', self.stribeck_velocity, 'm/s',
                                       'give the speed at which the falling part has dropped to 1/e')
        ranges.SLOPE.check_meaning(f'{name}.viscous', self.viscous, 's/m',
                                   'a coefficient that fell for ever would become negative')
        if isinstance(self.shape, Decay) and not MIN_EXPONENT <= self.shape.exponent <= MAX_EXPONENT:
            raise InputError(f'{name}.exponent', self.shape.exponent, f'>= {MIN_EXPONENT} and <= {MAX_EXPONENT}',
                             '2 is the Gaussian form, 1 the exponential law')

    @property
    def limit_velocity(self) -> float:
        """The speed at which the falling part has dropped to 1 %, m/s: v_s (ln 100)^(1/δ), hyperbolic 99 v_s."""
        return self.stribeck_velocity * self.shape.reach(_FALLEN)

    @property
    def inflection(self) -> float:
        """The speed at which the curvature changes its sign, m/s; 0 when it does nowhere."""
        return self.stribeck_velocity * self.shape.inflection

    def coefficient(self, speed: float) -> float:
        """Return mu_k at a speed >= 0 m/s."""
        falling = (self.initial - self.limit) * self.shape.value(speed / self.stribeck_velocity)
        return self.limit + falling + self.viscous * speed

    def slope(self, speed: float) -> float:
        """Return dmu_k/dw in s/m at a speed >= 0 m/s."""
        falling = (self.initial - self.limit) / self.stribeck_velocity
        return falling * self.shape.slope(speed / self.stribeck_velocity) + self.viscous


@dataclass(frozen=True, slots=True)
class SmoothExcess:
    """psi(w) = g(w/v): 1 at rest, 0 from the `limit_velocity` v (m/s) on.  Raises InputError."""

    shape: Shape
    limit_velocity: float

    def __post_init__(self) -> None:
        name = 'friction.excess'
        ranges.LAW_SPEED.check_meaning(f'{name}.limit_velocity', self.limit_velocity, 'm/s',
                                       'give the speed at which the two branches meet')
        if isinstance(self.shape, Power) and not 1.0 < self.shape.exponent <= MAX_EXPONENT:
            raise InputError(f'{name}.exponent', self.shape.exponent, f'> 1 and <= {MAX_EXPONENT}',
                             'for n = 1 leave out friction.excess: psi is linear then')

    @property
    def inflection(self) -> float:
        """The speed at which the curvature changes its sign, m/s; 0 when it does nowhere."""
        return self.limit_velocity * self.shape.inflection

    def fraction(self, speed: float) -> float:
        """Return psi at a speed >= 0 m/s."""
        return self.shape.value(speed / self.limit_velocity)

    def slope(self, speed: float) -> float:
        """Return dpsi/dw in s/m at a speed >= 0 m/s."""
        return self.shape.slope(speed / self.limit_velocity) / self.limit_velocity


def stribeck(initial: float, limit: float, stribeck_velocity: float, viscous: float = 0.0,
             exponent: float = 2.0) -> SmoothKinetic:
    """Return mu_c + (mu_0 − mu_c) exp(−(w/v_s)^δ) + k_v w."""
    return SmoothKinetic(Decay(exponent), initial, limit, stribeck_velocity, viscous)


def exponential(initial: float, limit: float, stribeck_velocity: float, viscous: float = 0.0) -> SmoothKinetic:
    """Return mu_c + (mu_0 − mu_c) exp(−w/v_s) + k_v w."""
    return SmoothKinetic(Decay(1.0), initial, limit, stribeck_velocity, viscous)


def hyperbolic(initial: float, limit: float, stribeck_velocity: float, viscous: float = 0.0) -> SmoothKinetic:
    """Return mu_c + (mu_0 − mu_c)/(1 + w/v_s) + k_v w."""
    return SmoothKinetic(Hyperbola(), initial, limit, stribeck_velocity, viscous)


def cosine(limit_velocity: float) -> SmoothExcess:
    """Return psi = (1 + cos(π w/v))/2."""
    return SmoothExcess(Cosine(), limit_velocity)


def power(limit_velocity: float, exponent: float) -> SmoothExcess:
    """Return psi = (1 − w/v)^n."""
    return SmoothExcess(Power(exponent), limit_velocity)
