# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Measurements beside the race: plain Python and starts of Python, in processes of their own; many axes at once."""

import json
import os
import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator, Sequence
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np

from ..axis import Axis
from ..core.input_profile import constant
from ..runs.batch import run_batch
from .contestants import exact_solver
from .peers import scipy_ivp
from .problem import NO_SETTING, Problem, Setting, make_case
from .race import RACE_DIGITS, CaseResult, Row, cost_sample, measure

_FINEST = Setting(1e-12, 'tolerance')
_TAYLOR = Setting(1e-16, 'tolerance')   # heyoka has rounding as error, as the exact engine has
_MILLISECOND = Setting(1e-3, 'step')
# (rival, setting, case, mark: at least that many times the exact engine's cost, aim; None: reported without a mark)
_MARKS: tuple[tuple[str, Setting, str, float | None, float | None], ...] = (
    *(('scipy DOP853', _FINEST, case, 3000.0, 6000.0) for case in 'ABC'), ('scipy DOP853', _FINEST, 'D', None, None),
    *(('heyoka', _TAYLOR, case, mark, aim) for case, mark, aim in (
        ('A', 25.0, 30.0), ('B', 25.0, 30.0), ('C', 18.0, 25.0), ('D', 30.0, 60.0))),
    *(('CVODE (Adams), as from C', _FINEST, case, None, None) for case in 'ABCD'),
    *(('DOP853 with events, numba', _FINEST, case, 10.0, 25.0) for case in 'ABC'),
    ('DOP853 with events, numba', _FINEST, 'D', 1.5, 5.0),
    ('fixed_step euler', _MILLISECOND, 'A', 5.0, 8.0),
    *(('fixed_step euler', _MILLISECOND, case, None, None) for case in 'BCD'),
    *(('MuJoCo', _MILLISECOND, case, None, None) for case in 'ABCD'))
_ERROR_MARK, _ERROR_AIM = 1e-12, 2e-14   # s, of event times


class Ratio(NamedTuple):
    """A measured figure beside the limit to reach (`mark`) and the goal (`aim`), where they are set."""

    what: str
    case: str
    measured: float
    mark: str = ''
    aim: str = ''
    met: bool | None = None   # the mark; None without one


def at_least(what: str, case: str, measured: float, mark: float, aim: float) -> Ratio:
    """Return a figure that must not be below its mark."""
    return Ratio(what, case, measured, f'>= {mark:g}', f'{aim:g}', measured >= mark)


def at_most(what: str, case: str, measured: float, mark: float, aim: float | None = None) -> Ratio:
    """Return a figure that must not be above its mark."""
    return Ratio(what, case, measured, f'<= {mark:g}', '' if aim is None else f'{aim:g}', measured <= mark)


def ratios(results: Sequence[CaseResult]) -> list[Ratio]:
    """Return all figures that the race can speak to."""
    by_case = {result.problem.name: result for result in results}
    return [*_costs(by_case), *_accuracy(by_case)]


def _costs(by_case: dict[str, CaseResult]) -> Iterator[Ratio]:
    for rival, setting, case, mark, aim in _MARKS:
        if case not in by_case:
            continue
        own, other = _find(by_case[case], 'exact', None), _find(by_case[case], rival, setting)
        if own is None or other is None or own.cost is None or other.cost is None:
            continue
        what, measured = f'cost of {rival}, {setting.label} / exact', other.cost.median / own.cost.median
        yield Ratio(what, case, measured) if mark is None or aim is None else at_least(what, case, measured, mark, aim)


def _accuracy(by_case: dict[str, CaseResult]) -> Iterator[Ratio]:
    for case in 'ABCD':
        row = _find(by_case[case], 'exact', None) if case in by_case else None
        if row is not None and row.errors is not None:
            error, duration = row.errors, by_case[case].problem.duration
            figure = at_most(f'worst event time of exact over {duration:g} s against {RACE_DIGITS} digits, s', case,
                             error.time, _ERROR_MARK, _ERROR_AIM)
            yield figure._replace(met=bool(figure.met) and error.missed == error.invented == 0)


def _find(result: CaseResult, contestant: str, setting: Setting | None) -> Row | None:
    return next((row for row in result.rows if row.contestant == contestant and setting in (None, row.setting)), None)


_CASES, _DURATION, _ROUNDS = 'ABC', 20.0, 5
_STARTS = 5
_PLAIN_MARK, _PLAIN_AIM = 200.0, 400.0                    # times
_COLD_MARK, _START_MARK, _START_AIM = 6.0, 0.6, 0.2       # s
# up to the first slip: an axis that nothing has moved yet needs little of the hot path
FIRST_SLIP = '''
from stickslip_sim.inputs import load_scene
from stickslip_sim.simulation.simulator import Simulator
from stickslip_sim.core.types import Instant
scene = load_scene('paper_fig8')
simulator = Simulator(scene.axis, scene.initial, scene.drive, scene.force)
simulator.advance(Instant(0.0, 0.8))
sample = simulator.sample()
'''
_AXES, _BATCH_DURATION = 10_000, 10.0   # s
_FEED = 0.001                    # m/s, of A and B
_CORES = 2
_BATCH_MARK, _BATCH_AIM = 1e6, 4e6          # axis-seconds a second
_SEED, _WALLS, _FEW = 20261121, 5, 6
_PLAIN = 'from stickslip_sim.bench.outside import print_plain_ratios; print_plain_ratios()'


def outside_ratios() -> Iterator[Ratio]:
    """Yield the figures of plain Python and the times of a start."""
    ratios = json.loads(_run(_PLAIN, STICKSLIP_COMPILED='0'))
    for case, ratio in ratios.items():
        yield at_least('cost of scipy DOP853, 1e-12 / exact, plain Python', case, ratio, _PLAIN_MARK, _PLAIN_AIM)
    yield from start_ratios()


def start_ratios() -> Iterator[Ratio]:
    """Yield the times from the start of Python until an axis slips."""
    with tempfile.TemporaryDirectory() as folder:
        cold = _start(PYTHONPYCACHEPREFIX=folder)
    warm, plain = (statistics.median(_start(STICKSLIP_COMPILED=switch) for _ in range(_STARTS)) for switch in '10')
    yield at_most('first start until the first slip, no bytecode cached, s', '', cold, _COLD_MARK)
    yield at_most('later start until the first slip, s', '', warm, _START_MARK, _START_AIM)
    yield Ratio('later start until the first slip, plain Python, s', '', plain)


def print_plain_ratios() -> None:
    """Print the cost of scipy over that of the exact engine by case; scipy's functions are compiled all the same."""
    peer = scipy_ivp.SCIPY_PEERS[0]
    ratios = {}
    for case in _CASES if peer.missing is None else ():
        problem = make_case(case, _DURATION)
        runs = [exact_solver().prepare(problem, NO_SETTING), peer.prepare(problem, Setting(1e-12, 'tolerance'))]
        for run in runs:
            run()
        own, other = measure(runs, _ROUNDS)
        ratios[case] = other.median / own.median
    sys.stdout.write(json.dumps(ratios) + '\n')


def _start(**environment: str) -> float:
    begin = time.monotonic()
    _run(FIRST_SLIP, **environment)
    return time.monotonic() - begin


def _run(program: str, **environment: str) -> str:
    """Run a program in a Python of its own."""
    path = os.pathsep.join(filter(None, sys.path))
    return subprocess.run([sys.executable, '-c', program], env={**os.environ, 'PYTHONPATH': path, **environment},
                          check=True, stdout=subprocess.PIPE, text=True).stdout


def drawn(axis: Axis, count: int, seed: int = _SEED) -> dict[str, Any]:
    """Return masses, stiffnesses and feeds drawn at random, each within a factor of 2 of the axis and 1 mm/s."""
    random = np.random.default_rng(seed)
    return {name: middle * 2.0 ** random.uniform(-1.0, 1.0, count) for name, middle in (
        ('mass', axis.mass), ('drive_stiffness', axis.drive_stiffness), ('drive_velocity', _FEED))}


def batch_ratios() -> Iterator[Ratio]:
    """Yield the throughput of a batch of variants of A and of B; scipy runs the first few of the same axes."""
    cores = min(_CORES, os.cpu_count() or 1)
    for name in 'AB':
        axis = make_case(name).axis
        grid = drawn(axis, _AXES)
        run_batch(axis, _BATCH_DURATION, threads=cores, **grid)
        rate = _AXES * _BATCH_DURATION / statistics.median(_wall(axis, grid, cores) for _ in range(_WALLS))
        yield at_least(f'axis-seconds a second, batch of {_AXES} on {cores} cores', name, rate, _BATCH_MARK, _BATCH_AIM)
        if scipy_ivp.SCIPY_PEERS[0].missing is None:
            rate = cores * _FEW * _BATCH_DURATION / sum(_by_scipy(axis, grid, k) for k in range(_FEW))
            yield Ratio(f'the same by scipy DOP853, 1e-12, extrapolated from {_FEW} axes on one core', name, rate)


def _wall(axis: Axis, grid: dict[str, Any], cores: int) -> float:
    begin = time.monotonic()
    run_batch(axis, _BATCH_DURATION, threads=cores, **grid)
    return time.monotonic() - begin


def _by_scipy(axis: Axis, grid: dict[str, Any], index: int) -> float:
    """Return the cost of one axis of the grid by scipy, s of processor time."""
    mass, stiffness, feed = (float(grid[name][index]) for name in ('mass', 'drive_stiffness', 'drive_velocity'))
    case = make_case('A')
    problem = Problem('one of many', '', replace(axis, mass=mass, drive_stiffness=stiffness), case.initial,
                      constant(feed), constant(0.0), _BATCH_DURATION)
    run = scipy_ivp.SCIPY_PEERS[0].prepare(problem, Setting(1e-12, 'tolerance'))
    if index == 0:
        run()
    return cost_sample(run)
