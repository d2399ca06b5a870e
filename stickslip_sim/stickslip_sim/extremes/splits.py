# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""X13 and X14: the same interval in one call or a million, and ten thousand events inside one tick."""

import random
import time
from collections.abc import Iterator
from dataclasses import replace

from ..axis import Axis, CompliantContact, Friction, InitialState
from ..core.errors import SolverError
from ..core.input_profile import InputProfile
from ..core.types import Event, Instant, Mode
from ..friction import KineticTable, StaticLaw, StaticLawKind
from ..simulation.simulator import Simulator
from ..simulation.solved_axis import MAX_EVENTS_AT_ONCE
from ..solvers import Solver
from .outcome import Measurement, Setup, Tally, require
from .shared_axes import COMPLIANT, CONTACTS, RIGID, Contact, instant, make, paper_axis, random_axis, random_profiles

_PATIENCE = 20.0   # s for a tick full of events; a solver that spins takes for ever


def splits(setup: Setup) -> Measurement:
    """X13: one call, a million, and random ones; same events, and a position within 1e-13 m."""
    tally = Tally(1e-13, 'm')
    for contact in CONTACTS:
        tally.measure(_a_million_calls, setup.solver, contact, setup.count(1_000_000, 20_000))
    for seed in range(setup.count(400, 15)):
        rng = random.Random(seed)
        axis, (drive, force) = random_axis(rng), random_profiles(rng)
        tally.measure(_random_calls, setup.solver, seed, axis, drive, force)
    return tally.finding('with other bits or events')


def _a_million_calls(solver: Solver, contact: Contact, count: int) -> float:
    axis = paper_axis(contact)
    whole, parts = make(axis, 0.002, solver=solver), make(axis, 0.002, solver=solver)
    events = whole.advance(instant(60.0))
    seen = [event for k in range(1, count + 1) for event in parts.advance(_share(60, k, count))]
    return _difference(events, seen, whole, parts)


def _share(whole: int, k: int, count: int) -> Instant:
    """Return the instant k/count of a whole number of seconds, rounded once."""
    second, rest = divmod(whole * k, count)
    return Instant(float(second), rest / count)


def _random_calls(solver: Solver, seed: int, axis: Axis, drive: InputProfile, force: InputProfile) -> float:
    rng = random.Random(seed)
    whole, parts = make(axis, drive, force, solver=solver), make(axis, drive, force, solver=solver)
    events = whole.advance(instant(4.0))
    seen = [event for t in _random_times(rng, 4.0) for event in parts.advance(instant(t))]
    return _difference(events, seen, whole, parts)


def _random_times(rng: random.Random, end: float) -> Iterator[float]:
    t = 0.0
    while t < end:
        t = min(t + rng.choice((1e-9, 1e-6, 1e-3, 0.3)) * rng.random(), end)
        yield t


def _difference(events: list[Event], seen: list[Event], whole: Simulator, parts: Simulator) -> float:
    """Return the distance of the final positions, m; raises Missed unless the events are equal to the bit."""
    require(seen == events, f'{len(seen)} events in parts, {len(events)} in one call, or other bits')
    return abs(whole.sample().position - parts.sample().position)


def events_inside_a_tick(setup: Setup) -> Measurement:
    """X14: more than 10^4 events in a tick: done, or refused by name with a valid state; never for ever."""
    tally = Tally(0.0)
    crowds: list[int] = []
    for mass in setup.choose((1e-8, 1e-9, 1e-10, 1e-12, 1e-15), (1e-8, 1e-12)):
        tally.measure(_swings_in_a_tick, setup.solver, mass, crowds)
    for factor in setup.choose((1e-10, 1e-8, 1e-6), (1e-8,)):
        for contact in CONTACTS:
            tally.measure(_sticks_in_a_tick, setup.solver, contact, factor, crowds)
    tally.measure(_goes_on_after_a_refusal, setup.solver)
    most = max(crowds, default=0)
    return tally.finding('without a bound or a valid state', f'up to {most} events in a tick', kept=most >= 10_000)


def _swings_in_a_tick(solver: Solver, mass: float, crowds: list[int]) -> float:
    """Let a light slider without friction reverse at every half swing of its spring."""
    free = Friction(StaticLaw(StaticLawKind.CONSTANT, 0.0, 0.0), KineticTable((0.0,), (0.0,)), None)
    axis = Axis(mass, 6e5, 0.0, 0.0, RIGID, free)
    return _crowded_tick(make(axis, 0.0, initial=InitialState(velocity=0.1), solver=solver), crowds, 0.1)


def _sticks_in_a_tick(solver: Solver, contact: Contact, factor: float, crowds: list[int]) -> float:
    """Make mass, load and dampers of the paper's axis so small that it sticks and slips within microseconds."""
    axis = paper_axis(contact, tau=1e-9)
    if isinstance(contact, CompliantContact):
        contact = replace(COMPLIANT, damping=COMPLIANT.damping * factor ** 0.5)
    axis = replace(axis, mass=350.0 * factor, drive_damping=4000.0 * factor ** 0.5,
                   normal_force=axis.normal_force * factor, contact=contact)
    return _crowded_tick(make(axis, 0.002, solver=solver), crowds, 1.0)


def _crowded_tick(simulator: Simulator, crowds: list[int], tick: float) -> float:
    begin = time.perf_counter()
    try:
        events = simulator.advance(instant(tick))
        crowds.append(len(events))
    except SolverError as error:
        crowds.append(MAX_EVENTS_AT_ONCE)
        require('events' in str(error) and 't =' in str(error), f'the refusal does not say what happened: {error}')
        require(0.0 <= simulator.time.seconds <= tick, 'the time is not one within the tick')
    require(time.perf_counter() - begin < _PATIENCE, 'it takes too long')
    _check_valid(simulator)
    return 0.0


def _check_valid(simulator: Simulator) -> None:
    sample = simulator.sample()   # raises when a value is not finite
    require(sample.time == simulator.time.seconds, 'the state is not that of its time')
    require(sample.mode != Mode.STICK or abs(sample.friction_coefficient) < 1e3, 'a force without a meaning')


def _goes_on_after_a_refusal(solver: Solver) -> float:
    """After a tick that was refused the next ticks go on, and a reset begins anew."""
    free = Friction(StaticLaw(StaticLawKind.CONSTANT, 0.0, 0.0), KineticTable((0.0,), (0.0,)), None)
    simulator = make(Axis(1e-12, 6e5, 0.0, 0.0, RIGID, free), 0.0, initial=InitialState(velocity=0.1), solver=solver)
    times = []
    for _ in range(2):
        try:
            simulator.advance(instant(1.0))
        except SolverError:
            times.append(simulator.time)
    require(len(times) == 2 and times[1] > times[0] > Instant(0.0, 0.0), 'time does not go on')
    simulator.reset()
    require(simulator.sample().velocity == 0.1 and simulator.time == Instant(0.0, 0.0), 'a reset does not begin anew')
    return 0.0
