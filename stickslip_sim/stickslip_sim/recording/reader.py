# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""A bag read back: its messages, what is attached to it, its topics as arrays, its transitions as events."""

import json
import math
import os
import warnings
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager, suppress
from functools import cached_property
from itertools import islice
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..bags import bag_files
from ..bags.bag import METADATA, NEXT_FILE, is_by_wall_clock
from ..bags.bag_files import column_blocks
from ..bags.mcap_file import Messages
from ..bags.message_layout import Layout, layout_of
from ..bags.schemas import Typestore, store_of, understood
from ..bags.topics import MODE_EVENT, Topic
from ..core.errors import InputError, RecordingError, RecordingWarning, one_line
from ..core.types import Event, EventKind, Mode
from ..scene import Scene, parse_scene
from .run import RECEIPT_FILE, SCENE_FILE

MOST_TOPIC_BYTES = 4 << 30    # bytes of a topic in memory at once

EVENT_FIELDS = ('time', 'kind', 'mode', 'direction', 'position', 'velocity', 'drive_force', 'friction_force',
                'static_coefficient', 'rest_time')


def open_bag(path: Path | str) -> 'Bag':
    """Return the bag in a folder, or in an MCAP file by itself; raises RecordingError when there is none, or damaged.

    One without an end (its process was killed, its disk was full, or it is still being written) is read as far as it
    goes, with a RecordingWarning.
    """
    bag = Bag(path)
    for shortfall in bag.shortfalls:
        warnings.warn(shortfall, RecordingWarning, stacklevel=2)
    return bag


class Bag:
    """A bag of one or more files; messages are read from there each time, in the order in which they were written.

    `path` is for people: its file, or the folder of several.  `next_file` is where it goes on, if that was not given.
    By topic: `topics` (type names), `channel_metadata`, `counts`; `channels` are numbers with their topics, `schemas`
    definitions by type name.
    """

    def __init__(self, path: Path | str) -> None:
        self.files = bag_files.files_of(Path(path))
        self.path = self.files[0] if len(self.files) == 1 else Path(path)
        self._parts = [bag_files.RecordedFile(file, whose_bytes_are_checked=True) for file in self.files]
        next_file = self._parts[-1].next_file
        self.is_complete = all(part.is_complete for part in self._parts) and not next_file
        self.next_file = '' if bag_files.goes_on_empty(self.files[-1]) or not self._parts[-1].is_complete else next_file
        self.attachments: dict[str, bytes] = {}
        self.metadata: dict[str, dict[str, str]] = {}
        self.schemas: dict[str, str] = {}
        self.topics: dict[str, str] = {}
        self.channel_metadata: dict[str, dict[str, str]] = {}
        self.counts: dict[str, int] = {}
        self.channels: set[tuple[int, str]] = set()
        for part in self._parts:
            self._take(part)
        self._stores: dict[str, Typestore] = {}

    def _take(self, part: bag_files.RecordedFile) -> None:
        self.attachments |= part.attachments
        for record in part.metadata:
            if record.name != NEXT_FILE and not (record.name == METADATA and METADATA in self.metadata):
                self.metadata[record.name] = record.metadata
        for schema in part.schemas.values():
            if schema.encoding == 'ros2msg':
                self.schemas[schema.name] = schema.data.decode(errors='replace')
        for number, channel in part.channels.items():
            self.channels.add((number, channel.topic))
            self.topics[channel.topic] = part.type_of(channel)
            self.channel_metadata[channel.topic] = channel.metadata
            self.counts[channel.topic] = self.counts.get(channel.topic, 0) + part.counts[number]

    @property
    def continuation(self) -> str:
        """Where it goes on, and why that was not read; for people, empty when it does not."""
        is_beside = os.path.isfile(self.files[-1].parent / os.path.basename(self.next_file))
        why = 'beside it; give the folder of the bag to have all' if is_beside else 'which is not there'
        return f'goes on in {one_line(self.next_file)}, {why}' if self.next_file else ''

    @property
    def shortfalls(self) -> tuple[str, ...]:
        """What is missing of it, for people."""
        if self.is_complete:
            return ()
        if self.next_file:
            return (f'{self.path} {self.continuation}',)
        return (f'{self.path} has no end: cut off, or still being written; {sum(self.counts.values())} messages are'
                ' whole, and metadata.yaml does not count them',)

    @property
    def receipt(self) -> dict[str, Any]:
        """The final figures; empty when the run was cut off.  Raises RecordingError when they are none."""
        return self.values(RECEIPT_FILE)

    @cached_property
    def scene(self) -> Scene:
        """The scene that travels in the run; raises RecordingError when there is none that this version can read."""
        if SCENE_FILE not in self.attachments:
            raise RecordingError(f'{self.path}: it has no {SCENE_FILE}; give a run that stickslip recorded')
        try:
            return parse_scene(self.attachments[SCENE_FILE].decode(errors='replace'))
        except InputError as error:
            raise RecordingError(f'{self.path}: its {SCENE_FILE} is not valid in this version: {error}') from None

    @property
    def _is_by_wall_clock(self) -> bool:
        return is_by_wall_clock(self.metadata.get(METADATA, {}))

    @property
    def events(self) -> list[Event]:
        """The transitions in the order of time; the drive position is not recorded with them (NaN).

        Raises RecordingError.
        """
        return self.events_in(self.columns_of(MODE_EVENT, EVENT_FIELDS))

    def events_in(self, columns: Mapping[str, NDArray[Any]]) -> list[Event]:
        """Return the transitions in columns of EVENT_FIELDS; raises RecordingError."""
        if not (np.isin(columns['kind'], list(EventKind)).all() and np.isin(columns['mode'], list(Mode)).all()):
            raise RecordingError(f'{self.path}: transitions of unknown kinds; recorded by another version?')
        return [_event(*row) for row in zip(*(columns[name].tolist() for name in EVENT_FIELDS))]

    def values(self, attachment: str) -> dict[str, Any]:
        """Return what a JSON file in the run says by name, nothing without the file; raises RecordingError."""
        try:
            return dict(json.loads(self.attachments.get(attachment, b'{}')))
        except (ValueError, TypeError, RecursionError) as error:
            raise RecordingError(f'{self.path}: damaged: its {attachment} is not a JSON object: {error}') from None

    def messages(self, topics: Iterable[str] | None = None) -> Iterator[bag_files.RecordedMessage]:
        """Yield the messages of some topics (None: all), with simulation time as their log time."""
        wanted = set(self.topics if topics is None else topics)
        return (message.at(self._is_by_wall_clock) for part in self._parts for message in part.written(wanted))

    def blocks(self) -> Iterator[Messages]:
        """Yield all messages as they stand in the chunks of the files."""
        return (block for part in self._parts for block in part.blocks())

    def decode(self, message: bag_files.RecordedMessage) -> Any:
        """Return the message as an object with its fields as attributes; raises RecordingError when it is damaged."""
        store = self._store(message.type)
        with self._named(f'{message.topic} at {message.log_time} ns'), understood(f'a {message.type}'):
            return store.deserialize_cdr(message.data, message.type)

    def columns(self, topic: str) -> dict[str, NDArray[Any]]:
        """Return a topic as one array for each field that is a number or a text.

        `log_time` (simulation time, also in a bag by the wall clock) and `publish_time` (the stamp) are in ns;
        `sequence` is the step.  A name without a leading slash is that of the one topic that ends so.
        Raises RecordingError when there is none, or too much of it.
        """
        name = self.resolved(topic)
        return self._held({name: None})[name]

    def column_blocks(self, topic: str) -> Iterator[dict[str, NDArray[Any]]]:
        """Yield the columns of a topic block by block, the first of them empty, as far as it goes."""
        return (block for _, block in self._blocks({self.resolved(topic): None}))

    def blocks_of(self, fields: Mapping[Topic, Sequence[str]]) -> Iterator[tuple[Topic, bag_files.Block]]:
        """Yield fields of the one topic of each type block by block, the first of each empty, in one pass.

        Raises RecordingError when topics or fields are not there.
        """
        topics = {self.name_of(topic): topic for topic in fields}
        wanted = {name: fields[topic] for name, topic in topics.items()}
        return ((topics[name], block) for name, block in self._blocks(wanted))

    def name_of(self, topic: Topic) -> str:
        """Return the name of the one topic of this type; raises RecordingError when there is none, or more than one."""
        names = [name for name, type_name in self.topics.items() if type_name == topic.type]
        if not self.topics and not self.is_complete:
            raise RecordingError(f'{self.path}: cut off before the first of its messages was written')
        if not names:
            raise RecordingError(f'{self.path}: no topic of type {topic.type}; there are '
                                 f'{", ".join(self.topics) or "none"}')
        if len(names) > 1:
            raise RecordingError(f'{self.path}: {" and ".join(names[:2])} are both of type {topic.type}; give a '
                                 'recording of one axis')
        return names[0]

    def columns_of(self, topic: Topic, fields: Sequence[str]) -> dict[str, NDArray[Any]]:
        """Return fields of the one topic of this type, in any namespace of its node.

        Raises RecordingError when topic or fields are not there.
        """
        return self.columns_of_all({topic: fields})[topic]

    def columns_of_all(self, fields: Mapping[Topic, Sequence[str]]) -> dict[Topic, dict[str, NDArray[Any]]]:
        """Return what `columns_of` does of several topics, in one pass over the files."""
        names = {topic: self.name_of(topic) for topic in fields}
        held = self._held({names[topic]: wanted for topic, wanted in fields.items()})
        return {topic: held[name] for topic, name in names.items()}

    def layout(self, topic: str) -> Layout:
        """Return where a topic has its numbers; raises RecordingError when they have no fixed places."""
        layout = layout_of(self._store(self.topics[topic]), self.topics[topic])
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

    def resolved(self, topic: str) -> str:
        """Return the name of the one topic that is, or ends so; raises RecordingError when there is none."""
        names = [name for name in self.topics if name == topic or name.endswith(f'/{topic}')]
        if len(names) == 1 or topic in names:
            return topic if topic in names else names[0]
        found = f'{len(names)} topics' if names else 'no topic'
        raise RecordingError(f'{self.path}: {found} {topic}; there are {", ".join(self.topics) or "none"}')

    def _blocks(self, wanted: Mapping[str, Sequence[str] | None]) -> Iterator[tuple[str, bag_files.Block]]:
        """Yield fields of topics (None: all) block by block, the first of each empty, in one pass."""
        topics = []
        for name, fields in wanted.items():
            type_name = self.topics[name]
            topic = bag_files.TopicColumns(name, type_name, self._store(type_name), self.decode, self._is_by_wall_clock)
            if missing := [field for field in fields or () if field not in topic.fields]:
                raise RecordingError(f'{self.path}: {name} has no {", ".join(missing)}; recorded by another version?')
            topic.fields = topic.fields if fields is None else [*fields]
            topics.append(topic)
            yield name, topic.empty
        with self._named(', '.join(wanted)), understood('a time beyond the year 2262', OverflowError):
            yield from ((topic.topic, block) for topic, block in column_blocks(self._parts, topics))

    def _held(self, wanted: Mapping[str, Sequence[str] | None]) -> dict[str, bag_files.Block]:
        """Return fields of topics (None: all), each as one array; raises RecordingError on more than fits."""
        blocks = self._blocks(wanted)
        held = {name: self._room(name, first) for name, first in islice(blocks, len(wanted))}
        done = dict.fromkeys(held, 0)
        for name, block in blocks:
            begin, rows = done[name], len(next(iter(block.values())))
            # more have come meanwhile to one that is being written
            done[name] = end = min(begin + rows, self.counts[name])
            for field_name, column in block.items():
                held[name][field_name][begin:end] = column[:end - begin]
        return {name: {field_name: column[:done[name]] for field_name, column in columns.items()}
                for name, columns in held.items()}

    def _room(self, topic: str, first: bag_files.Block) -> bag_files.Block:
        """Return columns for all messages of a topic; raises RecordingError on more than fits."""
        count = self.counts[topic]
        if (size := count * sum(column.itemsize for column in first.values())) > MOST_TOPIC_BYTES:
            raise RecordingError(f'{self.path}: {topic} has {count} messages of {size >> 20} MiB in all, which do not '
                                 'fit: iterate over messages(), or use a part of the recording')
        return {name: np.empty(count, column.dtype) for name, column in first.items()}

    def _store(self, type_name: str) -> Typestore:
        """Return what reads messages of a type; raises RecordingError without a definition of it that can be read."""
        if type_name not in self._stores:
            if type_name not in self.schemas:
                raise RecordingError(f'{self.path}: no definition of {type_name or "some messages"} in it')
            with self._named():
                self._stores[type_name] = store_of({type_name: self.schemas[type_name]})
        return self._stores[type_name]

    @contextmanager
    def _named(self, *part: str) -> Iterator[None]:
        """Put the file, and a part of it, in front of the text of a RecordingError."""
        try:
            yield
        except RecordingError as error:
            raise RecordingError(': '.join([str(self.path), *part, str(error)])) from None


def _event(time: float, kind: int, mode: int, direction: int, position: float, velocity: float, *rest: float) -> Event:
    second = math.floor(time)
    return Event(float(second), time - second, EventKind(kind), Mode(mode), direction, position, velocity, math.nan,
                 *rest)


# Recordings to be played: any MCAP bag of ROS 2, from any time on, without reading all that comes before.

class Recording:
    """A bag to be played: its topics, and the log times (ns) of its first and last message, `begin` and `end`.

    One that was cut off (`is_complete` is false) is what is whole of it.  Raises RecordingError when the bag cannot be
    read, or holds no message.
    """

    def __init__(self, path: Path | str) -> None:
        files = bag_files.files_of(Path(path))
        self.path = files[0] if len(files) == 1 else Path(path)
        self._files = [bag_files.RecordedFile(file, whose_bytes_are_checked=False) for file in files]
        self.is_complete = all(file.is_complete for file in self._files) and not bag_files.goes_on_empty(files[-1])
        self.topics: dict[str, bag_files.RecordedTopic] = {}
        for file in self._files:
            self.topics = {**file.topics, **self.topics}
        spans = [file.span for file in self._files if file.span is not None]
        if not spans:
            raise RecordingError(f'{self.path}: it has no readable message; give another recording')
        self.begin, self.end = min(begin for begin, _ in spans), max(end for _, end in spans)
        for file in self._files:
            file.begin = self.begin

    @cached_property
    def scene(self) -> Scene | None:
        """The scene that travels in it; None without one that this version can read."""
        with suppress(InputError, RecordingError):
            if text := self._files[0].attachments.get(SCENE_FILE):
                return parse_scene(text.decode(errors='replace'))
        return None

    def simulation_time(self, message: bag_files.RecordedMessage) -> int:
        """Return the simulation time of a message of a recording of an axis, ns."""
        return message.publish_time if self._is_by_wall_clock else message.log_time

    def stamp(self, message: bag_files.RecordedMessage) -> int:
        """Return when a message was stamped, ns."""
        return message.log_time if self._is_by_wall_clock else message.publish_time

    @cached_property
    def _is_by_wall_clock(self) -> bool:
        return any(is_by_wall_clock(record.metadata) for record in self._files[0].metadata if record.name == METADATA)

    @property
    def length(self) -> float:
        """From the first message to the last, s; log times of other recorders are since 1970."""
        return (self.end - self.begin) * 1e-9

    def messages(self, topics: Collection[str], since: int, until: int) -> Iterator[bag_files.RecordedMessage]:
        """Yield the messages of some topics from one log time to another (ns), both included, in this order.

        A bag without an index, such as one that was cut off, has them in the order in which they were written.  Raises
        RecordingError where the bag is damaged.
        """
        for file in self._files:
            if file.span is not None and file.span[0] <= until and file.span[1] >= since:
                yield from file.messages(topics, since, until)
