# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""replay_node with mode: commands: the orders of an axis, into a live one."""

import time
from collections.abc import Iterator, Mapping
from contextlib import AbstractContextManager
from pathlib import Path
from types import MappingProxyType
from typing import Any

import pytest
from mcap.reader import make_reader
from rclpy.serialization import serialize_message
from rosbags.rosbag2 import Reader

from stickslip_msgs.msg import RigEvent
from stickslip_msgs.srv import Step
from stickslip_sim.bags.topics import DRIVE_VELOCITY, RIG_EVENT, SLIDER_STATE, Topic, recorded_topics
from stickslip_sim.check.verification import verify
from stickslip_sim.core.errors import InputError
from stickslip_sim.inputs import load_scene
from stickslip_sim.recording import RECORDED, Bag, flat_layout, open_bag, open_run, read_run
from stickslip_sim.recording.messages import Packer
from stickslip_sim.ros.replay import live_axis as axis_of_replay
from stickslip_sim.simulation import RigEventKind
from tests.support.busy_machine import judged_by_time
from tests.support.eventful_runs import eventful_run
from tests.support.node_processes import NodeProcess, assert_clean, recording_into, running
from tests.support.recorded_runs import FACTS, samples
from tests.support.rigs import rig_events_in
from tests.support.ros_nodes import Client, client, live_axis
from tests.support.tool import restore_interrupt
from tests.support.waiting import wait_for

pytestmark = [pytest.mark.ros, pytest.mark.slow]

SAME = ('/slider_state', '/friction_force', '/mode_event')
LOCKSTEP = ('time.mode:=lockstep',)

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
def stamped(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, float, float]:
    """A run with log times of the wall clock, and when it began and ended."""
    folder, begin = tmp_path_factory.mktemp('recorded') / 'run', time.time()
    with eventful_run(folder, 'record.log_time:=wall') as axis:
        assert axis.switch('set_paused', True).success
        time.sleep(0.2)    # so that the stamps go on without the simulation
        assert axis.switch('set_paused', False).success
        axis.next('timing')
    return folder, begin, time.time()


@pytest.fixture
def recorded(stamped: tuple[Path, float, float]) -> Path:
    return stamped[0]


def replaying(folder: Path, *arguments: str, **options: Any) -> AbstractContextManager[NodeProcess]:
    return running(f'bag:={folder}', 'mode:=commands', *arguments, program='replay_node', **options)


def impatient() -> None:
    """For `prepare`."""
    restore_interrupt()
    axis_of_replay.PATIENCE = 1.0


def ended(process: NodeProcess) -> str:
    """Wait until a replay has ended well; return what it said."""
    assert_clean(*process.wait())
    return process.errors


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

    def test_simulation_time_is_read_from_it(self, recorded: Path) -> None:
        bag = open_bag(recorded)
        states = bag.columns('slider_state')
        assert [*states['log_time']] == [step * 1_000_000 for step in states['step']]
        assert next(bag.messages(['/slider_state'])).log_time == 0
        assert verify(read_run(recorded)).difference is None

    def test_no_wall_clock_in_lock_step(self) -> None:
        with pytest.raises(InputError, match=r'must be simulation unless time\.mode is realtime'):
            load_scene('paper_fig8', {'record.log_time': 'wall', 'time.mode': 'lockstep'})


@pytest.fixture(scope='class')
def axis() -> Iterator[Client]:
    with live_axis(*LOCKSTEP) as (_, axis):
        yield axis


class TestUnderWay:
    def test_an_axis_under_way_is_brought_to_its_start_again_and_again(self, axis: Client, recorded: Path) -> None:
        last = axis.call(Step, 'step', steps=700, velocity=0.05, force=0.0).state
        wait_for(lambda: last in axis.heard['slider_state'], 'the states of before')
        axis.heard['slider_state'].clear()
        with replaying(recorded, 'rate:=50', 'playback_duration:=0.2', 'loop:=true') as process:
            ends = wait_for(lambda: len(found := states_of(axis, 200)) > 2 and found, 'three rounds')
            assert_clean(*process.end())
        columns = open_bag(recorded).columns('slider_state')
        for name in ('position', 'velocity', 'acceleration', 'drive_force'):
            assert {getattr(state, name) for state in ends} == {columns[name][200]}

    def test_refused_by_the_axis(self, axis: Client, recorded: Path, tmp_path: Path) -> None:
        for folder, words, reported in (
                (recorded, ['start_offset:=0.1'], 'start_offset = 0.1 is refused: must be 0 in lock-step'),
                (commanded(tmp_path / 'mid', first=400), [], 'step 1 is missing; only a complete run of the node'),
                (commanded(tmp_path / 'fast', velocity=5.0), [], '/feed_axis gave up: velocity = 5.0 is refused')):
            assert reported in refusal(folder, *words)


class TestLockStep:
    def test_the_same_run_to_the_last_bit(self, recorded: Path, tmp_path: Path) -> None:
        again, scene = tmp_path / 'again', tmp_path / 'scene.yaml'
        scene.write_bytes(open_bag(recorded).attachments['scene.yaml'])
        arguments = ['--params-file', str(scene), *LOCKSTEP, 'record.log_time:=simulation', *recording_into(again)]
        with running(*arguments) as axis, replaying(recorded, 'rate:=50') as process:
            assert 'another scene' not in ended(process)
            assert_clean(*axis.end())
        assert_same(open_bag(recorded), open_bag(again))
        for topic in ('/drive_velocity', '/external_force', '/parameter_events'):
            steps, again_at = ([message.sequence for message in open_bag(folder).messages([topic])]
                               for folder in (recorded, again))
            assert steps == again_at

    @pytest.mark.parametrize(('word', 'reported'), [
        ('time.rate:=500.0', 'time.rate = 500.0 is refused: must be that of the recording, whose step 1'),
        ('time.mode:=free_run', "time.mode = 'free_run' is refused: must be realtime or lockstep"),
    ])
    def test_another_axis(self, recorded: Path, word: str, reported: str) -> None:
        with running(*LOCKSTEP, word) as axis:
            assert reported in refusal(recorded)
            assert_clean(*axis.end())

    def test_a_recording_axis_that_is_not_at_its_start(self, recorded: Path, tmp_path: Path) -> None:
        with live_axis(*LOCKSTEP, *recording_into(tmp_path / 'run')) as (_, viewer):
            assert viewer.call(Step, 'step', steps=5, velocity=0.0, force=0.0).success
            assert ("axis = '/feed_axis' is refused: must be at step 0, but is at 5; ~/reset is refused"
                    in refusal(recorded))

    def test_in_namespaces_with_a_time_out_that_is_left_to_the_axis(self, tmp_path: Path) -> None:
        """The axis is that of the recording, wherever the replay itself is."""
        timeout = RigEvent(kind=RigEvent.KIND_COMMAND_TIMEOUT, step=20, value=0.5)
        folder = commanded(tmp_path / 'run', {20: (RIG_EVENT, serialize_message(timeout))}, namespace='/cell')
        with live_axis(*LOCKSTEP, namespace='/cell') as (_, viewer):
            with replaying(folder, '-r', '__ns:=/elsewhere', afresh=True) as process:
                assert 'a command time-out at 0.019 s is left to the axis' in ended(process)
            wait_for(lambda: states_of(viewer, 49), 'the last step')

    def test_an_axis_that_is_killed_ends_it(self, recorded: Path, tmp_path: Path,
                                            monkeypatch: pytest.MonkeyPatch) -> None:
        short = tmp_path / 'short_lease.xml'
        short.write_text(SHORT_LEASE)
        for name in ('FASTRTPS', 'FASTDDS'):    # on Jazzy, and from Kilted on
            monkeypatch.setenv(f'{name}_DEFAULT_PROFILES_FILE', str(short))
        with running(*LOCKSTEP) as axis, client() as viewer, replaying(recorded, 'loop:=true') as process:
            viewer.next('slider_state', lambda state: state.step > 20)
            axis.kill()
            code, errors = process.wait()
        assert code == 2
        assert "axis = '/feed_axis' is refused: must be a sim_node that runs; " in errors


def states_of(axis: Client, step: int) -> list[Any]:
    """Return the states that were heard of a step."""
    return [state for state in axis.heard['slider_state'] if state.step == step]


def refusal(folder: Path, *words: str) -> str:
    """Return why a recording is not replayed into an axis that runs."""
    with replaying(folder, 'rate:=50', *words) as replay:
        code, errors = replay.wait()
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
        _, second, third = (message.log_time * 1e-9 for message in open_bag(recorded).messages(['/drive_velocity']))
        part = (f'start_offset:={(second + third) / 2.0:.9f}', 'playback_duration:=0.0')
        with live_axis('drive.velocity:=0.0') as (_, viewer):
            with replaying(recorded, *part) as process:
                said = ended(process)
            assert '/feed_axis has another scene than the recorded one: drive.velocity is 0.0, not 0.002; it' in said
            viewer.next('slider_state', lambda state: state.drive_velocity == -0.003)

    def test_nobody_there(self, recorded: Path) -> None:
        with replaying(recorded, prepare=impatient) as replay:
            code, errors = replay.wait()
        assert code == 2
        assert "axis = '/feed_axis' is refused: must be a sim_node that runs; none answers" in errors
