# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Rounds that repeat, one by one or in groups, by all four of their numbers."""

import numpy as np
import pytest

from stickslip_sim.core.arrays import Numbers
from stickslip_sim.figures.rounds import group_size

ROUND = np.array([0.5, 0.75, 800.0, 0.02])   # stick and period, s; force, N; speed, m/s
COUNT = 12


def size_of(rounds: Numbers) -> float:
    return float(group_size(rounds[None], np.array([float(COUNT)]), np.array([800.0]), 1e-6, 1e-11)[0])


@pytest.mark.parametrize('size', [1, 2, 3])
def test_the_shortest_group_is_found(size: int) -> None:
    turns = 1.0 + 0.1 * (np.arange(COUNT) % size)
    assert size_of(ROUND * turns[:, None]) == size


@pytest.mark.parametrize('number', range(4))
def test_rounds_of_which_a_number_still_changes_do_not_repeat(number: int) -> None:
    rounds = np.tile(ROUND, (COUNT, 1))
    assert size_of(rounds) == 1.0
    rounds[:, number] *= 1.0 + 1e-5 * np.arange(COUNT)
    assert size_of(rounds) == 0.0
