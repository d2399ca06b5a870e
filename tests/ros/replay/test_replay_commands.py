# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""replay_node with mode: commands: the orders of an axis, into a live one."""

import time
from collections.abc import Mapping, Sequence
from contextlib import AbstractContextManager
from pathlib import Path
from types import MappingProxyType

import pytest
from mcap.reader import make_reader
from rosbags.rosbag2 import Reader

from stickslip_sim.bags.topics import DRIVE_VELOCITY, RIG_EVENT, SLIDER_STATE, Topic, recorded_topics
from stickslip_sim.check.verification import verify
from stickslip_sim.recording import RECORDED, Bag, flat_layout, open_bag, open_run, read_run
from stickslip_sim.recording.messages import Packer
from stickslip_sim.simulation import RigEventKind
from tests.support.busy_machine import judged_by_time
from tests.support.eventful_runs import eventful_run
from tests.support.node_processes import NodeProcess, assert_clean, recording_into, running
from tests.support.recorded_runs import FACTS, samples
from tests.support.replays import rig_events_in
from tests.support.ros_nodes import client
from tests.support.waiting import wait_for

from rclpy.serialization import serialize_message  # isort: skip

from stickslip_msgs.msg import RigEvent  # isort: skip
from stickslip_msgs.srv import Step  # isort: skip

pytestmark = [pytest.mark.ros, pytest.mark.slow]

SAME = ('/slider_state', '/friction_force', '/mode_event')
LOCKSTEP = ('-p', 'time.mode:=lockstep')

# DDS misses who is silent for so long; 20 s by default
SHORT_LEASE = '''
<profiles xmlns="http://www.eprosima.com">
  <participant profile_name="short" is_default_profile="true">
    <rtps><builtin><discovery_config>
      <leaseDuration><sec>2</sec></leaseDuration>
      <leaseAnnouncement><nanosec>500000000</nanosec></leaseAnnouncement>
    </discovery_config></builtin></rtps>
  </participant>
</profiles>
'''


@pytest.fixture(scope='module')
def recorded(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp('recorded') / 'run'
    with eventful_run(folder):
        pass
    return folder


@pytest.fixture(scope='module')
def stamped(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, float, float]:
    folder, begin = tmp_path_factory.mktemp('stamped') / 'run', time.time()
    with eventful_run(folder, '-p', 'record.log_time:=wall') as axis:
        assert axis.switch('set_paused', True).success
        time.sleep(0.2)    # so that the stamps go on without the simulation
        assert axis.switch('set_paused', False).success
        axis.next('timing')
    return folder, begin, time.time()


def replaying(folder: Path, *arguments: str, afresh: bool = False) -> AbstractContextManager[NodeProcess]:
    return running('-p', f'bag:={folder}', '-p', 'mode:=commands', *arguments, program='replay_node', afresh=afresh)


def ended(process: NodeProcess) -> str:
    """Wait until a replay has ended well; return what it said."""
    code, errors = process.wait()
    assert code == 0, errors
    assert 'Traceback' not in errors
    return errors


def assert_same(one: Bag, other: Bag) -> None:
    """Assert that two runs have the same steps and events, to the last bit; stamps are those of their own clocks."""
    for topic in SAME:
        columns, others = one.columns(topic), other.columns(topic)
        assert len(columns['step']) > (0 if topic == '/mode_event' else 100)
        for name in columns.keys() - {'publish_time'}:
            assert columns[name].tobytes() == others[name].tobytes(), f'{topic} {name}'


class TestWallClock:
    """`record.log_time: wall`: log times are stamps, and everything of ours reads the bag as any other."""

    def test_it_aligns_with_other_bags(self, stamped: tuple[Path, float, float]) -> None:
        folder, begin, end = stamped
        with (folder / 'run_0.mcap').open('rb') as file:
            found = list(make_reader(file).iter_messages())
        times = [message.log_time * 1e-9 for *_, message in found]
        assert begin < times[0] < times[-1] < end
        bag = open_bag(folder)
        stamps = [bag.decode(message).header.stamp for message in bag.messages(['/slider_state'])]
        assert ([message.log_time for _, channel, message in found if channel.topic == '/slider_state']
                == [stamp.sec * 10**9 + stamp.nanosec for stamp in stamps])
        with Reader(folder) as reader:
            assert begin < reader.start_time * 1e-9 < reader.end_time * 1e-9 < end

    def test_simulation_time_is_read_from_it(self, stamped: tuple[Path, float, float]) -> None:
        bag = open_bag(stamped[0])
        states = bag.columns('slider_state')
        assert [*states['log_time']] == [step * 1_000_000 for step in states['step']]
        assert next(bag.messages(['/slider_state'])).log_time == 0
        assert verify(read_run(stamped[0])).difference is None

    def test_the_same_run_in_lock_step(self, stamped: tuple[Path, float, float], tmp_path: Path) -> None:
        folder, again = stamped[0], tmp_path / 'again'
        with running(*LOCKSTEP, *recording_into(again)) as axis, replaying(folder, '-p', 'rate:=50') as process:
            assert 'another scene' not in ended(process)
            assert_clean(*axis.end())
        assert_same(open_bag(folder), open_bag(again))

    def test_no_wall_clock_in_lock_step(self) -> None:
        with running(*LOCKSTEP, '-p', 'record.log_time:=wall') as process:
            code, errors = process.wait()
        assert code == 2
        assert "record.log_time = 'wall' is refused: must be simulation unless time.mode is realtime" in errors


class TestLockStep:
    def test_the_same_run_to_the_last_bit(self, recorded: Path, tmp_path: Path) -> None:
        again, scene = tmp_path / 'again', tmp_path / 'scene.yaml'
        scene.write_bytes(open_bag(recorded).attachments['scene.yaml'])
        arguments = ['--params-file', str(scene), *LOCKSTEP, *recording_into(again)]
        with running(*arguments) as axis, replaying(recorded, '-p', 'rate:=50') as process:
            assert 'another scene' not in ended(process)
            assert_clean(*axis.end())
        assert_same(open_bag(recorded), open_bag(again))
        for topic in ('/drive_velocity', '/external_force', '/parameter_events'):
            steps, again_at = ([message.sequence for message in open_bag(folder).messages([topic])]
                               for folder in (recorded, again))
            assert steps == again_at

    def test_an_axis_under_way_is_brought_to_its_start(self, recorded: Path) -> None:
        with running(*LOCKSTEP) as axis, client() as viewer:
            viewer.connect(is_moving=False)
            assert viewer.call(Step, 'step', steps=700, velocity=0.05, force=0.0).success
            with replaying(recorded, '-p', 'rate:=50', '-p', 'playback_duration:=0.5') as process:
                ended(process)
            wait_for(lambda: viewer.latest('slider_state').step == 500, 'the last step')
            columns = open_bag(recorded).columns('slider_state')
            for name in ('position', 'velocity', 'acceleration', 'drive_force'):
                assert getattr(viewer.latest('slider_state'), name) == columns[name][500]
            assert_clean(*axis.end())

    def test_again_and_again(self, recorded: Path) -> None:
        with running(*LOCKSTEP) as axis, client() as viewer:
            viewer.connect(is_moving=False)
            with replaying(recorded, '-p', 'rate:=50', '-p', 'playback_duration:=0.2', '-p', 'loop:=true') as process:
                wait_for(lambda: [state.step for state in viewer.heard['slider_state']].count(200) > 2, 'three rounds')
                code, errors = process.end()
                assert (code, 'Traceback' in errors) == (0, False), errors
            assert len({state.position for state in viewer.heard['slider_state'] if state.step == 200}) == 1
            assert_clean(*axis.end())

    def test_an_axis_that_is_killed_ends_it(self, recorded: Path, tmp_path: Path,
                                            monkeypatch: pytest.MonkeyPatch) -> None:
        short = tmp_path / 'short_lease.xml'
        short.write_text(SHORT_LEASE)
        for name in ('FASTRTPS', 'FASTDDS'):    # on Jazzy, and from Kilted on
            monkeypatch.setenv(f'{name}_DEFAULT_PROFILES_FILE', str(short))
        with running(*LOCKSTEP) as axis, client() as viewer, replaying(recorded, '-p', 'loop:=true') as process:
            viewer.next('slider_state', lambda state: state.step > 20)
            axis.kill()
            code, errors = process.wait()
        assert code == 2
        assert "axis = '/feed_axis' is refused: must be a sim_node that runs; " in errors

    @pytest.mark.parametrize(('arguments', 'options', 'reported'), [
        (['-p', 'time.rate:=500.0'], [], 'time.rate = 500.0 is refused: must be that of the recording, whose step 1'),
        ([], ['-p', 'start_offset:=0.1'], 'start_offset = 0.1 is refused: must be 0 in lock-step'),
        (['-p', 'time.mode:=free_run'], [], "time.mode = 'free_run' is refused: must be realtime or lockstep"),
    ])
    def test_another_axis(self, recorded: Path, arguments: list[str], options: list[str], reported: str) -> None:
        assert reported in refused(recorded, *options, axis=arguments)

    def test_a_recording_begun_in_mid_run(self, tmp_path: Path) -> None:
        assert 'step 1 is missing; only a run that was recorded' in refused(commanded(tmp_path / 'mid', first=400))

    def test_orders_that_the_axis_refuses(self, tmp_path: Path) -> None:
        assert '/feed_axis gave up: velocity = 5.0 is refused' in refused(commanded(tmp_path / 'fast', velocity=5.0))

    def test_a_time_out_is_left_to_the_axis_and_reported(self, tmp_path: Path) -> None:
        timeout = RigEvent(kind=RigEvent.KIND_COMMAND_TIMEOUT, step=20, value=0.5)
        folder = commanded(tmp_path / 'silent', {20: (RIG_EVENT, serialize_message(timeout))})
        with running(*LOCKSTEP) as axis, replaying(folder, afresh=True) as process:
            code, errors = process.wait()
            assert_clean(*axis.end())
        assert code == 0
        assert 'a command time-out at 0.019 s is left to the axis' in errors

    def test_in_namespaces(self, tmp_path: Path) -> None:
        """The axis is that of the recording, wherever the replay itself is."""
        folder = commanded(tmp_path / 'run', namespace='/cell')
        with running(*LOCKSTEP, '-r', '__ns:=/cell') as axis, client('/cell') as viewer:
            viewer.connect(is_moving=False)
            with replaying(folder, '-r', '__ns:=/elsewhere') as process:
                ended(process)
            states = viewer.heard['slider_state']
            wait_for(lambda: states and states[-1].step == 49, 'the last step')
            assert_clean(*axis.end())

    def test_a_recording_axis_that_is_not_at_its_start(self, recorded: Path, tmp_path: Path) -> None:
        with running(*LOCKSTEP, *recording_into(tmp_path / 'run')) as axis, client() as viewer:
            viewer.connect(is_moving=False)
            assert viewer.call(Step, 'step', steps=5, velocity=0.0, force=0.0).success
            with replaying(recorded) as process:
                code, errors = process.wait()
            assert code == 2
            assert "axis = '/feed_axis' is refused: must be at step 0, but is at 5; ~/reset is refused" in errors
            assert_clean(*axis.end())


def refused(folder: Path, *options: str, axis: Sequence[str] = ()) -> str:
    """Return why a recording is not replayed into an axis in lock-step."""
    with running(*LOCKSTEP, *axis) as process, replaying(folder, '-p', 'rate:=50', *options) as replay:
        code, errors = replay.wait()
        assert_clean(*process.end())
    assert (code, 'Traceback' in errors) == (2, False), errors
    line, = (line for line in errors.splitlines() if line.startswith('replay_node: '))
    return line


def commanded(folder: Path, others: Mapping[int, tuple[Topic, bytes]] = MappingProxyType({}), first: int = 0,
              velocity: float = 0.002, namespace: str = '/') -> Path:
    """Write a run of 50 steps with one command, before its second step, and `others` by step."""
    states, command = Packer(SLIDER_STATE), flat_layout(DRIVE_VELOCITY.type).pack(0, velocity)
    messages = {first + 1: (DRIVE_VELOCITY, command), **others}
    writer = open_run(folder, FACTS, recorded_topics(namespace))
    for step, sample in enumerate(samples(50, first), first):
        if step in messages:
            topic, data = messages[step]
            writer.write(RECORDED.index(topic), data, (step - 1) * 1_000_000, 0, step)
        writer.write(RECORDED.index(SLIDER_STATE), states.pack(0, step, sample), step * 1_000_000, 0, step)
    writer.close()
    return folder


class TestRealTime:
    def test_orders_in_their_time(self, recorded: Path, tmp_path: Path) -> None:
        again = tmp_path / 'again'
        with running(*recording_into(again)) as axis, replaying(recorded) as process, judged_by_time(0.001, axis.waits):
            ended(process)
            assert_clean(*axis.end())
            one, other = open_bag(recorded), open_bag(again)
            for topic in ('/drive_velocity', '/external_force'):    # the axis hears the latest, if it is late
                field = 'velocity' if topic == '/drive_velocity' else 'force'
                assert one.columns(topic)[field].tolist() == other.columns(topic)[field].tolist()
        orders = [[(event.kind, event.id, event.fault, event.start, event.duration, event.value)
                   for event in rig_events_in(run, RigEventKind.FAULT_INJECTED, RigEventKind.FAULT_CLEARED)]
                  for run in (one, other)]
        assert [order[:2] for order in orders[0]] == [
            (RigEventKind.FAULT_INJECTED, 'dry'), (RigEventKind.FAULT_INJECTED, 'force_pulse_1'),
            (RigEventKind.FAULT_CLEARED, 'dry')]
        assert orders[0] == orders[1]
        changes = [run.decode(message).changed_parameters[0].name for run in (one, other)
                   for message in run.messages(['/parameter_events'])]
        assert changes == ['axis.mass'] * 2

    def test_the_command_in_force_comes_first(self, recorded: Path) -> None:
        run = open_bag(recorded)
        _, second, third = (message.log_time * 1e-9 for message in run.messages(['/drive_velocity']))
        begin = (second + third) / 2.0
        with running('-p', 'drive.velocity:=0.0') as axis, client() as viewer:
            viewer.connect()
            part = ('-p', f'start_offset:={begin:.9f}', '-p', 'playback_duration:=0.0')
            with replaying(recorded, *part) as process:
                said = ended(process)
            assert '/feed_axis has another scene than the recorded one: drive.velocity is 0.0, not 0.002; it' in said
            viewer.next('slider_state', lambda state: state.drive_velocity == -0.003)
            assert_clean(*axis.end())

    def test_nobody_there(self, recorded: Path) -> None:
        with replaying(recorded) as process:
            code, errors = process.wait()
        assert code == 2
        assert "axis = '/feed_axis' is refused: must be a sim_node that runs; none answers" in errors
