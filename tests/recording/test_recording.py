# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Runs on disk: what is written, where it goes, and that other people's readers read it."""

import threading
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import yaml
from mcap.reader import make_reader
from mcap_ros2.decoder import DecoderFactory
from rosbags.highlevel import AnyReader
from rosbags.rosbag2 import StoragePlugin, Writer

from stickslip_sim.bags.schemas import store_of
from stickslip_sim.bags.topics import MODE_EVENT, SLIDER_STATE
from stickslip_sim.core.errors import RecordingError, RecordingWarning
from stickslip_sim.core.types import EventKind, Mode, Sample
from stickslip_sim.inputs import load_scene
from stickslip_sim.recording import (
    RECORDED,
    BagWriter,
    RecorderThread,
    messages,
    open_bag,
    open_run,
    receipt_file,
    recorded_topics,
    samples_of,
    schema,
    write_bag,
)
from stickslip_sim.recording.messages import Packer
from stickslip_sim.recording.recordings import Recordings, stamped_folder
from tests.support.recorded_runs import FACTS, events, friction_force, mode_event, samples, slider_state
from tests.support.waiting import wait_for

COUNTS = {
    '/slider_state': 120, '/friction_force': 120, '/mode_event': 5, '/drive_velocity': 2, '/external_force': 3,
    '/rig_event': 0, '/run_info': 1, '/timing': 0, '/parameter_events': 0,
}
Values = dict[str, Any]


@pytest.fixture
def bag(tmp_path: Path) -> Path:
    folder = tmp_path / 'runs' / 'first'
    assert write_bag(folder, FACTS, samples(120), events(), {'periods': 3, 'end': 'inf'}) == COUNTS
    return folder


def expected(folder: Path) -> dict[str, list[Values]]:
    """Return the fields of every message of the bag, by topic, straight from the outputs of the simulation."""
    states = list(samples(120))
    stamps = [k * 1_000_000 for k in range(120)]
    steps = [1, 11, 11, 40, 100]
    return {
        '/slider_state': [slider_state(k, s, t) for k, (s, t) in enumerate(zip(states, stamps))],
        '/friction_force': [friction_force(k, s, t) for k, (s, t) in enumerate(zip(states, stamps))],
        '/mode_event': [mode_event(k, e, e.instant.nanoseconds) for k, e in zip(steps, events())],
        '/drive_velocity': commands('velocity', {0: 0.002, 50: -0.001}),
        '/external_force': commands('force', {0: 0.0, 20: 5.0, 30: 0.0}),
        '/run_info': [messages.run_info(FACTS, 0, 0, str(folder))],
    }


def commands(field: str, values: dict[int, float]) -> list[Values]:
    """Return the fields of commands by the ms at which they were given."""
    return [{'header': messages.header(at * 1_000_000), field: value} for at, value in values.items()]


def fields(message: Any, like: Values) -> Values:
    """Return the named fields of a decoded message of any class."""
    return {
        name: fields(getattr(message, name), value) if isinstance(value, dict) else getattr(message, name)
        for name, value in like.items()
    }


def of_rosbags(bag: Path) -> dict[str, list[Any]]:
    found: dict[str, list[Any]] = {}
    with AnyReader([bag]) as reader:
        assert {name: topic.msgcount for name, topic in reader.topics.items()} == COUNTS
        assert (reader.start_time, reader.duration) == (0, 119_000_001)
        for connection, time_ns, data in reader.messages():
            message = reader.deserialize(data, connection.msgtype)
            stamp = message.header.stamp  # type: ignore[attr-defined]
            assert time_ns == stamp.sec * 10**9 + stamp.nanosec
            found.setdefault(connection.topic, []).append(message)
    return found


def of_mcap(bag: Path) -> dict[str, list[Any]]:
    found: dict[str, list[Any]] = {}
    with (bag / 'first_0.mcap').open('rb') as stream:
        reader = make_reader(stream, validate_crcs=True, decoder_factories=[DecoderFactory()])
        for item in reader.iter_decoded_messages():
            assert item.message.log_time == item.message.publish_time
            assert item.message.sequence == getattr(item.decoded_message, 'step', item.message.sequence)
            found.setdefault(item.channel.topic, []).append(item.decoded_message)
    return found


def of_ours(bag: Path) -> dict[str, list[Any]]:
    run, found = open_bag(bag), dict[str, list[Any]]()
    for message in run.messages():
        found.setdefault(message.topic, []).append(run.decode(message))
    return found


@pytest.mark.parametrize('read', [of_rosbags, of_mcap, of_ours])
def test_readers_find_what_was_written(bag: Path, read: Callable[[Path], dict[str, list[Any]]]) -> None:
    found = read(bag)
    for topic, wanted in expected(bag).items():
        assert [fields(message, like) for message, like in zip(found[topic], wanted, strict=True)] == wanted


class TestOurReader:
    def test_what_it_knows_of_the_run(self, bag: Path) -> None:
        run = open_bag(bag)
        assert run.is_complete
        assert run.counts == COUNTS
        assert run.receipt == {'periods': 3, 'end': 'inf'}
        assert run.attachments['scene.yaml'].decode() == FACTS.scene_text
        assert run.metadata['stickslip'].items() >= {'scene': 'made_up', 'seed': '7', 'rate': '1000.0'}.items()
        assert run.metadata['stickslip']['hot_path'] in ('compiled', 'plain python')
        steps = {topic: [message.sequence for message in run.messages([topic])]    # the first that a command acts on
                 for topic in ('/drive_velocity', '/external_force')}
        assert steps == {'/drive_velocity': [1, 51], '/external_force': [1, 21, 31]}

    def test_columns(self, bag: Path) -> None:
        run = open_bag(bag)
        columns, of_text = run.columns('/slider_state'), run.columns('/run_info')
        wanted = [slider_state(k, sample, 0) for k, sample in enumerate(samples(120))]
        for name in ('step', 'time', 'position', 'drive_force', 'rest_time', 'mode', 'direction'):
            assert columns[name].tolist() == [values[name] for values in wanted]
        assert columns['log_time'].tolist() == [k * 1_000_000 for k in range(120)]
        assert columns['sequence'].tolist() == list(range(120))
        assert run.columns('/timing')['lateness_max'].size == 0
        assert (of_text['seed'].tolist(), of_text['rate'].tolist()) == ([7], [1000.0])
        with pytest.raises(RecordingError, match=r'no topic /nothing; there are /slider_state, '):
            run.columns('/nothing')

class TestLayout:
    def test_metadata(self, bag: Path) -> None:
        body = yaml.safe_load((bag / 'metadata.yaml').read_text())['rosbag2_bagfile_information']
        assert (body['version'], body['storage_identifier'], body['message_count']) == (9, 'mcap', sum(COUNTS.values()))
        assert body['relative_file_paths'] == ['first_0.mcap']
        assert body['duration'] == {'nanoseconds': 119_000_000}
        assert body['starting_time'] == {'nanoseconds_since_epoch': 0}
        assert body['custom_data']['scene_hash'] == FACTS.scene_hash
        assert body['custom_data']['seed'] == '7'  # a text: rosbag2 reads nothing else there
        run = open_bag(bag)
        assert yaml.safe_load(run.metadata['rosbag2']['serialized_metadata']) == body
        for entry in body['topics_with_message_count']:
            topic, channel = entry['topic_metadata'], run.channel_metadata[entry['topic_metadata']['name']]
            assert entry['message_count'] == COUNTS[topic['name']]
            assert topic['offered_qos_profiles'] == yaml.safe_load(channel['offered_qos_profiles'])
            assert topic['type_description_hash'] == channel['topic_type_hash']

    def test_file(self, bag: Path) -> None:
        with (bag / 'first_0.mcap').open('rb') as stream:
            reader = make_reader(stream)
            summary = reader.get_summary()
            assert reader.get_header().profile == 'ros2'
            assert summary is not None
            assert summary.statistics is not None
            assert summary.statistics.message_count == sum(COUNTS.values())
            assert {schema.encoding for schema in summary.schemas.values()} == {'ros2msg'}
            assert {chunk.compression for chunk in summary.chunk_indexes} == {'zstd'}

    def test_true_from_the_start(self, tmp_path: Path) -> None:
        writer = open_run(tmp_path / 'new', FACTS, recorded_topics('/cell'))
        body = yaml.safe_load((tmp_path / 'new' / 'metadata.yaml').read_text())['rosbag2_bagfile_information']
        assert body['message_count'] == 0
        assert [topic['topic_metadata']['name'] for topic in body['topics_with_message_count']][:2] == [
            '/cell/slider_state', '/cell/friction_force']
        with pytest.warns(RecordingWarning, match='no end'):
            run = open_bag(tmp_path / 'new')
        assert not run.is_complete
        assert run.attachments['scene.yaml'].decode() == FACTS.scene_text
        assert run.metadata['stickslip']['scene_hash'] == FACTS.scene_hash
        writer.close(receipt_file({'steps': 0}))
        with AnyReader([tmp_path / 'new']) as reader:
            assert reader.message_count == 0

    def test_chunks_are_small(self, tmp_path: Path) -> None:
        write_bag(tmp_path / 'long', FACTS, samples(2000), [], {})
        with (tmp_path / 'long' / 'long_0.mcap').open('rb') as stream:
            summary = make_reader(stream).get_summary()
        assert summary is not None
        assert len(summary.chunk_indexes) > 5
        assert max(chunk.uncompressed_size for chunk in summary.chunk_indexes) < 70_000

    def test_samples_in_arrays(self) -> None:
        columns = {name: np.array([sample[i] for sample in samples(9)]) for i, name in enumerate(Sample._fields)}
        assert list(samples_of(columns)) == list(samples(9))

    def test_a_long_run_wraps_the_sequence_of_mcap_only(self, tmp_path: Path) -> None:
        writer = open_run(tmp_path / 'long', FACTS)
        writer.write(0, b'\0\1\0\0', 1, 1, 2**32 + 5)
        writer.close()
        assert [message.sequence for message in open_bag(tmp_path / 'long').messages()] == [5]


def with_events(folder: Path, namespace: str, **changes: Any) -> Path:
    """Write the transitions of the made-up run, with other fields."""
    packer = Packer(MODE_EVENT)
    writer = BagWriter(folder, recorded_topics(namespace), {}, {})
    for event in events():
        writer.write(RECORDED.index(MODE_EVENT), packer.pack(0, 1, event._replace(**changes)), 0, 0, 1)
    writer.close()
    return folder


def test_transitions_come_back_as_they_were(tmp_path: Path) -> None:
    found = open_bag(with_events(tmp_path / 'run', '/cell/press')).events
    for event, expected in zip(found, events(), strict=True):
        assert event.kind is expected.kind
        for name in set(event._fields) - {'drive_position'}:
            assert getattr(event, name) == getattr(expected, name), name


@pytest.mark.parametrize('changes', [{'kind': len(EventKind)}, {'mode': len(Mode)}])
def test_transitions_of_unknown_kinds(changes: dict[str, int], tmp_path: Path) -> None:
    with pytest.raises(RecordingError, match='unknown kinds; recorded by another version'):
        _ = open_bag(with_events(tmp_path / 'run', '/', **changes)).events


def test_messages_of_another_version(tmp_path: Path) -> None:
    text = schema(SLIDER_STATE.type).text.replace('float64 drive_position', 'float64 spindle_position')
    with Writer(tmp_path / 'old', version=9, storage_plugin=StoragePlugin.MCAP) as writer:
        writer.add_connection('/slider_state', SLIDER_STATE.type, typestore=store_of({SLIDER_STATE.type: text}))
    run = open_bag(tmp_path / 'old')
    assert run.columns_of(SLIDER_STATE, ['time'])['time'].size == 0
    with pytest.raises(RecordingError, match='/slider_state has no drive_position; recorded by another version'):
        run.columns_of(SLIDER_STATE, ['time', 'drive_position'])


@pytest.mark.parametrize('ending', ['/', '//', '/.'])
def test_a_folder_as_a_shell_completes_it(tmp_path: Path, ending: str) -> None:
    scene = load_scene('paper_fig8', {'record.folder': f'{tmp_path}/runs/first{ending}'})
    recordings = Recordings('/', scene)
    recordings.begin(scene)
    recordings.end({})
    assert open_bag(tmp_path / 'runs' / 'first').is_complete


def test_no_message_definition_is_read_while_the_axis_runs(tmp_path: Path) -> None:
    """It takes longer than a step."""
    scene = load_scene('paper_fig8', {'record.folder': f'{tmp_path}/runs/first'})
    recordings = Recordings('/', scene)
    schema.cache_clear()
    recordings.prepare()
    read = schema.cache_info().misses
    recordings.begin(scene)
    recordings.end({})
    assert schema.cache_info().misses == read > 0


def test_folders_of_one_second_have_numbers(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Also where a link to nowhere has the name."""
    monkeypatch.setattr('time.gmtime', lambda: (2026, 3, 1, 12, 0, 7, 6, 60, 0))
    (tmp_path / 'axis_20260301T120007Z').mkdir()
    (tmp_path / 'axis_20260301T120007Z_2').symlink_to(tmp_path / 'nowhere')
    assert stamped_folder(tmp_path, 'axis') == tmp_path / 'axis_20260301T120007Z_3'
    assert stamped_folder(tmp_path, 'mill') == tmp_path / 'mill_20260301T120007Z'


# The recorder: it never waits, never overwrites, and what is cut off can be read.

class TestRefusals:
    @pytest.mark.parametrize(('made', 'asked', 'reported'), [
        ('here/', 'here', '/here exists and is not overwritten; choose another name'),
        ('here/metadata.yaml', 'here', '/here exists and is not overwritten; choose another name'),
        ('here', 'here', 'here.*; choose a'), ('here', 'here/below', 'here.*; choose a'),
        ('here', 'here/far/below', 'here.*; choose a'),
        ('here', '/proc/run', '^/proc/run cannot be created: .*; choose a writable place$'),
    ])
    def test_to_write(self, tmp_path: Path, made: str, asked: str, reported: str) -> None:
        mine = tmp_path / made
        (mine if made.endswith('/') else mine.parent).mkdir(exist_ok=True)
        if not made.endswith('/'):
            mine.write_text('mine')
        before = sorted(tmp_path.rglob('*'))
        with pytest.raises(RecordingError, match=reported):
            open_run(tmp_path / asked, FACTS)
        assert sorted(tmp_path.rglob('*')) == before
        assert mine.is_dir() or mine.read_text() == 'mine'

    @pytest.mark.parametrize('name', ['nowhere', 'empty', 'text.mcap'])
    def test_to_read(self, tmp_path: Path, name: str) -> None:
        (tmp_path / 'empty').mkdir()
        (tmp_path / 'text.mcap').write_text('not a bag, but long enough to be one')
        with pytest.raises(RecordingError, match=name):
            open_bag(tmp_path / name)

class TestThread:
    def test_all_that_was_put_is_there(self, tmp_path: Path) -> None:
        recorder = RecorderThread(open_run(tmp_path / 'run', FACTS))
        for step in range(5000):
            recorder.put(step % 2, step.to_bytes(4, 'little'), step, step, step)
        assert recorder.close(receipt_file({'steps': 5000}))
        recorder.put(0, b'', 0, 0, 0)    # too late
        assert (recorder.written, recorder.dropped, recorder.failure) == (5000, 1, None)
        run = open_bag(tmp_path / 'run')
        assert [int.from_bytes(message.data, 'little') for message in run.messages()] == list(range(5000))
        assert run.receipt == {'steps': 5000}

    def test_a_full_queue_drops_and_counts(self, tmp_path: Path) -> None:
        writer = open_run(tmp_path / 'run', FACTS)
        gate = threading.Event()
        write = writer.write

        def slow(*item: Any) -> None:
            gate.wait()
            write(*item)

        writer.write = slow  # type: ignore[assignment, method-assign]
        recorder = RecorderThread(writer, capacity=10)
        for step in range(100):
            recorder.put(0, b'', step, step, step)
        gate.set()
        assert recorder.close()
        assert (recorder.written, recorder.dropped) == (10, 90)
        assert [message.sequence for message in open_bag(tmp_path / 'run').messages()] == list(range(10))

    @pytest.mark.filterwarnings('ignore::stickslip_sim.core.errors.RecordingWarning')   # it is still being written
    def test_few_messages_reach_the_disk_within_a_second(self, tmp_path: Path) -> None:
        recorder = RecorderThread(open_run(tmp_path / 'run', FACTS))
        recorder.put(0, b'only one', 0, 0, 0)
        (first,) = wait_for(lambda: list(open_bag(tmp_path / 'run').messages()), 'the message in the file')
        assert first.data == b'only one'
        recorder.close()

    def test_any_failure_is_reported_and_stops_nobody(self, tmp_path: Path) -> None:
        recorder = RecorderThread(open_run(tmp_path / 'run', FACTS))
        recorder.put(99, b'', 0, 0, 0)  # no such topic
        recorder.put(0, b'', 0, 0, 0)
        assert wait_for(lambda: recorder.failure, 'the failure')
        recorder.put(0, b'', 0, 0, 0)
        assert not recorder.close()
        assert recorder.dropped == 3

def test_a_file_cut_anywhere_gives_what_is_whole(tmp_path: Path) -> None:
    bag = tmp_path / 'first'
    write_bag(bag, FACTS, samples(120), events(), {})
    whole = (bag / 'first_0.mcap').read_bytes()
    steps = [message.sequence for message in open_bag(bag).messages()]
    file = tmp_path / 'cut.mcap'
    for size in range(60, len(whole), 293):
        file.write_bytes(whole[:size])
        with pytest.warns(RecordingWarning, match='no end'):
            run = open_bag(file)
        found = [message.sequence for message in run.messages()]
        assert not run.is_complete
        assert found == steps[:len(found)]
