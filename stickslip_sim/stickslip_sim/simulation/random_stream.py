# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Random numbers of a run: one stream for each purpose, so that none disturbs another."""

from collections.abc import Sequence
from enum import IntEnum
from typing import Any

import numpy as np

_WORDS = 624   # of the state of a Mersenne Twister


class Stream(IntEnum):
    """What the numbers are for."""

    SLIDER_NOISE = 0
    DRIVE_NOISE = 1
    DROPOUT = 2
    LOSS = 3


def stream(seed: int, purpose: Stream) -> np.random.RandomState:
    """Return the generator of a purpose.

    Mersenne Twister in numpy's frozen form: its numbers are the same in every version of numpy.
    """
    return np.random.RandomState([seed & 0xFFFFFFFF, seed >> 32, purpose])


def state_of(generator: np.random.RandomState) -> list[Any]:
    """Return the state of a generator as plain data."""
    _, key, position, *_ = generator.get_state()
    return [[int(word) for word in key], int(position)]


def restore(generator: np.random.RandomState, state: Sequence[Any]) -> None:
    """Set the state of a generator; raises TypeError or ValueError when it is none."""
    key, position = state
    if len(key) != _WORDS or not 0 <= position <= _WORDS:
        raise ValueError('a random generator stands nowhere')
    generator.set_state(('MT19937', np.array(key, np.uint32), int(position), 0, 0.0))
