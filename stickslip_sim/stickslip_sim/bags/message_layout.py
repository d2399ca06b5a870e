# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Messages that always have their numbers at the same places: packed and unpacked without looking at each field."""

import struct
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from mcap.opcode import Opcode
from numpy.typing import NDArray
from rosbags.interfaces import Nodetype
from rosbags.typesys.store import Typestore

from ..core.time_grid import NANOSECONDS

# By type of field: its character in `struct`, its size in bytes, which is its alignment too.
_NUMBERS = {
    'bool': ('?', 1), 'int8': ('b', 1), 'uint8': ('B', 1), 'int16': ('h', 2), 'uint16': ('H', 2), 'int32': ('i', 4),
    'uint32': ('I', 4), 'int64': ('q', 8), 'uint64': ('Q', 8), 'float32': ('f', 4), 'float64': ('d', 8),
}
_CDR = b'\0\1\0\0'                  # before the message: CDR, little endian
_HEADER = 'std_msgs/msg/Header'
_HEADER_FORMAT, _HEADER_SIZE = '<4siIIx', 13  # sec, nanosec, a text of one byte, which is its end
_STAMP = {'stamp.sec': ('<i4', 4), 'stamp.nanosec': ('<u4', 8)}


class Layout:
    """A std_msgs/Header without a frame, then numbers only."""

    def __init__(self, fields: Mapping[str, str]) -> None:
        code, at, places = _HEADER_FORMAT, _HEADER_SIZE, {}
        for name, kind in fields.items():
            character, size = _NUMBERS[kind]
            gap = -at % size
            code += f'{gap}x{character}'
            places[name] = at + gap
            at += gap + size
        self.names = tuple(fields)
        self._struct = struct.Struct(code)
        formats = [f'<{np.dtype(kind).str[1:]}' for kind in fields.values()]
        offsets = [place + len(_CDR) for place in places.values()]
        self._dtype = np.dtype({'names': list(fields), 'formats': formats, 'offsets': offsets,
                                'itemsize': self._struct.size})
        self.places = {**_STAMP, **dict(zip(fields, zip(formats, offsets)))}   # type and place in a message, by name

    @property
    def size(self) -> int:
        """Bytes of a message."""
        return self._struct.size

    def pack(self, stamp_ns: int, *numbers: float) -> bytes:
        """Return the CDR bytes of a message with its stamp (ns) and its numbers in the order of `names`."""
        return self._struct.pack(_CDR, *divmod(stamp_ns, NANOSECONDS), 1, *numbers)

    def numbers(self, data: bytes) -> Sequence[float] | None:
        """Return the numbers of a message in the order of `names`; None when it has a frame or is not laid out so."""
        if len(data) != self.size:
            return None
        encapsulation, _, _, length, *numbers = self._struct.unpack(data)
        return numbers if encapsulation == _CDR and length == 1 else None

    def unpack(self, messages: list[bytes]) -> NDArray[Any]:
        """Return the numbers of messages of this size as a structured array."""
        return np.frombuffer(b''.join(messages), self._dtype)


class FixedLayout:
    """A message with texts or lists, of which only the stamp and some numbers change: float64 at the `ends` in bytes.

    The `pattern` is such a message; an end is counted from its own, as the texts come first.
    """

    def __init__(self, pattern: bytes, ends: Mapping[str, int]) -> None:
        self.names, self.size, self._pattern = tuple(ends), len(pattern), pattern
        self.places = {**_STAMP, **{name: ('<f8', len(pattern) - end) for name, end in ends.items()}}

    def pack(self, _stamp_ns: int, *_numbers: float) -> bytes:
        """Return the pattern, into which `MessageRows` puts stamps and numbers."""
        return self._pattern

    def unpack(self, messages: list[bytes]) -> NDArray[Any]:
        """Return stamps and numbers of messages of this size as a structured array."""
        kind = np.dtype({'names': list(self.places), 'formats': [kind for kind, _ in self.places.values()],
                         'offsets': [place for _, place in self.places.values()], 'itemsize': self.size})
        return np.frombuffer(b''.join(messages), kind)


def layout_of(store: Typestore, type_name: str) -> Layout | None:
    """Return the layout of a type, None when its numbers have no fixed places."""
    fields = store.fielddefs[type_name][1]
    if len(fields) < 2 or fields[0][1] != (Nodetype.NAME, _HEADER):
        return None
    numbers = number_fields(store, type_name)
    return Layout(numbers) if len(numbers) == len(fields) - 1 else None


def text_fields(store: Typestore, type_name: str) -> list[str]:
    """Return the fields of a type that are single texts."""
    return [name for name, (node, inner) in store.fielddefs[type_name][1]
            if node == Nodetype.BASE and inner[0] == 'string']


def number_fields(store: Typestore, type_name: str) -> dict[str, str]:
    """Return the fields of a type that are single numbers, with their types."""
    return {
        name: str(inner[0]) for name, (node, inner) in store.fielddefs[type_name][1]
        if node == Nodetype.BASE and inner[0] in _NUMBERS
    }


# The record of a message in an MCAP file: what stands before the bytes of the message itself.

FIELDS = {'opcode': ('u1', 0), 'length': ('<u8', 1), 'channel': ('<u2', 9), 'sequence': ('<u4', 11),
          'log_time': ('<u8', 15), 'publish_time': ('<u8', 23)}   # type and place
SEQUENCE_MASK = 0xFFFFFFFF      # the file has 32 bits for it; the message itself has the whole step
_FRAME = struct.Struct('<BQHIQQ')
FRAME_SIZE = _FRAME.size
CHANNEL_AT = FIELDS['channel'][1]
FRAME_KIND = np.dtype({'names': list(FIELDS), 'formats': [kind for kind, _ in FIELDS.values()],
                       'offsets': [place for _, place in FIELDS.values()], 'itemsize': FRAME_SIZE})
_OPCODE = int(Opcode.MESSAGE)


def frame_at(data: bytes, place: int) -> tuple[int, int, int, int]:
    """Return channel, sequence, log and publish time (ns) of the message whose record begins at a place."""
    _, _, channel, sequence, log_time, publish_time = _FRAME.unpack_from(data, place)
    return channel, sequence, log_time, publish_time


def record_of(channel: int, sequence: int, log_time: int, publish_time: int, data: bytes) -> bytes:
    """Return the record of a message, times in ns: the bytes that the library would write, without an object for it."""
    length = FRAME_SIZE - CHANNEL_AT + len(data)
    return _FRAME.pack(_OPCODE, length, channel, sequence & SEQUENCE_MASK, log_time, publish_time) + data


# Messages of one size as rows of an array: the record of the file around each, its stamp, its numbers.

class MessageRows:
    """The rows of a channel whose messages have a layout."""

    def __init__(self, channel: int, layout: Layout | FixedLayout) -> None:
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


def row_kind(layout: Layout | FixedLayout) -> np.dtype[Any]:
    """Return the type of a row: the record of a message with such a layout."""
    of_message = {name: (kind, place + FRAME_SIZE) for name, (kind, place) in layout.places.items()}
    places = {**FIELDS, **of_message}
    return np.dtype({'names': list(places), 'formats': [kind for kind, _ in places.values()],
                     'offsets': [place for _, place in places.values()], 'itemsize': FRAME_SIZE + layout.size})
