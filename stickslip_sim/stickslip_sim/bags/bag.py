# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""A run folder that ROS tools read as a bag: metadata.yaml and one MCAP file."""

import json
import os
import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import NamedTuple, NoReturn

import numpy as np
from numpy.typing import NDArray

from ..core.errors import RecordingError
from ..core.version import __version__
from .mcap_file import McapFile, MessageBlock
from .schemas import schema
from .topics import Topic, Yaml

# What `metadata.yaml` of a bag says: rosbag2, version 9.

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




class Packing(NamedTuple):
    """How many bytes make a chunk, and how hard zstd tries, from 1 on."""

    chunk_size: int
    level: int


IN_STEP = Packing(64 * 1024, 3)      # a larger chunk takes longer to close than a step may wait
AT_ONCE = Packing(1024 * 1024, 1)    # of many messages that are known
METADATA = 'stickslip'  # the record that says what simulated the run
NEXT_FILE = 'stickslip_next'   # at the end of a file that was split: the one in which the bag goes on
_WALL = 'wall'       # log times in the metadata, where they are not simulation time
_MEDIA = {'.yaml': 'application/yaml', '.json': 'application/json'}


def is_by_wall_clock(metadata: Mapping[str, str]) -> bool:
    """Return whether the log times of a run are its stamps; its publish times are simulation time then, and not stamps.

    `metadata` is what it says of what simulated it.
    """
    return metadata.get('log_time') == _WALL


class Split(NamedTuple):
    """When a bag goes on in another file: at so many bytes, or after so long (ns); None: never."""

    max_size: int | None = None
    max_duration: int | None = None


ONE_FILE = Split()


class BagWriter:
    """Writes the messages of a run into a new folder; not safe to be used from two threads at once.

    `attachments` (by file name) and `metadata` are there from the start, so that a run that is cut off can still be
    run again.  Each file of a bag that is split is whole by itself; metadata.yaml lists the whole ones, and the first.
    Every method raises RecordingError when the disk refuses.
    """

    def __init__(
        self, folder: Path | str, topics: Sequence[Topic], attachments: Mapping[str, bytes],
        metadata: Mapping[str, str], split: Split = ONE_FILE, packing: Packing = IN_STEP,
    ) -> None:
        self.folder = Path(os.path.abspath(folder))
        self._topics = list(topics)
        self._schemas = {topic.type: schema(topic.type) for topic in topics}
        self._channel_facts = [{'offered_qos_profiles': to_yaml([topic.qos.as_yaml()]),
                                'topic_type_hash': self._schemas[topic.type].hash} for topic in topics]
        self._attachments, self._metadata = dict(attachments), dict(metadata)
        self._is_by_wall_clock = is_by_wall_clock(metadata)
        self._split, self._packing = split, packing
        self._parts: list[BagFile] = []       # the last of them is under way
        self._of_others = 0                # messages in the other files
        _make(self.folder)
        self._file, self._mcap = self._begun()

    @property
    def path(self) -> Path:
        """The file under way."""
        return self.folder / self._parts[-1].file

    @property
    def counts(self) -> dict[str, int]:
        """Messages written so far, by topic."""
        return {topic.name: sum(part.tally.counts[place] for part in self._parts)
                for place, topic in enumerate(self._topics)}

    @property
    def on_disk(self) -> int:
        """How many of them the operating system has; the others wait for their chunk to fill."""
        return self._of_others + self._mcap.on_disk

    def write(self, topic_index: int, data: bytes, log_time_ns: int, publish_time_ns: int, sequence: int) -> None:
        """Add a message (CDR), with simulation time and stamp, to the topic at that place in the list of topics."""
        if self._is_by_wall_clock:
            log_time_ns, publish_time_ns = publish_time_ns, log_time_ns
        try:
            if self._is_full(log_time_ns):
                self._go_on()
            self._mcap.add_message(topic_index + 1, log_time_ns, data, publish_time_ns, sequence)
        except OSError as error:
            _refuse(self.path, error)
        self._tally.add(topic_index, log_time_ns)

    def write_block(self, block: MessageBlock) -> None:
        """Add messages whose channels are the places of their topics in the list, from 1 on; never splits the bag."""
        try:
            self._mcap.add_block(block)
        except OSError as error:
            _refuse(self.path, error)
        self._tally.add_many(block.channels - 1, block.times)

    def attach(self, attachments: Mapping[str, bytes]) -> None:
        """Add attachments by file name while the run goes on."""
        try:
            self._attach(self._mcap, attachments, self._tally.last)
        except OSError as error:
            _refuse(self.path, error)

    def flush(self) -> None:
        """Hand everything to the operating system: a process that is killed afterwards loses nothing of it."""
        try:
            self._mcap.flush()
        except OSError as error:
            _refuse(self.path, error)

    def close(self, attachments: Mapping[str, bytes] | None = None) -> None:
        """Finish the bag: attachments, index, counts in metadata.yaml."""
        try:
            self._attach(self._mcap, attachments or {}, self._tally.last)
            self._finish()
            write_metadata(self.folder, self._information(self._parts))
        except OSError as error:
            self.abandon()
            _refuse(self.path, error)

    def abandon(self) -> None:
        """Close the file as it is, without an index; it can be read like that of a process that was killed."""
        self._file.close()

    @property
    def _tally(self) -> MessageTally:
        return self._parts[-1].tally

    def _is_full(self, time_ns: int) -> bool:
        size, duration = self._split
        return self._tally.total > 0 and ((size is not None and self._file.size >= size)
                                          or (duration is not None and time_ns - self._tally.first >= duration))

    def _go_on(self) -> None:
        """Finish the file and go on in the next one."""
        self._mcap.add_metadata(NEXT_FILE, {'file': self._file_name(len(self._parts))})
        self._finish()
        written = self._mcap.on_disk
        self._file, self._mcap = self._begun()
        self._of_others += written

    def _finish(self) -> None:
        self._add_information(self._mcap, self._parts[-1:])
        self._mcap.finish()
        self._file.close()

    def _begun(self) -> tuple['_File', McapFile]:
        """Begin a file with all that it needs to be read by itself."""
        whole = list(self._parts)
        part = BagFile(self._file_name(len(whole)), MessageTally([0] * len(self._topics)))
        path = self.folder / part.file
        try:
            file = _File(path)
        except OSError as error:
            if not whole:
                self.folder.rmdir()
            _refuse(path, error)
        try:
            mcap = McapFile(file, self._packing.chunk_size, f'stickslip_sim {__version__}', self._packing.level)
            self._begin(mcap, part, len(whole))
            write_metadata(self.folder, self._information(whole or [part]))
        except OSError as error:
            file.close()
            path.unlink()    # nothing of a file that could not be begun
            if not whole:
                _remove(self.folder)
            _refuse(path, error)
        self._parts.append(part)
        return file, mcap

    def _begin(self, mcap: McapFile, part: BagFile, number: int) -> None:
        mcap.add_metadata(METADATA, {**self._metadata, **({'part': str(number)} if number else {})})
        self._attach(mcap, self._attachments, 0)
        ids = {name: mcap.add_schema(name, 'ros2msg', known.text.encode()) for name, known in self._schemas.items()}
        for topic, facts in zip(self._topics, self._channel_facts, strict=True):
            mcap.add_channel(topic.name, 'cdr', ids[topic.type], facts)
        self._add_information(mcap, [part])

    def _add_information(self, mcap: McapFile, parts: Sequence[BagFile]) -> None:
        """Put what metadata.yaml says of a file into it, at both ends as rosbag2 does: one end may be lost."""
        mcap.add_metadata('rosbag2', {'serialized_metadata': to_yaml(self._information(parts))})

    def _attach(self, mcap: McapFile, attachments: Mapping[str, bytes], log_time_ns: int) -> None:
        for name, data in attachments.items():
            media = _MEDIA.get(Path(name).suffix, 'application/octet-stream')
            mcap.add_attachment(log_time_ns, name, media, data)

    def _information(self, parts: Sequence[BagFile]) -> dict[str, object]:
        hashes = {name: known.hash for name, known in self._schemas.items()}
        return information(parts, self._topics, hashes, self._metadata)

    def _file_name(self, number: int) -> str:
        return f'{self.folder.name}_{number}.mcap'


class _File:
    """A new file without a buffer: what `write` took is with the operating system, and closing cannot fail late."""

    def __init__(self, path: Path) -> None:
        self._raw = open(path, 'xb', buffering=0)  # noqa: SIM115
        self.size = 0

    def write(self, data: bytes) -> int:
        view = memoryview(data)
        while view:
            view = view[self._raw.write(view) or 0:]
        self.size += len(data)
        return len(data)

    def close(self) -> None:
        self._raw.close()


def _make(folder: Path) -> None:
    if os.path.lexists(folder):
        raise RecordingError(f'{folder} exists and is not overwritten; choose another name or remove it')
    try:
        folder.parent.mkdir(parents=True, exist_ok=True)
        folder.mkdir()
    except OSError as error:
        raise RecordingError(f'{folder} cannot be created: {error.strerror}; choose a writable place') from None


def _remove(folder: Path) -> None:
    for path in folder.iterdir():
        path.unlink()
    folder.rmdir()


def _refuse(path: Path, error: OSError) -> NoReturn:
    raise RecordingError(f'{path}: {error.strerror or error}; the recording ends here') from None
