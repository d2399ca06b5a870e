# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Where messages stand in a chunk: the same whether their sizes repeat or not, one by one or many at once."""

import struct

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from mcap.exceptions import McapError
from mcap.opcode import Opcode

from stickslip_sim.recording.message_places import messages_in
from stickslip_sim.recording.message_record import FRAME_SIZE as FRAME

_HEAD = struct.Struct('<BQ')
_CHANNEL = struct.Struct('<H')


def message(size: int, channel: int) -> bytes:
    body = _CHANNEL.pack(channel) + bytes(size - _HEAD.size - _CHANNEL.size)
    return _HEAD.pack(Opcode.MESSAGE, len(body)) + body


def other(size: int) -> bytes:
    return _HEAD.pack(Opcode.CHANNEL, size) + bytes(size)


STEPS = st.lists(st.tuples(st.lists(st.integers(FRAME, FRAME + 60), min_size=1, max_size=10),   # sizes of a step
                           st.integers(1, 300),                                                # so many steps
                           st.sampled_from([None, 0, 40])), max_size=5)                        # another record behind


@settings(max_examples=150, deadline=None)
@given(steps=STEPS)
def test_messages_are_where_they_were_put(steps: list[tuple[list[int], int, int | None]]) -> None:
    data, places, channels, others = b'', [], [], []
    for sizes, count, behind in steps:
        for number in range(count):
            for k, size in enumerate(sizes):
                places.append((len(data), size))
                channels.append((k + 300 * number) % 65536)
                data += message(size, channels[-1])
        if behind is not None:
            others.append((len(data), len(data) + _HEAD.size + behind))
            data += other(behind)
    found = messages_in(data)
    assert list(zip(found.starts.tolist(), found.sizes.tolist())) == places
    assert found.channels.tolist() == channels
    assert found.others == others


@pytest.mark.parametrize('damage', [
    lambda data: data[:-1], lambda data: data + b'\x05', lambda data: data + _HEAD.pack(Opcode.MESSAGE, 3) + bytes(3),
    lambda data: data + _HEAD.pack(Opcode.MESSAGE, 2 ** 63)])
def test_what_does_not_fit_is_refused(damage: object) -> None:
    whole = b''.join(message(size, 1) for _ in range(50) for size in (93, 125))
    assert len(messages_in(whole).starts) == 100
    with pytest.raises(McapError):
        messages_in(damage(whole))  # type: ignore[operator]
