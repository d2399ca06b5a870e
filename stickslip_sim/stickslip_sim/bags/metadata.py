# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""What `metadata.yaml` of a bag says: rosbag2, version 9."""

import json
import os
import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from .topics import Topic, Yaml

# Plain data as YAML text in block style, the way rosbag2 writes its metadata.

_PLAIN = re.compile(r'[A-Za-z/][\w/. -]*[\w/.-]|[A-Za-z/]')
_OTHER_THAN_TEXT = frozenset(['true', 'false', 'null', 'yes', 'no', 'on', 'off', 'y', 'n', 'nan', 'inf'])


def to_yaml(data: object) -> str:
    """Return mappings, lists, texts, integers, booleans and None as YAML, without a line end at the end."""
    return '\n'.join(_lines(data))


def _lines(data: object) -> Iterator[str]:
    if isinstance(data, Mapping) and data:
        for key, value in data.items():
            yield from _entry(f'{_scalar(str(key))}:', value)
    elif isinstance(data, list) and data:
        for item in data:
            first, *rest = _lines(item)
            yield f'- {first}'
            yield from (f'  {line}' for line in rest)
    else:
        yield _scalar(data)


def _entry(key: str, value: object) -> Iterator[str]:
    if isinstance(value, (Mapping, list)) and value:
        yield key
        yield from (f'  {line}' for line in _lines(value))
    else:
        yield f'{key} {_scalar(value)}'


def _scalar(value: object) -> str:
    if value is None:
        return '~'
    if isinstance(value, str) and _PLAIN.fullmatch(value) and value.lower() not in _OTHER_THAN_TEXT:
        return value
    return json.dumps(value, ensure_ascii=False)  # JSON is YAML: quoted texts, numbers, true, {} and []


@dataclass(slots=True)
class MessageTally:
    """How many messages a bag holds, and of which span of time (ns)."""

    counts: list[int]
    total: int = 0
    first: int = 0
    last: int = 0

    def add(self, topic_index: int, time_ns: int) -> None:
        """Count a message."""
        self.first = min(self.first, time_ns) if self.total else time_ns
        self.last = max(self.last, time_ns)
        self.counts[topic_index] += 1
        self.total += 1

    def add_many(self, topic_indexes: NDArray[np.int64], times_ns: NDArray[np.int64]) -> None:
        """Count messages."""
        begin = int(times_ns.min())
        self.first = min(self.first, begin) if self.total else begin
        self.last = max(self.last, int(times_ns.max()))
        for topic_index, count in enumerate(np.bincount(topic_indexes).tolist()):
            self.counts[topic_index] += count
        self.total += len(times_ns)


class BagFile(NamedTuple):
    """One file of a bag, and what is in it."""

    file: str
    tally: MessageTally


def ros_distro() -> str:
    """Return the ROS distro of the sourced workspace, empty without one."""
    return os.environ.get('ROS_DISTRO', '')


def information(
    parts: Sequence[BagFile], topics: Sequence[Topic], hashes: Mapping[str, str], custom: Mapping[str, str],
) -> Yaml:
    """Return the body of metadata.yaml of a bag of one or more files; `hashes` by type name."""
    tallies = [part.tally for part in parts]
    filled = [tally for tally in tallies if tally.total] or tallies[:1]
    first, last = min(tally.first for tally in filled), max(tally.last for tally in filled)
    counts = [sum(of_topic) for of_topic in zip(*(tally.counts for tally in tallies))]
    return {
        'version': 9,
        'storage_identifier': 'mcap',
        'duration': {'nanoseconds': last - first},
        'starting_time': {'nanoseconds_since_epoch': first},
        'message_count': sum(tally.total for tally in tallies),
        'topics_with_message_count': [
            _topic(topic, hashes[topic.type], count) for topic, count in zip(topics, counts, strict=True)
        ],
        'compression_format': '',
        'compression_mode': '',
        'relative_file_paths': [part.file for part in parts],
        'files': [{'path': part.file, 'starting_time': {'nanoseconds_since_epoch': part.tally.first},
                   'duration': {'nanoseconds': part.tally.last - part.tally.first},
                   'message_count': part.tally.total} for part in parts],
        'custom_data': dict(custom),
        'ros_distro': ros_distro(),
    }


def write_metadata(folder: Path, body: Yaml) -> None:
    """Write metadata.yaml so that a reader sees the old one or the new one, never a part; raises OSError."""
    temporary = folder / 'metadata.yaml.tmp'
    temporary.write_text(to_yaml({'rosbag2_bagfile_information': body}) + '\n', encoding='utf-8')
    temporary.replace(folder / 'metadata.yaml')


def _topic(topic: Topic, type_hash: str, count: int) -> Yaml:
    return {
        'topic_metadata': {
            'name': topic.name,
            'type': topic.type,
            'serialization_format': 'cdr',
            'offered_qos_profiles': [topic.qos.as_yaml()],
            'type_description_hash': type_hash,
        },
        'message_count': count,
    }
