# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Everything recorded, back onto its topics: for viewers."""

from collections.abc import Iterator, Sequence
from functools import partial
from importlib import import_module
from typing import Any

from rclpy.exceptions import NameValidationException
from rclpy.node import Node

from ...bags.bag_files import RecordedTopic
from ...core.errors import InputError
from ...recording import QosProfile, schema
from ...recording.reader import Recording
from ..environment import refusing
from ..node.endpoints import qos
from .player import Act, nothing
from .span import PlayedSpan

# Publishers of recorded topics: types as installed, quality of service as recorded, bytes as they are.

_DEPTH = 1000


def publisher_of(node: Node, topic: RecordedTopic) -> Any:
    """Create the publisher of a topic; raises InputError or RecordingError when its bytes mean nothing here."""
    if topic.encoding != 'cdr' or topic.type.count('/') != 2:
        raise InputError(topic.name, f'{topic.type} in {topic.encoding}', 'a ROS 2 message in CDR',
                         'name those to be played with topics')
    installed = schema(topic.type)
    if topic.type_hash not in ('', installed.hash):
        raise InputError(topic.name, topic.type_hash, f'{installed.hash}, the hash of {topic.type} here',
                         'it was recorded with another definition: use the version that recorded it')
    with refusing('topic', topic.name, NameValidationException):
        return node.create_publisher(message_class(topic.type), topic.name, qos(_offered(topic.qos)))


def _offered(recorded: QosProfile) -> QosProfile:
    """Return what to offer: as recorded, but what is sent faster than it was may wait longer for its readers.

    A depth is nobody's business but the publisher's, except where late joiners get so many messages.
    """
    if recorded.durability == 'transient_local':
        return recorded
    return recorded._replace(depth=max(recorded.depth, _DEPTH))


def message_class(type_name: str) -> Any:
    """Return the class of 'package/msg/Name'; raises InputError when its Python package is not installed."""
    package, kind, name = type_name.split('/')
    try:
        return getattr(import_module(f'{package}.{kind}'), name)
    except (ImportError, AttributeError):
        raise InputError('type', type_name, 'installed with its Python package', 'source its workspace') from None


class States:
    """The script of recorded topics, within a span of the recording."""

    def __init__(self, node: Node, recording: Recording, topics: Sequence[str], span: PlayedSpan) -> None:
        self.begin = span.begin
        self._recording, self._span = recording, span
        self._out = {name: publisher_of(node, recording.topics[name]) for name in topics}

    def prepare(self) -> None:
        """Do nothing: viewers come and go."""

    def acts(self) -> Iterator[Act]:
        """Yield the messages, each at its log time."""
        for message in self._recording.messages(self._out, self._span.begin, self._span.end):
            yield Act(message.log_time, partial(self._out[message.topic].publish, message.data))
        yield Act(self._span.end, nothing)
