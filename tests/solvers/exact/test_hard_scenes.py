# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Scenes that once were wrong, each against the 40-digit automaton run on the spot."""

import math
import random
from itertools import pairwise
from typing import Any

import numpy as np
import pytest

from stickslip_sim.axis import Axis, CompliantContact, Friction, InitialState
from stickslip_sim.core.arrays import Numbers
from stickslip_sim.core.input_profile import constant, ramp
from stickslip_sim.core.types import EventKind
from stickslip_sim.friction import KineticTable, StaticLaw, StaticLawKind
from stickslip_sim.inputs import load_scene
from stickslip_sim.simulation.simulator import Simulator
from tests.support.axes import instant
from tests.support.stored_objects import exact_run, inputs_of
from tests.support.stored_runs import stored

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


def test_a_contact_that_rest_strengthens_is_not_searched_at_each_command() -> None:
    # above N mu_s(0) for half of its rest, under a new command a millisecond: N mu_s of now holds it off
    scene = load_scene('positioning', {'drive.course': 'constant', 'drive.velocity': 0.0, 'initial.rest_time': 0.5})
    rig = scene.make_rig()
    side = scene.axis.friction.static
    at_once, above = scene.axis.normal_force * side.initial, 0
    result = rig.make_step()
    while not result.events:
        above += abs(result.sample.friction_force) > at_once
        result = rig.make_step(velocity=0.004 + 1e-5 * (rig.step % 3))
    assert above > 100
    assert result.events[0].kind == EventKind.BREAKAWAY
    assert rig.simulator.root_iterations < 20


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


# The engine against an independent automaton at 40 digits (stickslip_sim.reference), event by event.
#
# `time_sensitivity` of an event is what the reference measured: seconds of shift per relative unit of rounding in the
# data; a chaotic or nearly grazing run has a large one, and there no double-precision result can do better.

RUNS = stored()
ROUNDING = 2.220446049250313e-16


@pytest.mark.parametrize('name', RUNS)
def test_events_equal_the_stored_reference(name: str) -> None:
    run = RUNS[name]
    events, want = Simulator(*inputs_of(run['parameters'])).advance(instant(run['duration'])), run['events']
    assert [(e.kind.name.lower(), e.direction) for e in events] == list(zip(want['kind'], want['direction']))
    travel = max([abs(float(x) - run['parameters']['initial']['position']) for x in want['position']] or [0.0])
    size = max(travel, abs(run['parameters']['initial']['position']))
    force = max([abs(float(x)) for x in want['drive_force']] or [0.0])
    speed = max([abs(float(x)) for x in want['velocity']] or [0.0])
    worst = 0.0
    for i, event in enumerate(events):
        slack = max(1.0, 16.0 * want['time_sensitivity'][i] * ROUNDING / (1e-12 * run['duration']))
        worst = max(worst, _error(event.time, want['time'][i], run['duration']) / slack,
                    _error(event.position, want['position'][i], size) / slack,
                    _error(event.velocity, want['velocity'][i], speed) / slack,
                    _error(event.drive_force, want['drive_force'][i], force) / slack)
        if event.kind.name != 'REVERSE':
            assert _error(event.friction_force, want['friction_force'][i], force) <= 1e-11 * slack, i
        if event.kind.name == 'BREAKAWAY':
            coefficient = float(want['static_coefficient'][i])
            assert event.static_coefficient == pytest.approx(coefficient, rel=1e-11 * slack), i
    assert worst <= (1e-11 if name == 'D' else 1e-12)   # D is chaotic: errors grow tenfold every 2 s


@pytest.mark.parametrize('name', RUNS)
def test_states_between_events_equal_the_reference(name: str) -> None:
    run = RUNS[name]
    simulator, want = Simulator(*inputs_of(run['parameters'])), run['samples']
    slack = max([1.0, *(16.0 * s * ROUNDING / (1e-12 * run['duration']) for s in run['events']['time_sensitivity'])])
    force = max([1e-300, *(abs(float(x)) for x in [*want['drive_force'], *want['friction_force']])])
    length = max(abs(float(x)) for x in want['position']) or 1.0
    speed = max(abs(float(x)) for x in want['velocity']) or 1.0
    for i, time in enumerate(want['time']):
        simulator.advance(instant(float(time)))
        sample = simulator.sample()
        for got, column, scale in ((sample.position, 'position', length), (sample.velocity, 'velocity', speed),
                                   (sample.drive_force, 'drive_force', force),
                                   (sample.friction_force, 'friction_force', force)):
            assert _error(got, want[column][i], scale) <= 1e-11 * slack, (column, time)


def test_the_stored_runs_cover_the_model() -> None:
    assert len(RUNS) >= 40
    assert {kind for run in RUNS.values() for kind in run['events']['kind']} == {
        'breakaway', 'coast', 'accelerate', 'decelerate', 'stick', 'reverse', 'knot'}
    laws = {run['parameters']['friction']['static']['law'] for run in RUNS.values()}
    assert {'constant', 'exponential'} <= laws
    for run in RUNS.values():
        assert all(float(a) <= float(b) for a, b in pairwise(run['events']['time']))
        assert all(math.isfinite(s) for s in run['events']['time_sensitivity'])


def _error(got: float, want: str, scale: float) -> float:
    """Return |got − want| / scale, with the difference taken in exact arithmetic."""
    from fractions import Fraction
    return abs(float(Fraction(got) - Fraction(want))) / (scale or 1.0)


# A compliant contact that begins exactly on its limit and is pulled away from it: its force comes back in time.
#
# Value and slope of the guard are 0 there, and a ramp of the drive bends it, too.  The force is the sum of a parabola
# and two exponentials, looked at closely.

LIMIT = 0.25           # mu_s, and mu_k at rest: an arrest lands on the limit
FRICTION = Friction(StaticLaw(StaticLawKind.CONSTANT, LIMIT, LIMIT), KineticTable((0.0, 1.0), (LIMIT, 0.12)), None)
LOOKS, PERIODS = 40_000, 4.0
LIMIT_ROUNDING = 1e-11       # of the limit


def force_of(axis: Axis, stretch: float, deflection: float, velocity: float, acceleration: float, times: Numbers
             ) -> Numbers:
    """Return what holds the slider from rest on, N: the force of the contact, or of the drive that ends the stick."""
    contact = axis.contact
    assert isinstance(contact, CompliantContact)
    k, d, c, h, m = axis.drive_stiffness, axis.drive_damping, contact.stiffness, contact.damping, axis.mass
    push, push_rate = k * stretch + d * velocity - c * deflection, k * velocity + d * acceleration   # N, N/s
    gamma, square = 0.5 * (d + h) / m, (k + c) / m
    second = k * acceleration / m / square
    first = (push_rate / m - 2.0 * gamma * second) / square
    zeroth = (push / m - 2.0 * gamma * first - second) / square
    root = np.emath.sqrt(gamma ** 2 - square)
    roots = np.array([-gamma + root, -gamma - root])
    parts = np.linalg.solve(np.array([[1.0, 1.0], roots]), np.array([-zeroth, -first], complex))
    free = parts[:, None] * np.exp(roots[:, None] * times)
    y = (zeroth + (first + 0.5 * second * times) * times + free.sum(axis=0)).real
    u = (first + second * times + (roots[:, None] * free).sum(axis=0)).real
    if contact.ends_by_drive:
        moved = (velocity + 0.5 * acceleration * times) * times - y
        found: Numbers = k * (stretch + moved) + d * (velocity + acceleration * times - u)
    else:
        found = c * (deflection + y) + h * u
    return found


@pytest.mark.parametrize('damped', [False, True])
@pytest.mark.parametrize('by_drive', [False, True])
def test_the_first_return_to_the_limit_is_a_break_away(by_drive: bool, damped: bool) -> None:
    rng = random.Random(f'{by_drive} {damped}')
    returns = 0
    for _ in range(120):
        mass, k, c, normal = (10.0 ** rng.uniform(low, high) for low, high in ((-1, 2), (2, 6), (2, 7), (0, 4)))
        limit, side, square = LIMIT * normal, rng.choice((-1.0, 1.0)), (k + c) / mass
        d, h = (10.0 ** rng.uniform(-3, -0.5) * math.sqrt(square) * mass * damped for _ in range(2))
        inside = limit * (1.0 - 10.0 ** rng.uniform(-3, -0.1))
        pace = rng.choice((1.0, 0.0, -1.0)) * rng.random() if not (by_drive or damped) else 0.0
        velocity = pace * limit * math.sqrt(square) / k
        acceleration = rng.choice((-1.0, 1.0)) * limit * square / k * 10.0 ** rng.uniform(-2, 0.5)
        stretch, deflection = ((limit, inside) if by_drive else (inside, limit))
        stretch, deflection = side * stretch / k, side * deflection / c
        if abs(k * stretch if by_drive else c * deflection) != limit:   # beside its limit by rounding
            continue
        axis = Axis(mass, k, d, normal, CompliantContact(c, h, ends_by_drive=by_drive), FRICTION)
        end = PERIODS * 2.0 * math.pi / math.sqrt(square)
        simulator = Simulator(axis, InitialState(rest_time=0.0, stretch=stretch, deflection=deflection),
                              ramp(velocity, acceleration, math.inf), constant(0.0))
        first = next((event.time for event in simulator.advance(instant(end))), math.inf)
        times = np.linspace(0.0, end, LOOKS + 1, dtype=np.float64)
        beyond = np.abs(force_of(axis, stretch, deflection, velocity, acceleration, times)) - limit
        late = times[beyond > LIMIT_ROUNDING * limit]
        assert first <= (late[0] if len(late) else math.inf)
        if first < math.inf:
            force = force_of(axis, stretch, deflection, velocity, acceleration, np.array([first]))
            assert np.abs(force) == pytest.approx(limit, rel=LIMIT_ROUNDING)
        returns += 0.0 < first < math.inf
    assert returns > 10
