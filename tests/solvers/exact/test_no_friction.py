# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Where no friction holds the slider it moves as mass, spring and damper do, under every normal force, and may rest."""

import random
from collections.abc import Iterator
from typing import Any

import pytest
from scipy.integrate import solve_ivp

from stickslip_sim import load_scene
from stickslip_sim.core.types import Mode
from tests.support.axes import instant

LOADS: dict[str, dict[str, Any]] = {
    'constant': {},
    'sine': {'normal_load.course': 'sine', 'normal_load.constant': 500.0, 'normal_load.amplitude': 400.0,
             'normal_load.frequency': 7.0},
    'ramp': {'normal_load.course': 'ramp', 'normal_load.constant': 100.0, 'normal_load.rate': 200.0},
    'steps': {'normal_load.course': 'steps', 'normal_load.times': [0.0, 0.7], 'normal_load.forces': [10.0, 300.0]}}
CONTACTS: dict[str, dict[str, Any]] = {
    'rigid': {'contact.model': 'rigid'}, 'compliant': {'contact.model': 'compliant', 'contact.stiffness': 1e8},
    'by drive': {'contact.model': 'compliant', 'contact.stiffness': 1e8, 'contact.break_away': 'drive_force'}}
SINES = {'force.amplitudes': [30.0], 'force.frequencies': [3.0]}


def swing(axis: Any, velocity: float, force: Any, state: list[float], begin: float, end: float) -> list[float]:
    """Return position and velocity of the slider and position of the drive after a time without friction."""
    def rates(t: float, y: Any) -> list[float]:
        push = (axis.drive_stiffness * (y[2] - y[0]) + axis.drive_damping * (velocity - y[1]) + force.value_at(t))
        return [y[1], push / axis.mass, velocity]
    return [float(one) for one in solve_ivp(rates, (begin, end), state, 'DOP853', rtol=1e-12, atol=1e-16).y[:, -1]]


def commands(rng: random.Random) -> Iterator[tuple[float, float]]:
    """Yield drive velocities and until when they last; the first and some others are 0."""
    time = 0.0
    for k in range(8):
        time += rng.uniform(0.05, 0.4)
        yield (0.0 if k % 3 == 0 else rng.uniform(-5e-3, 5e-3)), time


@pytest.mark.parametrize('contact', CONTACTS)
@pytest.mark.parametrize('sines', [{}, SINES], ids=['still', 'pushed'])
@pytest.mark.parametrize('load', LOADS)
def test_it_moves_as_mass_spring_and_damper(load: str, sines: dict[str, Any], contact: str) -> None:
    scene = load_scene('paper_fig8', {'friction.scale': 0.0, 'drive.course': 'constant', 'drive.velocity': 0.0,
                                      **LOADS[load], **sines, **CONTACTS[contact]})
    simulator, state, begin = scene.make_simulator(), [0.0, 0.0, 0.0], 0.0
    for velocity, end in commands(random.Random(load + contact)):
        simulator.command_drive(velocity)
        simulator.advance(instant(end))
        state = swing(scene.axis, velocity, scene.force, state, begin, end)
        sample, begin = simulator.sample(), end
        assert [sample.position, sample.velocity, sample.drive_position] == pytest.approx(state, rel=1e-8, abs=1e-11)


@pytest.mark.parametrize('contact', CONTACTS)
@pytest.mark.parametrize('load', LOADS)
def test_it_rests_where_nothing_pushes_it_and_goes_with_the_first_command(load: str, contact: str) -> None:
    scene = load_scene('paper_fig8', {'friction.scale': 0.0, 'drive.course': 'constant', 'drive.velocity': 0.0,
                                      **LOADS[load], **CONTACTS[contact]})
    simulator = scene.make_simulator()
    assert simulator.advance(instant(1.0)) == []
    assert simulator.sample().mode is Mode.STICK
    simulator.command_drive(1e-3)
    assert [(event.time, event.direction) for event in simulator.advance(instant(1.001))] == [(1.0, 1)]
