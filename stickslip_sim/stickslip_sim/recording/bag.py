# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""A run folder that ROS tools read as a bag: metadata.yaml and one MCAP file."""

import os
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import NoReturn

from mcap.records import Message

from ..core.errors import RecordingError
from ..core.version import __version__
from .blocks import to_yaml
from .mcap_chunk import MessageBlock
from .mcap_file import McapFile
from .metadata import MessageTally, information, write_metadata
from .schemas import schema
from .topics import Topic

CHUNK_SIZE = 64 * 1024  # a larger chunk takes longer to close than a step may wait
METADATA = 'stickslip'  # the record that says what simulated the run
_MEDIA = {'.yaml': 'application/yaml', '.json': 'application/json'}
_SEQUENCE_MASK = 0xFFFFFFFF  # MCAP has 32 bits for it; the message itself has the whole step


class BagWriter:
    """Writes the messages of a run into a new folder; not safe to be used from two threads at once.

    `attachments` (by file name) and `metadata` are there from the start, so that a run that is cut off can still be
    run again.  Every method raises RecordingError when the disk refuses.
    """

    def __init__(
        self, folder: Path | str, topics: Sequence[Topic], attachments: Mapping[str, bytes],
        metadata: Mapping[str, str],
    ) -> None:
        self.folder = Path(os.path.abspath(folder))
        self.path = self.folder / f'{self.folder.name}_0.mcap'
        self._topics = list(topics)
        self._schemas = {topic.type: schema(topic.type) for topic in topics}
        self._metadata = dict(metadata)
        self._tally = MessageTally([0] * len(topics))
        _make(self.folder)
        try:
            self._file = _File(self.path)
        except OSError as error:
            self.folder.rmdir()
            _refuse(self.path, error)
        try:
            self._mcap = McapFile(self._file, CHUNK_SIZE, f'stickslip_sim {__version__}')
            self._begin(attachments)
        except OSError as error:
            self.abandon()
            _remove(self.folder)
            _refuse(self.path, error)

    @property
    def counts(self) -> dict[str, int]:
        """Messages written so far, by topic."""
        return {topic.name: count for topic, count in zip(self._topics, self._tally.counts, strict=True)}

    @property
    def on_disk(self) -> int:
        """How many of them the operating system has; the others wait for their chunk to fill."""
        return self._mcap.on_disk

    def write(self, topic_index: int, data: bytes, log_time_ns: int, publish_time_ns: int, sequence: int) -> None:
        """Add a message (CDR) to the topic at that place in the list of topics."""
        try:
            self._mcap.add_message(Message(topic_index + 1, log_time_ns, data, publish_time_ns,
                                           sequence & _SEQUENCE_MASK))
        except OSError as error:
            _refuse(self.path, error)
        self._tally.add(topic_index, log_time_ns)

    def write_block(self, block: MessageBlock) -> None:
        """Add messages whose channels are the places of their topics in the list, from 1 on."""
        try:
            self._mcap.add_block(block)
        except OSError as error:
            _refuse(self.path, error)
        self._tally.add_many(block.channels - 1, block.times)

    def attach(self, attachments: Mapping[str, bytes]) -> None:
        """Add attachments by file name while the run goes on."""
        try:
            self._attach(attachments, self._tally.last)
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
            self._attach(attachments or {}, self._tally.last)
            self._add_information()
            self._mcap.finish()
            self._file.close()
            write_metadata(self.folder, self._information())
        except OSError as error:
            self.abandon()
            _refuse(self.path, error)

    def abandon(self) -> None:
        """Close the file as it is, without an index; it can be read like that of a process that was killed."""
        self._file.close()

    def _begin(self, attachments: Mapping[str, bytes]) -> None:
        self._mcap.add_metadata(METADATA, self._metadata)
        self._attach(attachments, 0)
        ids = {name: self._mcap.add_schema(name, 'ros2msg', known.text.encode())
               for name, known in self._schemas.items()}
        for topic in self._topics:
            self._mcap.add_channel(topic.name, 'cdr', ids[topic.type], {
                'offered_qos_profiles': to_yaml([topic.qos.as_yaml()]),
                'topic_type_hash': self._schemas[topic.type].hash,
            })
        self._add_information()
        write_metadata(self.folder, self._information())

    def _add_information(self) -> None:
        """Put what metadata.yaml says into the file too, at both ends as rosbag2 does: one end may be lost."""
        self._mcap.add_metadata('rosbag2', {'serialized_metadata': to_yaml(self._information())})

    def _attach(self, attachments: Mapping[str, bytes], log_time_ns: int) -> None:
        for name, data in attachments.items():
            media = _MEDIA.get(Path(name).suffix, 'application/octet-stream')
            self._mcap.add_attachment(log_time_ns, name, media, data)

    def _information(self) -> dict[str, object]:
        hashes = {name: known.hash for name, known in self._schemas.items()}
        return information(self.path.name, self._topics, hashes, self._tally, self._metadata)


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
        raise RecordingError(f'{folder} exists and is never overwritten; choose another name or remove it')
    try:
        folder.parent.mkdir(parents=True, exist_ok=True)
        folder.mkdir()
    except OSError as error:
        raise RecordingError(f'{folder} cannot be made: {error.strerror}; choose a place that can be written') from None


def _remove(folder: Path) -> None:
    for path in folder.iterdir():
        path.unlink()
    folder.rmdir()


def _refuse(path: Path, error: OSError) -> NoReturn:
    raise RecordingError(f'{path}: {error.strerror or error}; the recording ends here') from None
