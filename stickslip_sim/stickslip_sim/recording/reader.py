"""Reads runs back, also those of a process that was killed or of a disk that was full."""

import json
import struct
import warnings
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import zstandard
from mcap.exceptions import McapError
from mcap.records import Attachment, Channel, Chunk, Footer, McapRecord, Message, Metadata, Schema
from mcap.stream_reader import CRCValidationError, StreamReader, breakup_chunk
from numpy.typing import NDArray
from rosbags.serde import SerdeError
from rosbags.typesys import TypesysError
from rosbags.typesys.store import Typestore

from ..errors import InputError, RecordingError, RecordingWarning
from ..scene import Scene, parse_scene
from ..words import Event
from .layout import Layout, layout_of, numbers_of, texts_of
from .run import RECEIPT_FILE, SCENE_FILE
from .schemas import store_of
from .tables import events_of

# What a file that ends anywhere makes the reader stumble over (RuntimeError: lz4).
_CUT_OFF = (McapError, CRCValidationError, struct.error, zstandard.ZstdError, RuntimeError, UnicodeDecodeError)
_COMPRESSIONS = ('', 'zstd', 'lz4')


class RecordedMessage(NamedTuple):
    """One message as it stands in the file; times in ns."""

    topic: str
    type: str
    sequence: int
    log_time: int
    publish_time: int
    data: bytes  # CDR


@dataclass
class Run:
    """A recorded run; messages are read from the file each time, in the order in which they were written."""

    path: Path
    is_complete: bool = False
    attachments: dict[str, bytes] = field(default_factory=dict)
    metadata: dict[str, dict[str, str]] = field(default_factory=dict)
    schemas: dict[str, str] = field(default_factory=dict)   # definitions by type name
    topics: dict[str, str] = field(default_factory=dict)    # type names by topic
    channel_metadata: dict[str, dict[str, str]] = field(default_factory=dict)
    counts: dict[str, int] = field(default_factory=dict)

    @property
    def receipt(self) -> dict[str, Any]:
        """The final figures; empty when the run was cut off."""
        return dict(json.loads(self.attachments.get(RECEIPT_FILE, b'{}')))

    @cached_property
    def scene(self) -> Scene:
        """The scene that travels in the run; raises RecordingError when there is none that this version can read."""
        if SCENE_FILE not in self.attachments:
            raise RecordingError(f'{self.path}: no {SCENE_FILE} travels in it; give a run that stickslip recorded')
        try:
            return parse_scene(self.attachments[SCENE_FILE].decode(errors='replace'))
        except InputError as error:
            raise RecordingError(f'{self.path}: its {SCENE_FILE} is none of this version: {error}') from None

    @property
    def events(self) -> list[Event]:
        """The transitions in the order of time; the drive position is not recorded with them (NaN)."""
        return events_of(self)

    def messages(self, topics: Iterable[str] | None = None) -> Iterator[RecordedMessage]:
        """Yield the messages of some topics (None: all)."""
        wanted = set(self.topics if topics is None else topics)
        channels: dict[int, Channel] = {}
        for record in _records(self.path):
            if isinstance(record, Channel):
                channels[record.id] = record
            elif isinstance(record, Message) and (topic := channels[record.channel_id].topic) in wanted:
                yield RecordedMessage(topic, self.topics[topic], record.sequence, record.log_time,
                                      record.publish_time, record.data)

    def decode(self, message: RecordedMessage) -> Any:
        """Return the message as an object with its fields as attributes; raises RecordingError when it is damaged."""
        try:
            return self._store.deserialize_cdr(message.data, message.type)
        except (SerdeError, struct.error, ValueError, IndexError) as error:
            raise RecordingError(f'{self.path}: {message.topic}: no {message.type} at {message.log_time} ns: {error}'
                                 ) from None

    def columns(self, topic: str) -> dict[str, NDArray[Any]]:
        """Return a topic as one array for each field that is a number or a text.

        `log_time` (simulation time) and `publish_time` are in ns; `sequence` is the step.  A name without a slash at
        its begin is that of the one topic that ends so.  Raises RecordingError when there is none.
        """
        topic = self._resolved(topic)
        messages = list(self.messages([topic]))
        columns = self._fields(self.topics[topic], [message.data for message in messages])
        for name in ('log_time', 'publish_time', 'sequence'):
            columns[name] = np.array([getattr(message, name) for message in messages], dtype=np.int64)
        return columns

    def layout(self, topic: str) -> Layout:
        """Return where a topic has its numbers; raises RecordingError when they have no fixed places."""
        layout = layout_of(self._store, self.topics[topic])
        if layout is None:
            raise RecordingError(f'{self.path}: {topic} has other fields than a step; recorded by another version?')
        return layout

    def frame(self, topic: str) -> Any:
        """Return `columns` as a pandas.DataFrame; raises RecordingError without pandas."""
        try:
            import pandas
        except ImportError:
            raise RecordingError('a frame needs pandas: pip install pandas; columns() needs nothing') from None
        return pandas.DataFrame(self.columns(topic))

    def _resolved(self, topic: str) -> str:
        names = [name for name in self.topics if name == topic or name.endswith(f'/{topic}')]
        if len(names) == 1 or topic in names:
            return topic if topic in names else names[0]
        found = f'{len(names)} topics' if names else 'no topic'
        raise RecordingError(f'{self.path}: {found} {topic}; there are {", ".join(self.topics) or "none"}')

    def _fields(self, type_name: str, data: list[bytes]) -> dict[str, NDArray[Any]]:
        layout = layout_of(self._store, type_name)
        if layout and all(len(item) == layout.size for item in data):
            rows = layout.unpack(data)
            return {name: rows[name].copy() for name in rows.dtype.names or ()}
        decoded = [self._store.deserialize_cdr(item, type_name) for item in data]
        return {
            name: np.array([getattr(message, name) for message in decoded], dtype=kind)
            for name, kind in numbers_of(self._store, type_name).items()
        } | {
            name: np.array([getattr(message, name) for message in decoded], dtype=object)
            for name in texts_of(self._store, type_name)
        }

    @cached_property
    def _store(self) -> Typestore:
        try:
            return store_of(self.schemas)
        except TypesysError as error:
            reason, *_ = str(error).splitlines()
            raise RecordingError(f'{self.path}: a definition of messages in it cannot be read: {reason}') from None


def read_run(path: Path | str) -> Run:
    """Return the run in a folder, or in an MCAP file by itself; raises RecordingError when there is none.

    A run without an end (its process was killed, its disk was full, or it is still being written) is read as far as it
    goes, with a RecordingWarning.
    """
    run = Run(_file_of(Path(path)))
    names: dict[int, str] = {}
    channels: dict[int, str] = {}
    for record in _records(run.path):
        if isinstance(record, Message):
            run.counts[channels[record.channel_id]] += 1
        elif isinstance(record, Schema) and record.id not in names:    # the index repeats them
            names[record.id] = record.name
            if record.encoding == 'ros2msg':
                run.schemas[record.name] = record.data.decode(errors='replace')
        elif isinstance(record, Channel) and record.id not in channels:
            channels[record.id] = record.topic
            run.topics[record.topic] = names.get(record.schema_id, '')    # other programs may give none
            run.channel_metadata[record.topic] = record.metadata
            run.counts[record.topic] = 0
        elif isinstance(record, Attachment):
            run.attachments[record.name] = record.data
        elif isinstance(record, Metadata):
            run.metadata[record.name] = record.metadata
        elif isinstance(record, Footer):
            run.is_complete = True
    if not run.is_complete:
        warnings.warn(f'{run.path} has no end: cut off, or still being written; {sum(run.counts.values())} messages are'
                      ' whole, and metadata.yaml does not count them', RecordingWarning, stacklevel=2)
    return run


def _file_of(path: Path) -> Path:
    files = sorted(path.glob('*.mcap')) if path.is_dir() else [path]
    for foreign in [*path.glob('*.mcap.*'), *path.glob('*.db3*')] if not files else []:
        raise RecordingError(f'{path}: {foreign.name} is not read, only .mcap is; decompress or convert it first '
                             '(zstd -d, ros2 bag convert)')
    if not files or not files[0].is_file():
        raise RecordingError(f'{path}: no recorded run there; give the folder of a run or an .mcap file')
    if len(files) > 1:
        raise RecordingError(f'{path}: {len(files)} .mcap files; give the one to read')
    return files[0]


def _records(path: Path) -> Iterator[McapRecord]:
    """Yield the records that are whole; a file that is cut off just ends earlier."""
    try:
        with path.open('rb') as stream:
            begin = True
            try:
                for record in StreamReader(stream, validate_crcs=True, emit_chunks=True).records:
                    begin = False
                    yield from _unpacked(path, record)
            except _CUT_OFF as error:
                if begin:
                    raise RecordingError(f'{path} is not an MCAP file: {error}') from None
    except OSError as error:
        raise RecordingError(f'{path}: {error.strerror}') from None


def _unpacked(path: Path, record: McapRecord) -> Iterable[McapRecord]:
    """Return the records of a chunk, or any other record by itself."""
    if not isinstance(record, Chunk):
        return [record]
    if record.compression not in _COMPRESSIONS:
        raise RecordingError(f'{path}: its chunks are compressed with {record.compression!r}; zstd, lz4 and none are '
                             'read: convert it first (mcap compress)')
    return breakup_chunk(record, validate_crc=True)
