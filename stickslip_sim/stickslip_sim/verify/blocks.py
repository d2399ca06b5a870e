# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""An offline run beside its recording, byte by byte: quick, and sure where all is the same.

A recording in which anything is not as this version writes it has to be compared step by step, which says what.
"""

from collections.abc import Iterator
from typing import NamedTuple

from ..core.time_grid import instants
from ..recording import RecordedRun
from ..recording.offline_bag import CHANNELS, message_blocks
from ..recording.topics import FRICTION_FORCE, MODE_EVENT, RUN_INFO, SLIDER_STATE
from ..runs import SimulatedRun


class Same(NamedTuple):
    """How much is the same: all of the recording, up to `end` (s)."""

    steps: int
    events: int
    end: float


def same_bytes(run: RecordedRun, again: SimulatedRun) -> Same | None:
    """Return how much is the same when all messages of steps are, None otherwise."""
    expected = _Expected(block.data for block in message_blocks(again.sample_blocks(), again.events))
    channels, counts = {topic.type: number for topic, number in CHANNELS.items()}, dict.fromkeys(CHANNELS.values(), 0)
    if any(channels.get(run.bag.topics[topic]) != number for number, topic in run.bag.channels):
        return None
    for record in run.bag.blocks():
        if not len(record.starts):
            continue
        first = int(record.channels[0] == CHANNELS[RUN_INFO])
        begin, end = int(record.starts[first:].min(initial=len(record.data))), len(record.data)
        if int(record.sizes[first:].sum()) != end - begin or record.data[begin:] != expected.take(end - begin):
            return None
        for channel in counts:
            counts[channel] += int((record.channels == channel).sum())
    steps = counts[CHANNELS[FRICTION_FORCE]]    # the latest state may lack it in a run that was cut off
    if counts[CHANNELS[RUN_INFO]] != 1 or not 0 <= counts[CHANNELS[SLIDER_STATE]] - steps <= 1 or not steps:
        return None
    at = instants(again.sample_period, steps - 1, steps) if again.sample_period else None
    return at and Same(steps, counts[CHANNELS[MODE_EVENT]], float(at.seconds[0] + at.fractions[0]))


class _Expected:
    """Bytes that come in blocks, taken in parts of other sizes."""

    def __init__(self, blocks: Iterator[bytes]) -> None:
        self._blocks, self._left = blocks, memoryview(b'')

    def take(self, count: int) -> bytes:
        """Return the next bytes, less of them at the end."""
        parts = []
        while count > 0 and (part := self._left or memoryview(next(self._blocks, b''))):
            parts.append(part[:count])
            self._left = part[count:]
            count -= len(parts[-1])
        return b''.join(parts)
