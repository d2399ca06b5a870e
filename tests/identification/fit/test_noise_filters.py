# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""What noise of a measured force does to the motion, and filters that take it out."""

import numpy as np
import pytest

from stickslip_sim.core.arrays import Numbers
from stickslip_sim.identification.force_noise import NoiseFilter, filters_of
from stickslip_sim.identification.readings import Channel, SensorReadings

TIMES: Numbers = np.arange(4000, dtype=np.float64) * 1e-3
NONE: Numbers = np.array([])


def measured(name: str, resolution: float, times: Numbers = TIMES) -> SensorReadings:
    channel = Channel(name, 'm', np.zeros(len(times)), resolution, 0.0, np.ones(len(times)))
    return SensorReadings(times, 0.0, 1e-3, (channel,), None, None, ())


def filtered(one: NoiseFilter | None, residuals: Numbers) -> Numbers:
    assert one is not None
    return one.white(residuals) / one.deviation


@pytest.mark.parametrize(('name', 'resolution'), [*(('position', noise) for noise in (1e-10, 1.4e-8, 3e-7, 1e-5)),
                                                  *(('velocity', noise) for noise in (1e-7, 3e-6, 1e-4))])
def test_noise_of_a_force_becomes_white(name: str, resolution: float) -> None:
    """A mass under a force with noise that is linear between readings, seen by a sensor with noise of its own."""
    random, mass, noise, period = np.random.default_rng(1), 95.0, 0.3, 1e-3
    times: Numbers = np.arange(20_000, dtype=np.float64) * period
    accelerations = random.normal(0.0, noise / mass, len(times))
    steps = 0.5 * (accelerations[1:] + accelerations[:-1]) * period
    velocity = np.append(0.0, np.cumsum(steps))
    moves = velocity[:-1] * period + (2.0 * accelerations[:-1] + accelerations[1:]) * period**2 / 6.0
    motion = velocity if name == 'velocity' else np.append(0.0, np.cumsum(moves))
    residuals = motion + random.normal(0.0, resolution, len(times))
    (one,) = filters_of(measured(name, resolution, times), noise, mass, NONE)
    white = filtered(one, residuals)
    assert white.std() == pytest.approx(1.0, abs=0.03)
    correlations = [float(white[lag:] @ white[:-lag]) / float(white @ white) for lag in range(1, 50)]
    assert np.abs(correlations).max() < 0.04


def test_after_a_gap_the_filter_starts_anew() -> None:
    """What came before, a drift of 1 mm, is not taken for something new."""
    times = np.concatenate([TIMES[:1000], TIMES[1500:]])
    (one,) = filters_of(measured('position', 1e-7, times), 0.3, 95.0, np.array([2.5]))
    residuals = np.where(times < 1.2, 0.0, 1e-3 * np.cos(times))
    white = filtered(one, residuals)
    assert np.abs(white[times < 2.5]).max() == 0.0   # nor what nobody knows of the force in the gap, up to a stop
    assert np.abs(white[times > 2.6]).max() > 0.0


@pytest.mark.parametrize('moves', [False, True])
def test_a_start_in_motion_counts_from_its_first_stop_on(moves: bool) -> None:
    (one,) = filters_of(measured('position', 1e-7), 0.3, 95.0, np.array([2.5]), moves)
    white = filtered(one, np.random.default_rng(1).normal(0.0, 1e-7, len(TIMES)))
    assert bool(np.any(white[TIMES < 2.4])) is not moves
    assert np.any(white[TIMES > 2.6])


def test_a_force_without_noise_needs_no_filter() -> None:
    assert filters_of(measured('position', 1e-6), 1e-9, 95.0, NONE) == (None,)
    assert filters_of(measured('drive_force', 1e-6), 0.3, 95.0, NONE) == (None,)
