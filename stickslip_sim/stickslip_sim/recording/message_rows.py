# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Messages of one size as rows of an array: the record of the file around each, its stamp, its numbers."""

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..core.time_grid import NANOSECONDS
from .message_layout import Layout
from .message_record import FIELDS, FRAME_SIZE, SEQUENCE_MASK, record_of


class MessageRows:
    """The rows of a channel whose messages have a layout."""

    def __init__(self, channel: int, layout: Layout) -> None:
        record = record_of(channel, 0, 0, 0, layout.pack(0, *[0] * len(layout.names)))
        self.names = layout.names
        self._kind, self._empty = row_kind(layout), np.frombuffer(record, np.uint8)

    def packed(self, log_times: NDArray[np.int64], publish_times: NDArray[np.int64], sequences: NDArray[np.int64],
               numbers: Mapping[str, NDArray[Any]]) -> NDArray[Any]:
        """Return rows of messages that are stamped with their times of publication, ns."""
        rows = np.tile(self._empty, len(log_times)).view(self._kind)
        rows['sequence'] = sequences & SEQUENCE_MASK
        rows['log_time'], rows['publish_time'] = log_times, publish_times
        rows['stamp.sec'], rows['stamp.nanosec'] = np.divmod(publish_times, NANOSECONDS)
        for name in self.names:
            rows[name] = numbers[name]
        return rows


def row_kind(layout: Layout) -> np.dtype[Any]:
    """Return the type of a row: the record of a message with such a layout."""
    of_message = {name: (kind, place + FRAME_SIZE) for name, (kind, place) in layout.places.items()}
    places = {**FIELDS, **of_message}
    return np.dtype({'names': list(places), 'formats': [kind for kind, _ in places.values()],
                     'offsets': [place for _, place in places.values()], 'itemsize': FRAME_SIZE + layout.size})
