# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The files of a bag, read by their summaries; one without an end, or without such a summary, as far as it goes."""

import re
from collections import Counter
from collections.abc import Callable, Collection, Iterable, Iterator, Sequence
from functools import cached_property
from heapq import heappop, heappush
from itertools import count
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from mcap import records
from numpy.typing import NDArray

from ..core.errors import RecordingError
from .bag import NEXT_FILE
from .mcap_file import Messages
from .mcap_records import CUT_OFF, contents, messages_at, record_at, summary_of
from .message_layout import FRAME_SIZE, layout_of, number_fields, row_kind, text_fields
from .schemas import Typestore
from .topics import QosProfile

MOST_BESIDE = 64 << 20   # bytes of all that a file holds beside messages
OVERHEAD = 300         # bytes of a record in memory beside its own
_PART = re.compile(r'(?P<name>.*)_(?P<number>0|[1-9]\d{0,8})\.mcap')
_DEFAULT_QOS = QosProfile(10)    # as rosbag2 plays what has none, or several


def files_of(path: Path) -> list[Path]:
    """Return the MCAP files of a bag in their order, given by its folder, or one of them by itself.

    Raises RecordingError when there is none, or one in between is missing, or they are not of one bag.
    """
    files = sorted(path.glob('*.mcap')) if path.is_dir() else [path]
    for foreign in [*path.glob('*.mcap.*'), *path.glob('*.db3*')] if not files else []:
        raise RecordingError(f'{path}: {foreign.name} is not read, only .mcap is; decompress or convert it first '
                             '(zstd -d, ros2 bag convert)')
    if not files or not files[0].is_file():
        raise RecordingError(f'{path}: no recorded run there; give the folder of a run or an .mcap file')
    return files if len(files) == 1 else _parts(path, files)


def _parts(path: Path, files: list[Path]) -> list[Path]:
    """Return the files of a bag that was split in the order of their numbers; raises RecordingError.

    The last one may be empty: its process was killed as it began the file, or is just about to write.  It is left out.
    """
    found = [_PART.fullmatch(file.name) for file in files]
    numbered = {int(match['number']): file for match, file in zip(found, files) if match}
    if len(numbered) < len(files) or len({match['name'] for match in found if match}) > 1:
        raise RecordingError(f'{path}: {len(files)} .mcap files; give the one to read')
    first, last = min(numbered), max(numbered)
    for number in range(first, last):
        if number not in numbered:
            name = numbered[first].name.rpartition('_')[0]
            raise RecordingError(f'{path}: {name}_{number}.mcap is missing; give a single part of the bag')
    parts = [numbered[number] for number in range(first, last + 1)]
    return parts[:-1] if goes_on_empty(parts[-2]) else parts


def goes_on_empty(part: Path) -> bool:
    """Return whether the next part of a bag is there, and empty."""
    match = _PART.fullmatch(part.name)
    behind = part.with_name(f'{match["name"]}_{int(match["number"]) + 1}.mcap') if match else part
    return behind.is_file() and behind.stat().st_size == 0


class RecordedTopic(NamedTuple):
    """A topic as it was recorded; `type_hash` is empty where the recorder did not know it."""

    name: str
    type: str
    encoding: str
    type_hash: str
    qos: QosProfile


class RecordedMessage(NamedTuple):
    """One message as it stands in the file; times in ns."""

    topic: str
    type: str
    sequence: int
    log_time: int
    publish_time: int
    data: bytes  # CDR

    def at(self, is_by_wall_clock: bool) -> 'RecordedMessage':
        """Return the message with simulation time as its log time, of a bag that may be by the wall clock."""
        return self._replace(log_time=self.publish_time, publish_time=self.log_time) if is_by_wall_clock else self


class _Chunk(NamedTuple):
    """The log times (ns) of a chunk's first and last message, and where it is."""

    begin: int
    end: int
    offset: int


class RecordedFile:
    """One file of a bag: its `channels` and `schemas` by number, `counts` of messages by channel.

    `span` are the log times (ns) of its first and last message, None without a message; `begin` is where the bag
    begins, which messages about damage count from.  A file `whose_bytes_are_checked` has no damage anywhere, which
    takes reading all of it; otherwise damage is found where it is met.  Raises RecordingError.
    """

    def __init__(self, path: Path, whose_bytes_are_checked: bool) -> None:
        self.path, self._is_checked = path, whose_bytes_are_checked
        if not self._take_summary():
            self._take_all()
        self.begin = self.span[0] if self.span else 0

    @cached_property
    def topics(self) -> dict[str, RecordedTopic]:
        """The topics with what was offered, by name; raises RecordingError when that cannot be read."""
        topics: dict[str, RecordedTopic] = {}
        for channel in self.channels.values():
            if channel.topic not in topics:
                topics[channel.topic] = RecordedTopic(
                    channel.topic, self.type_of(channel), channel.message_encoding,
                    channel.metadata.get('topic_type_hash', ''), self._qos_of(channel))
        return topics

    @cached_property
    def attachments(self) -> dict[str, bytes]:
        """What is attached, by name; raises RecordingError."""
        return {record.name: record.data for record in self._indexed(records.AttachmentIndex)
                if isinstance(record, records.Attachment)}

    @cached_property
    def metadata(self) -> list[records.Metadata]:
        """Its records of names and texts; raises RecordingError."""
        return [record for record in self._indexed(records.MetadataIndex) if isinstance(record, records.Metadata)]

    @property
    def next_file(self) -> str:
        """In which file the bag goes on; empty where it ends here."""
        return next((record.metadata.get('file', '') for record in reversed(self.metadata)
                     if record.name == NEXT_FILE), '')

    def type_of(self, channel: records.Channel) -> str:
        """Return the name of the type of a channel; empty without one, as other programs may have it."""
        schema = self.schemas.get(channel.schema_id)
        return schema.name if schema else ''

    def blocks(self) -> Iterator[Messages]:
        """Yield all messages as they stand in the chunks."""
        return (record for record in contents(self.path) if isinstance(record, Messages))

    def numbers_of(self, topics: Collection[str]) -> list[int]:
        """Return the channels of topics."""
        return [number for number, channel in self.channels.items() if channel.topic in topics]

    def written(self, topics: Collection[str]) -> Iterator[RecordedMessage]:
        """Yield the messages of topics in the order in which they were written."""
        numbers = self.numbers_of(topics)
        return (message for block in self.blocks() for message in self._named(block, block.on(numbers)))

    def messages(self, topics: Collection[str], since: int, until: int) -> Iterator[RecordedMessage]:
        """Yield the messages of topics from one log time to another (ns), both included, in this order.

        Without an index they come in the order in which they were written.
        """
        found = self._by_time(topics, since, until) if self._chunks else self.written(topics)
        return (message for message in found if since <= message.log_time <= until)

    def _by_time(self, topics: Collection[str], since: int, until: int) -> Iterator[RecordedMessage]:
        """Yield messages in the order of time, out of the chunks that hold any of this span."""
        waiting: list[tuple[int, int, RecordedMessage]] = []    # a heap, by time and place
        places, numbers = count(), self.numbers_of(topics)
        for chunk in self._chunks:
            if chunk.end < since or chunk.begin > until:
                continue
            while waiting and waiting[0][0] < chunk.begin:
                yield heappop(waiting)[-1]
            for message in self._in_chunk(chunk, numbers):
                heappush(waiting, (message.log_time, next(places), message))
        while waiting:
            yield heappop(waiting)[-1]

    def _in_chunk(self, chunk: _Chunk, numbers: list[int]) -> Iterator[RecordedMessage]:
        try:
            with self.path.open('rb') as file:
                messages = messages_at(self.path, file, chunk.offset)
        except (*CUT_OFF, OSError) as error:
            reason = str(error) or type(error).__name__   # some errors of mcap have no words
            raise RecordingError(f'{self.path}: damaged after {(chunk.begin - self.begin) * 1e-9:g} s: {reason}'
                                 ) from None
        return self._named(messages, messages.on(numbers))

    def _named(self, messages: Messages, chosen: NDArray[np.intp]) -> Iterator[RecordedMessage]:
        names = {number: (channel.topic, self.type_of(channel)) for number, channel in self.channels.items()}
        return (RecordedMessage(*names[channel], *facts, data) for channel, facts, data in messages.each(chosen))

    def _forget(self) -> None:
        self.channels: dict[int, records.Channel] = {}
        self.schemas: dict[int, records.Schema] = {}
        self.counts: Counter[int] = Counter()
        self.span: tuple[int, int] | None = None
        self.is_complete = False
        self._chunks: list[_Chunk] = []        # by time; empty without an index
        self._places: dict[type[records.McapRecord], list[int]] = {
            records.AttachmentIndex: [], records.MetadataIndex: []}
        self._beside = 0

    def _take_summary(self) -> bool:
        """Take what the summary says; return whether there is one to be trusted, about a file with messages."""
        self._forget()
        statistics: records.Statistics | None = None
        try:
            with self.path.open('rb') as file:
                for record in summary_of(file, self._is_checked):
                    if isinstance(record, records.Statistics):
                        statistics = record
                    elif isinstance(record, records.ChunkIndex) and not self._is_checked:    # else all is read in order
                        self._chunks.append(_Chunk(record.message_start_time, record.message_end_time,
                                                   record.chunk_start_offset))
                    elif isinstance(record, (records.AttachmentIndex, records.MetadataIndex)):
                        self._places[type(record)].append(record.offset)
                    else:
                        self._take(record)
        except (*CUT_OFF, OSError):
            return False
        if statistics is None or not statistics.message_count:
            return False
        self.counts.update(statistics.channel_message_counts)
        self.span = statistics.message_start_time, statistics.message_end_time
        self._chunks.sort(key=lambda chunk: chunk.begin)
        listed = len(self._places[records.AttachmentIndex]), len(self._places[records.MetadataIndex])
        return not self._is_checked or (
            listed == (statistics.attachment_count, statistics.metadata_count)
            and self.counts.total() == statistics.message_count and self.counts.keys() <= self.channels.keys())

    def _take_all(self) -> None:
        """Take what all records say, as far as they go."""
        self._forget()
        attachments: dict[str, bytes] = {}
        metadata: list[records.Metadata] = []
        for record in contents(self.path):
            if isinstance(record, Messages):
                self._count(record)
            elif isinstance(record, records.Attachment):
                attachments[record.name] = record.data
            elif isinstance(record, records.Metadata):
                metadata.append(record)
            if not isinstance(record, Messages):
                self._take(record)
        self.attachments, self.metadata = attachments, metadata

    def _take(self, record: records.McapRecord) -> None:
        """Take a record that is no message; the index repeats those of the file."""
        self._beside += _size(record)
        if self._beside > MOST_BESIDE:
            raise RecordingError(f'{self.path}: more than {MOST_BESIDE >> 20} MiB beside its messages; no run has that')
        if isinstance(record, records.Schema):
            self.schemas.setdefault(record.id, record)
        elif isinstance(record, records.Channel):
            self.channels.setdefault(record.id, record)
        elif isinstance(record, records.Footer):
            self.is_complete = True

    def _count(self, messages: Messages) -> None:
        for channel, number in enumerate(np.bincount(messages.channels).tolist()):
            if number and channel not in self.channels and self._is_checked:
                raise RecordingError(f'{self.path}: damaged: a message on channel {channel}, which is not defined')
            if number:
                self.counts[channel] += number
        if len(times := messages.log_times):
            span = int(times.min()), int(times.max())
            self.span = (min(span[0], self.span[0]), max(span[1], self.span[1])) if self.span else span

    def _indexed(self, kind: type[records.McapRecord]) -> Iterator[records.McapRecord]:
        """Yield the records that the index lists; raises RecordingError where they are not there."""
        try:
            with self.path.open('rb') as file:
                for place in self._places[kind]:
                    record = record_at(file, place)
                    self._take(record)
                    yield record
        except (*CUT_OFF, OSError):
            raise RecordingError(f'{self.path}: damaged: its index points to missing data; fetch it again') from None

    def _qos_of(self, channel: records.Channel) -> QosProfile:
        """Return what was offered, in the words of any version of rosbag2."""
        from rosbags.rosbag2 import ReaderError  # takes 5 MB, for a bag that is played only
        from rosbags.rosbag2.metadata import parse_qos

        try:
            offers = {(offer.reliability.name.lower(), offer.durability.name.lower(), offer.depth)
                      for offer in parse_qos(channel.metadata.get('offered_qos_profiles', ''))}
        except (ReaderError, KeyError, TypeError, AttributeError) as error:
            raise RecordingError(f'{self.path}: {channel.topic} has no readable quality of service: {error}') from None
        if len(offers) != 1:
            return _DEFAULT_QOS
        (reliability, durability, depth), = offers
        return QosProfile(depth or _DEFAULT_QOS.depth,
                          reliability if reliability == 'best_effort' else 'reliable',
                          durability if durability == 'transient_local' else 'volatile')


def _size(record: records.McapRecord) -> int:
    """Return about how many bytes of a record are kept."""
    if isinstance(record, (records.Attachment, records.Schema)):
        return len(record.name) + len(record.data)
    if isinstance(record, (records.Channel, records.Metadata)):
        return sum(len(key) + len(value) for key, value in record.metadata.items()) + OVERHEAD
    return 0


# A topic of a bag as columns, block by block: the numbers of all its messages in a chunk at once.

Block = dict[str, NDArray[Any]]

_TIMES = 'log_time', 'publish_time', 'sequence'
_SWAPPED = 'publish_time', 'log_time', 'sequence'
_LATEST = 2 ** 63 - 1   # ns: the year 2262


class TopicColumns:
    """The columns of a topic of a type: one for each field that is a number or a text, and its times.

    `decode` makes an object of a message; it serves those whose numbers have no fixed places.  In a bag by the wall
    clock, `log_time` and `publish_time` stand in each other's place.
    """

    def __init__(self, topic: str, type_name: str, store: Typestore, decode: Callable[[RecordedMessage], Any],
                 is_by_wall_clock: bool) -> None:
        self.topic, self._type, self._decode = topic, type_name, decode
        self._is_by_wall_clock = is_by_wall_clock
        self._places = dict(zip(_TIMES, _SWAPPED if is_by_wall_clock else _TIMES))
        self._layout = layout_of(store, type_name)
        self._kinds = {**number_fields(store, type_name), **dict.fromkeys(text_fields(store, type_name), 'object')}
        self.fields = list(dict.fromkeys((*self._kinds, *_TIMES)))   # that are made; fewer may be wanted

    @property
    def empty(self) -> Block:
        """A block without a message."""
        return self._decoded([])

    def block(self, messages: Messages, chosen: NDArray[np.intp]) -> Block:
        """Return the columns of chosen messages; raises OverflowError on times beyond 64 bits."""
        layout = self._layout
        if layout is None or (messages.sizes[chosen] != FRAME_SIZE + layout.size).any():
            return self._decoded([RecordedMessage(self.topic, self._type, *facts, data).at(self._is_by_wall_clock)
                                  for _, facts, data in messages.each(chosen)])
        rows = messages.rows(chosen, row_kind(layout))
        for name in _TIMES:
            if rows[name].max() > _LATEST:
                raise OverflowError(name)
        return {name: rows[self._places[name]].astype(np.int64) if name in _TIMES else rows[name].copy()
                for name in self.fields}

    def _decoded(self, messages: list[RecordedMessage]) -> Block:
        decoded = list(map(self._decode, messages))
        return {name: np.array([getattr(message, name) for message in messages], dtype=np.int64) if name in _TIMES
                else np.array([getattr(message, name) for message in decoded], dtype=self._kinds[name])
                for name in self.fields}


def column_blocks(files: Iterable[RecordedFile], topics: Sequence[TopicColumns]
                  ) -> Iterator[tuple[TopicColumns, Block]]:
    """Yield the columns of topics block by block as they stand in files, in one pass; raises OverflowError."""
    for file in files:
        channels = [file.numbers_of([topic.topic]) for topic in topics]
        for messages in file.blocks():
            for topic, known in zip(topics, channels):
                if len(chosen := messages.on(known)):
                    yield topic, topic.block(messages, chosen)
