# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""X21: a rigid contact with two friction branches under sines; the rate of the force alone says that it slips.

Friction is continuous at such a break-away: at that instant nothing is left over to accelerate the slider, and which
mode comes next is decided by where the sines of that very instant move the force.
"""

import random

from ..axis import InitialState
from ..core.input_profile import InputProfile, Sinusoid, constant
from ..solvers import Solver
from .against import error_of_run
from .outcome import Measurement, Setup, Tally
from .shared_axes import RIGID, paper_axis

_DURATION = 3.0   # s
_DOUBLED = Sinusoid(900.0, 0.7, 0.3), Sinusoid(850.0, 1.1, 2.0)   # whose break-aways were doubled once


def shaken(setup: Setup) -> Measurement:
    """X21: the paper's axis under one to three sines that pass its limit; the run is the reference's."""
    tally = Tally(1e-12)
    for sinusoid in _DOUBLED:
        tally.measure(_equals_the_reference, setup.solver, sinusoid)
    for seed in range(setup.count(100, 6)):
        tally.measure(_equals_the_reference, setup.solver, *_random_sinusoids(random.Random(seed)))
    return tally.finding('with other events than the reference')


def _random_sinusoids(rng: random.Random) -> tuple[Sinusoid, ...]:
    """Return sines whose amplitudes make 1 to 2.5 times the static limit together."""
    axis = paper_axis(RIGID)
    count = rng.randint(1, 3)
    size = rng.uniform(1.0, 2.5) * axis.friction.static.limit * axis.normal_force / count
    return tuple(Sinusoid(size, 10 ** rng.uniform(-0.5, 1.0), rng.uniform(-7.0, 7.0)) for _ in range(count))


def _equals_the_reference(solver: Solver, *sinusoids: Sinusoid) -> float:
    force = InputProfile((0.0,), (0.0,), (0.0,), sinusoids=sinusoids)
    return error_of_run(paper_axis(RIGID), InitialState(), constant(0.0), force, _DURATION, solver)
