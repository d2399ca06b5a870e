# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""X16: the energy of a run, integrated over samples between events; the engine's closed forms take no part in it.

    ∫ F_d v dt + ∫ F_e ẋ dt = ∫ F ẋ dt + ∫ h (v − ẋ)² dt + Δ(m ẋ²/2 + c (s − x)²/2)

F is friction in slip and the contact force in stick, whose own spring and damper are a part of ∫ F ẋ dt.  Between two
events all terms are smooth, and Gauss and Legendre's rule of 12 points over a fifth of a swing is exact to rounding.
"""

import math
import random
from itertools import pairwise

import numpy as np

from ..axis import Axis, CompliantContact
from ..core.input_profile import InputProfile, constant, ramp
from ..core.types import Instant, Mode, Sample
from ..simulation.simulator import Simulator
from ..solvers import Solver
from .outcome import Measurement, Setup, Tally, require
from .shared_axes import COMPLIANT, CONTACTS, instant, make, paper_axis, random_axis

_NODES, _WEIGHTS = (tuple(map(float, part)) for part in np.polynomial.legendre.leggauss(12))
_PANEL = 1.2   # rad of the fastest motion


def energy_balance(setup: Setup) -> Measurement:
    """X16: the residual of the balance over its throughput, for each cycle and over the run; friction only takes."""
    tally = Tally(1e-12)
    for contact in CONTACTS:
        for branches in (True, False):
            hours = setup.full and branches and contact == COMPLIANT
            tally.measure(_balances, setup.solver, paper_axis(contact, branches=branches), constant(0.002),
                        3600.0 if hours else 10.0)
    for seed in range(setup.count(100, 5)):
        rng = random.Random(seed)
        speed = 10 ** rng.uniform(-3, -1.5)
        drive = rng.choice((constant(speed), ramp(0.0, speed, 2.0)))
        tally.measure(_balances, setup.solver, random_axis(rng), drive, 3.0)
    return tally.finding('wrong')


class _Account:
    """Works and losses, summed without rounding at the end."""

    def __init__(self) -> None:
        self.terms: list[float] = []

    def add(self, *terms: float) -> None:
        self.terms += terms

    def balance(self, before: float, stored: float) -> float:
        """Return | given − taken − stored | over the sum of magnitudes, or the stored energy where that is more."""
        size = max(math.fsum(map(abs, self.terms)), before, before + stored)
        return abs(math.fsum(self.terms) - stored) / size if size > 0.0 else 0.0


def _balances(solver: Solver, axis: Axis, drive: InputProfile, duration: float) -> float:
    """Return the worst of the balances of all cycles, and of the whole run."""
    events = make(axis, drive, solver=solver).advance(instant(duration))
    simulator = make(axis, drive, solver=solver)
    whole, cycle, worst = _Account(), _Account(), 0.0
    begin = start = _stored(axis, simulator.sample())
    borders = sorted({Instant(0.0, 0.0), instant(duration), *(event.instant for event in events),
                      *(instant(t) for t in drive.starts if t < duration)})
    arrests = {event.instant for event in events if event.mode == Mode.STICK}
    for low, high in pairwise(borders):
        terms, last = _works(simulator, axis, low, high)
        whole.add(*terms)
        cycle.add(*terms)
        if high in arrests:
            worst = max(worst, cycle.balance(begin, last - begin))
            cycle, begin = _Account(), last
    return max(worst, whole.balance(start, last - start))


def _stored(axis: Axis, sample: Sample) -> float:
    """Return m ẋ²/2 + c (s − x)²/2, J."""
    stretch = sample.drive_position - sample.position
    return 0.5 * axis.mass * sample.velocity ** 2 + 0.5 * axis.drive_stiffness * stretch ** 2


def _works(simulator: Simulator, axis: Axis, low: Instant, high: Instant) -> tuple[list[float], float]:
    """Return the terms between two events, and the energy that is stored at the end."""
    length = (high.second - low.second) + (high.fraction - low.fraction)
    panels = max(1, math.ceil(length * _rate(axis) / _PANEL))
    width = length / panels
    terms = [0.0, 0.0, 0.0]
    for panel in range(panels):
        for node, weight in zip(_NODES, _WEIGHTS):
            offset = (panel + 0.5 * (node + 1.0)) * width
            simulator.advance(_later(low, offset))
            sample, step = simulator.sample(), 0.5 * weight * width
            slip = sample.drive_velocity - sample.velocity
            lost = sample.friction_force * sample.velocity
            require(sample.mode == Mode.STICK or lost >= 0.0, f'friction gives energy at {sample.time!r} s')
            terms[0] += step * sample.drive_force * sample.drive_velocity
            terms[1] -= step * lost
            terms[2] -= step * axis.drive_damping * slip * slip
    simulator.advance(high)
    return terms, _stored(axis, simulator.sample())


def _later(begin: Instant, offset: float) -> Instant:
    later = begin.fraction + offset
    return Instant(begin.second + math.floor(later), later - math.floor(later))


def _rate(axis: Axis) -> float:
    """Return a bound on the eigenvalues of all modes, 1/s."""
    damping, stiffness = axis.drive_damping, axis.drive_stiffness
    if isinstance(axis.contact, CompliantContact):
        damping, stiffness = damping + axis.contact.damping, stiffness + axis.contact.stiffness
    table = axis.friction.kinetic
    slopes = [abs((b - a) / (w - v)) for (v, a), (w, b) in
              pairwise(zip(table.velocities, table.coefficients, strict=True))]
    steepest = 3.0 * max(slopes, default=0.0)
    return (damping + axis.normal_force * steepest) / axis.mass + math.sqrt(stiffness / axis.mass)
