# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The parameters of an input course: those of the drive and of the force are alike."""

import math

from ..config.bounds import PHASE, TIME
from ..config.parameter import Parameter, When
from ..core.input_profile import FREQUENCIES, MAX_SINUSOIDS
from .declare import choice, number, numbers

_COURSES = ('constant', 'ramp', 'steps', 'sine', 'table')


def profile(section: str, value: str, rate: str, values: str, unit: str, what: str, most: float,
           fastest_change: float) -> tuple[Parameter, ...]:
    """Return the parameters of an input profile of `what`, which is a `unit` and at most `most` of them."""
    ramp = When(f'{section}.course', ('ramp',))
    knots = When(f'{section}.course', ('steps', 'table'))
    sine = When(f'{section}.course', ('sine',))
    slowest, fastest = FREQUENCIES
    return (
        choice(f'{section}.course', 'constant',
               f'input profile of the {what}, offline and in the node until a command arrives: constant; ramp (to a'
               ' constant); steps (jumps); sine; table (linear between breakpoints); sinusoids may come on top',
               _COURSES),
        number(f'{section}.{value}', 0.0, unit, f'{what}; of a ramp its value at the start, of a sine its mean',
               low=-most, high=most, when=When(f'{section}.course', ('constant', 'ramp', 'sine'))),
        number(f'{section}.{rate}', None, f'{unit}/s' if unit == 'N' else 'm/s²',
               f'rate of change of the {what}, of a ramp', low=-fastest_change, high=fastest_change, when=ramp),
        number(f'{section}.duration', math.inf, 's', 'duration of a ramp; then its last value holds', low=0.0,
               high=TIME, above=True, infinite=True, when=ramp),
        numbers(f'{section}.times', None, 's', 'times at which the values of steps or a table begin: 0, then each'
                ' later', low=0.0, high=TIME, when=knots),
        numbers(f'{section}.{values}', None, unit, f'{what} at these times; the last one holds', low=-most, high=most,
                when=knots),
        number(f'{section}.period', math.inf, 's', 'time after which steps or a table begin again (.inf: never); a'
               ' table is linear from its last breakpoint back to the first', low=1e-6, high=TIME,
               infinite=True, when=knots),
        number(f'{section}.amplitude', None, unit, 'of a sine amplitude sin(2π frequency t + phase), t since the'
               ' start of the run', low=-most, high=most, when=sine),
        number(f'{section}.frequency', None, 'Hz', 'frequency of a sine', low=slowest, high=fastest, when=sine),
        number(f'{section}.phase', 0.0, 'rad', 'phase of a sine', low=-PHASE, high=PHASE, when=sine),
        numbers(f'{section}.amplitudes', None, unit,
                f'amplitudes of sinusoids on top of any input profile, at most {MAX_SINUSOIDS}', low=-most,
                high=most, required=False),
        numbers(f'{section}.frequencies', None, 'Hz', 'frequencies of these sinusoids', low=slowest, high=fastest,
                required=False),
        numbers(f'{section}.phases', None, 'rad', 'phases of these sinusoids; left out: 0', low=-PHASE, high=PHASE,
                required=False),
    )
