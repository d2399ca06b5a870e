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
LOAD = {'normal_load.course': 'sine', 'normal_load.constant': 500.0, 'normal_load.amplitude': 400.0,
        'normal_load.frequency': 7.0}
SCATTER = {'friction.static.scatter': 0.2, 'friction.static.scatter_run': 0.1, 'seed': 2 ** 62}
STEPS = [{'solver.name': 'fixed_step', 'solver.method': method, 'solver.step': 1e-3} for method in ('euler', 'rk4')]
SCENES = f'''
from fractions import Fraction
from itertools import product
from stickslip_sim import load_scene, scene_names, simulate
for overrides, name in product({[{}, *STEPS, LOAD, SCATTER]!r}, scene_names()):
    run = simulate(load_scene(name, overrides), 2.0, Fraction(1, 10))
    printed(run.events)
    printed(run.sample_rows())
    print(name, overrides, len(run.events), json.dumps(run.receipt['energy']))
'''
RANDOM = '''
import random
from stickslip_sim.proof.axes import instant, random_parts
from tests.support.forced_profiles import with_sinusoids
for seed in range(12):
    rng = random.Random(seed)
    parts = random_parts(rng, 1.5)
    pull = 0.2 * parts.axis.normal_force, 10 ** rng.uniform(-1, 2), 1.0
    for force in (parts.force, with_sinusoids(parts.force, pull)):
        simulator = parts._replace(force=force).simulator()
        printed([*simulator.advance(instant(1.5)), simulator.sample()])
'''


def test_compiled_and_plain_python_agree_bit_by_bit(in_a_process: Program) -> None:
    """Scenes by the exact solver, by fixed steps and under a load, and axes at random, with sinusoids too."""
    program = ('from stickslip_sim.core.hot_path import hot_path\nassert hot_path() == WORDS\n'
               f'{PRINTED}{SCENES}{RANDOM}')
    compiled = in_a_process(program.replace('WORDS', '"compiled"'), compiled=True)
    assert compiled.count('\n') > 1000
    assert compiled == in_a_process(program.replace('WORDS', '"plain python"'), compiled=False)
