# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""X3 and X12: guards that stand at their limit already, and events that meet each other or a tick."""

import math
import random
from collections.abc import Callable
from dataclasses import replace
from itertools import groupby, pairwise, permutations

from ...axis import Axis, InitialState
from ...core.input_profile import InputProfile, constant, steps
from ...core.types import Event, EventKind, Instant
from ...friction import KineticTable
from ...simulation.simulator import Simulator
from ...solvers import Solver
from ..axes import CONTACTS, instant, make, paper_axis, random_axis, run_events
from ..judges import Measurement, Setup, Tally, error_of_run, in_parts, require, same_bits

_AT_ONE_INSTANT = 3   # break-away, coast, accelerate: more of them at one instant is no progress


def guards_at_their_limit(setup: Setup) -> Measurement:
    """X3: mu_s(0) = mu_k(0), so that every arrest is exactly on the static limit; progress at every event."""
    tally = Tally(1e-12)
    for seed in range(setup.choose(500, 20)):
        tally.measure(_arrives_on_the_limit, setup.solver, seed)
    for contact in CONTACTS:
        for branches in (True, False):
            axis = paper_axis(contact, branches=branches)
            for speed in setup.choose((0.0005, 0.002, 0.008), (0.002,)):
                tally.measure(error_of_run, setup.solver, axis, speed, 2.0)
            tally.measure(_starts_on_the_limit, setup.solver, axis)
    return tally.finding('without progress or wrong')


def _arrives_on_the_limit(solver: Solver, seed: int) -> None:
    rng = random.Random(seed)
    axis = random_axis(rng)
    friction = axis.friction
    at_rest = friction.static.initial
    kinetic = KineticTable(friction.kinetic.velocities, (at_rest, *friction.kinetic.coefficients[1:]))
    axis = replace(axis, friction=replace(friction, kinetic=kinetic))
    events = run_events(axis, rng.choice((-1, 1)) * 10 ** rng.uniform(-3, -1.5), 5.0, solver=solver)
    _check_progress(events)
    for event, after in pairwise(events):
        if event.kind == EventKind.STICK:
            require(after.instant > event.instant, f'it breaks away at the instant of its arrest, t = {event.time!r} s')


def _check_progress(events: list[Event]) -> None:
    for moment, group in groupby(events, key=lambda event: event.instant):
        count = sum(1 for _ in group)
        require(count <= _AT_ONE_INSTANT, f'{count} events at t = {moment.seconds!r} s')


def _starts_on_the_limit(solver: Solver, axis: Axis) -> None:
    """At rest time 0 the limit is met by the force at the start, and later at every multiple of a square wave."""
    load = 0.12 * axis.normal_force
    force = steps('force', [0.0, 0.5], [load, -load], 1.0)
    simulator = make(axis, 0.0, force, InitialState(rest_time=0.0), solver)
    _check_progress(in_parts(simulator, (instant(0.25 * k) for k in range(1, 21))))
    require(simulator.sample().time == 5.0, 'it does not reach the end')


def meeting_events(setup: Setup) -> Measurement:
    """X12: two things at one instant in either order, and ticks on an event and one ULP beside it."""
    tally = Tally(0.0)
    for contact in CONTACTS:
        for branches in (True, False):
            axis = paper_axis(contact, branches=branches)
            tally.measure(_ticks_on_events, setup.solver, axis)
            tally.measure(_jumps_on_events, setup.solver, axis)
        for seed in range(setup.choose(200, 10)):
            tally.measure(_commands_in_any_order, setup.solver, paper_axis(contact), seed)
    for seed in range(setup.choose(100, 5)):
        tally.measure(_ticks_on_events, setup.solver, random_axis(random.Random(seed)))
    return tally.finding('depend on the order or on the ticks')


def _ticks_on_events(solver: Solver, axis: Axis) -> None:
    """Tick on every event, one ULP before, one after: each comes once, in the first call that reaches it."""
    events = run_events(axis, 0.004, 3.0, solver=solver)
    for offset in (-1, 0, 1):
        simulator, seen = make(axis, 0.004, solver=solver), list[Event]()
        for event in events:
            to = _beside(event.instant, offset)
            if to < simulator.time:
                continue
            fresh = simulator.advance(to)
            require(all(e.instant <= to for e in fresh), 'an event comes before its time')
            require(offset < 0 or event in seen or event in fresh, 'an event comes late')
            seen += fresh
        seen += simulator.advance(Instant(3.0, 0.0))
        same_bits(seen, events, f'ticks {offset} ULP beside the events')


def _beside(at: Instant, offset: int) -> Instant:
    if offset == 0:
        return at
    fraction = math.nextafter(at.fraction, 2.0 * offset)
    return Instant(at.second, min(max(fraction, 0.0), math.nextafter(1.0, 0.0)))


def _jumps_on_events(solver: Solver, axis: Axis) -> None:
    """Let the force jump at the instant of an event, or one ULP beside it: the ticks still change no bit."""
    for event in run_events(axis, 0.004, 1.5, solver=solver)[:6]:
        if event.second:
            continue
        for offset in (-1, 0, 1):
            begin = _beside(event.instant, offset).fraction
            for size in (150.0, -150.0):
                force = steps('force', [0.0, begin], [0.0, size])
                events = run_events(axis, 0.004, 2.0, force, solver=solver)
                _check_progress(events)
                seen = in_parts(make(axis, 0.004, force, solver=solver), (instant(k / 100) for k in range(1, 201)))
                same_bits(seen, events, f'ticks with a jump of {size!r} N at {begin!r} s')


def _commands_in_any_order(solver: Solver, axis: Axis, seed: int) -> None:
    """Commands of one instant give the same run in any order of application."""
    rng = random.Random(seed)
    v, f = rng.uniform(-0.1, 0.1), rng.uniform(-1000.0, 1000.0)
    when = instant(rng.uniform(0.0, 1.5))
    orders: tuple[Callable[[Simulator], None], ...] = (lambda s: s.command_drive(v), lambda s: s.command_force(f))
    outcomes = []
    for order in permutations(orders):
        simulator = make(axis, 0.002, solver=solver)
        events = simulator.advance(when)
        for apply in order:
            apply(simulator)
        events += simulator.advance(instant(3.0))
        outcomes.append((events, simulator.sample()))
    require(outcomes[0] == outcomes[1], f'v = {v!r} m/s and F = {f!r} N at {when.seconds!r} s')
    profile = make(axis, _switch(0.002, v, when), _switch(0.0, f, when), solver=solver)
    events = profile.advance(instant(3.0))
    require([(e.kind, e.direction) for e in events] == [(e.kind, e.direction) for e in outcomes[0][0]],
            f'input profiles that jump together differ from commands: v = {v!r} m/s, F = {f!r} N at {when.seconds!r} s')


def _switch(before: float, after: float, when: Instant) -> InputProfile:
    return steps('profile', [0.0, when.seconds], [before, after]) if when.seconds > 0.0 else constant(after)
