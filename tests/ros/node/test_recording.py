# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Recordings of the node: where they may go, what they hold, and what a full disk does."""

import os
import signal
import sys
import time
from pathlib import Path
from typing import Any

import pytest
from rclpy.serialization import serialize_message

from stickslip_sim.check.verification import verify
from stickslip_sim.core.errors import RecordingWarning
from stickslip_sim.core.types import EventKind, Sample
from stickslip_sim.inputs import load_scene
from stickslip_sim.recording import open_bag, open_run, read_run, recordings
from stickslip_sim.ros.node.publishers import Publishers
from stickslip_sim.runs.run import LOAD_COLUMN
from tests.support.axis_here import axis_here
from tests.support.node_processes import recording_into, running, with_small_files
from tests.support.ros_nodes import client, live_axis
from tests.support.tool import restore_interrupt
from tests.support.waiting import wait_for

pytestmark = [pytest.mark.ros, pytest.mark.slow]

CHANGES: dict[str, Any] = {
    'time.mode': 'lockstep',
    'friction.static.backward.initial': 0.1, 'friction.static.backward.limit': 0.15,
    'friction.kinetic.backward.coefficients': [0.1, 0.03], 'normal_load.course': 'steps',
    'normal_load.times': [0.0, 0.7, 1.6], 'normal_load.forces': [0.0, 500.0, -800.0],
}
SPEEDS, STEPS = (0.004, -0.01, 0.006), 800
RANGES = {1: (0.12, 0.24), -1: (0.1, 0.15)}    # of the static coefficient, by direction


class TestPlace:
    def test_a_node_that_cannot_record_from_the_start_does_not_start(self, tmp_path: Path) -> None:
        (tmp_path / 'mine').write_text('precious')
        with running(*recording_into(tmp_path)) as process:
            code, errors = process.wait()
        *before, refusal = errors.splitlines()
        assert code == 2
        assert refusal.startswith(f"sim_node: record.folder = '{tmp_path}': {tmp_path} exists and is not overwritten")
        assert [line for line in before if '[ERROR]' in line] == []
        assert [file.name for file in tmp_path.iterdir()] == ['mine']

    def test_only_below_the_folder_of_the_start_and_nothing_is_overwritten(self, tmp_path: Path) -> None:
        """Who may set parameters may not write anywhere: not up, not elsewhere, not through a link."""
        runs = tmp_path / 'runs'
        (runs / 'mine').mkdir(parents=True)
        (runs / 'away').symlink_to(tmp_path, target_is_directory=True)
        with live_axis(f'record.folder:={runs}/first', folder=tmp_path) as (_, axis):
            for place in ('elsewhere', f'{runs}/../up', f'{runs}/away/x', '/dev/shm/x', '~/x'):
                answer = axis.set_parameters(record__folder=place)
                assert not answer.successful
                assert answer.reason.startswith(f"record.folder = '{place[:20]}")   # a long path is shortened
                assert f'is refused: must be below {runs}' in answer.reason
            assert axis.values('record.folder')[0].string_value == f'{runs}/first'
            assert axis.set_parameters(record__folder=f'{runs}/later/x').successful
            (runs / 'later').symlink_to('/dev/shm', target_is_directory=True)
            answer = axis.switch('record', True)
            assert (answer.success, 'must be below' in answer.message) == (False, True), answer.message
            assert axis.set_parameters(record__folder=f'{runs}/mine').successful
            answer = axis.switch('record', True)
            assert (answer.success, f'{runs}/mine exists and is not overwritten' in answer.message) == (False, True)
            status, _ = axis.status('recorder')
            assert (status.level, status.message) == (b'\2', answer.message)    # and the axis goes on
            for place in (f'{runs}/second', ''):
                assert axis.set_parameters(record__folder=place).successful
                assert axis.switch('record', True).success
                assert axis.switch('record', False).success
        assert {path.name for path in tmp_path.iterdir()} == {'runs'}
        assert len(list(runs.iterdir())) == 5

    def test_a_scene_whose_name_is_a_path(self, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
        scene = tmp_path / 'scene.yaml'
        scene.write_text('/**:\n  ros__parameters: {scene: ../../up, axis: {mass: 300.0}, record: {enabled: true}}\n')
        monkeypatch.chdir(tmp_path)
        with axis_here('--params-file', scene):
            pass
        (folder,) = (tmp_path / 'runs').iterdir()
        assert folder.name.startswith('.._.._up_')


class TestFullDisk:
    def test_ends_the_recording_not_the_axis(self, tmp_path: Path) -> None:
        folder = tmp_path / 'run'
        with live_axis(*recording_into(folder), prepare=with_small_files) as (process, axis):
            status, _ = axis.status('recorder', lambda values: int(values['dropped']) > 0, b'\2')
            assert 'File too large; the recording ends here' in status.message
            wait_for(lambda: axis.latest('run_info').bag_path == '', 'run_info without a bag')
            step = axis.latest('slider_state').step
            axis.next('slider_state', lambda state: state.step > step + 100)
            for _ in range(2):    # how it ended is said as often as it is asked for
                answer = axis.switch('record', False)
                assert (answer.success, answer.message) == (False, f'not recording: {status.message}')
            assert axis.set_parameters(record__folder=str(tmp_path / 'other')).successful
            assert axis.switch('record', True).success
            assert axis.switch('record', False).success
            answer = axis.switch('record', False)
            assert (answer.success, answer.message) == (True, 'not recording')
            code, errors = process.end()
        assert (code, errors.splitlines()[-1]) == (2, f'sim_node: {status.message}')    # also when another was whole
        with pytest.warns(RecordingWarning, match='no end'):
            run = open_bag(folder)
        assert len(run.columns('/slider_state')['step']) > 100


LAG = 'stamps lag by, s: '


def with_a_slow_disk() -> None:
    """Let a node take half a second to open a bag, and end after 300 steps: for `prepare`."""
    lags: list[int] = []

    def slow_open_run(*given: Any) -> Any:
        time.sleep(0.5)
        return open_run(*given)

    def sample(publishers: Publishers, _: int, state: Sample) -> None:
        lags.append(time.time_ns() - publishers.start_ns - state.instant.nanoseconds)
        if len(lags) == 300:
            print(LAG, min(lags) * 1e-9, file=sys.stderr)
            os.kill(os.getpid(), signal.SIGINT)

    restore_interrupt()
    recordings.open_run = slow_open_run    # type: ignore[assignment, attr-defined]
    Publishers.sample = sample             # type: ignore[assignment, method-assign]


class TestContent:
    def test_stamps_keep_to_the_clock_when_it_records_from_the_start(self, tmp_path: Path) -> None:
        """However long the bag takes to open."""
        with running(*recording_into(tmp_path / 'run'), prepare=with_a_slow_disk) as process:
            code, errors = process.wait()
        assert code == 0, errors
        assert abs(float(errors.partition(LAG)[2].split()[0])) < 0.25

    def test_the_names_that_the_topics_have_and_the_settings_of_the_solver(self, tmp_path: Path) -> None:
        """As those of `ros2 bag record`; readers go by the types."""
        folder = tmp_path / 'run'
        rules = [word for rule in ('__ns:=/cell/press', 'slider_state:=/mill/state', 'drive_velocity:=command',
                                   'rig_event:=~/rig_event') for word in ('-r', rule)]
        names = {'/mill/state', '/cell/press/command', '/cell/press/feed_axis/rig_event', '/cell/press/friction_force'}
        solver = ('solver.name:=fixed_step', 'solver.step:=0.0005')
        with running(*rules, *solver, *recording_into(folder)) as process, client('/cell/press') as axis:
            axis.hear_friction()
            wait_for(lambda: {*names, '/diagnostics'} <= {name for name, _ in axis.node.get_topic_names_and_types()},
                     'the topics')
            axis.next('friction_force', lambda message: message.step > 10)
            assert axis.next('/diagnostics').status[0].hardware_id == '/cell/press/feed_axis'
            assert process.end()[0] == 0
        bag = open_bag(folder)
        assert set(bag.topics) >= {*names, '/parameter_events'}
        assert not {'/cell/press/slider_state', '/cell/press/drive_velocity', '/rig_event'} & set(bag.topics)
        assert bag.receipt['solver'] == 'fixed_step'
        assert bag.receipt['solver_settings'] == {'method': 'euler', 'step': 0.0005}
        assert 'error_estimate' not in bag.receipt
        assert verify(read_run(folder)).difference is None

    def test_the_bytes_that_were_published(self, tmp_path: Path) -> None:
        """Also in a recording that begins and ends while the axis runs."""
        folder = tmp_path / 'run'
        with live_axis(f'record.folder:={folder}') as (_, axis):
            axis.send_velocity(0.003)
            axis.next('slider_state', lambda state: state.drive_velocity == 0.003)
            assert axis.switch('record', True).message == f'recording into {folder}'
            wait_for(lambda: axis.latest('run_info').bag_path == str(folder), 'run_info')
            begin = axis.latest('slider_state').step
            axis.next('slider_state', lambda state: state.step > begin + 600)
            assert axis.switch('record', False).message == f'recorded into {folder}'
            run = open_bag(folder)
            messages = {message.sequence: message.data for message in run.messages(['/slider_state'])}
            axis.next('slider_state', lambda state: state.step > max(messages), begin=0)
            heard = {state.step: state for state in axis.states_of_run()}
        assert (run.is_complete, run.receipt['dropped_messages']) == (True, 0)
        assert len(messages) > 500
        assert list(messages) == list(range(min(messages), max(messages) + 1))
        for step in messages.keys() & heard.keys():    # what was not heard was reported as lost
            assert messages[step] == serialize_message(heard[step])
        (command,) = (run.decode(message) for message in run.messages(['/drive_velocity']))
        assert command.velocity == 0.003      # the one in force when it began


def test_a_load_and_a_friction_of_each_direction_are_recorded_and_made_again(tmp_path: Path) -> None:
    """A node that is ordered to go forwards, backwards, and forwards again."""
    (tmp_path / 'scene.yaml').write_text(load_scene('paper_fig8', CHANGES).text, encoding='utf-8')
    with axis_here('--params-file', tmp_path / 'scene.yaml', *recording_into(tmp_path / 'run')) as axis:
        for speed in SPEEDS:
            axis.step(STEPS, speed)
    recorded, weight = read_run(tmp_path / 'run'), 3432.3275
    assert recorded.samples[LOAD_COLUMN][[699, 700, 1600]].tolist() == [weight, weight + 500.0, weight - 800.0]
    away = [event for event in recorded.events if event.kind == EventKind.BREAKAWAY]
    assert {event.direction for event in away} == {1, -1}
    for event in away:
        low, high = RANGES[event.direction]
        assert low <= event.static_coefficient <= high
    verdict = verify(recorded)
    assert verdict.difference is None, verdict
    assert (verdict.steps, verdict.events, verdict.missing) == (1 + len(SPEEDS) * STEPS, len(recorded.events), 0)
