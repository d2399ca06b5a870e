# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Axes and input profiles of any kind, and rigid contacts with two branches under sines."""

import math
from dataclasses import replace
from typing import NamedTuple

from hypothesis import strategies as st
from hypothesis.strategies import DrawFn, SearchStrategy

from stickslip_sim.axis import Axis, CompliantContact, Friction, InitialState, RigidContact
from stickslip_sim.core.input_profile import InputProfile, Sinusoid, constant, ramp, steps, table
from stickslip_sim.friction import KineticTable, StaticLaw, StaticLawKind
from stickslip_sim.friction.kinetic import default_excess

_SIGNS = st.sampled_from((-1.0, 1.0))
_LAWS = st.sampled_from(list(StaticLawKind))


class Case(NamedTuple):
    """All that a run is made of; the duration in s."""

    axis: Axis
    initial: InitialState
    drive: InputProfile
    force: InputProfile
    duration: float


@st.composite
def machines(draw: DrawFn) -> Case:
    """Return a run of some swings of an axis that one may meet."""
    mass, omega = draw(_powers(-1, 4)), draw(_powers(0.5, 3))
    load = mass * draw(st.just(9.80665) | _powers(-1, 2))
    speed = load / (mass * omega) * draw(_powers(-3, 0.5))
    friction = draw(_frictions(speed, omega))
    axis = Axis(mass, mass * omega * omega, 2.0 * mass * omega * draw(_ZETAS), load, draw(_contacts(mass, omega)),
                friction)
    swings = draw(st.floats(1.0, 60.0))
    duration = swings / omega
    return Case(axis, draw(_starts(speed)), draw(_profiles(speed, omega, duration)),
                draw(_profiles(load * draw(st.floats(0.0, 0.4)), omega, duration)), duration)


@st.composite
def shaken(draw: DrawFn) -> Case:
    """Return the run of a rigid contact with two branches under sines: nothing but rates decides its break-aways."""
    case = draw(machines())
    axis = case.axis
    kinetic = axis.friction.kinetic
    if kinetic.limit_velocity == 0.0:
        kinetic = KineticTable((0.0, 1.0), (kinetic.coefficients[0], 0.5 * kinetic.coefficients[0]))
    axis = replace(axis, contact=RigidContact(),
                   friction=replace(axis.friction, kinetic=kinetic, excess=default_excess(kinetic)))
    omega = math.sqrt(axis.drive_stiffness / axis.mass)
    load = axis.normal_force * axis.friction.static.initial
    force = draw(_sinusoids(load * draw(st.floats(0.3, 3.0)), omega, 1))
    return case._replace(axis=axis, force=replace(case.force, sinusoids=force))


def _powers(low: float, high: float) -> SearchStrategy[float]:
    """Return numbers from 10^low to 10^high, round ones among them."""
    return st.floats(low, high).map(lambda power: float(10.0 ** power)) | st.integers(
        math.ceil(low), math.floor(high)).map(lambda power: float(f'1e{power}'))


_ZETAS = st.sampled_from((0.0, 1.0, 1e-9, 30.0)) | st.floats(0.0, 0.6)


@st.composite
def _contacts(draw: DrawFn, mass: float, omega: float) -> RigidContact | CompliantContact:
    if draw(st.booleans()):
        return RigidContact()
    stiffness = mass * omega * omega * draw(_powers(-1, 4))
    return CompliantContact(stiffness, 2.0 * math.sqrt(mass * stiffness) * draw(_ZETAS))


@st.composite
def _frictions(draw: DrawFn, speed: float, omega: float) -> Friction:
    at_rest = draw(st.floats(0.01, 0.5))
    speeds = [0.0]
    for each in sorted(speed * draw(_powers(-2, 2)) for _ in range(draw(st.integers(0, 4)))):
        if each - speeds[-1] > 1e-7 * each:    # nearer ones are refused
            speeds.append(each)
    kinetic = KineticTable(tuple(speeds), (at_rest, *(at_rest * draw(st.floats(0.05, 1.0)) for _ in speeds[1:])),
                           draw(st.sampled_from((0.0, 0.01 / speed))))
    initial = at_rest * draw(st.sampled_from((1.0, 1.0, 1.2)))
    # a rise within rounding of 0 is one for the reference alone
    limit = initial * draw(st.just(1.0) | st.floats(1.01, 3.0))
    static = StaticLaw(draw(_LAWS), initial, limit, draw(_powers(-3, 1)) / omega,
                       draw(st.sampled_from((0.3, 1.0, 2.0))))
    branches = len(speeds) > 1 and draw(st.booleans())
    return Friction(static, kinetic, default_excess(kinetic) if branches else None)


def _starts(speed: float) -> SearchStrategy[InitialState]:
    moving = st.builds(InitialState, velocity=st.sampled_from((speed, -speed)))
    return st.just(InitialState(rest_time=0.0)) | st.just(InitialState(rest_time=1.0)) | moving.map(
        lambda start: replace(start, rest_time=0.0))


@st.composite
def _profiles(draw: DrawFn, size: float, omega: float, duration: float) -> InputProfile:
    size *= draw(_SIGNS)
    values = [size * draw(st.sampled_from((1.0, -1.0, 0.0, 0.3))) for _ in range(3)]
    times = [0.0, duration * draw(st.floats(0.01, 0.4)), duration * draw(st.floats(0.5, 0.8))]
    profile = draw(st.sampled_from((
        constant(0.0), constant(size), ramp(0.0, size / duration, math.inf),
        ramp(size, -2.0 * size / duration, times[2]),
        steps('profile', times, values), table('profile', times, values), table('profile', times, values, duration),
        steps('profile', [t / 4.0 for t in times], values, 0.3 * duration))))
    return replace(profile, sinusoids=draw(_sinusoids(size, omega, 0)))


@st.composite
def _sinusoids(draw: DrawFn, size: float, omega: float, fewest: int) -> tuple[Sinusoid, ...]:
    """Return sines, some of them in resonance, some with the same frequency."""
    frequency = omega / (2.0 * math.pi)
    return tuple(Sinusoid(size * draw(st.floats(0.01, 1.0)),
                      min(max(frequency * draw(st.just(1.0) | _powers(-1.5, 1)), 1e-9), 1e6),
                      draw(st.sampled_from((0.0, 0.5 * math.pi)) | st.floats(-7.0, 7.0)))
                 for _ in range(draw(st.integers(fewest, 3))))
