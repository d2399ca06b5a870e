"""Recordings to be played: any MCAP bag of ROS 2, from any time on, without reading all that comes before."""

from collections.abc import Callable, Collection, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import IO, NamedTuple

from mcap.reader import McapReader, NonSeekingReader, SeekingReader
from mcap.records import Channel, Schema
from rosbags.rosbag2 import ReaderError
from rosbags.rosbag2.metadata import parse_qos

from ..errors import RecordingError
from .reader import _CUT_OFF, RecordedMessage, _file_of
from .topics import QosProfile

_COMPRESSIONS = {'', 'zstd', 'lz4'}
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
        self.path = _file_of(Path(path))
        self.topics: dict[str, RecordedTopic] = {}
        self.is_complete = True
        with self._reading() as stream:
            span = self._look_at_summary(stream) or self._look_at_all(stream)
        if span is None:
            raise RecordingError(f'{self.path}: no message in it; give a recording that holds some')
        self.begin, self.end = span

    def messages(self, topics: Collection[str], since: int, until: int) -> Iterator[RecordedMessage]:
        """Yield the messages of some topics from one log time to another (ns), both included, in this order.

        A bag that was cut off has them in the order in which they were written.  Raises RecordingError where the bag
        is damaged.
        """
        make: Callable[..., McapReader] = SeekingReader if self.is_complete else NonSeekingReader
        time = since
        with self._reading() as stream:
            items = make(stream, validate_crcs=True).iter_messages(
                topics, log_time_order=self.is_complete, starting_at=since, ending_at=until)
            try:
                for _, channel, message in items:
                    time = message.log_time
                    yield RecordedMessage(channel.topic, self.topics[channel.topic].type, message.sequence, time,
                                          message.publish_time, message.data)
            except _CUT_OFF as error:
                if self.is_complete:
                    raise RecordingError(f'{self.path}: damaged behind {time * 1e-9:g} s: {error}') from None

    @contextmanager
    def _reading(self) -> Iterator[IO[bytes]]:
        try:
            with self.path.open('rb') as stream:
                yield stream
        except OSError as error:
            raise RecordingError(f'{self.path}: {error.strerror}') from None

    def _look_at_summary(self, stream: IO[bytes]) -> tuple[int, int] | None:
        """Take the topics from the end of the file; return first and last time, None where that does not tell."""
        try:
            summary = SeekingReader(stream).get_summary()
        except (*_CUT_OFF, OSError, StopIteration):    # there is no end, or the file is shorter than one
            return None
        if summary is None or summary.statistics is None or not summary.statistics.message_count:
            return None
        unknown = {chunk.compression for chunk in summary.chunk_indexes} - _COMPRESSIONS
        if unknown:
            raise RecordingError(f'{self.path}: compressed with {", ".join(unknown)}; only zstd and lz4 can be read')
        for channel in summary.channels.values():
            self._add(channel, summary.schemas.get(channel.schema_id))
        return summary.statistics.message_start_time, summary.statistics.message_end_time

    def _look_at_all(self, stream: IO[bytes]) -> tuple[int, int] | None:
        """Take the topics from the messages; return first and last time, None when there is no message."""
        stream.seek(0)
        span: tuple[int, int] | None = None
        try:
            for schema, channel, message in NonSeekingReader(stream, validate_crcs=True).iter_messages(
                    log_time_order=False):
                self._add(channel, schema)
                time = message.log_time
                span = (min(span[0], time), max(span[1], time)) if span else (time, time)
        except _CUT_OFF as error:
            self.is_complete = False
            if span is None:
                raise RecordingError(f'{self.path}: no message can be read: {error}') from None
        return span

    def _add(self, channel: Channel, schema: Schema | None) -> None:
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
