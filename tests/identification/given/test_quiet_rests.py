# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The force on a slider that rests is smoothed, and nothing else: noise must not decide when it breaks away."""

import numpy as np

from stickslip_sim.core.arrays import Numbers
from stickslip_sim.identification.force_noise import with_quiet_rests
from stickslip_sim.identification.motions import MeasuredMotion
from stickslip_sim.identification.readings import LINE, InputReadings, SensorReadings

TIMES: Numbers = np.arange(3000, dtype=np.float64) * 1e-3
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
