# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""X16 and X25: the energy of a run, integrated over samples between events, and the engine's own account of it.

    ∫ F_d v dt + ∫ F_e ẋ dt = ∫ F ẋ dt + ∫ h (v − ẋ)² dt + Δ(m ẋ²/2 + c (s − x)²/2)

F is friction in slip and the contact force in stick, whose own spring and damper are a part of ∫ F ẋ dt.  Between two
events all terms are smooth, and Gauss and Legendre's rule of 12 points over a fifth of a swing is exact to rounding:
the engine's closed forms take no part in X16.  X25 holds the account to the same balance, however the axis is shaken.
"""

import math
import random
import statistics
import time
from collections.abc import Iterator, Mapping
from dataclasses import replace
from itertools import pairwise

import numpy as np

from ...axis import Axis, CompliantContact, InitialState
from ...core.input_profile import InputProfile, Sinusoid, constant, ramp, steps
from ...core.types import Instant, Mode, Sample
from ...inputs import load_scene
from ...simulation.simulator import Simulator
from ...solvers import Solver
from ..axes import COMPLIANT, CONTACTS, RIGID, Contact, Parts, instant, make, paper_axis, random_axis
from ..judges import Measurement, Setup, Tally, require

_NODES, _WEIGHTS = (tuple(map(float, part)) for part in np.polynomial.legendre.leggauss(12))
_PANEL = 1.2   # rad of the fastest motion
_CONTACTS: Mapping[str, Contact] = {'rigid': RIGID, 'compliant': COMPLIANT}
_ROUNDS = 11
_SHORTEST = 1e-2    # s of CPU time that a round takes at least
_SCENES = ('paper_fig4_constant', 'paper_fig4_falling', 'paper_fig7', 'paper_fig8', 'micro_feed', 'fast_feed',
           'positioning', 'cutting_force', 'stribeck')
_RESONANT = math.sqrt(5.6e6 / 350.0) / (2.0 * math.pi)   # Hz, the paper's contact without dampers


def energy_balance(setup: Setup) -> Measurement:
    """X16: the residual of the balance over its throughput, for each cycle and over the run; friction only takes."""
    tally = Tally(1e-12)
    for contact in CONTACTS:
        for branches in (True, False):
            hours = setup.full and branches and contact == COMPLIANT
            tally.measure(_balances, setup.solver, paper_axis(contact, branches=branches), constant(0.002),
                        3600.0 if hours else 10.0)
    for seed in range(setup.choose(100, 5)):
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
    later = instant(begin.fraction + offset)
    return later._replace(second=begin.second + later.second)


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


def cost_of_the_account(setup: Setup) -> Measurement:
    """X25: the residual of the balance, and the CPU time with the account over that without, less one."""
    cases = dict(_cases(setup))
    tally = Tally(1e-12)
    for name, parts in cases.items():
        tally.measure(_residual, setup.solver, name, parts)
    if not setup.full:   # a figure of time belongs to a quiet machine
        return tally.finding()
    worst = max(_extra_cost(setup.solver, parts) for parts in cases.values())
    return tally.finding('wrong', f'costs at most {worst:.2g} x the motion', kept=worst <= 1.0)


def _cases(setup: Setup) -> Iterator[tuple[str, Parts]]:
    rigid, still = paper_axis(RIGID), constant(0.0)
    critical = replace(rigid, drive_damping=2.0 * math.sqrt(350.0 * 6e5))
    undamped = replace(paper_axis(CompliantContact(5e6, 0.0)), drive_damping=0.0)
    for scene in map(load_scene, setup.choose(_SCENES, _SCENES[2:4])):
        yield _case(scene.name, scene.axis, scene.drive, scene.force, 20.0)
    yield _case('critically damped', critical, constant(0.002), still, 60.0)
    yield _case('rings for a year', undamped, steps('v', (0.0, 0.93), (0.002, 0.0)), still, 3.2e7)
    for frequency in setup.choose((1.0, 50.0, 1e3, 1e6), (1e6,)):
        shaken = _sinusoids(0.0, 1e-9 * min(1e5, 1e3 * frequency), frequency)
        pushed = _sinusoids(0.0, 100.0, frequency)
        for name, contact in _CONTACTS.items():
            yield _case(f'{name} hold {frequency:g} Hz', paper_axis(contact), still, pushed, 1000.0)
            yield _case(f'{name} shaken hold {frequency:g} Hz', paper_axis(contact), shaken, still, 1000.0)
        yield _case(f'slide {frequency:g} Hz', rigid, constant(0.1), _sinusoids(0.0, 20.0, frequency),
                    min(100.0, 2e3 / frequency), 0.1)
    for frequency in setup.choose((1.0, 50.0, 1e3), (1.0,)):
        for name, contact in _CONTACTS.items():
            yield _case(f'{name} shaken stick-slip {frequency:g} Hz', paper_axis(contact),
                        _sinusoids(0.002, 1e-4, frequency), still, 20.0)
    for damping in setup.choose((0.0, 1.5e4, 1e6, 1e8, 1e10), (1e8,)):
        axis = paper_axis(CompliantContact(5e6, damping))
        yield _case(f'h_c {damping:g}, shaken', axis, _sinusoids(0.0, 1e-3, 3.0), still, 60.0)
        yield _case(f'h_c {damping:g}, driven', axis, _sinusoids(0.002, 1e-3, 3.0), still, 60.0)
    for detuned in setup.choose((0.0, 1e-9, 1e-4, 1e-2), (1e-9,)):
        yield _case(f'off resonance by {detuned:g}', undamped, still,
                    _sinusoids(0.0, 0.1, _RESONANT * (1.0 + detuned)), 100.0)
    for stiffer in setup.choose((1e3, 1e6, 1e9), (1e9,)):
        yield _case(f'c_c x {stiffer:g}', paper_axis(CompliantContact(5e6 * stiffer, 15000.0)), constant(0.002), still,
                    20.0)


def _case(name: str, axis: Axis, drive: InputProfile, force: InputProfile, duration: float,
          velocity: float = 0.0) -> tuple[str, Parts]:
    return name, Parts(axis, InitialState(0.0, velocity), drive, force, duration)


def _sinusoids(base: float, amplitude: float, frequency: float) -> InputProfile:
    return InputProfile((0.0,), (base,), (0.0,), sinusoids=(Sinusoid(amplitude, frequency, 0.1),))


def _residual(solver: Solver, name: str, parts: Parts) -> float:
    simulator = parts.simulator(solver, accounting=True)
    require(simulator.energy is not None, f'{name}: no account')
    simulator.advance(instant(parts.duration))
    energy = simulator.energy
    return energy.relative_residual if energy is not None else math.inf


def _extra_cost(solver: Solver, parts: Parts) -> float:
    """Return (with − without)/without, the median of several rounds of both; each run ends with a sample."""
    runs = max(1, math.ceil(_SHORTEST / max(_seconds(solver, parts, 1, accounting=True), 1e-7)))
    ratios = [_seconds(solver, parts, runs, accounting=True) / _seconds(solver, parts, runs, accounting=False)
              for _ in range(_ROUNDS)]
    return statistics.median(ratios) - 1.0


def _seconds(solver: Solver, parts: Parts, runs: int, *, accounting: bool) -> float:
    simulators = [parts.simulator(solver, accounting=accounting) for _ in range(runs)]
    end = instant(parts.duration)
    begin = time.process_time()
    for simulator in simulators:
        simulator.advance(end)
        simulator.sample()
        _ = simulator.energy
    return time.process_time() - begin
