# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""A topic of a bag as columns, block by block: the numbers of all its messages in a chunk at once."""

from collections.abc import Callable, Iterable, Iterator, Sequence
from functools import reduce
from operator import or_
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from mcap.records import Channel
from numpy.typing import NDArray
from rosbags.typesys.store import Typestore

from .mcap_chunk import Messages
from .mcap_records import contents
from .message_layout import FIELDS, FRAME_SIZE, layout_of, number_fields, row_kind, text_fields

Block = dict[str, NDArray[Any]]

_TIMES = 'log_time', 'publish_time', 'sequence'
_SWAPPED = 'publish_time', 'log_time', 'sequence'
_LATEST = 2 ** 63 - 1   # ns: the year 2262


class RecordedMessage(NamedTuple):
    """One message as it stands in the file; times in ns."""

    topic: str
    type: str
    sequence: int
    log_time: int
    publish_time: int
    data: bytes  # CDR


class TopicColumns:
    """The columns of a topic of a type: one for each field that is a number or a text, and its times.

    `decode` makes an object of a message; it serves those whose numbers have no fixed places.  In a bag by the wall
    clock, `log_time` and `publish_time` stand in each other's place.
    """

    def __init__(self, topic: str, type_name: str, store: Typestore, decode: Callable[[RecordedMessage], Any],
                 is_by_wall_clock: bool) -> None:
        self.topic, self._type, self._decode = topic, type_name, decode
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
            return self._decoded([self._message(messages, int(k)) for k in chosen])
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

    def _message(self, messages: Messages, k: int) -> RecordedMessage:
        begin, size = int(messages.starts[k]), int(messages.sizes[k])
        frame = np.frombuffer(messages.data, _FRAME, 1, begin)[0]
        log_time, publish_time, sequence = (int(frame[self._places[name]]) for name in _TIMES)
        return RecordedMessage(self.topic, self._type, sequence, log_time, publish_time,
                               messages.data[begin + FRAME_SIZE:begin + size])


def column_blocks(files: Iterable[Path], topics: Sequence[TopicColumns]) -> Iterator[tuple[TopicColumns, Block]]:
    """Yield the columns of topics block by block as they stand in files, in one pass; raises OverflowError."""
    for file in files:
        channels: list[list[int]] = [[] for _ in topics]
        for record in contents(file):
            if isinstance(record, Channel):
                for topic, known in zip(topics, channels):
                    if record.topic == topic.topic:
                        known.append(record.id)
            elif isinstance(record, Messages):
                for topic, known in zip(topics, channels):
                    chosen = np.flatnonzero(reduce(or_, (record.channels == one for one in known), False))
                    if len(chosen):
                        yield topic, topic.block(record, chosen)


_FRAME = np.dtype({'names': list(FIELDS), 'formats': [kind for kind, _ in FIELDS.values()],
                   'offsets': [place for _, place in FIELDS.values()], 'itemsize': FRAME_SIZE})
