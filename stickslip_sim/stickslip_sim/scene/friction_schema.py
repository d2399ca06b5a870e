# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The parameters of friction, those of both directions first; a number backwards that is left out is that forwards."""

from dataclasses import replace

from ..core import ranges
from ..core.ranges import Range
from ..friction.shapes import MAX_EXPONENT, MIN_EXPONENT
from .parameter import Parameter, When, choice, number, numbers

BACKWARD = 'backward'

_LAWS = ('constant', 'exponential', 'kato', 'hyperbolic', 'logarithmic')
_KINETIC = ('table', 'stribeck', 'exponential', 'hyperbolic')
_EXCESS = ('table', 'cosine', 'power')

_GROWS = When('friction.static.law', _LAWS[1:])
_BRANCHES = When('friction.acceleration_dependence', (True,))
_BREAKPOINTS = When('friction.kinetic.law', ('table',))
_SMOOTH = When('friction.kinetic.law', _KINETIC[1:])
_EXCESS_BREAKPOINTS = When('friction.excess.law', ('table',))
_EXCESS_SMOOTH = When('friction.excess.law', _EXCESS[1:])

_STATIC_LAW: tuple[Parameter, ...] = (
    choice('friction.static.law', 'constant', 'growth of the static coefficient mu_s with the rest time', _LAWS),
    number('friction.static.initial', 0.0, '', 'mu_s at zero rest time', within=ranges.COEFFICIENT, live=True),
    number('friction.static.limit', None, '', 'mu_s after infinite rest (logarithmic: initial + one unit of growth)',
           within=ranges.COEFFICIENT, live=True, when=_GROWS),
    number('friction.static.time_constant', None, 's', 'tau of the growth of mu_s',
           within=ranges.TIME_CONSTANT, live=True, when=_GROWS),
    number('friction.static.exponent', None, '', "n of Kato's law exp(-(t/tau)^n)",
           within=ranges.KATO_EXPONENT, live=True, when=When('friction.static.law', ('kato',))),
    Parameter('friction.static.delay', 'double', None, 's', 'rest time before mu_s begins to grow, as while the contact'
              ' still rings (docs/paper.md); left out: 0', *ranges.TIME, live=True, when=_GROWS),
)

_KINETIC_LAW: tuple[Parameter, ...] = (
    choice('friction.kinetic.law', 'table', 'kinetic coefficient mu_k over the speed: a table, linear between'
           ' breakpoints; or mu_c + (mu_0 - mu_c) g(speed/v_s) + k_v speed with g(z) = exp(-z^exponent) (stribeck),'
           ' exp(-z) (exponential) or 1/(1 + z) (hyperbolic)', _KINETIC),
    numbers('friction.kinetic.velocities', (0.0,), 'm/s', 'breakpoints of the kinetic coefficient; the first is 0, each'
            ' is higher, the last is v_gr', within=ranges.SPEED, live=True, when=_BREAKPOINTS),
    numbers('friction.kinetic.coefficients', (0.0,), '', 'mu_k at these speeds',
            within=ranges.COEFFICIENT, live=True, when=_BREAKPOINTS),
    number('friction.kinetic.end_slope', 0.0, 's/m', 'slope of mu_k beyond the last breakpoint',
           within=ranges.SLOPE, live=True, when=_BREAKPOINTS),
    number('friction.kinetic.initial', None, '', 'mu_0, mu_k at rest; not above friction.static.initial',
           within=ranges.COEFFICIENT, live=True, when=_SMOOTH),
    number('friction.kinetic.limit', None, '', 'mu_c, limit of the falling part at high speed',
           within=ranges.COEFFICIENT, live=True, when=_SMOOTH),
    number('friction.kinetic.stribeck_velocity', None, 'm/s', 'v_s, at which the falling part has dropped to 1/e'
           ' (hyperbolic: to 1/2)', within=ranges.LAW_SPEED, live=True, when=_SMOOTH),
    number('friction.kinetic.exponent', 2.0, '', 'delta of the law stribeck; 2: Gaussian',
           within=Range(MIN_EXPONENT, MAX_EXPONENT), live=True, when=When('friction.kinetic.law', ('stribeck',))),
    number('friction.kinetic.viscous', 0.0, 's/m', 'k_v, rise of mu_k with the speed', within=ranges.SLOPE,
           live=True, when=_SMOOTH),
    number('friction.kinetic.tolerance', 1e-4, '', 'largest difference, in mu, between the smooth law and its'
           ' table', within=ranges.TOLERANCE, live=True, when=_SMOOTH),
)

_COMMON: tuple[Parameter, ...] = (
    Parameter('friction.scale', 'double', None, '', 'factor on all coefficients of friction, static and kinetic, as of'
              ' the fault friction_scale: a whole measured curve that is known to some percent; left out: 1',
              *ranges.FACTOR, live=True),
    Parameter('friction.acceleration_dependence', 'bool', False, '', 'whether the accelerating branch of mu_k lies'
              ' above the decelerating one (Fig. 6) instead of one curve for both (Fig. 3)'),
)

_EXCESS_LAW: tuple[Parameter, ...] = (
    choice('friction.excess.law', 'table', 'psi over the speed, the shape of the excess of the accelerating branch: a'
           ' table; or (1 + cos(pi z))/2 (cosine) or (1 - z)^exponent (power) with z = speed/limit_velocity,'
           ' 0 beyond', _EXCESS, _BRANCHES),
    numbers('friction.excess.velocities', None, 'm/s', 'breakpoints of psi; left out: linear to 0 at the last'
            ' breakpoint of mu_k (a smooth law: where its falling part has dropped to 1 %)', within=ranges.SPEED,
            live=True, when=_EXCESS_BREAKPOINTS, required=False),
    numbers('friction.excess.fractions', None, '', 'psi at these speeds: 1 at the first, 0 at the last',
            within=ranges.SHARE, live=True, when=_EXCESS_BREAKPOINTS, required=False),
    Parameter('friction.excess.limit_velocity', 'double', None, 'm/s', 'speed at which psi ends; left out: as for a'
              ' table', *ranges.LAW_SPEED, live=True, when=_EXCESS_SMOOTH),
    number('friction.excess.exponent', None, '', 'n of the law power', within=Range(1.0, MAX_EXPONENT), above=True,
           live=True, when=When('friction.excess.law', ('power',))),
    number('friction.excess.tolerance', 1e-3, '', 'largest difference between the smooth psi and its table',
           within=ranges.TOLERANCE, live=True, when=_EXCESS_SMOOTH),
)


def backward_name(name: str) -> str:
    """Return the name of the parameter backwards of one of friction."""
    section, _, leaf = name.rpartition('.')
    return f'{section}.{BACKWARD}.{leaf}'


def forward_name(name: str) -> str:
    """Return the name of a parameter of friction without its direction."""
    return name.replace(f'.{BACKWARD}.', '.')


def _with_backward(section: tuple[Parameter, ...]) -> tuple[Parameter, ...]:
    """Return a section and behind it its numbers for motion along −x."""
    shared = ('law', 'tolerance', 'delay')
    return section + tuple(
        replace(entry, name=backward_name(entry.name), default=None, required=False,
                description=f'along -x: {entry.description.partition("; left out")[0]}; left out: as forwards')
        for entry in section if entry.name.rpartition('.')[2] not in shared)


FRICTION: tuple[Parameter, ...] = (*_with_backward(_STATIC_LAW), *_with_backward(_KINETIC_LAW), *_COMMON,
                                   *_with_backward(_EXCESS_LAW))
