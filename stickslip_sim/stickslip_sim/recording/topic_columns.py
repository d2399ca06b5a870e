# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""A topic of a bag as columns, block by block: the numbers of all its messages in a chunk at once."""

from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from mcap.records import Channel
from numpy.typing import NDArray
from rosbags.typesys.store import Typestore

from .layout import layout_of, number_fields, text_fields
from .message_places import FRAME, Messages
from .records import contents
from .rows import FRAME_FIELDS, row_kind

Block = dict[str, NDArray[Any]]

_TIMES = 'log_time', 'publish_time', 'sequence'
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
    """The columns of a topic of a type in files: one for each field that is a number or a text, and its times.

    `decode` makes an object of a message; it serves those whose numbers have no fixed places.
    """

    def __init__(self, files: Sequence[Path], topic: str, type_name: str, store: Typestore,
                 decode: Callable[[RecordedMessage], Any]) -> None:
        self._files, self._topic, self._type, self._decode = files, topic, type_name, decode
        self._layout = layout_of(store, type_name)
        self._kinds = {**number_fields(store, type_name), **dict.fromkeys(text_fields(store, type_name), 'object')}

    def blocks(self) -> Iterator[Block]:
        """Yield the columns block by block, the first of them empty; raises OverflowError on times beyond 64 bits."""
        yield self._decoded([])
        for file in self._files:
            channels: list[int] = []
            for record in contents(file):
                if isinstance(record, Channel) and record.topic == self._topic:
                    channels.append(record.id)
                elif isinstance(record, Messages) and (chosen := np.isin(record.channels, channels)).any():
                    yield self._block(record, np.flatnonzero(chosen))

    def _block(self, messages: Messages, chosen: NDArray[np.intp]) -> Block:
        layout = self._layout
        if layout is None or (messages.sizes[chosen] != FRAME + layout.size).any():
            return self._decoded([self._message(messages, int(k)) for k in chosen])
        rows = messages.rows(chosen, row_kind(layout))
        for name in _TIMES:
            if rows[name].max() > _LATEST:
                raise OverflowError(name)
        return {**{name: rows[name].copy() for name in layout.names},
                **{name: rows[name].astype(np.int64) for name in _TIMES}}

    def _decoded(self, messages: list[RecordedMessage]) -> Block:
        decoded = list(map(self._decode, messages))
        columns = {name: np.array([getattr(message, name) for message in decoded], dtype=kind)
                   for name, kind in self._kinds.items()}
        return {**columns, **{name: np.array([getattr(message, name) for message in messages], dtype=np.int64)
                              for name in _TIMES}}

    def _message(self, messages: Messages, k: int) -> RecordedMessage:
        begin, size = int(messages.starts[k]), int(messages.sizes[k])
        frame = np.frombuffer(messages.data, _FRAME, 1, begin)[0]
        return RecordedMessage(self._topic, self._type, int(frame['sequence']), int(frame['log_time']),
                               int(frame['publish_time']), messages.data[begin + FRAME:begin + size])


_FRAME = np.dtype({'names': list(FRAME_FIELDS), 'formats': [kind for kind, _ in FRAME_FIELDS.values()],
                   'offsets': [place for _, place in FRAME_FIELDS.values()], 'itemsize': FRAME})
