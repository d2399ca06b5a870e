# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""X3, X12, X21, X22, X23 and X27: guards at their limit: touched, passed at once, or met by another event or a tick.

In X21 friction is continuous at a break-away: at that instant nothing is left over to accelerate the slider, and which
mode comes next is decided by where the sines of that very instant move the force.  In X22 and
X23 a step of the root finding gives out.
"""

import math
import random
from collections.abc import Callable
from dataclasses import replace
from itertools import groupby, pairwise, permutations

from ...axis import Axis, CompliantContact, Friction, InitialState
from ...core.input_profile import InputProfile, Sinusoid, constant, steps
from ...core.types import Event, EventKind, Instant
from ...friction import KineticTable, StaticLaw, StaticLawKind
from ...friction.kinetic import default_excess
from ...reference import simulate
from ...simulation.simulator import Simulator
from ...solvers import Solver
from ..axes import CONTACTS, RIGID, instant, make, paper_axis, random_axis, run_events
from ..judges import DIGITS, Measurement, Setup, Tally, error_of_events, error_of_run, in_parts, require, same_bits

_DOUBLED = Sinusoid(900.0, 0.7, 0.3), Sinusoid(850.0, 1.1, 2.0)   # whose break-aways were doubled once


def shaken(setup: Setup) -> Measurement:
    """X21: the paper's axis under one to three sines that pass its limit; the run is the reference's."""
    tally = Tally(1e-12)
    random_ones = (_random_sinusoids(random.Random(seed)) for seed in range(setup.choose(100, 6)))
    for sinusoids in (*((one,) for one in _DOUBLED), *random_ones):
        force = InputProfile((0.0,), (0.0,), (0.0,), sinusoids=sinusoids)
        tally.measure(error_of_run, setup.solver, paper_axis(RIGID), 0.0, 3.0, force)
    return tally.finding('with other events than the reference')


def _random_sinusoids(rng: random.Random) -> tuple[Sinusoid, ...]:
    """Return sines whose amplitudes make 1 to 2.5 times the static limit together."""
    axis = paper_axis(RIGID)
    count = rng.randint(1, 3)
    size = rng.uniform(1.0, 2.5) * axis.friction.static.limit * axis.normal_force / count
    return tuple(Sinusoid(size, 10 ** rng.uniform(-0.5, 1.0), rng.uniform(-7.0, 7.0)) for _ in range(count))


def steep_segments(setup: Setup) -> Measurement:
    """X22: kinetic friction that falls within 0.05 to 50 mm/s: slips grow by e²⁴⁰ and more."""
    tally = Tally(1e-12)
    tally.measure(_equals_the_reference, setup.solver, _blown_up(), 0.1, 0.0, 60.0)
    for k in setup.choose(tuple(range(0, 400, 2)), (186, 210)):
        tally.measure(_equals_the_reference, setup.solver, _paper_axis(5e-5 * 10.0 ** (k / 399)), 0.01, 0.0, 3.0)
    for seed in range(setup.choose(100, 3)):
        rng = random.Random(seed)
        tally.measure(_equals_the_reference, setup.solver, _steep(rng), 10 ** rng.uniform(-4, -1), 0.0, 3.0)
    return tally.finding('with other events than the reference')


def _paper_axis(limit_velocity: float) -> Axis:
    axis = paper_axis(RIGID, branches=False)
    table = KineticTable((0.0, limit_velocity), (0.12, 0.05))
    return replace(axis, friction=replace(axis.friction, kinetic=table))


def _blown_up() -> Axis:
    """Return an axis that reached 3.8e95 km/s once."""
    table = KineticTable((0.0, 0.00273), (1.5, 1.0))
    return Axis(1.0, 2.0, 0.0, 1.0, RIGID, Friction(StaticLaw(StaticLawKind.CONSTANT, 1.5, 1.5), table, None))


def _steep(rng: random.Random) -> Axis:
    mass, omega = 10 ** rng.uniform(0, 4), 10 ** rng.uniform(0.5, 2.3)
    at_rest = rng.uniform(0.1, 1.5)
    table = KineticTable((0.0, 10 ** rng.uniform(-4.3, -1.3)), (at_rest, at_rest * rng.uniform(0.1, 0.95)))
    static = StaticLaw(StaticLawKind.EXPONENTIAL, at_rest, at_rest * rng.uniform(1.0, 2.0), 10 ** rng.uniform(-2, 1))
    damping = rng.choice((0.0, rng.uniform(0.0, 1.2))) * 2.0 * mass * omega
    contact = rng.choice((RIGID, CompliantContact(mass * omega * omega * rng.uniform(1, 50), mass * omega)))
    excess = rng.choice((None, default_excess(table)))
    return Axis(mass, mass * omega * omega, damping, 9.80665 * mass, contact, Friction(static, table, excess))


def near_critical(setup: Setup) -> Measurement:
    """X23: slips that are critically damped to 1e-5 to 1e-13, from both sides: they die out to 1e-300 before a turn."""
    tally = Tally(1e-12)
    tally.measure(_equals_the_reference, setup.solver, _near_critical(28982.753), 0.0286, -300.0, 1.0)
    for seed in range(setup.choose(200, 10)):
        rng = random.Random(seed)
        off = rng.choice((-1.0, 1.0)) * 10 ** rng.uniform(-13, -5)
        axis = _near_critical(2.0 * math.sqrt(6e5 * 350.0) * (1.0 + off))
        tally.measure(_equals_the_reference, setup.solver, axis, rng.uniform(0.001, 0.06), rng.uniform(-400, 400), 1.0)
    return tally.finding('with other events than the reference')


def _near_critical(damping: float) -> Axis:
    axis = paper_axis(RIGID, branches=False)
    table = KineticTable((0.0, 0.001, 0.003, 0.01, 0.035), (0.12, 0.12, 0.12, 0.12, 0.05))
    return replace(axis, drive_damping=damping, friction=replace(axis.friction, kinetic=table))


def _equals_the_reference(solver: Solver, axis: Axis, feed: float, force: float, duration: float) -> float:
    """Compare both up to where the axis slides steadily, within rounding; the reference goes on turning below."""
    events = run_events(axis, constant(feed), duration, constant(force), solver=solver)
    wanted = simulate(axis, InitialState(), constant(feed), constant(force), duration, DIGITS).events
    if events and events[-1].kind == EventKind.COAST and events[-1].velocity == feed:
        end = len(events) - 1
        require(all(abs(event.velocity - feed) <= 1e-12 * feed for event in wanted[end:]), 'it does not slide steadily')
        events, wanted = events[:end], wanted[:end]
    return error_of_events(events, wanted, duration)


def touched_limits(setup: Setup) -> Measurement:
    """X27: mu_s = mu_k, no damper anywhere and a drive that rests: the contact comes back to its limit for ever."""
    tally = Tally(0.0)
    for seed in range(setup.choose(2000, 200)):
        tally.measure(_breaks_only_beyond, setup.solver, seed)
    return tally.finding('with an invented or a missed break-away')


def _breaks_only_beyond(solver: Solver, seed: int) -> None:
    """Push the slider once; after it has come to stick, the far end of its swing alone may break it, or nothing."""
    rng = random.Random(seed)
    axis, speed = _undamped(rng), rng.choice((-1, 1)) * 10 ** rng.uniform(-4, -1)
    events = run_events(axis, constant(0.0), 10.0, initial=InitialState(0.0, speed, 0.0), solver=solver)
    stiffness = axis.contact.stiffness if isinstance(axis.contact, CompliantContact) else 0.0
    limit = axis.normal_force * axis.friction.static.limit
    for arrest, after in zip(events, [*events[1:], None]):
        if arrest.kind != EventKind.STICK:
            continue
        swing = 2.0 * (arrest.drive_force - arrest.friction_force) * stiffness / (axis.drive_stiffness + stiffness)
        beyond = abs(arrest.friction_force + swing) / limit - 1.0
        if abs(beyond) > 1e-9:
            require((after is not None) == (beyond > 0.0), f'the far end is {1.0 + beyond} of the limit; then {after}')


def _undamped(rng: random.Random) -> Axis:
    mass, stiffness, coefficient = 10 ** rng.uniform(0, 4), 10 ** rng.uniform(4, 8), rng.uniform(0.05, 0.5)
    falling = KineticTable((0.0, 10 ** rng.uniform(-3, -1)), (coefficient, coefficient * rng.uniform(0.3, 1.0)))
    table = rng.choice((KineticTable((0.0,), (coefficient,)), falling))
    static = StaticLaw(StaticLawKind.CONSTANT, coefficient, coefficient)
    contact = CompliantContact(stiffness * 10 ** rng.uniform(-0.5, 2.0), 0.0)
    return Axis(mass, stiffness, 0.0, 9.80665 * mass, contact, Friction(static, table, None))


# Guards that stand at their limit already, and events that meet each other or a tick.

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
