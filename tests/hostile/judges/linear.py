# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Linear motion by the matrix exponential in extended precision, many at once.  Knows no friction.

The series of the exponential is summed for a step so short that nothing cancels, and squared up; the samples are powers
of one step.  Nothing here is a root, a sine or an eigenvalue.
"""

from typing import Any, NamedTuple

import numpy as np

from .extended import Long

Array = Any
TERMS = 22
EARLY = 24      # halvings of the interval towards its start


class Samples(NamedTuple):
    """States (n, K, d), their rates, and how far rounding of the start may have moved them, at times (n, K)."""

    times: Array
    states: Array
    rates: Array
    noise: Array


def grown(matrices: Array) -> Array:
    """Return exp − 1 of matrices (n, d, d) of norm 1/2 or less: what is small next to 1 keeps its digits."""
    eye = np.eye(matrices.shape[-1], dtype=Long)
    total = eye + matrices / Long(TERMS)
    for k in range(TERMS - 1, 1, -1):
        total = eye + np.matmul(matrices, total) / Long(k)
    return np.matmul(matrices, total)


def doubled(growth: Array) -> Array:
    """Return exp(2 a) − 1 from exp(a) − 1."""
    return 2 * growth + np.matmul(growth, growth)


def samples(rates: Array, start: Array, noise: Array, times: Array, scale: Array, count: int) -> Samples:
    """Return z on a grid of `count` steps up to `times` (n), and at halvings of it, for z′ = A z.

    `rates` (n, d, d), `start` and `noise` (n, d); `scale` (n) bounds the norms.
    """
    step = times / Long(count)
    with np.errstate(over='ignore', invalid='ignore', divide='ignore'):
        halvings = np.maximum(np.ceil(np.log2(np.maximum(4.0 * scale * step, Long(1e-300)))), 0).astype(int)
        most = int(halvings.max()) if len(halvings) else 0
        # all are halved as often as the one that needs it most, and then some: the early samples come from there
        deep = max(most, EARLY - int(np.log2(count)))
        eye = np.eye(rates.shape[1], dtype=Long)
        power = grown(rates * (step / Long(2.0) ** deep)[:, None, None])
        early, early_times = [], []
        for level in range(deep):
            if deep - level <= EARLY:
                early.append(eye + power)
                early_times.append(step / Long(2.0) ** (deep - level))
            power = doubled(power)
        grid = np.stack([np.broadcast_to(eye, power.shape), eye + power], axis=1)
        while grid.shape[1] <= count:
            power = doubled(power)
            grid = np.concatenate([grid, np.matmul((eye + power)[:, None], grid)], axis=1)[:, :count + 1]
        if early:
            grid = np.concatenate([grid[:, :1], np.stack(early, axis=1), grid[:, 1:]], axis=1)
        at = np.concatenate([np.zeros((len(step), 1), dtype=Long), *(t[:, None] for t in early_times),
                             step[:, None] * np.arange(1, count + 1, dtype=Long)], axis=1)
        states = np.matmul(grid, start[:, None, :, None])[..., 0]
        moved = np.matmul(np.abs(grid), noise[:, None, :, None])[..., 0]
        return Samples(at, states, np.matmul(rates[:, None], states[..., None])[..., 0], moved)
