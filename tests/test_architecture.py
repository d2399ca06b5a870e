"""The one-way rule, and the compile cache: kept by machines, so that nobody has to remember them."""

import subprocess
import sys
from pathlib import Path

from tests.conftest import Program

ROOT = Path(__file__).parents[1]


def test_rooms_import_only_from_the_floors_below() -> None:
    """The contracts stand in pyproject.toml; a new module must be placed there."""
    done = subprocess.run([Path(sys.executable).with_name('lint-imports')], cwd=ROOT, capture_output=True, text=True,
                          timeout=120, check=False)
    assert done.returncode == 0, done.stdout + done.stderr


def test_a_second_start_compiles_nothing(in_a_process: Program) -> None:
    """The entry points of the engine come from the cache, whoever compiled them before."""
    program = '''
from stickslip_sim.offline import warm_up
from stickslip_sim.scene import load_scene
from stickslip_sim.solvers import exact
warm_up(load_scene('paper_fig8'))
entries = exact.SOLVER[1:7]
print(sum(len(entry.stats.cache_misses) for entry in entries), sum(len(entry.stats.cache_hits) for entry in entries))
'''
    in_a_process(program, compiled=True)
    assert in_a_process(program, compiled=True).split() == ['0', '6']
