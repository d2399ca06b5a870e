# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""What nodes say of a defect of their own, in whatever thread: one line, or with STICKSLIP_DEBUG=1 where it is."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

from stickslip_sim.recording import write_bag
from tests.support.recorded_runs import FACTS, samples

pytest.importorskip('rclpy')
pytestmark = pytest.mark.ros

PROGRAM = """
import sys
from importlib import import_module

def broken(*_):
    raise ZeroDivisionError('first\\nsecond')

module, owner, method, program = sys.argv[1:5]
setattr(getattr(import_module('stickslip_sim.' + module), owner), method, broken)
sys.exit(import_module('stickslip_sim.ros.' + program).main(sys.argv[5:]))
"""
IN_THE_STEP_LOOP = ('rig.rig', 'Rig', 'make_step', 'sim_node')
IN_THE_PLAYER = ('ros.replay.states', 'States', 'acts', 'replay_node')
IN_THE_EXECUTOR = ('ros.diagnostics.periodic_report', 'PeriodicReport', 'report', 'sim_node')
PLACES = {'step loop': IN_THE_STEP_LOOP, 'player': IN_THE_PLAYER, 'executor': IN_THE_EXECUTOR}


@pytest.mark.parametrize('place', PLACES)
def test_a_defect_is_told_and_shown_where(tmp_path: Path, place: str) -> None:
    write_bag(tmp_path / 'run', FACTS, samples(3), [], {})
    bag = ['--ros-args', '-p', f'bag:={tmp_path}/run'] if place == 'player' else []
    command = [sys.executable, '-c', PROGRAM, *PLACES[place], *bag]
    *before, line = errors_of(command, '0')
    assert not any('Traceback' in text for text in before)
    assert line == f'{PLACES[place][-1]}: internal error: ZeroDivisionError: first (STICKSLIP_DEBUG=1 shows where)'
    shown = errors_of(command, '1')
    assert 'Traceback (most recent call last):' in shown
    assert any(text.endswith('in broken') for text in shown)
    assert shown[-2:] == ['ZeroDivisionError: first', 'second']


def errors_of(command: list[str], debug: str) -> list[str]:
    done = subprocess.run(command, stderr=subprocess.PIPE, text=True, timeout=60, check=False,
                          env={**os.environ, 'STICKSLIP_DEBUG': debug})
    assert done.returncode == 1, done.stderr
    return done.stderr.splitlines()
