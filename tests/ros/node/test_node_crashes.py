# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""What nodes say of a defect of their own, in any thread: one line, or with STICKSLIP_DEBUG=1 where it is."""

import signal
import subprocess
import sys
from functools import partial
from pathlib import Path

import pytest

from stickslip_sim.recording import open_bag, write_bag
from tests.support.defects import break_method
from tests.support.recorded_runs import FACTS, samples

from tests.support.node_processes import recording_into, running  # isort: skip  # skips without ROS

pytestmark = pytest.mark.ros

IN_THE_STEP_LOOP = ('simulation.rig', 'Rig', 'make_step', 'sim_node')
IN_THE_PLAYER = ('ros.replay.states', 'States', 'acts', 'replay_node')
IN_THE_EXECUTOR = ('ros.node.periodic_report', 'PeriodicReport', 'report', 'sim_node')
PLACES = {'step loop': IN_THE_STEP_LOOP, 'player': IN_THE_PLAYER, 'executor': IN_THE_EXECUTOR}


@pytest.mark.parametrize('place', PLACES)
def test_a_defect_is_reported_and_shown_where(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, place: str) -> None:
    write_bag(tmp_path / 'run', FACTS, samples(3), [], {})
    *method, program = PLACES[place]
    bag = ['-p', f'bag:={tmp_path}/run'] if place == 'player' else []

    def errors() -> list[str]:
        with running(*bag, program=program, folder=tmp_path, prepare=partial(break_method, *method)) as process:
            code, errors = process.wait()
        assert code == 1, errors
        return errors.splitlines()

    monkeypatch.setenv('STICKSLIP_DEBUG', '0')
    *before, line = errors()
    assert not any('Traceback' in text for text in before)
    assert line == f'{program}: internal error: ZeroDivisionError: first (STICKSLIP_DEBUG=1 shows where)'
    monkeypatch.setenv('STICKSLIP_DEBUG', '1')
    shown = errors()
    assert 'Traceback (most recent call last):' in shown
    assert any(text.endswith('in broken') for text in shown)
    assert shown[-2:] == ['ZeroDivisionError: first', 'second']


CORRUPTED = """
import sys
from stickslip_sim.ros.executables import sim_node
from stickslip_sim.solvers import exact, with_advance

done = []

def corrupted(p, s, second, fraction, *arguments):
    if not done and fraction > 0.005:
        done.append(True)
        s.stored_at_start += 1e3      # J that the run never had
    return exact.advance(p, s, second, fraction, *arguments)

exact.SOLVER = with_advance(exact.SOLVER, corrupted)
sys.exit(sim_node(sys.argv[1:]))
"""


def test_a_run_that_contradicts_itself_stands_still(tmp_path: Path) -> None:
    """The check of runs finds it at the next event; the node says so and waits, and its bag is whole."""
    with subprocess.Popen([sys.executable, '-c', CORRUPTED, '--ros-args', *recording_into(tmp_path / 'run')],
                          stderr=subprocess.PIPE, text=True) as node:
        assert node.stderr is not None
        line = next(line for line in node.stderr if 'stands still' in line)
        node.send_signal(signal.SIGINT)
        node.stderr.read()
        assert node.wait(60) == 0
    assert 'the run contradicts its own motion or balance of energy at t = ' in line
    bag = open_bag(tmp_path / 'run')
    assert bag.is_complete
    assert len(list(bag.messages(['/slider_state']))) > 5
