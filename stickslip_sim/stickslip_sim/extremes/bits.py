# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""X19 and X20: mirrored, in other units, and twice: the same bits."""

import hashlib
import math
import random
import subprocess
import sys
from collections.abc import Iterable
from dataclasses import replace

from ..axis import Axis, CompliantContact
from ..core.input_profile import InputProfile
from ..core.types import Event, Sample
from ..friction import ExcessTable, KineticTable, StaticLaw
from ..simulation.simulator import Simulator
from ..solvers import Solver, exact
from .outcome import Measurement, Setup, Tally, require
from .shared_axes import instant, make, random_axis, random_profiles, run_events, scaled_profile


def mirrored_and_scaled(setup: Setup) -> Measurement:
    """X19: (x, v, F) → (−x, −v, −F); the units of mass, length and time multiplied by powers of two."""
    tally = Tally(0.0)
    for seed in range(setup.count(1000, 25)):
        tally.measure(_mirrored, setup.solver, seed)
        for unit in (_mass_unit, _length_unit, _time_unit):
            tally.measure(unit, setup.solver, seed)
    return tally.finding('with other bits')


def _mirrored(solver: Solver, seed: int) -> float:
    rng = random.Random(seed)
    axis, (drive, force) = random_axis(rng), random_profiles(rng)
    events = run_events(axis, drive, 3.0, force, solver=solver)
    images = run_events(axis, scaled_profile(drive, -1.0), 3.0, scaled_profile(force, -1.0), solver=solver)
    _check_equal(images, (e._replace(
        direction=-e.direction, position=-e.position, velocity=-e.velocity, drive_position=-e.drive_position,
        drive_force=-e.drive_force, friction_force=-e.friction_force) for e in events))
    return 0.0


def _check_equal(events: list[Event], wanted: Iterable[Event]) -> None:
    wanted = list(wanted)
    require(len(events) == len(wanted), f'{len(events)} events instead of {len(wanted)}')
    for i, (event, other) in enumerate(zip(events, wanted)):
        require(event == other, f'event {i}: {tuple(event)} instead of {tuple(other)}')


def _mass_unit(solver: Solver, seed: int) -> float:
    """All forces, stiffnesses, dampers and the mass are multiplied."""
    rng = random.Random(seed)
    axis, (drive, force) = random_axis(rng), random_profiles(rng)
    k = math.ldexp(1.0, rng.choice((-40, -7, 1, 13, 60)))
    other = replace(_times(axis, k, k), mass=k * axis.mass, normal_force=k * axis.normal_force)
    _check_equal(run_events(other, drive, 3.0, scaled_profile(force, k), solver=solver), (
        e._replace(drive_force=k * e.drive_force, friction_force=k * e.friction_force)
        for e in run_events(axis, drive, 3.0, force, solver=solver)))
    return 0.0


def _times(axis: Axis, stiffer: float, damper: float) -> Axis:
    """Return the axis with stiffnesses and dampers multiplied."""
    contact = axis.contact
    if isinstance(contact, CompliantContact):
        contact = CompliantContact(stiffer * contact.stiffness, damper * contact.damping)
    return replace(axis, drive_stiffness=stiffer * axis.drive_stiffness, drive_damping=damper * axis.drive_damping,
                   contact=contact)


def _faster(axis: Axis, k: float) -> Axis:
    """Return the axis with all speeds of its friction tables multiplied."""
    friction = axis.friction
    kinetic, excess = friction.kinetic, friction.excess
    kinetic = KineticTable(tuple(k * v for v in kinetic.velocities), kinetic.coefficients, kinetic.end_slope / k)
    if excess is not None:
        excess = ExcessTable(tuple(k * v for v in excess.velocities), excess.fractions)
    return replace(axis, friction=replace(friction, kinetic=kinetic, excess=excess))


def _length_unit(solver: Solver, seed: int) -> float:
    """All lengths, speeds and forces are multiplied; mass, stiffnesses and dampers stay."""
    rng = random.Random(seed)
    axis, (drive, force) = random_axis(rng), random_profiles(rng)
    k = math.ldexp(1.0, rng.choice((-40, -7, 1, 13, 60)))
    other = replace(_faster(axis, k), normal_force=k * axis.normal_force)
    events = run_events(axis, drive, 3.0, force, solver=solver)
    _check_equal(run_events(other, scaled_profile(drive, k), 3.0, scaled_profile(force, k), solver=solver), (
        e._replace(position=k * e.position, velocity=k * e.velocity, drive_position=k * e.drive_position,
                   drive_force=k * e.drive_force, friction_force=k * e.friction_force) for e in events))
    return 0.0


def _time_unit(solver: Solver, seed: int) -> float:
    """All times are multiplied by k < 1, within the first second, where a time is one number: c/k², h/k, v/k, F/k²."""
    rng = random.Random(seed)
    axis, (drive, force) = random_axis(rng), random_profiles(rng)
    k = math.ldexp(1.0, rng.choice((-1, -3, -10, -20)))
    law = axis.friction.static
    other = _faster(_times(axis, 1.0 / (k * k), 1.0 / k), 1.0 / k)
    law = StaticLaw(law.kind, law.initial, law.limit, k * law.time_constant, law.exponent)
    other = replace(other, normal_force=axis.normal_force / (k * k), friction=replace(other.friction, static=law))
    end = 0.999
    events = run_events(axis, drive, end, force, solver=solver)
    force_factor = 1.0 / (k * k)
    slower = run_events(other, _in_time(drive, k, 1.0 / k), k * end, _in_time(force, k, force_factor), solver=solver)
    _check_equal(slower, (
        e._replace(fraction=k * e.fraction, velocity=e.velocity / k, drive_force=force_factor * e.drive_force,
                   friction_force=force_factor * e.friction_force, rest_time=k * e.rest_time) for e in events))
    return 0.0


def _in_time(profile: InputProfile, k: float, factor: float) -> InputProfile:
    return InputProfile(tuple(k * t for t in profile.starts), tuple(factor * x for x in profile.values),
                  tuple(factor * x / k for x in profile.rates), k * profile.period)


def run_twice(setup: Setup) -> Measurement:
    """X20: the same scene twice, in this process and in another; recorded commands run again."""
    tally = Tally(0.0)
    for seed in range(setup.count(100, 5)):
        tally.measure(_recorded_commands, setup.solver, seed)
    seeds = setup.count(20, 2)
    if setup.solver is exact.SOLVER:
        tally.measure(_in_another_process, seeds)
    return tally.finding('with other bits')


def _recorded_commands(solver: Solver, seed: int) -> float:
    """Commands at random ticks are recorded as applied, and run again from the record alone, in other calls."""
    rng = random.Random(seed)
    axis, (drive, force) = random_axis(rng), random_profiles(rng)
    record: list[tuple[int, float, float]] = []
    first = make(axis, drive, force, solver=solver)
    seen, states = list[Event](), list[Sample]()
    for tick in range(1, 2001):
        seen += first.advance(instant(tick / 1000))
        states.append(first.sample())
        if rng.random() < 0.01 and tick < 2000:
            record.append((tick, rng.uniform(-0.02, 0.02), rng.uniform(-300.0, 300.0)))
            _command(first, *record[-1][1:])
    again, repeated = make(axis, drive, force, solver=solver), list[Event]()
    for tick, velocity, pull in record:
        repeated += again.advance(instant(tick / 1000))
        require(again.sample() == states[tick - 1], f'another state at tick {tick}')
        _command(again, velocity, pull)
    repeated += again.advance(instant(2.0))
    require(repeated == seen, f'{len(repeated)} events instead of {len(seen)}, or other bits')
    return 0.0


def _command(simulator: Simulator, velocity: float, force: float) -> None:
    simulator.command_drive(velocity)
    simulator.command_force(force)


def _in_another_process(seeds: int) -> float:
    program = f'from {__name__} import digest; print(digest({seeds}))'
    done = subprocess.run([sys.executable, '-c', program], capture_output=True, text=True, check=False)
    require(done.stdout.strip() == digest(seeds), f'another process gives other bits {done.stderr[-200:]}')
    return 0.0


def digest(seeds: int) -> str:
    """Return a digest of all bits of the events of random runs."""
    total = hashlib.sha256()
    for seed in range(seeds):
        rng = random.Random(seed)
        axis, (drive, force) = random_axis(rng), random_profiles(rng)
        for event in run_events(axis, drive, 3.0, force):
            total.update(' '.join(float(number).hex() for number in event).encode())
    return total.hexdigest()
