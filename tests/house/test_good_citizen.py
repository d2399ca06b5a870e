# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""A bag of a real node among other people's tools: readers, the ROS graph, the files of rosbag2, layouts of viewers."""

import json
import os
import xml.etree.ElementTree as ElementTree
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any, NamedTuple

import pytest
import yaml
from mcap.reader import make_reader
from mcap_ros2.decoder import DecoderFactory
from rosbags.highlevel import AnyReader

from stickslip_sim.bags.schemas import store_of
from stickslip_sim.bags.topics import RECORDED, Topic
from stickslip_sim.core.errors import RecordingWarning
from stickslip_sim.recording import open_bag, schema

pytest.importorskip('rclpy')
from rclpy.serialization import deserialize_message

from stickslip_sim.ros.node.endpoints import message_type
from tests.support.eventful_runs import eventful_run
from tests.support.repository import ROOT
from tests.support.ros_nodes import Client
from tests.support.waiting import wait_for

pytestmark = [pytest.mark.ros, pytest.mark.slow]

PACKAGE = ROOT / 'stickslip_sim'
TOPICS = [topic.resolved() for topic in RECORDED]
ENDLESS = {'sec': 9223372036, 'nsec': 854775807}


class Recorded(NamedTuple):
    """A bag, its metadata.yaml while it was written, and what the graph said then."""

    folder: Path
    metadata: Mapping[str, Any]
    offers: Mapping[str, tuple[str, str, str]]    # hash of the type, reliability and durability


@pytest.fixture(scope='module')
def recorded(tmp_path_factory: pytest.TempPathFactory) -> Recorded:
    folder = tmp_path_factory.mktemp('citizen') / 'run'
    with eventful_run(folder) as axis:
        offers = {topic.name: offer(axis, topic) for topic in TOPICS}
        metadata = information(folder)
    return Recorded(folder, metadata, offers)


def offer(axis: Client, topic: Topic) -> tuple[str, str, str]:
    """Return what the node offers, or asks for where others publish."""
    graph = axis.node
    info, = wait_for(lambda: [info for info in (*graph.get_publishers_info_by_topic(topic.name),
                                                *graph.get_subscriptions_info_by_topic(topic.name))
                              if info.node_name == 'feed_axis'], topic.name)
    quality = info.qos_profile
    return str(info.topic_type_hash), quality.reliability.name.lower(), quality.durability.name.lower()


def information(folder: Path) -> Any:
    return yaml.safe_load((folder / 'metadata.yaml').read_text())['rosbag2_bagfile_information']


def file_of(folder: Path) -> Path:
    return folder / f'{folder.name}_0.mcap'


def plain(message: Any, like: Any) -> Any:
    """Return a message of any reader as plain values; the fields are those of the ROS message `like`."""
    if hasattr(like, 'get_fields_and_field_types'):
        return {name: plain(getattr(message, name), getattr(like, name)) for name in like.get_fields_and_field_types()}
    if isinstance(like, (str, bytes)) or not hasattr(like, '__len__'):
        return message
    return [plain(item, like_item) for item, like_item in zip(message, like, strict=True)]


class TestReaders:
    """Every message of every topic, read by others as rclpy reads it."""

    @staticmethod
    def assert_as_rclpy_reads(found: list[tuple[str, int, Any]], folder: Path) -> None:
        run = open_bag(folder)
        assert len(found) == sum(run.counts.values())
        for topic in TOPICS:
            wanted = sorted(run.messages([topic.name]), key=lambda message: message.log_time)
            assert wanted, topic.name
            of_topic = [(time, content) for name, time, content in found if name == topic.name]
            for (time, content), recorded in zip(of_topic, wanted, strict=True):
                message = deserialize_message(recorded.data, message_type(topic))
                assert time == recorded.log_time
                assert repr(plain(content, message)) == repr(plain(message, message))

    def test_rosbags(self, recorded: Recorded) -> None:
        counts = open_bag(recorded.folder).counts
        with AnyReader([file_of(recorded.folder)]) as reader:
            assert {name: topic.msgcount for name, topic in reader.topics.items()} == counts
        with AnyReader([recorded.folder]) as reader:
            assert {name: topic.msgcount for name, topic in reader.topics.items()} == counts
            self.assert_as_rclpy_reads([(connection.topic, time, reader.deserialize(data, connection.msgtype))
                                        for connection, time, data in reader.messages()], recorded.folder)

    def test_mcap_ros2(self, recorded: Recorded) -> None:
        with file_of(recorded.folder).open('rb') as stream:
            reader = make_reader(stream, validate_crcs=True, decoder_factories=[DecoderFactory()])
            self.assert_as_rclpy_reads([(item.channel.topic, item.message.log_time, item.decoded_message)
                                        for item in reader.iter_decoded_messages()], recorded.folder)


def test_type_hashes_and_quality_are_those_of_the_graph(recorded: Recorded) -> None:
    run = open_bag(recorded.folder)
    for topic in TOPICS:
        channel, offered = run.channel_metadata[topic.name], recorded.offers[topic.name]
        quality, = yaml.safe_load(channel['offered_qos_profiles'])
        assert (channel['topic_type_hash'], quality['reliability'], quality['durability']) == offered


class TestFilesOfRosbag2:
    """Version 9 of its metadata, as `rosbag2_storage` of Jazzy writes and reads it (yaml.hpp, qos.cpp)."""

    def test_while_it_is_recorded(self, recorded: Recorded, tmp_path: Path) -> None:
        """No message is promised that a reader might miss, every topic is named, and the file says the same."""
        body = recorded.metadata
        assert (body['message_count'], body['duration'], body['starting_time']) == (
            0, {'nanoseconds': 0}, {'nanoseconds_since_epoch': 0})
        assert names_and_counts(body) == {topic.name: 0 for topic in TOPICS}
        data = file_of(recorded.folder).read_bytes()
        (tmp_path / 'cut.mcap').write_bytes(data[:len(data) // 2])
        with pytest.warns(RecordingWarning, match='no end'):
            assert yaml.safe_load(open_bag(tmp_path / 'cut.mcap').metadata['rosbag2']['serialized_metadata']) == body

    def test_at_the_end(self, recorded: Recorded) -> None:
        body, run = information(recorded.folder), open_bag(recorded.folder)
        times = [message.log_time for message in run.messages()]
        assert yaml.safe_load(run.metadata['rosbag2']['serialized_metadata']) == body
        assert body['message_count'] == len(times)
        assert body['starting_time'] == {'nanoseconds_since_epoch': min(times)}
        assert body['duration'] == {'nanoseconds': max(times) - min(times)}
        assert names_and_counts(body) == run.counts
        assert body['files'] == [{'path': 'run_0.mcap', 'starting_time': body['starting_time'],
                                  'duration': body['duration'], 'message_count': len(times)}]
        with file_of(recorded.folder).open('rb') as stream:
            statistics = getattr(make_reader(stream).get_summary(), 'statistics', None)
        assert statistics is not None
        assert (statistics.message_start_time, statistics.message_end_time) == (min(times), max(times))

    def test_keys_types_and_their_order(self, recorded: Recorded) -> None:
        body = information(recorded.folder)
        assert list(body) == [
            'version', 'storage_identifier', 'duration', 'starting_time', 'message_count', 'topics_with_message_count',
            'compression_format', 'compression_mode', 'relative_file_paths', 'files', 'custom_data', 'ros_distro']
        assert (body['version'], body['storage_identifier']) == (9, 'mcap')
        assert body['ros_distro'] == os.environ['ROS_DISTRO']
        assert all(isinstance(value, str) for value in body['custom_data'].values())
        for entry in body['topics_with_message_count']:
            assert list(entry) == ['topic_metadata', 'message_count']
            topic = entry['topic_metadata']
            assert list(topic) == ['name', 'type', 'serialization_format', 'offered_qos_profiles',
                                   'type_description_hash']
            known = next(one.qos for one in TOPICS if one.name == topic['name'])
            assert topic['offered_qos_profiles'] == [{
                'history': 'keep_last', 'depth': known.depth, 'reliability': known.reliability,
                'durability': known.durability, 'deadline': ENDLESS, 'lifespan': ENDLESS, 'liveliness': 'automatic',
                'liveliness_lease_duration': ENDLESS, 'avoid_ros_namespace_conventions': False}]

    def test_in_block_style(self, recorded: Recorded) -> None:
        text = (recorded.folder / 'metadata.yaml').read_text()
        assert text.startswith('rosbag2_bagfile_information:\n  version: 9\n  storage_identifier: mcap\n  duration:\n')
        assert '\n        offered_qos_profiles:\n          - history: keep_last\n            depth: 1\n' in text

    def test_a_schema_is_what_rosbag2_would_store(self) -> None:
        """Depth first, sorted by name, each definition once (docs/message_definition_encoding.md of rosbag2)."""
        root, *rest = schema('rcl_interfaces/msg/ParameterEvent').text.split('\n' + '=' * 80 + '\nMSG: ')
        assert root.startswith('# This message contains a parameter event.')
        assert [part.split('\n', 1)[0] for part in rest] == [
            'builtin_interfaces/Time', 'rcl_interfaces/Parameter', 'rcl_interfaces/ParameterValue']


def names_and_counts(body: Mapping[str, Any]) -> dict[str, int]:
    return {entry['topic_metadata']['name']: entry['message_count'] for entry in body['topics_with_message_count']}


class TestLayouts:
    """The programs themselves are not here: what their layouts name is what a run has."""

    MAIN = frozenset({('/slider_state', 'position'), ('/slider_state', 'velocity'), ('/friction_force', 'force'),
                      ('/slider_state', 'mode')})

    @pytest.fixture
    def numbers(self) -> set[tuple[str, str]]:
        """Return the topics of a run with their fields."""
        return {(topic.name, name) for topic in TOPICS
                for name, _ in store_of({topic.type: schema(topic.type).text}).fielddefs[topic.type][1]} - {
                    (topic.name, 'header') for topic in TOPICS}

    def test_plotjuggler(self, numbers: set[tuple[str, str]]) -> None:
        root = ElementTree.parse(PACKAGE / 'layouts' / 'plotjuggler.xml').getroot()
        curves = {(topic, field) for curve in root.iter('curve') for key, value in curve.attrib.items()
                  if key in ('curve_x', 'curve_y') or (key == 'name' and 'curve_x' not in curve.attrib)
                  for topic, _, field in [value.rpartition('/')]}
        assert self.MAIN <= curves <= numbers
        for splitter in root.iter('DockSplitter'):
            assert int(splitter.attrib['count']) == len(splitter) == len(splitter.attrib['sizes'].split(';'))

    def test_foxglove(self, numbers: set[tuple[str, str]]) -> None:
        layout = json.loads((PACKAGE / 'layouts' / 'foxglove.json').read_text())
        panels = layout['configById']
        assert sorted(leaves(layout['layout'])) == sorted(panels)
        paths = {(topic, field) for panel in panels.values()
                 for path in (*panel.get('paths', ()), *([panel['xAxisPath']] if 'xAxisPath' in panel else ()))
                 for topic, _, field in [path['value'].rpartition('.')]}
        assert self.MAIN <= paths <= numbers
        assert panels['RawMessages!run']['topicPath'] in [topic.name for topic in TOPICS]


def leaves(tree: Any) -> Iterator[str]:
    if isinstance(tree, str):
        yield tree
    else:
        yield from leaves(tree['first'])
        yield from leaves(tree['second'])
