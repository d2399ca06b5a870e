# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""X13, X14, X19 and X20: split, mirrored, in other units, twice: the same bits; ten thousand events inside a tick."""

import hashlib
import random
import subprocess
import sys
import time
from collections.abc import Iterator
from dataclasses import replace

from ...axis import Axis, CompliantContact, InitialState
from ...core.errors import SolverError
from ...core.types import Event, Instant, Mode, Sample
from ...simulation.simulator import Simulator
from ...simulation.solved_axis import MAX_EVENTS_AT_ONCE
from ...solvers import Solver, exact
from ..axes import COMPLIANT, CONTACTS, FRICTIONLESS, RIGID, Contact, instant, make, paper_axis, random_parts
from ..judges import Measurement, Setup, Tally, in_parts, require, same_bits
from ..transforms import Image, images

_PATIENCE = 20.0   # s for a tick full of events; a solver that spins takes for ever


def mirrored_and_scaled(setup: Setup) -> Measurement:
    """X19: (x, v, F) → (−x, −v, −F); the units of mass, length and time multiplied by powers of two."""
    tally = Tally(0.0)
    for seed in range(setup.choose(1000, 25)):
        rng = random.Random(seed)
        parts = random_parts(rng, 3.0)
        events = parts.events(setup.solver)
        for image in images(parts, rng):
            tally.measure(_image, setup.solver, image, events)
    return tally.finding('with other bits')


def _image(solver: Solver, image: Image, events: list[Event]) -> None:
    same_bits(image.parts.events(solver), image.of_events(events), image.name)


def splits(setup: Setup) -> Measurement:
    """X13: one call, a million, and random ones; same events, and a position within 1e-13 m."""
    tally = Tally(1e-13, 'm')
    for contact in CONTACTS:
        tally.measure(_a_million_calls, setup.solver, contact, setup.choose(1_000_000, 20_000))
    for seed in range(setup.choose(400, 15)):
        tally.measure(_random_calls, setup.solver, seed)
    return tally.finding('with other bits or events')


def _a_million_calls(solver: Solver, contact: Contact, count: int) -> float:
    axis = paper_axis(contact)
    whole, parts = make(axis, 0.002, solver=solver), make(axis, 0.002, solver=solver)
    events = whole.advance(instant(60.0))
    same_bits(in_parts(parts, (_share(60, k, count) for k in range(1, count + 1))), events)
    return _distance(whole, parts)


def _share(whole: int, k: int, count: int) -> Instant:
    """Return the instant k/count of a whole number of seconds, rounded once."""
    second, rest = divmod(whole * k, count)
    return Instant(float(second), rest / count)


def _random_calls(solver: Solver, seed: int) -> float:
    run = random_parts(random.Random(seed), 4.0)
    whole, parts = run.simulator(solver), run.simulator(solver)
    events = whole.advance(instant(run.duration))
    same_bits(in_parts(parts, map(instant, _random_times(random.Random(seed), run.duration))), events)
    return _distance(whole, parts)


def _random_times(rng: random.Random, end: float) -> Iterator[float]:
    t = 0.0
    while t < end:
        t = min(t + rng.choice((1e-9, 1e-6, 1e-3, 0.3)) * rng.random(), end)
        yield t


def _distance(whole: Simulator, parts: Simulator) -> float:
    """Return the distance of the final positions, m."""
    return abs(whole.sample().position - parts.sample().position)


def events_inside_a_tick(setup: Setup) -> Measurement:
    """X14: more than 10^4 events in a tick: done, or refused by name with a valid state; never for ever."""
    tally = Tally(0.0)
    crowds: list[int] = []
    for mass in setup.choose((1e-8, 1e-9, 1e-10, 1e-12, 1e-15), (1e-10,)):
        tally.measure(_swings_in_a_tick, setup.solver, mass, crowds)
    for factor in setup.choose((1e-10, 1e-8, 1e-6), (1e-8,)):
        for contact in CONTACTS:
            tally.measure(_sticks_in_a_tick, setup.solver, contact, factor, crowds)
    tally.measure(_goes_on_after_a_refusal, setup.solver)
    most = max(crowds, default=0)
    return tally.finding('without a bound or a valid state', f'up to {most} events in a tick', kept=most >= 10_000)


def _swings_in_a_tick(solver: Solver, mass: float, crowds: list[int]) -> None:
    """Let a light slider without friction reverse at every half swing of its spring."""
    _crowded_tick(_swinging(solver, mass), crowds, 0.1)


def _swinging(solver: Solver, mass: float) -> Simulator:
    axis = Axis(mass, 6e5, 0.0, 0.0, RIGID, FRICTIONLESS)
    return make(axis, 0.0, initial=InitialState(velocity=0.1), solver=solver)


def _sticks_in_a_tick(solver: Solver, contact: Contact, factor: float, crowds: list[int]) -> None:
    """Make mass, load and dampers of the paper's axis so small that it sticks and slips within microseconds."""
    axis = paper_axis(contact, tau=1e-9)
    if isinstance(contact, CompliantContact):
        contact = replace(COMPLIANT, damping=COMPLIANT.damping * factor ** 0.5)
    axis = replace(axis, mass=350.0 * factor, drive_damping=4000.0 * factor ** 0.5,
                   normal_force=axis.normal_force * factor, contact=contact)
    _crowded_tick(make(axis, 0.002, solver=solver), crowds, 1.0)


def _crowded_tick(simulator: Simulator, crowds: list[int], tick: float) -> None:
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


def _check_valid(simulator: Simulator) -> None:
    sample = simulator.sample()   # raises when a value is not finite
    require(sample.time == simulator.time.seconds, 'the state is not that of its time')
    require(sample.mode != Mode.STICK or abs(sample.friction_coefficient) < 1e3, 'a force without a meaning')


def _goes_on_after_a_refusal(solver: Solver) -> None:
    """After a tick that was refused the next ticks go on, and a reset begins anew."""
    simulator = _swinging(solver, 1e-12)
    times = []
    for _ in range(2):
        try:
            simulator.advance(instant(1.0))
        except SolverError:
            times.append(simulator.time)
    require(len(times) == 2 and times[1] > times[0] > Instant(0.0, 0.0), 'time does not go on')
    simulator.reset()
    require(simulator.sample().velocity == 0.1 and simulator.time == Instant(0.0, 0.0), 'a reset does not begin anew')


def run_twice(setup: Setup) -> Measurement:
    """X20: the same scene twice, in this process and in another; recorded commands run again."""
    tally = Tally(0.0)
    for seed in range(setup.choose(100, 5)):
        tally.measure(_recorded_commands, setup.solver, seed)
    seeds = setup.choose(20, 2)
    if setup.solver is exact.SOLVER:
        tally.measure(_in_another_process, seeds)
    return tally.finding('with other bits')


def _recorded_commands(solver: Solver, seed: int) -> None:
    """Commands at random ticks are recorded as applied, and run again from the record alone, in other calls."""
    rng = random.Random(seed)
    parts = random_parts(rng, 2.0)
    record: list[tuple[int, float, float]] = []
    first = parts.simulator(solver)
    seen, states = list[Event](), list[Sample]()
    for tick in range(1, 2001):
        seen += first.advance(instant(tick / 1000))
        states.append(first.sample())
        if rng.random() < 0.01 and tick < 2000:
            record.append((tick, rng.uniform(-0.02, 0.02), rng.uniform(-300.0, 300.0)))
            _command(first, *record[-1][1:])
    again, repeated = parts.simulator(solver), list[Event]()
    for tick, velocity, pull in record:
        repeated += again.advance(instant(tick / 1000))
        require(again.sample() == states[tick - 1], f'another state at tick {tick}')
        _command(again, velocity, pull)
    repeated += again.advance(instant(2.0))
    same_bits(repeated, seen)


def _command(simulator: Simulator, velocity: float, force: float) -> None:
    simulator.command_drive(velocity)
    simulator.command_force(force)


def _in_another_process(seeds: int) -> None:
    program = f'from {__name__} import digest; print(digest({seeds}))'
    done = subprocess.run([sys.executable, '-c', program], capture_output=True, text=True, check=False)
    require(done.stdout.strip() == digest(seeds), f'another process gives other bits {done.stderr[-200:]}')


def digest(seeds: int) -> str:
    """Return a digest of all bits of the events of random runs."""
    total = hashlib.sha256()
    for seed in range(seeds):
        for event in random_parts(random.Random(seed), 3.0).events():
            total.update(' '.join(float(number).hex() for number in event).encode())
    return total.hexdigest()
