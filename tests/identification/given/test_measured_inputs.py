# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Measured inputs: the way of a drive within the resolution of its encoder."""

import numpy as np
import pytest

from stickslip_sim.core.arrays import Numbers
from stickslip_sim.identification.measured_inputs import travelled, velocity_within

MICROMETRE = 1e-6
TIMES: Numbers = np.arange(4000, dtype=np.float64) * 1e-3


def test_an_even_feed_that_was_counted_is_even() -> None:
    profile = velocity_within(TIMES, np.round(TIMES * 0.00263 / MICROMETRE) * MICROMETRE, 0.5 * MICROMETRE)
    assert len(profile.starts) <= 5
    assert profile.values_at(TIMES[:3900]) == pytest.approx(np.full(3900, 0.00263), rel=1e-4)


def test_the_way_of_a_drive_turns_where_it_must_and_is_near_the_true_one() -> None:
    """Two feeds, a rest, a sine; differences of the readings are off by 1e-3 m/s."""
    turning = np.where(TIMES > 2.5, 2e-4 * np.sin(3.0 * (TIMES - 2.5)), 0.0)
    true = np.interp(TIMES, [0.0, 1.0, 1.5], [0.0, 0.002, 0.0025]) + turning
    places = np.round(true / MICROMETRE) * MICROMETRE
    profile = velocity_within(TIMES, places, 0.5 * MICROMETRE)
    off = travelled(profile, TIMES) - true
    assert np.abs(off - off[0]).max() < 0.6 * MICROMETRE
    assert len(profile.starts) < 150
    velocity = profile.values_at(TIMES)
    for first, last, feed in ((50, 950, 0.002), (1050, 1450, 0.001), (1550, 2450, 0.0)):
        assert np.abs(velocity[first:last] - feed).max() < 2e-6
