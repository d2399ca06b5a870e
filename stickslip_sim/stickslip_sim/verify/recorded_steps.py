# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The messages of a recording, step by step."""

from collections.abc import Iterable, Iterator
from itertools import groupby
from typing import NamedTuple

from ..core.errors import RecordingError
from ..recording import RecordedMessage, RecordedRun
from ..recording.topics import (
    DRIVE_VELOCITY,
    EXTERNAL_FORCE,
    FRICTION_FORCE,
    MODE_EVENT,
    PARAMETER_EVENTS,
    RIG_EVENT,
    SLIDER_STATE,
    Topic,
)
from .orders import is_order
from .origin import offline_of

ORDERS = DRIVE_VELOCITY, EXTERNAL_FORCE, RIG_EVENT, PARAMETER_EVENTS
_OUTPUTS = SLIDER_STATE, FRICTION_FORCE, MODE_EVENT
MOST_MISSING = 1_000_000           # steps that are made again without being compared
_HALF, _WHOLE = 1 << 31, 1 << 32   # the file has 32 bits for the number of a step


class RecordedStep(NamedTuple):
    """What was recorded of a step: what was ordered before it, and what came of it, by type of topic."""

    number: int
    orders: list[RecordedMessage]
    outputs: dict[Topic, list[RecordedMessage]]

    @property
    def is_whole(self) -> bool:
        """Whether the state at its end was recorded."""
        return bool(self.outputs[SLIDER_STATE] and self.outputs[FRICTION_FORCE])


def steps_of(run: RecordedRun, start: int) -> Iterator[RecordedStep]:
    """Yield the recorded steps after `start` (−1: all); raises RecordingError when they do not follow each other.

    An offline run has no orders: its commands only repeat what its input profiles did.
    """
    bag = run.bag
    ordered = () if offline_of(run) else [topic for topic in ORDERS if topic.type in bag.topics.values()]
    kinds = {bag.name_of(topic): topic for topic in (*ordered, *_OUTPUTS)}
    messages = (message for message in bag.messages(kinds) if kinds[message.topic] != RIG_EVENT
                or is_order(bag, message))
    number, missing = start, 0
    for sequence, group in groupby(_numbered(messages, kinds, start), key=lambda item: item[0]):
        ahead = (sequence - number + _HALF) % _WHOLE - _HALF
        if ahead < 0:
            raise RecordingError(f'{bag.path}: step {number + ahead} after step {number}; give a recording of one run')
        missing += max(ahead - 1, 0)
        if missing > MOST_MISSING:
            raise RecordingError(f'{bag.path}: step {number + ahead} after step {number}; a recording that lacks more '
                                 f'than {MOST_MISSING} steps is damaged')
        number += ahead
        if number > start:     # what was in force at the checkpoint is recorded again
            yield _step(number, [message for _, message in group], kinds)


def _numbered(messages: Iterable[RecordedMessage], kinds: dict[str, Topic], start: int
              ) -> Iterator[tuple[int, RecordedMessage]]:
    """Yield messages with the number of their step; events at the very start belong to step 0, which is none."""
    is_at_start = start < 0
    for message in messages:
        is_at_start = is_at_start and kinds[message.topic] != SLIDER_STATE
        yield 0 if is_at_start and kinds[message.topic] == MODE_EVENT else message.sequence, message


def _step(number: int, messages: list[RecordedMessage], kinds: dict[str, Topic]) -> RecordedStep:
    outputs: dict[Topic, list[RecordedMessage]] = {topic: [] for topic in _OUTPUTS}
    orders: list[RecordedMessage] = []
    for message in messages:
        outputs.get(kinds[message.topic], orders).append(message)
    return RecordedStep(number, orders, outputs)
