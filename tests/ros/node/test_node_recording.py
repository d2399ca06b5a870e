# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Recordings of the node: where they may go, what they hold, and what a full disk does."""

import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

from stickslip_sim.check.verification import verify
from stickslip_sim.core.errors import RecordingWarning
from stickslip_sim.recording import Bag, open_bag, read_run
from tests.support.node_processes import assert_clean, recording_into, running, with_small_files
from tests.support.ros_nodes import client
from tests.support.waiting import DEADLINE, wait_for

pytestmark = [pytest.mark.ros, pytest.mark.slow]


class TestRecording:
    def test_a_node_that_cannot_record_from_the_start_does_not_start(self, tmp_path: Path) -> None:
        (tmp_path / 'mine').write_text('precious')
        with running(*recording_into(tmp_path)) as process:
            code, errors = process.wait()
        assert code == 2
        refusal = errors.splitlines()[-1]
        assert refusal.startswith(f"sim_node: record.folder = '{tmp_path}': {tmp_path} exists and is never overwritten")
        assert [line for line in errors.splitlines() if '[ERROR]' in line] == []
        assert [file.name for file in tmp_path.iterdir()] == ['mine']

    def test_an_existing_folder_stays_and_the_axis_goes_on(self, tmp_path: Path) -> None:
        (tmp_path / 'mine').write_text('precious')
        with running('-p', f'record.folder:={tmp_path}') as process, client() as axis:
            axis.connect()
            answer = axis.switch('record', True)
            assert not answer.success
            assert f'{tmp_path} exists and is never overwritten' in answer.message
            status, _ = axis.status('recorder')
            assert (status.level, status.message) == (b'\2', answer.message)
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
            for _ in range(2):    # how it ended is said as often as it is asked for
                answer = axis.switch('record', False)
                assert (answer.success, answer.message) == (False, f'not recording: {status.message}')
            code, errors = process.end()
        assert (code, errors.splitlines()[-1]) == (2, f'sim_node: {status.message}')
        with pytest.warns(RecordingWarning, match='no end'):
            run = open_bag(folder)
        assert len(run.columns('/slider_state')['step']) > 100

    def test_one_that_died_is_reported_at_the_end_also_when_another_did_not(self, tmp_path: Path) -> None:
        with running(*recording_into(tmp_path / 'run'), prepare=with_small_files) as process, client() as axis:
            axis.connect()
            status, _ = axis.status('recorder', lambda values: int(values['dropped']) > 0)
            assert axis.set_parameters(record__folder=str(tmp_path / 'other')).successful
            assert axis.switch('record', True).success
            assert axis.switch('record', False).success
            answer = axis.switch('record', False)
            assert (answer.success, answer.message) == (True, 'not recording')
            code, errors = process.end()
        assert (code, errors.splitlines()[-1]) == (2, f'sim_node: {status.message}')

    def test_stamps_keep_to_the_clock_when_it_records_from_the_start(self, tmp_path: Path) -> None:
        """However long the bag takes to open."""
        done = subprocess.run([sys.executable, '-m', 'tests.support.slow_bag', *recording_into(tmp_path / 'run')],
                              capture_output=True, text=True, timeout=DEADLINE, check=True)
        assert abs(float(done.stdout)) < 0.25, done.stderr

    def test_the_receipt_has_the_solver_and_its_settings(self, tmp_path: Path) -> None:
        folder = tmp_path / 'run'
        wanted = [*recording_into(folder), '-p', 'solver.name:=fixed_step', '-p', 'solver.step:=0.0005']
        with running(*wanted) as process, client() as axis:
            axis.connect()
            assert_clean(*process.end())
        receipt = open_bag(folder).receipt
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
        assert set(open_bag(folder).topics) >= {'/cell/press/slider_state', '/parameter_events'}

    def test_the_bag_has_the_names_that_the_topics_have(self, tmp_path: Path) -> None:
        """As those of `ros2 bag record`; readers go by the types."""
        folder = tmp_path / 'run'
        rules = [word for rule in ('slider_state:=/mill/state', 'drive_velocity:=command', 'rig_event:=~/rig_event')
                 for word in ('-r', rule)]
        with running(*rules, *recording_into(folder)) as process, client() as axis:
            axis.hear_friction()
            names = {'/mill/state', '/command', '/feed_axis/rig_event', '/friction_force'}
            wait_for(lambda: names <= {name for name, _ in axis.node.get_topic_names_and_types()}, 'the topics')
            axis.next('friction_force', lambda message: message.step > 10)
            assert_clean(*process.end())
        bag = open_bag(folder)
        assert set(bag.topics) >= names
        assert not {'/slider_state', '/drive_velocity', '/rig_event'} & set(bag.topics)
        assert verify(read_run(folder)).difference is None

    def test_only_below_the_folder_of_the_start(self, tmp_path: Path) -> None:
        """Who may set parameters may not write anywhere: not up, not elsewhere, not through a link."""
        (tmp_path / 'runs').mkdir()
        (tmp_path / 'runs' / 'away').symlink_to(tmp_path, target_is_directory=True)
        with running('-p', f'record.folder:={tmp_path}/runs/first', folder=tmp_path) as process, client() as axis:
            axis.connect()
            for place in ('elsewhere', f'{tmp_path}/runs/../up', f'{tmp_path}/runs/away/x', '/dev/shm/x', '~/x'):
                answer = axis.set_parameters(record__folder=place)
                assert not answer.successful
                assert answer.reason.startswith(f"record.folder = '{place[:20]}")   # a long path is shortened
                assert f'is refused: must be below {tmp_path}/runs' in answer.reason
            assert axis.values('record.folder')[0].string_value == f'{tmp_path}/runs/first'
            assert axis.set_parameters(record__folder=f'{tmp_path}/runs/later/x').successful
            (tmp_path / 'runs' / 'later').symlink_to('/dev/shm', target_is_directory=True)
            answer = axis.switch('record', True)
            assert (answer.success, 'must be below' in answer.message) == (False, True), answer.message
            for place in (f'{tmp_path}/runs/second', ''):
                assert axis.set_parameters(record__folder=place).successful
                assert axis.switch('record', True).success
                assert axis.switch('record', False).success
            process.end()
        assert {path.name for path in tmp_path.iterdir()} == {'runs'}
        assert len(list((tmp_path / 'runs').iterdir())) == 4

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
            run = open_bag(folder)
            last = run.columns('/slider_state')['step'][-1]
            axis.next('slider_state', lambda state: state.step > last, begin=0)
            heard = {state.step: state for state in axis.states_of_run()}
            assert_clean(*process.end())
        assert run.is_complete
        assert run.receipt['dropped_messages'] == 0
        assert_same(run, '/slider_state', heard)
        (command,) = (run.decode(message) for message in run.messages(['/drive_velocity']))
        assert command.velocity == 0.003      # the one in force when it began


def assert_same(run: Bag, topic: str, heard: dict[int, Any]) -> None:
    from rclpy.serialization import serialize_message
    messages = {message.sequence: message.data for message in run.messages([topic])}
    assert len(messages) > 500
    assert list(messages) == list(range(min(messages), max(messages) + 1))
    for step in messages.keys() & heard.keys():    # what was not heard was reported as lost
        assert messages[step] == serialize_message(heard[step])
