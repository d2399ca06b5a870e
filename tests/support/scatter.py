# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The scatter of static friction once more, in whole numbers and from its description alone (docs/model.md)."""

import math
from dataclasses import replace
from functools import cache

from stickslip_sim.axis import Friction
from stickslip_sim.friction import Scatter, StaticLaw

_WORD = 2 ** 26
_OF_RUN = 2 ** 45


def words(left: int, right: int, odd: int, even: int) -> tuple[int, int]:
    """Return two words of 26 bits after 16 rounds of a Feistel network with the middle of a square."""
    for _ in range(16):
        root = (left + odd) % _WORD
        left, right = (right + (root * root >> 13)) % _WORD, left
        odd, even = even, (odd + 41475559) % _WORD
    return left, right


def normals(seed: int, counter: int) -> list[float]:
    """Return the normal numbers of a counter, attempt by attempt."""
    seed %= 2 ** 52 - 47
    odd, even = words(seed % _WORD, seed // _WORD, 0, 0)
    drawn = []
    for attempt in range(64):
        left, right = words(counter % _WORD, counter // _WORD + attempt * 2 ** 20, odd, even)
        drawn.append(math.sqrt(-2.0 * math.log((left + 1) / _WORD)) * math.cos(2.0 * math.pi * right / _WORD))
    return drawn


@cache
def factor_of(scatter: Scatter, stick: int) -> float:
    """Return the factor on mu_s of a stick."""
    factor = 1.0
    for deviation, counter in ((scatter.of_run, _OF_RUN), (scatter.deviation, stick)):
        if deviation > 0.0:
            factor *= 1.0 + deviation * next(z for z in normals(scatter.seed, counter) if deviation * abs(z) < 1.0)
    return factor


def law_of_stick(friction: Friction, stick: int) -> StaticLaw:
    """Return the static law of a stick in one direction: mu_0 and mu_inf times its factor, mu_k(0) at least."""
    law = friction.static
    if law.scatter is None:
        return law
    initial = max(factor_of(law.scatter, stick) * law.initial, friction.kinetic.coefficients[0])
    return replace(law, initial=initial, limit=max(factor_of(law.scatter, stick) * law.limit, initial), scatter=None)
