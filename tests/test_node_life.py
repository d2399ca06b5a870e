# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The life of the node as a process: refused starts, signals, recordings that end well, badly or not at all."""

import itertools
import resource
import signal
import subprocess
import sys
import time
from pathlib import Path
from typing import Any

import pytest

from stickslip_sim.errors import InputError, RecordingWarning
from stickslip_sim.recording import Run, read_run
from stickslip_sim.scene import load_scene
from stickslip_sim.words import EventKind
from tests.ros_nodes import assert_clean, client, executable, recording_into, restore_interrupt, running
from tests.waiting import wait_for

pytestmark = pytest.mark.ros


class TestRefusedStart:
    @pytest.mark.parametrize(('content', 'told'), [
        ('axis: {mass: -1.0}', ['axis.mass = -1.0', '>= 1e-09 and <= 1e+12 kg']),
        ('axis: {weight: 1.0}', ['axis.weight = 1.0']),
        ('axis: {mass: heavy}', ["axis.mass = 'heavy'"]),
        ('friction: {kinetic: {velocities: [0.0, 1], coefficients: [0.1, 0.1]}}', ['a list of one type']),
        ('axis: [', ['scene.yaml', 'YAML as ROS reads it']),
        (None, ['scene.yaml', 'No such file']),
    ])
    def test_one_line_and_exit_code(self, tmp_path: Path, content: str | None, told: list[str]) -> None:
        file = tmp_path / 'scene.yaml'
        if content is not None:
            file.write_text(f'/**:\n  ros__parameters:\n    scene: mine\n    {content}\n')
        code, errors = start('--params-file', str(file))
        assert code == 2
        assert errors.startswith('sim_node: ')
        assert len(errors.splitlines()) == 1, errors
        assert all(words in errors for words in told), errors

    @pytest.mark.parametrize('text', [
        '', '# nothing\n', 'other:\n  ros__parameters:\n    scene: mine\n', '/**:\n  ros__parameters:\n',
        '/**:\n  ros__parameters:\n    scene: a\n---\n/**:\n  ros__parameters:\n    scene: b\n',
        '/**:\n  ros__parameters:\n    scene: mine.yaml\n', '/**:\n  ros__parameters:\n    axis: {mass: 0.0}\n',
    ])
    def test_in_the_words_of_the_tool(self, tmp_path: Path, text: str) -> None:
        file = tmp_path / 'scene.yaml'
        file.write_text(text)
        with pytest.raises(InputError) as of_the_tool:
            load_scene(str(file))
        assert start('--params-file', str(file)) == (2, f'sim_node: {of_the_tool.value}\n')

    def test_a_file_for_a_node_elsewhere(self, tmp_path: Path) -> None:
        file = tmp_path / 'scene.yaml'
        file.write_text('/press/feed_axis:\n  ros__parameters:\n    axis: {mass: 1.0}\n')
        code, errors = start('--params-file', str(file))
        assert (code, len(errors.splitlines())) == (2, 1), errors
        assert 'axis.mass = 1.0 is refused: must be in a section of /feed_axis' in errors

    @pytest.mark.parametrize(('name', 'value', 'told'), [
        ('ROS_DOMAIN_ID', '9999', '0 to 232'), ('ROS_DOMAIN_ID', '-1', '0 to 232'), ('ROS_DOMAIN_ID', 'x', '0 to 232'),
        ('ROS_STATIC_PEERS', 'no address', 'Unable to resolve peer'),
        ('AMENT_PREFIX_PATH', '', 'setup.bash'),
        ('RMW_IMPLEMENTATION', 'rmw_smoke_signals', 'rmw_fastrtps_cpp'), ('ROS_LOG_DIR', '/proc/x', '/proc/x'),
    ])
    def test_environment(self, monkeypatch: pytest.MonkeyPatch, name: str, value: str, told: str) -> None:
        program = executable('sim_node')
        monkeypatch.setenv(name, value)
        code, errors = run(program)
        assert (code, len(errors.splitlines())) == (2, 1), errors
        assert value in errors
        assert told in errors

    @pytest.mark.parametrize(('arguments', 'told'), [
        (['-p', 'axis.mas:=1.0'], ['axis.mas = 1.0', 'did you mean axis.mass?']),
        (['-p', 'scene:=paper_fig9'], ['paper_fig9', 'paper_fig8']),
        (['--nonsense'], ['--nonsense']),
        (['-p', 'record.enabled:=true', '-p', 'axis.mass:=-1.0'], ['axis.mass = -1.0']),
        (['-p', 'solver.name:=adaptive'], ['solver.name', 'exact or fixed_step in the node']),
    ])
    def test_arguments(self, arguments: list[str], told: list[str]) -> None:
        code, errors = start(*arguments)
        assert (code, len(errors.splitlines())) == (2, 1), errors
        assert all(words in errors for words in told), errors


def start(*ros_args: str) -> tuple[int, str]:
    return run(executable('sim_node'), '--ros-args', *ros_args)


def run(*command: str) -> tuple[int, str]:
    done = subprocess.run(command, capture_output=True, text=True, timeout=60, check=False)
    return done.returncode, done.stderr


class TestFiles:
    @pytest.mark.parametrize(('texts', 'arguments', 'scene', 'mass'), [
        (['scene: mine'], [], 'mine', 350.0),
        (['scene: paper_fig7'], ['-p', 'axis.mass:=300.0'], 'paper_fig7', 300.0),
        (['record: {enabled: false}'], ['-p', 'scene:=positioning'], 'positioning', 350.0),
        (['{scene: mine, axis: {mass: 200.0}}', 'seed: 5'], ['-p', 'scene:=yours'], 'yours', 200.0),
        (['use_sim_time: false'], [], 'paper_fig8', 350.0),
    ])
    def test_are_a_scene_by_the_rules_of_the_tool(self, tmp_path: Path, texts: list[str], arguments: list[str],
                                                  scene: str, mass: float) -> None:
        for number, text in reversed([*enumerate(texts)]):    # what comes later on the command line wins
            file = tmp_path / f'{number}.yaml'
            file.write_text(f'/**:\n  ros__parameters: {text}\n' if text[0] == '{'
                            else f'/**:\n  ros__parameters:\n    {text}\n')
            arguments = ['--params-file', str(file), *arguments]
        with running(*arguments) as process, client() as axis:
            axis.connect()
            of_the_node = axis.values('scene', 'axis.mass', 'contact.model', 'friction.static.law')
            assert [value.string_value or value.double_value for value in of_the_node[:2]] == [scene, mass]
            if texts[0].startswith('scene'):
                same = load_scene(str(tmp_path / '0.yaml')).values
                assert [value.string_value for value in of_the_node[2:]] == [
                    same['contact.model'], same['friction.static.law']]
            assert_clean(*process.end())

    def test_one_without_an_axis_is_warned_of(self, tmp_path: Path) -> None:
        file = tmp_path / 'scene.yaml'
        file.write_text('/**:\n  ros__parameters:\n    scene: mine\n')
        with running('--params-file', str(file)) as process, client() as axis:
            axis.connect()
            code, errors = process.end()
        assert (code, 'nothing of an axis' in errors) == (0, True)


def test_nothing_is_imported_before_signals_are_taken() -> None:
    program = ('import os, signal, sys, collections.abc; before = set(sys.modules); import stickslip_sim.ros.sim_node;'
               ' print(*sorted(set(sys.modules) - before))')
    done = subprocess.run([sys.executable, '-c', program], capture_output=True, text=True, timeout=60, check=True)
    assert done.stdout.split() == ['stickslip_sim', 'stickslip_sim.ros', 'stickslip_sim.ros.sim_node']


def test_refused_commands_of_one_kind_do_not_hush_up_the_other() -> None:
    with running() as process, client() as axis:
        axis.connect()
        axis.send_velocity(5.0)
        axis.send_force(1e9)
        axis.status('command', lambda values: values['velocity refused'] == values['force refused'] == '1')
        _, errors = process.end()
    assert 'velocity = 5.0 is refused' in errors
    assert 'force = 1000000000.0 is refused' in errors


def test_a_smooth_law_changes_while_the_axis_moves() -> None:
    with running('-p', 'scene:=stribeck') as process, client() as axis:
        axis.connect()
        assert axis.values('friction.kinetic.tolerance')[0].double_value == 1e-4
        answer = axis.set_parameters(friction__kinetic__tolerance=1e-9)
        assert not answer.successful
        assert 'fits' in answer.reason
        assert not axis.set_parameters(friction__kinetic__law='exponential').successful
        assert axis.set_parameters(friction__kinetic__initial=0.1, friction__kinetic__viscous=0.2).successful
        stop = axis.next('mode_event', lambda event: event.kind == EventKind.STICK)
        assert stop.friction_force == pytest.approx(0.1 * 3432.3275, rel=1e-12)
        assert_clean(*process.end())


class TestSignals:
    @pytest.mark.parametrize('number', [signal.SIGINT, signal.SIGTERM])
    def test_the_bag_is_closed(self, tmp_path: Path, number: int) -> None:
        folder = tmp_path / 'run'
        with running(*recording_into(folder)) as process, client() as axis:
            axis.connect()
            axis.send_velocity(0.004)
            axis.next('slider_state', lambda state: state.drive_velocity == 0.004)
            axis.send_force(50.0)
            assert axis.set_parameters(axis__mass=300.0).successful
            axis.next('timing')
            process.send(number)
            process.send(number)      # impatient
            assert_clean(*process.wait())
        run = read_run(folder)
        assert run.is_complete
        states = run.columns('/slider_state')
        assert list(states['step']) == list(range(len(states['step'])))
        assert list(states['sequence']) == list(states['step'])
        assert list(states['log_time']) == [step * 1_000_000 for step in states['step']]
        (velocity,), (force,) = run.messages(['/drive_velocity']), run.messages(['/external_force'])
        assert run.decode(velocity).velocity == 0.004
        assert run.decode(force).force == 50.0
        before, after = (states['drive_velocity'][velocity.sequence + i] for i in (-1, 0))
        assert (before, after) == (0.002, 0.004)
        (change,) = (run.decode(message) for message in run.messages(['/parameter_events']))
        assert change.changed_parameters[0].name == 'axis.mass'
        assert run.receipt['timing']['steps'] == len(states['step'])
        assert run.columns('/timing')['steps'].sum() == len(states['step'])
        assert run.receipt['commands']['velocity'] == {'received': 1, 'refused': 0}
        assert run.receipt['energy']['relative_residual'] <= 1e-13
        assert b'paper_fig8' in run.attachments['scene.yaml']

    @pytest.mark.parametrize('delay', [0.2, 0.5, 0.8])
    @pytest.mark.parametrize('number', [signal.SIGINT, signal.SIGTERM])
    def test_while_it_starts(self, number: int, delay: float) -> None:
        with running() as process:
            time.sleep(delay)
            assert_clean(*process.end(number))

    def test_killed(self, tmp_path: Path) -> None:
        folder = tmp_path / 'run'
        with running(*recording_into(folder)) as process, client() as axis:
            axis.connect()
            axis.next('slider_state', lambda state: state.step > 2500)
            process.kill()
            last = axis.latest('slider_state').step
        with pytest.warns(RecordingWarning, match='no end'):
            run = read_run(folder)
        assert not run.is_complete
        steps = run.columns('/slider_state')['step']
        assert list(steps) == list(range(len(steps)))
        assert last - 1000 < steps[-1] <= last + 1000

    def test_stopped_for_a_while(self) -> None:
        with running() as process, client() as axis:
            axis.connect()
            before = axis.next('slider_state')
            reports = len(axis.heard['timing'])
            process.send(signal.SIGSTOP)
            time.sleep(1.0)
            process.send(signal.SIGCONT)
            axis.next('timing', lambda timing: timing.lateness_max > 0.5)
            # a stop at the end of a second is told by that second's report, the late step by the next one's
            wait_for(lambda: any(timing.real_time_factor < 0.95 for timing in axis.heard['timing'][reports:]),
                     'a report of the lost time')
            _, values = axis.status('step loop')
            assert values['times skipped'] == '1'
            states = [state for state in axis.heard['slider_state'] if state.step >= before.step]
            assert [b.step - a.step for a, b in itertools.pairwise(states)] == [1] * (len(states) - 1)


class TestRecording:
    def test_an_existing_folder_stays_and_the_axis_goes_on(self, tmp_path: Path) -> None:
        (tmp_path / 'mine').write_text('precious')
        with running(*recording_into(tmp_path)) as process, client() as axis:
            axis.connect()
            status, _ = axis.status('recorder')
            assert status.level == b'\2'
            assert f'{tmp_path} exists and is never overwritten' in status.message
            answer = axis.switch('record', True)
            assert (answer.success, answer.message) == (False, status.message)
            axis.next('slider_state', lambda state: state.step > 500)
            assert_clean(*process.end())
        assert [file.name for file in tmp_path.iterdir()] == ['mine']

    def test_a_full_disk_ends_the_recording_not_the_axis(self, tmp_path: Path) -> None:
        folder = tmp_path / 'run'
        with running(*recording_into(folder), prepare=with_small_files) as process, client() as axis:
            axis.connect()
            status, _ = axis.status('recorder', lambda values: int(values['dropped']) > 0)
            assert status.level == b'\2'
            assert 'File too large; the recording ends here' in status.message
            wait_for(lambda: axis.latest('run_info').bag_path == '', 'run_info without a bag')
            step = axis.latest('slider_state').step
            axis.next('slider_state', lambda state: state.step > step + 100)
            assert_clean(*process.end())
        with pytest.warns(RecordingWarning, match='no end'):
            run = read_run(folder)
        assert len(run.columns('/slider_state')['step']) > 100

    def test_the_receipt_tells_the_solver_and_its_settings(self, tmp_path: Path) -> None:
        folder = tmp_path / 'run'
        wanted = [*recording_into(folder), '-p', 'solver.name:=fixed_step', '-p', 'solver.step:=0.0005']
        with running(*wanted) as process, client() as axis:
            axis.connect()
            assert_clean(*process.end())
        receipt = read_run(folder).receipt
        assert (receipt['solver'], receipt['solver_settings']) == ('fixed_step', {'method': 'euler', 'step': 0.0005})
        assert 'error_estimate' not in receipt

    def test_namespace(self, tmp_path: Path) -> None:
        folder = tmp_path / 'run'
        with running('-r', '__ns:=/cell/press', *recording_into(folder)) as process, client('/cell/press') as axis:
            axis.connect()
            names = {name for name, _ in axis.node.get_topic_names_and_types()}
            assert {'/cell/press/slider_state', '/cell/press/drive_velocity', '/diagnostics'} <= names
            assert axis.next('/diagnostics').status[0].hardware_id == '/cell/press/feed_axis'
            assert_clean(*process.end())
        assert set(read_run(folder).topics) >= {'/cell/press/slider_state', '/parameter_events'}

    def test_only_below_the_folder_of_the_start(self, tmp_path: Path) -> None:
        """Who may set parameters may not write anywhere: not up, not elsewhere, not through a link."""
        (tmp_path / 'runs').mkdir()
        (tmp_path / 'runs' / 'away').symlink_to(tmp_path, target_is_directory=True)
        with running('-p', f'record.folder:={tmp_path}/runs/first', folder=tmp_path) as process, client() as axis:
            axis.connect()
            for place in ('elsewhere', f'{tmp_path}/runs/../up', f'{tmp_path}/runs/away/x', '/dev/shm/x', '~/x'):
                assert axis.set_parameters(record__folder=place).successful
                answer = axis.switch('record', True)
                assert (answer.success, 'must lie below' in answer.message) == (False, True), answer.message
            for place in (f'{tmp_path}/runs/second', ''):
                assert axis.set_parameters(record__folder=place).successful
                assert axis.switch('record', True).success
                assert axis.switch('record', False).success
            process.end()
        assert {path.name for path in tmp_path.iterdir()} == {'runs'}
        assert len(list((tmp_path / 'runs').iterdir())) == 3

    def test_a_scene_whose_name_is_a_path(self, tmp_path: Path) -> None:
        scene = tmp_path / 'scene.yaml'
        scene.write_text('/**:\n  ros__parameters: {scene: ../../up, axis: {mass: 300.0}, record: {enabled: true}}\n')
        with running('--params-file', str(scene), folder=tmp_path) as process, client() as axis:
            axis.connect()
            process.end()
        (folder,) = (tmp_path / 'runs').iterdir()
        assert folder.name.startswith('.._.._up_')

    def test_bytes_are_those_that_were_published(self, tmp_path: Path) -> None:
        """Also from a recording that begins and ends while the axis runs."""
        folder = tmp_path / 'run'
        with running('-p', f'record.folder:={folder}') as process, client() as axis:
            axis.connect()
            axis.send_velocity(0.003)
            axis.next('slider_state', lambda state: state.drive_velocity == 0.003)
            assert axis.switch('record', True).success
            begin = axis.latest('slider_state').step
            axis.next('slider_state', lambda state: state.step > begin + 600)
            assert axis.switch('record', False).success
            heard = {state.step: state for state in axis.heard['slider_state']}
            assert_clean(*process.end())
        run = read_run(folder)
        assert run.is_complete
        assert_same(run, '/slider_state', heard)
        (command,) = (run.decode(message) for message in run.messages(['/drive_velocity']))
        assert command.velocity == 0.003      # the one in force when it began


def assert_same(run: Run, topic: str, heard: dict[int, Any]) -> None:
    from rclpy.serialization import serialize_message
    messages = list(run.messages([topic]))
    assert len(messages) > 500
    for message in messages:
        assert message.data == serialize_message(heard[message.sequence])


def with_small_files() -> None:
    restore_interrupt()
    resource.setrlimit(resource.RLIMIT_FSIZE, (200_000, 200_000))
