# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""What noise of a measured force does to the motion, and filters that take it out."""

import numpy as np
import pytest

from stickslip_sim import Sample, Simulator, load_scene
from stickslip_sim.core.arrays import Numbers
from stickslip_sim.identification.direct import with_delay
from stickslip_sim.identification.force_noise import NoiseFilter, filters_of, with_quiet_rests
from stickslip_sim.identification.free_parameters import FreeParameter
from stickslip_sim.identification.motions import MeasuredMotion
from stickslip_sim.identification.readings import (
    LINE,
    Channel,
    InputReadings,
    SensorReadings,
    instants_of,
    profile_through,
)

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


# The force on a slider that rests is smoothed, and nothing else: noise must not decide when it breaks away.

MOTION = MeasuredMotion(1.0, 1.5, 0.0, 1e-3, (1.1, 1.2, 1.25, 1.3, 1.4))   # at rest before 1.1 s and from 1.5 s on
NOISE = 0.2   # N


def smoothed(force: Numbers) -> tuple[Numbers, Numbers]:
    """Return the readings of a force, and what is taken for it (n,)."""
    readings = InputReadings(TIMES, force + np.random.default_rng(1).normal(0.0, NOISE, len(TIMES)), LINE)
    found = with_quiet_rests(SensorReadings(TIMES, 0.0, 1e-3, (), None, readings.profile(), (),
                                            force_readings=readings), [MOTION])
    assert found.force is not None
    assert found.force_readings is readings
    return readings.values, found.force.values_at(TIMES)


def test_noise_goes_only_while_the_slider_rests() -> None:
    force = 50.0 * np.sin(3.0 * TIMES)
    readings, found = smoothed(force)
    moves = (TIMES > 1.101) & (TIMES < 1.499)
    np.testing.assert_allclose(found[moves], readings[moves], atol=1e-9)
    assert np.std((found - force)[TIMES < 1.0]) < 0.3 * NOISE
    assert np.std((found - force)[TIMES > 1.6]) < 0.3 * NOISE


def test_a_step_of_the_force_stays_one() -> None:
    force = np.where(TIMES < 0.5, 0.0, 20.0)
    _, found = smoothed(force)
    assert np.abs(found - force).max() < 5.0 * NOISE


# What a measured force and the motion that it makes tell by themselves: how late the force was read.

MICROMETRE = 1e-6
MASS = FreeParameter('axis.mass', 'kg', 70.0, 50.0, 200.0)


@pytest.mark.parametrize(('held', 'late', 'delay'), [(True, 0, 0.5e-3), (False, 0, 0.0), (False, 3, 3e-3)])
def test_a_delay_of_the_force_shows_in_the_motion(held: bool, late: int, delay: float) -> None:
    """It does where the force has more than one frequency; one that is held acts half a period later than a line."""
    random = np.random.default_rng(3)
    times: Numbers = np.arange(3000, dtype=np.float64) * 1e-3
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
    readings = InputReadings(times, read, LINE)
    parameters, found = with_delay((MASS,), SensorReadings(times, 0.0, 1e-3, (channel,), None, readings.profile(), (),
                                                           force_readings=readings), 70.0)
    assert bool(found.notes) is (delay != 0.0)
    assert len(parameters) == 1 + bool(delay)
    if delay:
        assert parameters[-1].name == 'sensor.external_force.delay'
        assert parameters[-1].start == pytest.approx(delay, abs=2e-4)
