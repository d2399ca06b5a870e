# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Parts of the replay, without ROS: the bag, its time line, the player, and recorded orders as bytes."""

import threading
from collections.abc import Iterator
from functools import partial
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from mcap.writer import CompressionType, Writer
from rcl_interfaces.msg import Parameter, ParameterEvent, ParameterType, ParameterValue
from rclpy.serialization import serialize_message

from stickslip_msgs.msg import RigEvent
from stickslip_sim.bags.topics import PARAMETER_EVENTS, RECORDED, RIG_EVENT
from stickslip_sim.core.errors import RecordingError
from stickslip_sim.recording import QosProfile, Topic, write_bag
from stickslip_sim.recording.reader import Recording
from stickslip_sim.ros.replay.orders import Request, is_timeout, request_of
from stickslip_sim.ros.replay.player import Act, Player, Timeline
from stickslip_sim.simulation import RigEventKind
from tests.support.made_up_texts import accepts_or_refuses
from tests.support.recorded_runs import FACTS, damage, events, samples
from tests.support.waiting import wait_for

pytestmark = pytest.mark.filterwarnings("ignore:module 'sre_:DeprecationWarning")

SECOND = 1_000_000_000


class StillClock:
    """A clock that goes only when it is asked to."""

    def __init__(self) -> None:
        self.time = 5 * SECOND

    def now(self) -> int:
        return self.time

    def sleep(self, seconds: float) -> None:
        raise NotImplementedError


class TestTimeline:
    def test_goes_at_a_rate_that_may_change(self) -> None:
        clock = StillClock()
        timeline = Timeline(2.0, clock=clock)
        timeline.move(10 * SECOND)
        clock.time += SECOND
        assert timeline.now() == 12 * SECOND
        assert timeline.left(13 * SECOND) == 0.5
        timeline.change_rate(0.25)
        clock.time += 4 * SECOND
        assert timeline.now() == 13 * SECOND
        assert timeline.left(14 * SECOND) == 4.0
        assert timeline.left(12 * SECOND) == -4.0

    def test_stands_still_and_goes_on(self) -> None:
        clock = StillClock()
        timeline = Timeline(1.0, is_paused=True, clock=clock)
        timeline.move(SECOND)
        clock.time += SECOND
        assert timeline.now() == SECOND
        assert timeline.left(SECOND) == float('inf')
        timeline.pause(False)
        clock.time += SECOND
        timeline.pause(True)
        timeline.pause(True)
        clock.time += SECOND
        assert timeline.now() == 2 * SECOND

    def test_no_lateness_adds_up(self) -> None:
        clock = StillClock()
        timeline = Timeline(1.1, clock=clock)
        start = clock.time
        for _ in range(1000):
            clock.time += 999_999
            timeline.now()
        assert timeline.now() == round((clock.time - start) * 1.1)


class Counting:
    """A script that notes its acts."""

    begin = 0

    def __init__(self, times: list[int]) -> None:
        self.times = times
        self.done: list[int] = []

    def prepare(self) -> None:
        pass

    def acts(self) -> Iterator[Act]:
        for number, at in enumerate(self.times):
            yield Act(at, partial(self.done.append, number))


def test_a_player_that_is_paused_plays_one_at_a_time() -> None:
    script = Counting([0, 0, 7200 * SECOND])
    player = Player(script, Timeline(1.0, is_paused=True), threading.Event(), 0.0, loop=False)
    player.start()
    for number in range(3):
        assert script.done == list(range(number))
        assert player.play_next()
        wait_for(partial(script.done.__contains__, number), f'message {number}')
    wait_for(lambda: player.is_over, 'the end')
    assert not player.play_next()
    player.end()


@pytest.fixture(scope='module')
def bag(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp('bags') / 'run'
    write_bag(folder, FACTS, samples(2000), events(), {})
    return folder


@pytest.fixture(scope='module')
def whole(bag: Path) -> bytes:
    return next(bag.glob('*.mcap')).read_bytes()


class TestRecording:
    def test_topics_span_and_messages_from_any_time_on(self, bag: Path) -> None:
        recording = Recording(bag)
        assert {name: topic.qos for name, topic in recording.topics.items()} == {
            f'/{topic.name.lstrip("/")}': topic.qos for topic in RECORDED}
        assert (recording.begin, recording.end, recording.is_complete) == (0, 1_999_000_000, True)
        messages = list(recording.messages(['/slider_state'], 1_500_000_000, 1_600_000_000))
        assert [message.sequence for message in messages] == list(range(1500, 1601))
        everything = [message.log_time for message in recording.messages(recording.topics, 0, recording.end)]
        assert everything == sorted(everything)

    def test_cut_off(self, whole: bytes, tmp_path: Path) -> None:
        (tmp_path / 'cut.mcap').write_bytes(whole[:len(whole) // 2])
        recording = Recording(tmp_path / 'cut.mcap')
        assert not recording.is_complete
        steps = [message.sequence for message in recording.messages(['/slider_state'], 0, recording.end)]
        assert steps == list(range(len(steps)))
        assert 500 < len(steps) < 1500
        assert recording.end == (len(steps) - 1) * 1_000_000

    def test_none_can_be_read(self, whole: bytes, tmp_path: Path) -> None:
        path, empty = tmp_path / 'cut.mcap', foreign(tmp_path, {}, messages=0).read_bytes()
        for data, reported in ((b'', 'not an MCAP file'), (whole[:5], 'not an MCAP file'),
                               (whole[:20], 'not an MCAP file'), (b'nothing of that kind', 'not an MCAP file'),
                               (whole[:60], 'it has no readable message'), (empty, 'it has no readable message')):
            path.write_bytes(data)
            with pytest.raises(RecordingError, match=reported):
                Recording(path)
        with pytest.raises(RecordingError, match='no recorded run there'):
            Recording(tmp_path / 'nowhere')


class TestOtherRecorders:
    """Bags that other programs write."""

    def test_offers_of_older_versions_none_and_several(self, tmp_path: Path) -> None:
        time = '{sec: 9223372036, nsec: 854775807}'
        older = (f'- {{history: 1, depth: 5, reliability: 2, durability: 1, deadline: {time}, lifespan: {time},'
                 f' liveliness: 1, liveliness_lease_duration: {time}, avoid_ros_namespace_conventions: false}}')
        one = QosProfile(1, 'best_effort').as_yaml()
        several = str([one, {**one, 'durability': 'transient_local'}])
        for metadata, qos in (({'offered_qos_profiles': older}, QosProfile(5, 'best_effort', 'transient_local')),
                              ({'offered_qos_profiles': several}, QosProfile(10)), ({}, QosProfile(10))):
            topic = Recording(foreign(tmp_path, metadata)).topics['/chatter']
            assert topic.qos == qos
            assert (topic.type, topic.encoding, topic.type_hash) == ('std_msgs/msg/Empty', 'cdr', '')

    @pytest.mark.parametrize('offer', ['- {history: 1}', '[', '- 5', '{a: b}'])
    def test_offers_that_are_none(self, tmp_path: Path, offer: str) -> None:
        with pytest.raises(RecordingError, match='/chatter has no readable quality of service'):
            Recording(foreign(tmp_path, {'offered_qos_profiles': offer}))

    @pytest.mark.parametrize('compression', [CompressionType.LZ4, CompressionType.NONE])
    def test_other_compressions(self, tmp_path: Path, compression: CompressionType) -> None:
        recording = Recording(foreign(tmp_path, {}, compression=compression))
        assert [message.data for message in recording.messages(['/chatter'], 0, 9)] == [b'\0\1\0\0\0'] * 3

    def test_a_length_counts_from_the_first_message_on(self, tmp_path: Path) -> None:
        """Log times are since 1970."""
        recording = Recording(foreign(tmp_path, {}, since=1_700_000_000 * SECOND))
        assert recording.begin > 1_700_000_000 * SECOND
        assert recording.length == 2e-9
        damage(recording.path)
        with pytest.raises(RecordingError, match=r'damaged after 0 s'):
            list(recording.messages(['/chatter'], recording.begin, recording.end))

    def test_without_figures_at_its_end(self, tmp_path: Path) -> None:
        """It is played as it was written."""
        recording = Recording(foreign(tmp_path, {}, use_statistics=False))
        assert recording.is_complete
        assert [m.log_time for m in recording.messages(['/chatter'], recording.begin, recording.end)] == [3, 2, 1]


def foreign(folder: Path, metadata: dict[str, str], messages: int = 3,
            compression: CompressionType = CompressionType.ZSTD, use_statistics: bool = True,
            since: int = 0) -> Path:
    """Write a bag as another program might: messages at 1, 2, ... ns after `since`, the later ones first."""
    path = folder / 'foreign.mcap'
    with path.open('wb') as stream:
        writer = Writer(stream, compression=compression, use_statistics=use_statistics)
        writer.start('ros2', 'another')
        schema = writer.register_schema('std_msgs/msg/Empty', 'ros2msg', b'')
        channel = writer.register_channel('/chatter', 'cdr', schema, metadata)
        for at in reversed(range(1, messages + 1)):
            writer.add_message(channel, since + at, b'\0\1\0\0\0', since + at, 0)
        writer.finish()  # type: ignore[no-untyped-call]
    return path


MASS = Parameter(name='axis.mass', value=ParameterValue(type=ParameterType.PARAMETER_DOUBLE, double_value=300.0))


@pytest.fixture(scope='module')
def orders() -> list[tuple[Topic, bytes]]:
    fault = RigEvent(kind=int(RigEventKind.FAULT_INJECTED), id='dry', fault='friction_scale')
    change = ParameterEvent(node='/feed_axis', changed_parameters=[MASS])
    return [(RIG_EVENT, serialize_message(fault)), (PARAMETER_EVENTS, serialize_message(change))]


@settings(max_examples=150)
@given(place=st.integers(0, 200), cut=st.integers(0, 9), data=st.binary(max_size=9))
def test_orders(orders: list[tuple[Topic, bytes]], place: int, cut: int, data: bytes) -> None:
    for kind, whole in orders:
        assert isinstance(request_of(kind, whole), Request)
        for sent in (whole[:place], whole[:place] + data + whole[place + cut:], data):
            accepts_or_refuses(request_of, kind, sent)
            accepts_or_refuses(is_timeout, kind, sent)


@pytest.mark.parametrize('data', [b'', b'\x00\x01\x00\x01'])   # no header; padding where there is no content
def test_no_order_is_refused_with_what_to_do(data: bytes) -> None:
    for kind in (RIG_EVENT, PARAMETER_EVENTS):
        with pytest.raises(RecordingError, match='is damaged: play what is before with playback_duration'):
            request_of(kind, data)
