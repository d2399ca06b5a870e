# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""replay_node as a process: recorded runs back onto topics."""

import signal
import statistics
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import pytest
from mcap.writer import Writer
from rclpy.qos import QoSProfile
from rosgraph_msgs.msg import Clock
from std_srvs.srv import SetBool, Trigger

from stickslip_msgs.msg import SliderState
from stickslip_sim.bags.topics import CLOCK, PARAMETER_EVENTS, RECORDED, SLIDER_STATE, Topic
from stickslip_sim.core.errors import RecordingWarning
from stickslip_sim.recording import open_bag, open_run, schema, write_bag
from stickslip_sim.ros.node.endpoints import message_type, qos
from tests.support.busy_machine import judged_by_time
from tests.support.node_processes import NodeProcess, assert_clean, ended_at_once, refusal_of, running
from tests.support.recorded_runs import FACTS, damage, events, samples
from tests.support.ros_nodes import Client, client
from tests.support.tool import Capture, answered
from tests.support.waiting import wait_for

pytestmark = [pytest.mark.ros, pytest.mark.slow]

SECOND = 1_000_000_000

TOPICS = [topic.resolved() for topic in RECORDED if topic is not PARAMETER_EVENTS]    # nobody else publishes on these
PAUSED = ('start_paused:=true',)


@pytest.fixture(scope='module')
def bag(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A made-up run of 0.3 s, in which no two messages of a topic are the same."""
    folder = tmp_path_factory.mktemp('bags') / 'run'
    write_bag(folder, FACTS, samples(301), events(), {})
    return folder


def replaying(folder: Path, *arguments: str, afresh: bool = False) -> Any:
    return running(f'bag:={folder}', *arguments, program='replay_node', afresh=afresh)


@contextmanager
def viewed(folder: Path, *arguments: str) -> Iterator[tuple[Client, NodeProcess]]:
    """Replay beside a viewer who leaves before its end: it takes seconds to be sure that one who listens has it all."""
    with replaying(folder, *arguments) as process:
        with client() as viewer:
            yield viewer, process
        assert_clean(*process.wait())


def call(viewer: Client, service: str, on: bool | None = None) -> Any:
    if on is None:
        return viewer.call(Trigger, service, 'replay')
    return viewer.call(SetBool, service, 'replay', data=on)


class ByteEars:
    """Hears topics as bytes.

    Endpoints are announced in order: a server that answers a call knows those that were made before the call.
    """

    def __init__(self, viewer: Client, *topics: Topic) -> None:
        self.heard: list[tuple[str, bytes]] = []
        self._lost = viewer.lost
        for topic in topics:
            viewer.hear(message_type(topic), topic.name, self._note(topic.name), qos(topic.qos._replace(depth=5000)),
                        raw=True)

    def _note(self, name: str) -> Callable[[bytes], None]:
        return lambda data: self.heard.append((name, data))

    def of(self, name: str) -> list[bytes]:
        return [data for topic, data in self.heard if topic == name]

    def wait_for(self, name: str, wanted: list[bytes], count: int | None = None) -> None:
        """Wait until the wanted messages came, or `count` of them, and compare them in order.

        DDS may report some as lost, and pads them to a multiple of 4 bytes.
        """
        wait_for(lambda: len(self.of(name)) + self._lost[name] >= (count or len(wanted)), name)
        rest = iter([data + bytes(-len(data) % 4) for data in wanted])
        assert all(data in rest for data in self.of(name))


def recorded(bag: Path, name: str, since: float = 0.0, until: float = 1e9) -> list[bytes]:
    """Return the bytes of a topic between two log times, s."""
    return [message.data for message in open_bag(bag).messages([name])
            if since * 1e9 <= message.log_time <= until * 1e9]


class TestStates:
    def test_all_as_recorded(self, bag: Path) -> None:
        with client() as viewer, replaying(bag, *PAUSED) as process:
            ears = ByteEars(viewer, *TOPICS)
            assert call(viewer, 'is_paused').success
            for topic in TOPICS:
                assert_offered_as_recorded(viewer, topic)
            assert ears.heard == []
            assert call(viewer, 'resume').success
            for topic in TOPICS:
                ears.wait_for(topic.name, recorded(bag, topic.name))
            assert_clean(*process.wait())

    def test_a_part_of_it(self, bag: Path) -> None:
        part = ('start_offset:=0.1', 'playback_duration:=0.05', 'topics:=[slider_state]')
        with client() as viewer, replaying(bag, *PAUSED, *part, '-r', '/slider_state:=/seen') as process:
            ears = ByteEars(viewer, SLIDER_STATE._replace(name='/seen'), *TOPICS)
            assert call(viewer, 'is_paused').success
            assert call(viewer, 'set_paused', on=False).success
            assert_clean(*process.wait())
            ears.wait_for('/seen', recorded(bag, '/slider_state', 0.1, 0.15))
            assert {name for name, _ in ears.heard} == {'/seen'}

    def test_again_and_again(self, bag: Path) -> None:
        """Transitions, of which none is lost: the publisher keeps more of them than come in these rounds."""
        arguments = ('loop:=true', 'topics:=[mode_event]')
        with viewed(bag, *arguments, *PAUSED) as (viewer, _):
            ears = ByteEars(viewer, *TOPICS)
            assert call(viewer, 'toggle_paused').message.startswith('running')
            once = recorded(bag, '/mode_event')
            ears.wait_for('/mode_event', 1000 * once, count=3 * len(once))    # a busy machine looks some rounds later
            assert call(viewer, 'stop').success


def assert_offered_as_recorded(viewer: Client, topic: Topic) -> None:
    infos = wait_for(lambda: [info for info in viewer.node.get_publishers_info_by_topic(topic.name)
                              if info.node_name == 'replay'], f'the offer of {topic.name}')
    assert [str(info.topic_type_hash) for info in infos] == [schema(topic.type).hash]
    assert infos[0].qos_profile.reliability.name.lower() == topic.qos.reliability
    assert infos[0].qos_profile.durability.name.lower() == topic.qos.durability


class TestTime:
    def test_each_message_in_its_time(self, bag: Path) -> None:
        """0.3 s at a third of the speed: 301 states, one in 3 ms; the host may be late now and then."""
        with viewed(bag, *PAUSED, 'rate:=0.3333333333333333') as (viewer, process):
            times: dict[int, float] = {}
            viewer.hear(SliderState, '/slider_state', lambda state: times.setdefault(state.step, time.monotonic()),
                        QoSProfile(depth=500))
            with judged_by_time(0.05, process.waits):
                assert call(viewer, 'resume').success
                wait_for(lambda: len(times) + viewer.lost['/slider_state'] == 301, 'all states')
                first, last = min(times), max(times)
                delays = [at - times[first] - 0.003 * (step - first) for step, at in times.items()]
                assert abs(statistics.median(delays)) < 0.05
                assert times[last] - times[first] > 0.85 / 300 * (last - first)

    def test_clock_is_that_of_the_stamps(self, tmp_path: Path) -> None:
        start = 1_700_000_000 * SECOND
        writer = open_run(tmp_path / 'run', FACTS)
        for step in (0, 100, 200):
            writer.write(0, b'\0\1\0\0', step * 1_000_000, start + step * 1_000_000, step)
        writer.close()
        with client() as viewer, replaying(tmp_path / 'run', *PAUSED, 'clock:=200.0') as process:
            clocks: list[int] = []
            viewer.node.create_subscription(
                Clock, '/clock', lambda sent: clocks.append(sent.clock.sec * SECOND + sent.clock.nanosec), 1000)
            wait_for(lambda: len(clocks) > 3, 'a clock that stands still')
            assert set(clocks) == {start}
            assert call(viewer, 'resume').success
            with judged_by_time(0.04, process.waits):
                wait_for(lambda: clocks[-1] > start + 150_000_000, 'a tick of its end', 5.0)
            assert_clean(*process.wait())
        assert clocks == sorted(clocks)
        assert clocks[-1] < start + SECOND

    def test_paused_message_by_message(self, bag: Path, capsys: Capture) -> None:
        slowly = ('rate:=0.02', 'topics:=[/slider_state]')   # 15 s
        with viewed(bag, *PAUSED, *slowly) as (viewer, _):
            ears = ByteEars(viewer, SLIDER_STATE.resolved())
            wanted = recorded(bag, '/slider_state')
            for count in range(1, 4):
                assert call(viewer, 'play_next').success
                ears.wait_for('/slider_state', wanted[:count])
            assert answered(capsys, 'call', 'play-next') == (0, 'the next message goes out\n', '')
            ears.wait_for('/slider_state', wanted[:4])
            assert call(viewer, 'resume').success
            assert call(viewer, 'pause').message.startswith('paused at 0.')
            assert call(viewer, 'is_paused').success
            count = len(ears.of('/slider_state'))
            assert viewer.set_parameters('replay', rate=1.0).successful
            assert call(viewer, 'toggle_paused').success
            ears.wait_for('/slider_state', wanted)
            assert 3 <= count < len(wanted)

    def test_rate_is_a_parameter(self, bag: Path) -> None:
        with viewed(bag, 'rate:=0.001') as (viewer, _):
            refused = viewer.set_parameters('replay', rate=0.0)
            assert not refused.successful
            assert 'rate = 0.0 is refused: must be a number, > 0' in refused.reason
            assert 'cannot change' in viewer.set_parameters('replay', loop=True).reason
            assert not call(viewer, 'play_next').success
            assert viewer.set_parameters('replay', rate=1).successful


class TestProcess:
    @pytest.mark.parametrize(('number', 'words'), [
        (signal.SIGTERM, PAUSED), (signal.SIGINT, ('loop:=true',)), (signal.SIGINT, ('delay:=1000.0',))])
    def test_signals(self, bag: Path, number: int, words: tuple[str, ...]) -> None:
        with client() as viewer, replaying(bag, *words, afresh=number == signal.SIGTERM) as process:
            assert call(viewer, 'is_paused').success is (words == PAUSED)
            assert_clean(*process.end(number))

    def test_a_bag_that_was_cut_off_is_played_as_far_as_it_goes(self, bag: Path, tmp_path: Path) -> None:
        data = (bag / 'run_0.mcap').read_bytes()
        cut = tmp_path / 'cut.mcap'
        cut.write_bytes(data[:len(data) // 2])
        with client() as viewer, replaying(cut, *PAUSED, 'rate:=10') as process:
            ears = ByteEars(viewer, *TOPICS)
            assert call(viewer, 'resume').success
            code, errors = process.wait()
            assert_clean(code, errors)
            with pytest.warns(RecordingWarning, match='no end'):
                wanted = recorded(cut, '/slider_state')
            ears.wait_for('/slider_state', wanted)
        assert 'was cut off: it is played as far as it goes' in errors
        assert 0 < len(wanted) < 301

    def test_a_damaged_bag_is_played_up_to_the_damage(self, tmp_path: Path) -> None:
        write_bag(tmp_path / 'run', FACTS, samples(3000), [], {})
        file = tmp_path / 'run' / 'run_0.mcap'
        damage(file)
        code, errors = ended_at_once('replay_node', f'bag:={file}', 'rate:=100')
        assert (code, 'Traceback' in errors) == (2, False)
        assert f'replay_node: {file}: damaged after 1.' in errors

    @pytest.mark.parametrize(('arguments', 'reported'), [
        ([], "bag = '' is refused: must be the folder of a run"),
        (['bag:=nowhere'], 'nowhere: no recorded run there'),
        (['bag:=BAG', 'rate:=0'], 'rate = 0 is refused: must be a number, > 0'),
        (['bag:=BAG', 'start_offset:=0.4'], 'start_offset = 0.4 is refused: must be at most 0.3 s'),
        (['bag:=BAG', 'topics:=[nothing]'], "topics = 'nothing' is refused: must be in the recording: "),
        (['bag:=BAG', 'reit:=2.0'], 'did you mean rate?'),
        (['bag:=BAG', 'mode:=commands', 'clock:=40.0'], 'clock = 40.0 is refused'),
        (['bag:=BAG', 'axis:=/feed_axis'], "axis = '/feed_axis' is refused: must be omitted"),
        (['bag:=BAG', 'mode:=commands', 'axis:=/a//b'], "axis = '/a//b' is refused"),
        (['bag:=OTHER'], 'use the version that recorded it'),
        (['bag:=UNKNOWN'], 'no definition of nobody_msgs/msg/Nothing'),
        (['bag:=UNKNOWN', 'mode:=commands'], 'neither drive velocities nor forces'),
    ])
    def test_refused_in_one_line(self, bag: Path, tmp_path: Path, arguments: list[str], reported: str) -> None:
        bags = {'BAG': bag, 'OTHER': another(tmp_path / 'other.mcap', SLIDER_STATE.type, 'RIHS01_0'),
                'UNKNOWN': another(tmp_path / 'unknown.mcap', 'nobody_msgs/msg/Nothing', '')}
        for name, path in bags.items():
            arguments = [argument.replace(name, str(path)) for argument in arguments]
        assert reported in refusal_of('replay_node', *arguments)

    @pytest.mark.parametrize('topic', ['', '/a b', '/../x', '/\x1b[31m', '/' + 'x' * 5000])
    def test_a_topic_by_a_name_that_ros_refuses(self, tmp_path: Path, topic: str) -> None:
        line = refusal_of('replay_node', f'bag:={another(tmp_path / "odd.mcap", CLOCK.type, "", topic)}')
        assert line.startswith('replay_node: topic = ')
        assert '\x1b' not in line

    def test_a_node_that_is_no_axis(self, bag: Path) -> None:
        """The replay itself, which answers on the services for parameters as any node does."""
        code, errors = ended_at_once('replay_node', f'bag:={bag}', 'mode:=commands', 'axis:=replay')
        assert (code, 'Traceback' in errors) == (2, False)
        assert "replay_node: axis = 'replay' is refused: must be a sim_node; this node has no time.mode" in errors


def another(path: Path, type_name: str, type_hash: str, topic: str = '/slider_state') -> Path:
    """Write a bag of a message of another type, under another name."""
    with path.open('wb') as stream:
        writer = Writer(stream)
        writer.start('ros2', 'another')
        schema_id = writer.register_schema(type_name, 'ros2msg', b'')
        channel = writer.register_channel(topic, 'cdr', schema_id, {'topic_type_hash': type_hash})
        writer.add_message(channel, 0, b'\0\1\0\0\0', 0)
        writer.finish()  # type: ignore[no-untyped-call]
    return path
