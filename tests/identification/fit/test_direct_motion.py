# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""What a measured force and the motion that it makes tell by themselves: how late the force was read."""

import numpy as np
import pytest

from stickslip_sim import Sample, Simulator, load_scene
from stickslip_sim.core.arrays import Numbers
from stickslip_sim.identification.direct import with_delay
from stickslip_sim.identification.free_parameters import FreeParameter
from stickslip_sim.identification.measured_inputs import profile_through
from stickslip_sim.identification.readings import LINE, Channel, InputReadings, SensorReadings, instants_of

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
