# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Where the messages stand in the content of a chunk, and those of a channel as rows of an array."""

import struct
from typing import Any, NamedTuple

import numpy as np
from mcap.exceptions import McapError
from mcap.opcode import Opcode
from numpy.typing import NDArray

_HEAD = struct.Struct('<BQ')       # of a record: what it is, and its length without this
_CHANNEL = 9                       # where the channel of a message stands in its record
FRAME = 31                         # bytes of the record of a message before those of the message itself


class Messages(NamedTuple):
    """The messages in the content of a chunk: where the record of each begins, its size, its channel.

    `others` are where the records that are no messages begin and end.
    """

    data: bytes
    starts: NDArray[np.int64]
    sizes: NDArray[np.int64]
    channels: NDArray[np.int64]
    others: list[tuple[int, int]]

    def rows(self, chosen: NDArray[Any], kind: np.dtype[Any]) -> NDArray[Any]:
        """Return the records of chosen messages, all of the size of a row, as an array."""
        bytes_each = np.dtype((np.void, kind.itemsize))
        count = max(len(self.data) - kind.itemsize + 1, 0)
        every: NDArray[Any] = np.ndarray(count, bytes_each, self.data, strides=(1,))
        rows: NDArray[Any] = every[self.starts[chosen]].view(kind)
        return rows


def messages_in(data: bytes) -> Messages:
    """Return the messages in the content of a chunk; raises McapError where its records do not fit into it."""
    at, end = 0, len(data)
    others: list[tuple[int, int]] = []
    starts: list[int] = []
    ends: list[int] = []
    unpack, size = _HEAD.unpack_from, _HEAD.size
    while at + size <= end:
        kind, length = unpack(data, at)
        begin, at = at, at + size + length
        if kind == Opcode.MESSAGE:
            starts.append(begin)
            ends.append(at)
        else:
            others.append((begin, at))
    places = np.array(starts, np.int64)
    if at != end or (np.array(ends) - places).min(initial=FRAME) < FRAME:
        raise McapError('a record that does not fit into its chunk')
    raw = np.frombuffer(data, np.uint8)
    channels = raw[places + _CHANNEL] + 256 * raw[places + _CHANNEL + 1].astype(np.int64)
    return Messages(data, places, np.array(ends, np.int64) - places, channels, others)
