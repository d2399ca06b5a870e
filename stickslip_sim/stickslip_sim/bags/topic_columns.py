# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""A topic of a bag as columns, block by block: the numbers of all its messages in a chunk at once."""

from collections.abc import Callable, Iterable, Iterator, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .bag_files import RecordedFile, RecordedMessage
from .mcap_chunk import Messages
from .message_layout import FRAME_SIZE, layout_of, number_fields, row_kind, text_fields
from .schemas import Typestore

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
