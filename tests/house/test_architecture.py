# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The one-way rule, and code compiled at build time: kept by machines, so that nobody has to remember them."""

import subprocess
import sys
from pathlib import Path

import pytest

import stickslip_sim
from tests.conftest import Program
from tests.support.repository import ROOT


def test_rooms_import_only_from_the_floors_below() -> None:
    """The contracts stand in pyproject.toml; a new module must be placed there."""
    done = subprocess.run([Path(sys.executable).with_name('lint-imports')], cwd=ROOT, capture_output=True, text=True,
                          timeout=120, check=False)
    assert done.returncode == 0, done.stdout + done.stderr


def test_an_installed_package_starts_without_a_compiler(in_a_process: Program) -> None:
    """Its hot path was compiled while it was built, from these very sources."""
    if 'site-packages' not in stickslip_sim.__file__:
        pytest.skip('this is the source tree, which may have no compiled code; `make test` tests the installed copy')
    program = '''
import sys
from stickslip_sim import simulate_events
from stickslip_sim.core.hot_path import hot_path
from stickslip_sim.inputs import load_scene
simulate_events(load_scene('paper_fig8'), 1.0)
print(hot_path(), {'Cython', 'numba'} & set(sys.modules))
'''
    assert in_a_process(program, compiled=True).strip() == 'compiled set()'
