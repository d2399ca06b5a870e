# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Scenes that once were wrong, each against the 40-digit automaton run on the spot."""

from typing import Any

import pytest

from stickslip_sim.simulation.simulator import Simulator
from tests.support.axes import instant
from tests.support.stored_objects import exact_run, inputs_of

OVERDAMPED_SLIP: dict[str, Any] = {
    'axis': {'mass': 16.446948494982106, 'drive_stiffness': 175885.98157369555, 'drive_damping': 170081.97082383372,
             'normal_force': 83.26794526381126},
    'contact': {'model': 'rigid'},
    'friction': {'static': {'law': 'exponential', 'initial': 0.07077598440132506, 'limit': 0.18908444510979028,
                            'time_constant': 0.01711587765437397},
                 'kinetic': {'velocities': [0.0, 0.0017832506254085658],
                             'coefficients': [0.07077598440132506, 0.054928209239847564]},
                 'acceleration_dependence': True},
    'drive': [[0.0, 0.00463367275569588, 0.0]], 'force': [[0.0, 7.657407661926342, 0.0]],
    'initial': {'position': 0.0, 'velocity': 0.0, 'rest_time': float('inf')}}
KATO_IN_AN_OVERDAMPED_CONTACT: dict[str, Any] = {
    'axis': {'mass': 8.450498813714473, 'drive_stiffness': 548621.3378468909, 'drive_damping': 0.0,
             'normal_force': 160.7667181464546},
    'contact': {'model': 'compliant', 'stiffness': 15007399.089951735, 'damping': 450457.5597440039},
    'friction': {'static': {'law': 'kato', 'initial': 0.3100035400160625, 'limit': 0.32550371701686565,
                            'time_constant': 0.541806530068847, 'exponent': 1.5},
                 'kinetic': {'velocities': [0.0], 'coefficients': [0.3100035400160625]},
                 'acceleration_dependence': False},
    'drive': [[0.0, 0.007406879132777259, 0.0]], 'force': [[0.0, -19.809695726210332, 0.0]],
    'initial': {'position': 0.0, 'velocity': 0.0, 'rest_time': 0.0}}
KATO_THAT_DOES_NOT_RISE: dict[str, Any] = {
    'axis': {'mass': 1.451899440495982, 'drive_stiffness': 2077.6380903047884, 'drive_damping': 10.984573875880052,
             'normal_force': 0.001451899440495982},
    'contact': {'model': 'compliant', 'stiffness': 2687.0777693336768, 'damping': 2498.436858474436},
    'friction': {'static': {'law': 'kato', 'initial': 0.10267952414132435, 'limit': 0.10267952414132435,
                            'time_constant': 1000.0, 'exponent': 0.3},
                 'kinetic': {'velocities': [0.0, 8.3e-8, 1.08e-7], 'coefficients': [0.0318, 0.0141, 0.0071]},
                 'acceleration_dependence': False},
    'drive': [[0.0, -1.0048e-05, 0.0], [0.1792, 1.0048e-05, 0.0]], 'force': [[0.0, 0.0, 0.0003624806147554921]],
    'initial': {'position': 0.0, 'velocity': 0.0, 'rest_time': 0.1}}
UNDAMPED_KATO: dict[str, Any] = {
    'axis': {'mass': 350.0, 'drive_stiffness': 6e5, 'drive_damping': 0.0, 'normal_force': 3432.3275},
    'contact': {'model': 'compliant', 'stiffness': 5e7, 'damping': 0.0},
    'friction': {'static': {'law': 'kato', 'initial': 0.12, 'limit': 0.24, 'time_constant': 0.2, 'exponent': 2.0},
                 'kinetic': {'velocities': [0.0, 0.035], 'coefficients': [0.12, 0.05]},
                 'acceleration_dependence': True},
    'drive': [[0.0, 0.002, 0.0]], 'force': [[0.0, 0.0, 0.0]],
    'initial': {'position': 0.0, 'velocity': 0.0, 'rest_time': float('inf')}}
UNDAMPED_UNDER_A_RAMP = UNDAMPED_KATO | {
    'friction': UNDAMPED_KATO['friction'] | {'static': UNDAMPED_KATO['friction']['static'] | {'law': 'exponential'}},
    'drive': [[0.0, 0.002, -5e-4]]}
NO_FRICTION = UNDAMPED_KATO | {'axis': UNDAMPED_KATO['axis'] | {'normal_force': 0.0}}
LIGHTLY_PRESSED: dict[str, Any] = {
    'axis': {'mass': 31422.4, 'drive_stiffness': 1e8, 'drive_damping': 2.9e6, 'normal_force': 1e-9},
    'contact': {'model': 'compliant', 'stiffness': 1e9, 'damping': 2.3e6},
    'friction': {'static': {'law': 'kato', 'initial': 0.12, 'limit': 0.13, 'time_constant': 1.0, 'exponent': 2.0},
                 'kinetic': {'velocities': [0.0], 'coefficients': [0.12]}, 'acceleration_dependence': False},
    'drive': [[0.0, 0.0, 0.04]], 'force': [[0.0, 0.0, 0.0]],
    'initial': {'position': 0.0, 'velocity': 0.0, 'rest_time': 1.0}}


@pytest.mark.parametrize(('scene', 'duration'), [
    (OVERDAMPED_SLIP, 0.1), (KATO_IN_AN_OVERDAMPED_CONTACT, 0.05), (KATO_THAT_DOES_NOT_RISE, 0.3),
    (LIGHTLY_PRESSED, 1e-8), (UNDAMPED_KATO, 1.4), (UNDAMPED_UNDER_A_RAMP, 1.6),
    (NO_FRICTION | {'drive': [[0.0, 0.0, 0.001]]}, 0.3),
    (NO_FRICTION | {'drive': [[0.0, 0.0, 0.0], [0.1, 0.002, 0.0]], 'force': [[0.0, 0.0, 50.0]]}, 0.3)])
def test_events_equal_the_reference(scene: dict[str, Any], duration: float) -> None:
    events, want = Simulator(*inputs_of(scene)).advance(instant(duration)), exact_run(scene, duration)
    assert [(e.kind.name.lower(), e.direction) for e in events] == [(e.kind, e.direction) for e in want]
    travel = max(abs(float(e.position)) for e in want)
    for event, exact in zip(events, want):
        assert abs(float(event.time - exact.time)) <= 1e-12 * duration
        assert abs(float(event.position - exact.position)) <= 1e-11 * travel


@pytest.mark.parametrize('scene', [UNDAMPED_KATO, UNDAMPED_UNDER_A_RAMP])
def test_a_ring_that_never_dies_is_leapt_over(scene: dict[str, Any]) -> None:
    # 5e15 N/m ring half a million times before the second break-away
    simulator = Simulator(*inputs_of(scene | {'contact': scene['contact'] | {'stiffness': 5e15}}))
    events = simulator.advance(instant(2.0))
    assert len(events) >= 8
    assert simulator.root_iterations <= 100 * len(events)


def test_breakpoints_that_are_close_together_lose_no_digits() -> None:
    # psi falls by 9e-5 between the first two breakpoints, those of mu_k: the difference of two rounded fractions there
    table = {'velocities': [0.0, 1e-06, 0.01], 'coefficients': [0.09, 0.09, 0.14]}
    scene: dict[str, Any] = {
        'axis': {'mass': 102.3, 'drive_stiffness': 7.2e6, 'drive_damping': 21712.0, 'normal_force': 1682.0},
        'contact': {'model': 'rigid'},
        'friction': {'static': {'law': 'constant', 'initial': 0.24}, 'kinetic': table, 'acceleration_dependence': True},
        'drive': [[0.0, -1e-07, 0.0]], 'force': [[0.0, -300.0, 0.0]],
        'initial': {'position': 0.0, 'velocity': 0.0, 'rest_time': 0.0}}
    events, want = Simulator(*inputs_of(scene)).advance(instant(600.0)), exact_run(scene, 600.0)
    assert [e.kind.name.lower() for e in events] == [e.kind for e in want]
    assert len(events) >= 3
    for event, exact in zip(events, want):
        assert abs(float(event.time - exact.time)) <= 1e-15 * 600.0
        assert abs(float(event.velocity - exact.velocity)) <= 4e-15 * abs(exact.velocity)


def test_a_command_in_a_long_slip_does_not_depend_on_the_ticks_before_it() -> None:
    # more than 4 s after the break-away a search up to the jump ends at it, to the bit
    scene: dict[str, Any] = {
        'axis': {'mass': 10.3, 'drive_stiffness': 0.001, 'drive_damping': 1014.0, 'normal_force': 437.7},
        'contact': {'model': 'rigid'},
        'friction': {'static': {'law': 'exponential', 'initial': 0.28, 'limit': 0.3, 'time_constant': 0.14},
                     'kinetic': {'velocities': [0.0, 0.045], 'coefficients': [0.28, 0.13]},
                     'acceleration_dependence': False},
        'drive': [[0.0, -0.0008, 0.0]], 'force': [[0.0, 0.0, 530.6], [4.6, -83.9, -530.6]],
        'initial': {'position': 0.0, 'velocity': 0.0, 'rest_time': 0.0}}
    for jump in (4.6, 4.7, 4.8, 4.9, 5.0, 5.1, 5.2, 5.3):
        scene['force'][1][0] = jump
        whole, split = Simulator(*inputs_of(scene)), Simulator(*inputs_of(scene))
        want = whole.advance(instant(6.0))
        assert [e for i in range(1, 13) for e in split.advance(instant(0.5 * i))] == want
        assert split.sample() == whole.sample()
