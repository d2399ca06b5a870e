# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""First steps of README and docs/hil.md: `make run`, its commands, the examples, five minutes with a human's delays."""

import importlib.util
import re
import shlex
import signal
import subprocess
import sys
from collections.abc import Iterator
from contextlib import AbstractContextManager, ExitStack
from dataclasses import replace
from pathlib import Path

import pytest

import stickslip_sim as stickslip
from stickslip_sim.check.observed_run import timing_of
from stickslip_sim.recording import open_bag
from tests.support.node_processes import NodeProcess, attentive, recording_into, running
from tests.support.repository import ROOT
from tests.support.ros_nodes import Client, client
from tests.support.tool import Capture, answered
from tests.support.waiting import wait_for

pytestmark = [pytest.mark.ros, pytest.mark.slow]

DRIVE, SETPOINT, CONTROLLER, LOCKSTEP = (ROOT / 'examples' / f'{name}.py'
                                         for name in ('drive', 'setpoint', 'controller', 'lockstep'))
ENCODERS = ('-p', 'drive.velocity:=0.0', '-p', 'joint_interface.enabled:=true', '-p', 'encoder.resolution:=1.0e-6')
README_AXIS, *README_COMMANDS = (
    shlex.split(line, comments=True) for line in re.findall(r'^    (\S.*)$', (ROOT / 'README.md').read_text(
        encoding='utf-8').partition('### You know ROS')[2].partition('The PyPI wheels')[0], re.MULTILINE))


def started(example: str | Path, *arguments: str) -> AbstractContextManager[NodeProcess]:
    """Run an example in a fork, which keeps what it says on both streams."""
    return running(program=str(example), options=arguments)


def ended(program: NodeProcess, code: int = 0) -> str:
    """Return what a program has said when it has ended."""
    assert program.wait()[0] == code, program.errors
    return program.errors


def said_by(example: str | Path, *arguments: str, code: int = 0) -> str:
    with started(example, *arguments) as program:
        return ended(program, code)


class TestDemonstration:
    """`make run`."""

    def test_it_records_and_has_nothing_to_complain_of(self, tmp_path: Path) -> None:
        done = subprocess.run([sys.executable, '-m', 'stickslip_sim.ros.demo', '--duration', '1', '--out', tmp_path],
                              capture_output=True, text=True, timeout=60, check=False)
        assert (done.returncode, done.stderr) == (0, '')
        verdict = re.search(r'^verdict  real-time valid: (yes|no), worst ', done.stdout, re.MULTILINE)
        assert verdict is not None
        assert ('lock-step is the way ' in done.stdout) == (verdict[1] == 'no')
        [folder] = tmp_path.iterdir()
        assert (folder / 'run.png').stat().st_size > 10_000
        assert open_bag(folder).receipt is not None    # it was closed

    def test_late_steps_are_no_wrong_motion(self, tmp_path: Path) -> None:
        """Its report on a run whose steps were late, by limits that no machine keeps; no such advice otherwise."""
        from stickslip_sim.ros.demo import real_time_lines
        with running(*recording_into(tmp_path / 'late'), 'timing.max_lateness:=1e-9') as process, client() as axis:
            axis.connect()
            assert process.end()[0] == 0
        timing = timing_of(stickslip.read_run(tmp_path / 'late'))
        assert timing is not None
        verdict, *advice = real_time_lines(timing)
        assert verdict.startswith('verdict  real-time valid: no, ')
        assert 'lock-step is the way ' in ' '.join(advice)
        assert len(real_time_lines(replace(timing, valid=True))) == 1


@pytest.fixture(scope='class')
def axis(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Client]:
    """The axis of README, at a tenth of its rate."""
    program, flag, *words = README_AXIS
    assert (Path(program).name, flag) == ('sim_node', '--ros-args')
    with running(*words, 'time.rate:=100.0', folder=tmp_path_factory.mktemp('axis'), prepare=attentive
                 ), client() as it:
        it.connect()
        yield it


class TestDrive:
    def test_the_commands_of_the_readme(self, axis: Client, capsys: Capture) -> None:
        (program, script, velocity), inject, off = README_COMMANDS
        assert (program, script, inject[0], off[0]) == ('python3', 'examples/drive.py', 'stickslip', 'stickslip')
        said_by(ROOT / script, velocity)
        wait_for(lambda: axis.latest('slider_state').drive_velocity == float(velocity), 'its effect')
        assert answered(capsys, *inject[1:])[1].startswith('friction_scale_1 (friction_scale 1.5) begins ')
        code, said, errors = answered(capsys, *off[1:])
        assert code == 0, errors
        assert answered(capsys, 'verify', said.split()[-1])[1].startswith('identical, ')

    def test_what_is_sent_holds(self, axis: Client) -> None:
        said = said_by(DRIVE, '0.004', '--force', '400')
        assert said.endswith('taken: velocity = 0.004 m/s, force = 400.0 N\n')
        wait_for(lambda: axis.latest('slider_state').drive_velocity == 0.004, 'its effect')

    @pytest.mark.parametrize('value', ['5.0', 'nan'])
    def test_a_refused_value_is_an_error_of_the_sender(self, axis: Client, value: str) -> None:
        before = axis.latest('slider_state').drive_velocity
        said = said_by(DRIVE, value, code=2)    # as of stickslip call
        assert (f'velocity = {value} is refused' in said, 'taken' in said) == (True, False)
        assert axis.latest('slider_state').drive_velocity == before


def test_nothing_to_send_is_wrong_use() -> None:
    assert 'give a velocity in m/s' in said_by(DRIVE, code=2)


def test_the_examples_say_once_that_they_wait_for_an_axis() -> None:
    """In a namespace where there is none, and where there is one; all at once, as each takes its time."""
    nowhere = '--ros-args', '-r', '__ns:=/nowhere'
    with ExitStack() as stack:
        stack.enter_context(running('-r', '__ns:=/cell', 'time.rate:=100.0'))
        with client('/cell') as found:
            found.connect()
        waiting = [stack.enter_context(started(*example, *nowhere)) for example in (
            [CONTROLLER], [SETPOINT], [LOCKSTEP], [DRIVE, '0.001'])]
        for each in waiting:
            wait_for(lambda: '\n' in each.said, 'a line')    # noqa: B023
            _, line = each.end()
            assert 'waiting for an axis: start sim_node ' in line
            assert line.endswith('with this ROS_DOMAIN_ID; axes run in: /cell (--ros-args -r __ns:=NAMESPACE)\n')
            assert line.count('\n') == 1


class TestSetpoint:
    def test_it_is_followed_on_the_encoders(self, tmp_path: Path) -> None:
        moved: list[float] = []
        with running(*ENCODERS, 'time.rate:=400.0', folder=tmp_path), client() as axis:    # the example has 200
            axis.connect()
            for _ in range(3):    # one that waits a second for a core goes too far
                begin = axis.latest('slider_state').position
                said_by(SETPOINT)
                rest = axis.next('slider_state', lambda state: state.drive_velocity == 0.0)
                moved.append(rest.position - begin)
                if abs(moved[-1] - 0.010) < 1e-3:
                    break
        assert abs(moved[-1] - 0.010) < 1e-3, moved

    def test_and_in_lock_step_as_without_ros_to_the_last_digit(self, tmp_path: Path, capsys: Capture) -> None:
        with running(*ENCODERS, '-p', 'time.mode:=lockstep', '-r', '__ns:=/stepped', folder=tmp_path):
            said = said_by(SETPOINT, '--ros-args', '-r', '__ns:=/stepped')
        assert said.endswith(']: done: 2000 steps, t = 2 s\n')
        result, = re.findall(r'^there: the largest error was 1\..*\n', said, re.MULTILINE)
        assert said.count('connected to /stepped/feed_axis') == 1
        example = importlib.util.spec_from_file_location('setpoint', SETPOINT)
        assert example is not None
        assert example.loader is not None
        example.loader.exec_module(module := importlib.util.module_from_spec(example))
        scene = stickslip.load_scene('paper_fig8', {'drive.velocity': 0.0, 'encoder.resolution': 1e-6})
        stickslip.close_loop(module.Follower(), scene, duration=2.0, rate=200.0)
        assert capsys.readouterr().out.endswith(result)    # what the node logged stands before it

    def test_and_with_measurements_that_get_lost(self, tmp_path: Path) -> None:
        lost = [f'-p faults.{name}:=[{value}]' for name, value in (
            ('ids', '"lost"'), ('kinds', '"encoder_dropout"'), ('starts', '0.2'), ('durations', '0.4'),
            ('values', '1.0'))]
        words = [word for words in lost for word in words.split()]
        with running(*ENCODERS, *words, 'time.rate:=400.0', 'time.mode:=lockstep', folder=tmp_path):
            assert re.search(r'^there: the largest error was [1-9]\.', said_by(SETPOINT), re.MULTILINE)


class TestFiveMinutes:
    """The first minutes of docs/hil.md: its commands, one after the other."""

    HUMAN = 2.2      # s from the start of the axis to that of the controller: beyond the window of any limits from 0 on
    CHECKED = 2.0     # s, in examples/controller_limits.yaml
    SAID = r'(\[WARN\].*: waiting for an axis: .*\n)?.*: connected: .*\n'    # the first where it waits for 2 s
    PAGE = (ROOT / 'docs/hil.md').read_text(encoding='utf-8')
    AXIS, CONTROLLER, CHECK, STEPPED_AXIS, STEPPER = (
        shlex.split(line) for block in re.findall(
            r'```sh\n(.*?)```', PAGE.partition('## Wired in five minutes')[2].partition('\n## ')[0], re.DOTALL)
        for line in block.replace('\\\n', ' ').splitlines() if not line.startswith('source '))

    @pytest.fixture(autouse=True)
    def folder(self, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
        """Return where the commands run: an empty folder with the examples."""
        (tmp_path / 'examples').symlink_to(ROOT / 'examples')
        monkeypatch.chdir(tmp_path)
        return tmp_path

    def check(self, capsys: Capture, *limits: str) -> tuple[int, list[str], str]:
        """Check the first run as the page does, or by other limits; return exit code, lines and errors."""
        _, verb, runs, *options = self.CHECK
        code, out, errors = answered(capsys, verb, min(Path().glob(runs)), *options[:-len(limits) or None], *limits)
        return code, out.splitlines(), errors

    def test_the_run_is_not_taken_for_that_of_make_run(self) -> None:
        """A reader has that one in the same folder already."""
        from stickslip_sim.ros.demo import DEMO_SCENE
        commands = self.AXIS, self.CONTROLLER, self.CHECK, self.STEPPED_AXIS, self.STEPPER
        assert [Path(program).name for program, *_ in commands] == [
            'sim_node', 'python3', 'stickslip', 'sim_node', 'python3']
        assert self.CHECK[2].startswith('runs/')
        assert not self.CHECK[2].startswith(f'runs/{DEMO_SCENE}_')

    def test_a_controller_that_is_started_by_hand_is_checked(self, capsys: Capture) -> None:
        with running(*self.AXIS[2:], 'time.rate:=500.0') as axis, client() as listener:    # for half the cost
            listener.next('slider_state', lambda state: state.time > self.HUMAN)
            assert listener.latest('slider_state').drive_velocity == 0.0    # it rests until the first command
            with started(*self.CONTROLLER[1:]) as controller:
                first = listener.next('slider_state', lambda state: state.drive_velocity != 0.0).time
                listener.next('slider_state', lambda state: state.time > first + self.CHECKED + 0.1)
                controller.send(signal.SIGINT)
                assert re.fullmatch(self.SAID, ended(controller))
                listener.next('slider_state', lambda state: state.drive_velocity == 0.0)
            _, said = axis.end()
        code, lines, errors = self.check(capsys)
        assert code == 3, errors
        head, verdict, *_, last = lines
        assert float(head.rpartition('first command at t = ')[2].removesuffix(' s')) > self.HUMAN
        assert verdict.startswith('real-time valid: ')
        assert verdict in said
        assert re.match(r'FAILED: \d of 5: .*overshoot.*sticks', last)
        assert not any('no controller was checked' in line for line in lines)
        code, _, errors = self.check(capsys, 'examples/limits.yaml')    # it ends before
        assert (code, 'no controller was checked' in errors) == (3, True)

    def test_lock_step_gives_the_same_recorded_run_each_time(self, folder: Path, capsys: Capture) -> None:
        with running(*self.STEPPED_AXIS[2:]) as axis:
            said_by(*self.STEPPER[1:], '--duration', '0.3')
            for words in ('record off', 'reset', 'record'):
                code, _, errors = answered(capsys, 'call', *words.split())
                assert code == 0, errors
            said_by(*self.STEPPER[1:], '--duration', '0.2')
            assert axis.end()[0] == 0
        first, second = sorted((folder / 'runs').iterdir())
        whole, part = (open_bag(run).columns('/slider_state')['position'].tolist() for run in (first, second))
        assert (part, len(whole)) == (whole[:201], 301)
        assert answered(capsys, 'verify', first)[0] == 0

    def test_in_lock_step_the_check_prints_what_the_page_shows(self, capsys: Capture) -> None:
        with running(*self.STEPPED_AXIS[2:]) as axis:
            said_by(*self.STEPPER[1:])
            assert axis.end()[0] == 0
        code, lines, errors = self.check(capsys)
        assert code == 3, errors
        assert '\n'.join(f'    {line}' for line in lines[2:]) in self.PAGE
