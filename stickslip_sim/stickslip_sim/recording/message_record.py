# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The record of a message in an MCAP file: what stands before the bytes of the message itself."""

import struct

from mcap.opcode import Opcode

FIELDS = {'opcode': ('u1', 0), 'length': ('<u8', 1), 'channel': ('<u2', 9), 'sequence': ('<u4', 11),
          'log_time': ('<u8', 15), 'publish_time': ('<u8', 23)}   # type and place
SEQUENCE_MASK = 0xFFFFFFFF      # the file has 32 bits for it; the message itself has the whole step
_FRAME = struct.Struct('<BQHIQQ')
FRAME_SIZE = _FRAME.size
CHANNEL_AT = FIELDS['channel'][1]
_OPCODE = int(Opcode.MESSAGE)


def record_of(channel: int, sequence: int, log_time: int, publish_time: int, data: bytes) -> bytes:
    """Return the record of a message, times in ns: the bytes that the library would write, without an object for it."""
    length = FRAME_SIZE - CHANNEL_AT + len(data)
    return _FRAME.pack(_OPCODE, length, channel, sequence & SEQUENCE_MASK, log_time, publish_time) + data
