# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""`stickslip call` beside a node: what the node answers, and what is said when it refuses, or nobody answers."""

from collections.abc import Iterator
from pathlib import Path

import pytest

from stickslip_sim.recording import open_bag
from tests.support.tool import Capture, answered, refused, tool

from tests.support.node_processes import running  # isort: skip  # skips without ROS
from tests.support.ros_nodes import client  # isort: skip  # skips without ROS
from tests.support.waiting import wait_for  # isort: skip

pytestmark = pytest.mark.ros

AXIS = '/cell/feed_axis'
NO_PROFILES = {'FASTRTPS_DEFAULT_PROFILES_FILE': '', 'FASTDDS_DEFAULT_PROFILES_FILE': ''}    # as users start the tool


@pytest.fixture(scope='module')
def folder(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Path]:
    """Return where an axis runs."""
    folder = tmp_path_factory.mktemp('axis')
    with running('-r', '__ns:=/cell', folder=folder):
        with client('/cell') as axis:
            axis.connect()
        yield folder


def said(capsys: Capture, *words: str) -> str:
    """Return the one line that the tool prints of an answer."""
    code, out, err = answered(capsys, 'call', *words, '--node', AXIS)
    assert (code, err) == (0, '')
    return out


def test_a_recording_and_a_new_run(folder: Path, capsys: Capture) -> None:
    assert said(capsys, 'record').startswith(f'recording into {folder}/runs/cell_paper_fig8_')
    assert 'refused while recording' in refused(capsys, 'call', 'reset', '--node', AXIS)
    begun = said(capsys, 'record', 'off').removeprefix('recorded into ').strip()
    assert open_bag(begun).is_complete
    assert said(capsys, 'record', 'off') == 'not recording\n'
    assert said(capsys, 'reset') == 'simulation time and steps begin anew at 0\n'


def test_steps_while_it_is_paused(folder: Path, capsys: Capture) -> None:
    assert 'refused while time runs by itself' in refused(capsys, 'call', 'step', '--node', AXIS)
    try:
        assert said(capsys, 'pause').startswith('paused at simulation time ')
        first, *events, state = said(capsys, 'step', '500', '--velocity', '-0.02', '--force', '10').splitlines()
        assert first.startswith('500 steps made')
        assert any('breakaway at ' in event for event in events)
        assert 'drive -20 mm/s' in state
        assert said(capsys, 'step').startswith('1 step made')
        assert 'drive -20 mm/s' in said(capsys, 'step')          # it goes on under what is in force
        assert 'steps = 0 is refused' in refused(capsys, 'call', 'step', '0', '--node', AXIS)
        assert 'velocity = 5.0 is refused' in refused(capsys, 'call', 'step', '--velocity', '5', '--node', AXIS)
    finally:
        assert said(capsys, 'resume').startswith('running at simulation time ')


def test_faults(folder: Path, capsys: Capture) -> None:
    assert said(capsys, 'inject-fault', 'friction_scale', '--value', '1.5'
                ) == 'friction_scale_1 (friction_scale 1.5) begins 0 s from now\n'
    assert said(capsys, 'inject-fault', 'force_pulse', '--value', '-20', '--start', '60', '--duration', '2', '--id', 'a'
                ) == 'a (force_pulse -20) begins 60 s from now\n'
    assert said(capsys, 'inject-fault', 'drive_freeze', '--start', '60', '--id', 'b'
                ) == 'b (drive_freeze) begins 60 s from now\n'
    assert said(capsys, 'inject-fault', 'encoder_dropout', '--value', '0.5', '--id', 'c') == (
        'c (encoder_dropout 0.5) begins 0 s from now; encoder_dropout does nothing: no encoder is read; '
        'set joint_interface.enabled: true\n')
    assert said(capsys, 'clear-faults', 'c') == 'c cleared\n'
    assert said(capsys, 'clear-faults', 'b') == 'b cleared\n'
    assert said(capsys, 'clear-faults', 'a') == 'a cleared\n'
    assert said(capsys, 'clear-faults') == 'cleared: friction_scale_1\n'
    assert "kind = 'friction' is refused" in refused(capsys, 'call', 'inject-fault', 'friction', '--node', AXIS)


def test_parameters(folder: Path, capsys: Capture) -> None:
    assert said(capsys, 'set', 'axis.mass=300', 'command.max_velocity=0.5') == 'set: axis.mass, command.max_velocity\n'
    assert 'axis.mass = -1' in refused(capsys, 'call', 'set', 'axis.mass=-1', '--node', AXIS)
    assert 'solver.name' in refused(capsys, 'call', 'set', 'axis.mass=350', 'solver.name=fixed_step', '--node', AXIS)
    assert 'must be A.B=VALUE' in refused(capsys, 'call', 'set', 'axis.mass', '--node', AXIS)
    assert said(capsys, 'set', 'axis.mass=350', 'command.max_velocity=1') == 'set: axis.mass, command.max_velocity\n'


def test_a_fault_without_the_value_that_its_kind_needs(capsys: Capture) -> None:
    """0 would be a friction that is gone."""
    assert refused(capsys, 'call', 'inject-fault', 'friction_scale') == (
        'stickslip: --value is missing: must be given with friction_scale: a factor, >= 0 and <= 100;'
        ' add --value X\n')
    assert 'force_pulse: within ±1e9 N' in refused(capsys, 'call', 'inject-fault', 'force_pulse')


def test_nobody_answers(folder: Path, capsys: Capture) -> None:
    line = refused(capsys, 'call', 'reset', '--timeout', '3', code=1)
    assert line == (f'stickslip: no node /feed_axis offers reset (looked for 3 s); there is {AXIS}: name it with'
                    ' --node\n')
    assert '--node' in refused(capsys, 'call', 'reset', '--node', 'a b')


def test_two_of_one_name(folder: Path, tmp_path: Path, capsys: Capture) -> None:
    """Each would do it, and one of the answers be reported.  A killed one is in the graph for a while.

    A call may have heard of one node only when it is made: then the other does not hear of it.
    """
    def refusal() -> str:
        return refused(capsys, 'call', 'step', '--node', AXIS)    # of any: time runs by itself

    with running('-r', '__ns:=/cell', folder=tmp_path):
        assert wait_for(lambda: 'two nodes' in (line := refusal()) and line, 'both').startswith(
            f"stickslip: --node = '{AXIS}' is refused: must be the name of one node; two nodes named {AXIS} answer")
        afresh = [tool('call', 'step', '--node', AXIS, **NO_PROFILES).stderr for _ in range(8)]
        assert sum('two nodes' in line for line in afresh) >= 4    # 19 of 20; 5 where the second was greeted once
    assert 'refused while time runs by itself' in refusal()    # it was killed


def test_wrong_use(capsys: Capture) -> None:
    assert 'call record --help' in refused(capsys, 'call', 'record', 'perhaps')
    assert 'See stickslip call step --help' in refused(capsys, 'call', 'step', 'many')
    assert answered(capsys, 'call')[0] == 2


def test_without_a_workspace() -> None:
    done = tool('call', 'reset', AMENT_PREFIX_PATH='')
    assert (done.returncode, done.stdout) == (2, '')
    assert done.stderr == ("stickslip: AMENT_PREFIX_PATH = '' is refused: must be that of a ROS 2 workspace; source its"
                           ' setup.bash\n')
