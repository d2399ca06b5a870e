# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Measured inputs: the way of a drive within the resolution of its encoder, and what noise of a force does."""

import numpy as np
import pytest
from numpy.typing import NDArray

from stickslip_sim import Sample, Simulator, load_scene
from stickslip_sim.identification.direct_motion import with_delay
from stickslip_sim.identification.free_parameters import FreeParameter
from stickslip_sim.identification.input_noise import NoiseFilter, filters_of
from stickslip_sim.identification.measured_inputs import profile_through, travelled, velocity_within
from stickslip_sim.identification.readings import Channel, SensorReadings, instants_of

Numbers = NDArray[np.float64]

MICROMETRE = 1e-6
TIMES: Numbers = np.arange(4000, dtype=np.float64) * 1e-3
NONE: Numbers = np.array([])


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


MASS = FreeParameter('axis.mass', 'kg', 70.0, 50.0, 200.0)


@pytest.mark.parametrize(('held', 'late', 'delay'), [(True, 0, 0.5e-3), (False, 0, 0.0), (False, 3, 3e-3)])
def test_a_delay_of_the_force_shows_in_the_motion(held: bool, late: int, delay: float) -> None:
    """It does where the force has more than one frequency; one that is held acts half a period later than a line."""
    random, times = np.random.default_rng(3), TIMES[:3000]
    force = 60.0 * np.sin(25.0 * times) + 60.0 * np.sin(7.0 * times)
    scene = load_scene('paper_fig7', {'axis.drive_stiffness': 0.0, 'axis.drive_damping': 0.0, 'axis.mass': 95.0,
                                      'axis.normal_force': 100.0, 'drive.velocity': 0.0,
                                      'friction.acceleration_dependence': False, 'friction.kinetic.velocities': (0.0,),
                                      'friction.kinetic.coefficients': (0.1,), 'friction.kinetic.end_slope': 2.0})
    simulator = Simulator(scene.axis, scene.initial, scene.drive, profile_through(times, force, held))
    rows = np.empty((len(times), len(Sample._fields)))
    simulator.take_samples(instants_of(times), rows)
    position = np.round(rows[:, Sample._fields.index('position')] / MICROMETRE) * MICROMETRE
    channel = Channel('position', 'm', position, 3e-7, MICROMETRE, np.ones(len(times)))
    read = np.append(force[late:], np.full(late, force[-1])) + random.normal(0.0, 0.3, len(times))
    parameters, found = with_delay((MASS,), SensorReadings(times, 0.0, 1e-3, (channel,), None,
                                                           profile_through(times, read), ()), 70.0)
    assert bool(found.notes) is (delay != 0.0)
    assert len(parameters) == 1 + bool(delay)
    if delay:
        assert parameters[-1].name == 'sensor.external_force.delay'
        assert parameters[-1].start == pytest.approx(delay, abs=2e-4)
