"""Random numbers of a run: one stream for each purpose, so that none disturbs another."""

from enum import IntEnum

import numpy as np


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
