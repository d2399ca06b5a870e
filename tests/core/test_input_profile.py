# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Input profiles: pieces follow each other to the last bit, and are what they say."""

import math
import random
from copy import deepcopy

import pytest

from stickslip_sim.core.errors import InputError
from stickslip_sim.core.input_profile import InputProfile, Sinusoid, constant, ramp, steps, table


def test_pieces_of_a_periodic_profile_follow_each_other_for_any_period() -> None:
    rng = random.Random(1)
    for _ in range(100):
        period = rng.uniform(1e-3, 3.0)
        profile = table('force', [0.0, 0.1 * period, 0.5 * period, 0.6 * period], [0.0, -1.0, -1.0, 0.0], period)
        time = 0.0
        for _ in range(1000):
            piece = profile.piece_at(time)
            assert piece.start == time < piece.end
            time = piece.end


def test_values() -> None:
    assert constant(3.0).value_at(1e9) == 3.0
    assert [ramp(1.0, 2.0, 3.0).value_at(t) for t in (0.0, 1.0, 3.0, 9.0)] == [1.0, 3.0, 7.0, 7.0]
    assert ramp(0.0, 1.0, math.inf).value_at(1e6) == 1e6
    assert [steps('drive', [0.0, 1.0], [5.0, -5.0]).value_at(t) for t in (0.0, 0.999, 1.0, 7.0)] == [5, 5, -5, -5]
    saw = table('drive', [0.0, 1.0], [0.0, 4.0], 2.0)
    assert [saw.value_at(t) for t in (0.0, 0.5, 1.0, 1.5, 2.0, 2.5, 3.75)] == [0, 2, 4, 2, 0, 2, 1]


@pytest.mark.parametrize(('times', 'values', 'period', 'word'), [
    ([], [], math.inf, 'as many'), ([0.0, 1.0], [1.0], math.inf, 'as many'), ([1.0], [1.0], math.inf, '0 s at'),
    ([0.0, 1.0, 1.0], [1.0] * 3, math.inf, 'increasing'), ([0.0, 1.0], [1.0] * 2, 1.0, 'below the period')])
def test_bad_times_are_refused(times: list[float], values: list[float], period: float, word: str) -> None:
    for make in (steps, table):
        with pytest.raises(InputError, match=word):
            make('drive', times, values, period)


@pytest.mark.parametrize(('sinusoid', 'word'), [
    (Sinusoid(math.nan, 1.0, 0.0), 'finite'), (Sinusoid(1.0, 0.0, 0.0), 'Hz'), (Sinusoid(1.0, 1e7, 0.0), 'Hz'),
    (Sinusoid(1.0, 1.0, math.inf), 'finite')])
def test_bad_sinusoids_are_refused(sinusoid: Sinusoid, word: str) -> None:
    with pytest.raises(InputError, match=word):
        InputProfile((0.0,), (0.0,), (0.0,), sinusoids=(sinusoid,))
    with pytest.raises(InputError, match='at most 100'):
        InputProfile((0.0,), (0.0,), (0.0,), sinusoids=(Sinusoid(1.0, 1.0, 0.0),) * 101)


def test_a_copy_of_what_holds_a_profile_holds_the_same_one() -> None:
    """What holds measured ones is copied for every fit."""
    profile = table('force', [0.0, 1.0], [2.0, 3.0])
    assert deepcopy({'force': profile})['force'] is profile
