# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""What README and docs/hil.md have a newcomer do first: `make run`, and the examples beside an axis."""

import re
import signal
import subprocess
import sys
from collections.abc import Iterator
from contextlib import ExitStack
from pathlib import Path

import pytest

from stickslip_sim.recording import open_bag
from tests.support.node_processes import recording_into, running
from tests.support.repository import ROOT
from tests.support.ros_nodes import Client, client
from tests.support.waiting import wait_for

pytestmark = [pytest.mark.ros, pytest.mark.slow]

DRIVE = ROOT / 'examples' / 'drive.py'
SETPOINT = ROOT / 'examples' / 'setpoint.py'
CONTROLLER = ROOT / 'examples' / 'controller.py'
LOCKSTEP = ROOT / 'examples' / 'lockstep.py'


def python(*arguments: str | Path) -> subprocess.CompletedProcess[str]:
    return subprocess.run([sys.executable, *map(str, arguments)], capture_output=True, text=True, timeout=60,
                          check=False)


@pytest.fixture(scope='class')
def axis(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Client]:
    with running(folder=tmp_path_factory.mktemp('axis'), afresh=True), client() as it:
        it.connect()
        yield it


def test_the_demonstration_records_and_has_nothing_to_complain_of(tmp_path: Path) -> None:
    done = python('-m', 'stickslip_sim.ros.demo', '--duration', '1', '--out', tmp_path)
    assert (done.returncode, done.stderr) == (0, '')
    assert re.search(r'^verdict  real-time valid: (yes|no), worst ', done.stdout, re.MULTILINE)
    [folder] = tmp_path.iterdir()
    assert (folder / 'run.png').stat().st_size > 10_000
    assert open_bag(folder).receipt is not None    # it was closed


def test_late_steps_are_no_wrong_motion(tmp_path: Path) -> None:
    """What the demonstration says of a run whose steps were late, by limits that no machine keeps."""
    from stickslip_sim.ros.demo_report import report
    for most, verdict in (('1e-9', 'no'), ('60.0', 'yes')):
        limits = '-p', f'timing.max_lateness:={most}', '-p', 'timing.max_overruns:=1.0'
        with running(*recording_into(tmp_path / verdict), *limits) as process, client() as axis:
            axis.connect()
            assert process.end()[0] == 0
        said = '\n'.join(report(tmp_path / verdict))
        assert f'verdict  real-time valid: {verdict}, ' in said
        assert [words in said for words in ('the motion is right, the timing was late, ', 'lock-step is the way ')
                ] == 2 * [verdict == 'no']


class TestDrive:
    def test_what_is_sent_holds(self, axis: Client) -> None:
        done = python(DRIVE, '0.005', '--force', '400')
        assert done.returncode == 0, done.stderr
        assert done.stderr.splitlines()[-1].endswith('taken: velocity = 0.005 m/s, force = 400.0 N')
        wait_for(lambda: axis.latest('slider_state').drive_velocity == 0.005, 'its effect')

    @pytest.mark.parametrize('value', ['5.0', 'nan'])
    def test_a_refused_value_is_an_error_of_the_sender(self, axis: Client, value: str) -> None:
        before = axis.latest('slider_state').drive_velocity
        done = python(DRIVE, value)
        assert done.returncode == 2    # as of stickslip call
        assert f'velocity = {value} is refused' in done.stderr
        assert 'taken' not in done.stderr
        assert axis.latest('slider_state').drive_velocity == before


def test_nothing_to_send_is_wrong_use() -> None:
    done = python(DRIVE)
    assert done.returncode == 2
    assert 'give a velocity in m/s' in done.stderr


def test_the_controller_is_the_one_of_the_page() -> None:
    _, _, code = CONTROLLER.read_text(encoding='utf-8').partition('DriveVelocity, SliderState\n\n')
    shown = [line.strip() for line in (ROOT / 'docs/hil.md').read_text(encoding='utf-8').splitlines()]
    assert code
    assert [line.strip() for line in code.splitlines() if line.strip() and line.strip() not in shown] == []


def test_the_examples_say_once_that_they_wait_for_an_axis() -> None:
    """In a namespace where there is none, and where there is one; all at once, as each takes its time."""
    nowhere = '--ros-args', '-r', '__ns:=/nowhere'
    with ExitStack() as ended:
        ended.enter_context(running('-r', '__ns:=/cell', afresh=True))
        ended.enter_context(client('/cell')).connect()
        waiting = [ended.enter_context(subprocess.Popen([sys.executable, *map(str, example), *nowhere],
                                                        stderr=subprocess.PIPE, text=True))
                   for example in ([CONTROLLER], [SETPOINT], [SETPOINT, '--lockstep'], [LOCKSTEP], [DRIVE, '0.001'])]
        for each in waiting:
            assert each.stderr
            line = each.stderr.readline()
            assert 'waiting for an axis: start sim_node ' in line
            assert line.endswith('with this ROS_DOMAIN_ID; axes run in: /cell (--ros-args -r __ns:=NAMESPACE)\n')
            each.send_signal(signal.SIGINT)
            assert each.stderr.read() == ''


ENCODERS = ('-p', 'drive.velocity:=0.0', '-p', 'joint_interface.enabled:=true', '-p', 'encoder.resolution:=1.0e-6')


def test_a_setpoint_is_followed_on_the_encoders(tmp_path: Path) -> None:
    moved: list[float] = []
    with running(*ENCODERS, folder=tmp_path, afresh=True), client() as axis:
        axis.connect()
        for _ in range(3):    # one that waits a second for a core goes too far
            begin = axis.latest('slider_state').position
            done = python(SETPOINT)
            assert done.returncode == 0, done.stderr
            rest = axis.next('slider_state', lambda state: state.drive_velocity == 0.0)
            moved.append(rest.position - begin)
            if abs(moved[-1] - 0.010) < 1e-3:
                break
    assert abs(moved[-1] - 0.010) < 1e-3, moved


def test_and_in_lock_step_to_the_last_bit(tmp_path: Path) -> None:
    with running(*ENCODERS, '-p', 'time.mode:=lockstep', '-r', '__ns:=/stepped', folder=tmp_path):
        runs = [python(SETPOINT, '--lockstep', '--ros-args', '-r', '__ns:=/stepped') for _ in range(2)]
    assert [run.returncode for run in runs] == [0, 0], runs
    first, second = (run.stderr.rpartition(']: ')[2] for run in runs)
    assert first == second
    assert first.startswith('done: the largest error was 1.')
