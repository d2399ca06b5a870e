# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Runs on disk: what is written, and that other people's readers read it."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest
import yaml
from mcap.reader import make_reader
from mcap_ros2.decoder import DecoderFactory
from rosbags.highlevel import AnyReader

from stickslip_sim.core.errors import RecordingError, RecordingWarning
from stickslip_sim.core.types import Sample
from stickslip_sim.recording import (
    messages,
    open_bag,
    open_run,
    receipt_file,
    recorded_topics,
    samples_of,
    write_bag,
)
from tests.support.recorded_runs import FACTS, events, friction_force, mode_event, samples, slider_state

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


def same(found: dict[str, list[Any]], folder: Path) -> None:
    for topic, wanted in expected(folder).items():
        assert [fields(message, like) for message, like in zip(found[topic], wanted, strict=True)] == wanted


class TestReaders:
    def test_rosbags(self, bag: Path) -> None:
        found: dict[str, list[Any]] = {}
        with AnyReader([bag]) as reader:
            assert {name: topic.msgcount for name, topic in reader.topics.items()} == COUNTS
            assert (reader.start_time, reader.duration) == (0, 119_000_001)
            for connection, time_ns, data in reader.messages():
                message = reader.deserialize(data, connection.msgtype)
                stamp = message.header.stamp  # type: ignore[attr-defined]
                assert time_ns == stamp.sec * 10**9 + stamp.nanosec
                found.setdefault(connection.topic, []).append(message)
        same(found, bag)

    def test_mcap_ros2(self, bag: Path) -> None:
        found: dict[str, list[Any]] = {}
        with (bag / 'first_0.mcap').open('rb') as stream:
            reader = make_reader(stream, validate_crcs=True, decoder_factories=[DecoderFactory()])
            for item in reader.iter_decoded_messages():
                assert item.message.log_time == item.message.publish_time
                assert item.message.sequence == getattr(item.decoded_message, 'step', item.message.sequence)
                found.setdefault(item.channel.topic, []).append(item.decoded_message)
        same(found, bag)

    def test_ours(self, bag: Path) -> None:
        run = open_bag(bag)
        found: dict[str, list[Any]] = {}
        for message in run.messages():
            found.setdefault(message.topic, []).append(run.decode(message))
        same(found, bag)
        assert run.is_complete
        assert run.counts == COUNTS
        assert run.receipt == {'periods': 3, 'end': 'inf'}
        assert run.attachments['scene.yaml'].decode() == FACTS.scene_text
        assert run.metadata['stickslip'].items() >= {'scene': 'made_up', 'seed': '7', 'rate': '1000.0'}.items()
        assert run.metadata['stickslip']['hot_path'] in ('compiled', 'plain python')

    def test_columns(self, bag: Path) -> None:
        columns = open_bag(bag).columns('/slider_state')
        wanted = [slider_state(k, sample, 0) for k, sample in enumerate(samples(120))]
        for name in ('step', 'time', 'position', 'drive_force', 'rest_time', 'mode', 'direction'):
            assert columns[name].tolist() == [values[name] for values in wanted]
        assert columns['log_time'].tolist() == [k * 1_000_000 for k in range(120)]
        assert columns['sequence'].tolist() == list(range(120))
        assert open_bag(bag).columns('/timing')['lateness_max'].size == 0

    def test_columns_of_a_message_with_text(self, bag: Path) -> None:
        columns = open_bag(bag).columns('/run_info')
        assert (columns['seed'].tolist(), columns['rate'].tolist()) == ([7], [1000.0])

    def test_columns_of_nothing(self, bag: Path) -> None:
        with pytest.raises(RecordingError, match=r'no topic /nothing; there are /slider_state, '):
            open_bag(bag).columns('/nothing')

    def test_commands_bear_the_first_step_they_act_on(self, bag: Path) -> None:
        run = open_bag(bag)
        assert [m.sequence for m in run.messages(['/drive_velocity'])] == [1, 51]
        assert [m.sequence for m in run.messages(['/external_force'])] == [1, 21, 31]


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
