# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""X25: the account of energy costs at most as much again as the motion, however the axis is shaken, and it closes."""

import math
import statistics
import time
from dataclasses import replace
from typing import NamedTuple

from ..axis import Axis, CompliantContact, InitialState
from ..core.input_profile import InputProfile, Sinusoid, constant, steps
from ..core.types import Instant
from ..inputs import load_scene
from ..simulation.simulator import Simulator
from ..solvers import Solver
from .outcome import Measurement, Setup, Tally, require
from .shared_axes import COMPLIANT, RIGID, paper_axis

_ROUNDS = 11
_SHORTEST = 1e-2    # s of CPU time that a round takes at least
_SCENES = ('paper_fig4_constant', 'paper_fig4_falling', 'paper_fig7', 'paper_fig8', 'micro_feed', 'fast_feed',
           'positioning', 'cutting_force', 'stribeck')
_RESONANT = math.sqrt(5.6e6 / 350.0) / (2.0 * math.pi)   # Hz, the paper's contact without dampers


class _Case(NamedTuple):
    name: str
    axis: Axis
    drive: InputProfile
    force: InputProfile
    duration: float   # s
    velocity: float = 0.0


def cost_of_the_account(setup: Setup) -> Measurement:
    """X25: the residual of the balance, and the CPU time with the account over that without, less one."""
    cases = _cases(setup)
    tally = Tally(1e-12)
    for case in cases:
        tally.measure(_residual, setup.solver, case)
    if not setup.full:   # a figure of time belongs to a quiet machine
        return tally.finding()
    worst = max(_extra_cost(setup.solver, case) for case in cases)
    return tally.finding('wrong', f'costs at most {worst:.2g} x the motion', kept=worst <= 1.0)


def _cases(setup: Setup) -> list[_Case]:
    rigid, still = paper_axis(RIGID), constant(0.0)
    critical = replace(rigid, drive_damping=2.0 * math.sqrt(350.0 * 6e5))
    undamped = replace(paper_axis(CompliantContact(5e6, 0.0)), drive_damping=0.0)
    scenes = [load_scene(name) for name in setup.choose(_SCENES, _SCENES[2:4])]
    cases = [_Case(scene.name, scene.axis, scene.drive, scene.force, 20.0) for scene in scenes]
    cases += [_Case('critically damped', critical, constant(0.002), still, 60.0),
              _Case('rings for a year', undamped, steps('v', (0.0, 0.93), (0.002, 0.0)), still, 3.2e7)]
    for frequency in setup.choose((1.0, 50.0, 1e3, 1e6), (1e6,)):
        shaken = _sinusoids(0.0, 1e-9 * min(1e5, 1e3 * frequency), frequency)
        pushed = _sinusoids(0.0, 100.0, frequency)
        for contact in (RIGID, COMPLIANT):
            cases += [_Case(f'hold {frequency:g} Hz', paper_axis(contact), still, pushed, 1000.0),
                      _Case(f'shaken hold {frequency:g} Hz', paper_axis(contact), shaken, still, 1000.0)]
        cases.append(_Case(f'slide {frequency:g} Hz', rigid, constant(0.1), _sinusoids(0.0, 20.0, frequency),
                           min(100.0, 2e3 / frequency), 0.1))
    for frequency in setup.choose((1.0, 50.0, 1e3), (1.0,)):
        for contact in (RIGID, COMPLIANT):
            cases.append(_Case(f'shaken stick-slip {frequency:g} Hz', paper_axis(contact),
                               _sinusoids(0.002, 1e-4, frequency), still, 20.0))
    for damping in setup.choose((0.0, 1.5e4, 1e6, 1e8, 1e10), (1e8,)):
        axis = paper_axis(CompliantContact(5e6, damping))
        cases += [_Case(f'h_c {damping:g}, shaken', axis, _sinusoids(0.0, 1e-3, 3.0), still, 60.0),
                  _Case(f'h_c {damping:g}, driven', axis, _sinusoids(0.002, 1e-3, 3.0), still, 60.0)]
    for detuned in setup.choose((0.0, 1e-9, 1e-4, 1e-2), (1e-9,)):
        cases.append(_Case(f'off resonance by {detuned:g}', undamped, still,
                           _sinusoids(0.0, 0.1, _RESONANT * (1.0 + detuned)), 100.0))
    for stiffer in setup.choose((1e3, 1e6, 1e9), (1e9,)):
        cases.append(_Case(f'c_c x {stiffer:g}', paper_axis(CompliantContact(5e6 * stiffer, 15000.0)), constant(0.002),
                           still, 20.0))
    return cases


def _sinusoids(base: float, amplitude: float, frequency: float) -> InputProfile:
    return InputProfile((0.0,), (base,), (0.0,), sinusoids=(Sinusoid(amplitude, frequency, 0.1),))


def _made(solver: Solver, case: _Case, accounting: bool) -> Simulator:
    return Simulator(case.axis, InitialState(0.0, case.velocity), case.drive, case.force, solver=solver,
                     accounting=accounting)


def _residual(solver: Solver, case: _Case) -> float:
    simulator = _made(solver, case, accounting=True)
    require(simulator.energy is not None, f'{case.name}: no account')
    simulator.advance(Instant(math.floor(case.duration), case.duration % 1.0))
    energy = simulator.energy
    return energy.relative_residual if energy is not None else math.inf


def _extra_cost(solver: Solver, case: _Case) -> float:
    """Return (with − without)/without, the median of several rounds of both; each run ends with a sample."""
    runs = max(1, math.ceil(_SHORTEST / max(_seconds(solver, case, 1, accounting=True), 1e-7)))
    ratios = [_seconds(solver, case, runs, accounting=True) / _seconds(solver, case, runs, accounting=False)
              for _ in range(_ROUNDS)]
    return statistics.median(ratios) - 1.0


def _seconds(solver: Solver, case: _Case, runs: int, accounting: bool) -> float:
    simulators = [_made(solver, case, accounting) for _ in range(runs)]
    end = Instant(math.floor(case.duration), case.duration % 1.0)
    begin = time.process_time()
    for simulator in simulators:
        simulator.advance(end)
        simulator.sample()
        _ = simulator.energy
    return time.process_time() - begin
