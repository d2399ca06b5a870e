# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The same source compiled and as plain Python: the same bits of all events, samples and energies."""

import pytest

from stickslip_sim.core import hot_path
from tests.conftest import Program

pytestmark = pytest.mark.skipif(hot_path.UNIT is None, reason='no compiled code in this source tree; `make test` tests '
                                'the installed copy')
PRINTED = '''
import json
def printed(rows):
    for row in rows:
        print(*(float(number).hex() for number in row))
'''
SCENES = PRINTED + '''
from fractions import Fraction
from stickslip_sim import load_scene, scene_names, simulate
for name in scene_names():
    run = simulate(load_scene(name, OVERRIDES), 2.0, Fraction(1, 10))
    printed(run.events)
    printed(run.sample_rows())
    print(name, len(run.events), json.dumps(run.receipt['energy']))
'''
RANDOM = PRINTED + '''
import random
from tests.support.axes import random_axis, run_events
for seed in range(25):
    rng = random.Random(seed)
    axis = random_axis(rng)
    printed(run_events(axis, rng.choice((-1, 1)) * 10 ** rng.uniform(-3, -1.5), 3.0))
'''
LOAD = {'normal_load.course': 'sine', 'normal_load.constant': 500.0, 'normal_load.amplitude': 400.0,
        'normal_load.frequency': 7.0}
STEPS = [(method, {'solver.name': 'fixed_step', 'solver.method': method, 'solver.step': 1e-3})
         for method in ('euler', 'rk4')]


@pytest.mark.parametrize('program', [
    *(pytest.param(SCENES.replace('OVERRIDES', repr(overrides)), id=name)
      for name, overrides in (('exact', {}), *STEPS)),
    pytest.param(SCENES.replace('OVERRIDES', repr(LOAD)), id='a load'),
    pytest.param(RANDOM, id='random axes'),
])
def test_compiled_and_plain_python_agree_bit_by_bit(program: str, in_a_process: Program) -> None:
    program = 'from stickslip_sim.core.hot_path import hot_path\nassert hot_path() == WORDS\n' + program
    compiled = in_a_process(program.replace('WORDS', '"compiled"'), compiled=True)
    assert compiled.count('\n') > 200
    assert compiled == in_a_process(program.replace('WORDS', '"plain python"'), compiled=False)
