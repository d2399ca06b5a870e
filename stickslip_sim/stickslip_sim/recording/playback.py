# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Recordings to be played: any MCAP bag of ROS 2, from any time on, without reading all that comes before."""

from collections.abc import Collection, Iterator
from contextlib import suppress
from functools import cached_property
from heapq import heappop, heappush
from itertools import count, takewhile
from pathlib import Path
from typing import NamedTuple

from mcap.records import Attachment, Channel, ChunkIndex, Footer, McapRecord, Message, Metadata, Schema
from rosbags.rosbag2 import ReaderError
from rosbags.rosbag2.metadata import parse_qos

from ..bags.bag import METADATA, is_by_wall_clock
from ..bags.mcap_records import CUT_OFF, chunk_at, records, summary_of
from ..bags.topic_columns import RecordedMessage
from ..bags.topics import QosProfile
from ..core.errors import InputError, RecordingError
from ..scene import Scene, parse_scene
from .opening import files_of, goes_on_empty
from .run import SCENE_FILE

_DEFAULT_QOS = QosProfile(10)    # as rosbag2 plays what has none, or several


class RecordedTopic(NamedTuple):
    """A topic as it was recorded; `type_hash` is empty where the recorder did not know it."""

    name: str
    type: str
    encoding: str
    type_hash: str
    qos: QosProfile


class Recording:
    """A bag to be played: its topics, and the log times (ns) of its first and last message, `begin` and `end`.

    One that was cut off (`is_complete` is false) is what is whole of it.  Raises RecordingError when the bag cannot be
    read, or holds no message.
    """

    def __init__(self, path: Path | str) -> None:
        files = files_of(Path(path))
        self.path = files[0] if len(files) == 1 else Path(path)
        self._files = list(map(_RecordedFile, files))
        self.is_complete = all(file.is_complete for file in self._files) and not goes_on_empty(files[-1])
        self.topics: dict[str, RecordedTopic] = {}
        for file in self._files:
            self.topics = {**file.topics, **self.topics}
        spans = [file.span for file in self._files if file.span is not None]
        if not spans:
            raise RecordingError(f'{self.path}: no message can be read of it; give a recording that holds some')
        self.begin, self.end = min(begin for begin, _ in spans), max(end for _, end in spans)
        for file in self._files:
            file.begin = self.begin

    @cached_property
    def scene(self) -> Scene | None:
        """The scene that travels in it, before its first message; None without one that this version can read."""
        for record in self._head:
            if isinstance(record, Attachment) and record.name == SCENE_FILE:
                with suppress(InputError):
                    return parse_scene(record.data.decode(errors='replace'))
        return None

    def simulation_time(self, message: RecordedMessage) -> int:
        """Return the simulation time of a message of a recording of an axis, ns."""
        return message.publish_time if self._is_by_wall_clock else message.log_time

    def stamp(self, message: RecordedMessage) -> int:
        """Return when a message was stamped, ns."""
        return message.log_time if self._is_by_wall_clock else message.publish_time

    @cached_property
    def _is_by_wall_clock(self) -> bool:
        return any(is_by_wall_clock(record.metadata) for record in self._head
                   if isinstance(record, Metadata) and record.name == METADATA)

    @property
    def _head(self) -> Iterator[McapRecord]:
        """Its records before its first message."""
        return takewhile(lambda record: not isinstance(record, Message), records(self._files[0].path))

    @property
    def length(self) -> float:
        """From the first message to the last, s; log times of other recorders are since 1970."""
        return (self.end - self.begin) * 1e-9

    def messages(self, topics: Collection[str], since: int, until: int) -> Iterator[RecordedMessage]:
        """Yield the messages of some topics from one log time to another (ns), both included, in this order.

        A bag without an index, such as one that was cut off, has them in the order in which they were written.  Raises
        RecordingError where the bag is damaged.
        """
        for file in self._files:
            if file.span is not None and file.span[0] <= until and file.span[1] >= since:
                yield from file.messages(topics, since, until)


class _RecordedFile:
    """A file of a bag that begins at `begin`.

    `span` are the log times (ns) of its first and last message, None without a message.
    """

    def __init__(self, path: Path) -> None:
        self.path = path
        self.topics: dict[str, RecordedTopic] = {}
        self.is_complete = True
        self._names: dict[int, str] = {}           # of topics by channel
        self._chunks: list[ChunkIndex] = []        # by time; empty without an index
        self.span = self._look_at_summary() or self._look_at_all()
        self.begin = self.span[0] if self.span else 0

    def messages(self, topics: Collection[str], since: int, until: int) -> Iterator[RecordedMessage]:
        """Yield what `Recording.messages` does."""
        for message in self._indexed(since, until) if self._chunks else self._written():
            name = self._names.get(message.channel_id, '')
            if name in topics and since <= message.log_time <= until:
                yield RecordedMessage(name, self.topics[name].type, message.sequence, message.log_time,
                                      message.publish_time, message.data)

    def _indexed(self, since: int, until: int) -> Iterator[Message]:
        """Yield all messages in the order of time, out of the chunks that hold any of this span."""
        waiting: list[tuple[int, int, Message]] = []    # a heap, by time and place
        places = count()
        for chunk in self._chunks:
            if chunk.message_end_time < since or chunk.message_start_time > until:
                continue
            while waiting and waiting[0][0] < chunk.message_start_time:
                yield heappop(waiting)[-1]
            for message in self._messages_in(chunk):
                heappush(waiting, (message.log_time, next(places), message))
        while waiting:
            yield heappop(waiting)[-1]

    def _messages_in(self, chunk: ChunkIndex) -> list[Message]:
        try:
            with self.path.open('rb') as file:
                return [record for record in chunk_at(self.path, file, chunk.chunk_start_offset)
                        if isinstance(record, Message)]
        except (*CUT_OFF, OSError) as error:
            begin = (chunk.message_start_time - self.begin) * 1e-9
            reason = str(error) or type(error).__name__   # some errors of mcap have no words
            raise RecordingError(f'{self.path}: damaged behind {begin:g} s: {reason}') from None

    def _written(self) -> Iterator[Message]:
        return (record for record in records(self.path) if isinstance(record, Message))

    def _look_at_summary(self) -> tuple[int, int] | None:
        """Take topics and index from the end of the file; return first and last time, None where that does not say."""
        try:
            with self.path.open('rb') as file:
                summary = summary_of(file)
        except OSError as error:
            raise RecordingError(f'{self.path}: {error.strerror}') from None
        if summary is None or summary.statistics is None or not summary.statistics.message_count:
            return None
        for channel in summary.channels.values():
            self._add(channel, summary.schemas.get(channel.schema_id))
        self._chunks = sorted(summary.chunk_indexes, key=lambda chunk: chunk.message_start_time)
        return summary.statistics.message_start_time, summary.statistics.message_end_time

    def _look_at_all(self) -> tuple[int, int] | None:
        """Take the topics from the records; return first and last time, None when there is no message."""
        schemas: dict[int, Schema] = {}
        span: tuple[int, int] | None = None
        self.is_complete = False
        for record in records(self.path):
            if isinstance(record, Schema):
                schemas[record.id] = record
            elif isinstance(record, Channel):
                self._add(record, schemas.get(record.schema_id))
            elif isinstance(record, Message):
                time = record.log_time
                span = (min(span[0], time), max(span[1], time)) if span else (time, time)
            elif isinstance(record, Footer):
                self.is_complete = True
        return span

    def _add(self, channel: Channel, schema: Schema | None) -> None:
        if channel.id in self._names:    # the index repeats them
            return
        self._names[channel.id] = channel.topic
        if channel.topic not in self.topics:
            self.topics[channel.topic] = RecordedTopic(
                channel.topic, schema.name if schema else '', channel.message_encoding,
                channel.metadata.get('topic_type_hash', ''), self._qos_of(channel))

    def _qos_of(self, channel: Channel) -> QosProfile:
        """Return what was offered, in the words of any version of rosbag2."""
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
