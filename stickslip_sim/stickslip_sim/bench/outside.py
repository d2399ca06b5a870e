# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Measurements in processes of their own: plain Python, and starts of Python until an axis slips."""

import json
import os
import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator

from .cases import make_case
from .measure import measure
from .own_solvers import exact_solver
from .peers import scipy_ivp
from .peers.peer import NO_SETTING, Setting
from .ratios import Ratio, at_least, at_most

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
