# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""X1, X2, X4, X5, X7, X10 and X18: rest that lasts, and a break-away where it is.

It is grazed, under a blow, at the limit, while the contact rings.  X4 looks at what follows one: branches apart below
the limit velocity.
"""

import math
import random
from collections.abc import Callable
from dataclasses import replace

from mpmath import mp, mpf, workdps

from ...axis import Axis, CompliantContact, InitialState
from ...core.input_profile import InputProfile, ramp, steps
from ...core.types import Event, EventKind, Mode
from ...friction import KineticTable, StaticLaw, StaticLawKind
from ...friction.kinetic import default_excess
from ...simulation.simulator import Simulator
from ...solvers import Solver
from .. import axes
from ..axes import CONTACTS, Contact, instant, make, paper_axis, run_events, with_static
from ..closed_form import (
    CLOSED_FORM_DIGITS,
    Jump,
    Number,
    exact,
    exact_contact_force,
    exact_static_coefficient,
    root_near,
)
from ..judges import Measurement, Setup, Tally, error_of_run, in_parts, require, same_bits

YEAR = 3.15576e7     # s, 365.25 days
_RAMP = 100.0        # N/s, after the year
_SHARES = (0.1, 0.5, 0.9, 0.99)
_LIMIT = 0.24        # of the paper's axis after prolonged rest


def year_long_hold(setup: Setup) -> Measurement:
    """X7: hold a share of the limit for a year, by a force or by the drive, then pull until it breaks."""
    tally = Tally(1e-12)
    drift = [0.0]
    for contact in CONTACTS:
        for share in _SHARES:
            for side in (1.0, -1.0):
                tally.measure(_held_by_force, setup.solver, contact, side * share, drift)
                tally.measure(_held_by_drive, setup.solver, contact, side * share, drift)
        tally.measure(_ageing, setup.solver, contact)
    return tally.finding('wrong', f'drift {max(drift):.2g} m in a year', kept=max(drift) == 0.0)


def _held_by_force(solver: Solver, contact: Contact, share: float, drift: list[float]) -> float:
    """Return the relative error of the time from the start of the ramp to the break-away."""
    axis = paper_axis(contact)
    load = share * _LIMIT * axis.normal_force
    side = math.copysign(1.0, share)
    reach = 100.0   # s, so slowly that the contact rings little
    force = InputProfile((0.0, reach, YEAR), (0.0, load, load), (load / reach, 0.0, side * _RAMP))
    simulator = make(axis, 0.0, force, solver=solver)
    _hold(simulator, drift, reach)
    events = simulator.advance(instant(YEAR + 20.0))
    with workdps(CLOSED_FORM_DIGITS):
        jumps = [Jump(0, 1, mpf(load / reach)), Jump(reach, 1, -mpf(load / reach)), Jump(YEAR, 1, side * mpf(_RAMP)),
                 Jump(reach, 0, mpf(load) - mpf(load / reach) * mpf(reach))]
        rigid = (mpf(axis.normal_force) * mpf(_LIMIT) - abs(mpf(load))) / _RAMP
        return _error(axis, events, side, jumps, rigid, 2 * rigid + 2)


def _held_by_drive(solver: Solver, contact: Contact, share: float, drift: list[float]) -> float:
    """Let the drive pull up to the share, stand for a year and go on; error as above."""
    axis = paper_axis(contact)
    side = math.copysign(1.0, share)
    feed = side * 1e-6
    reach = float(round(share * _LIMIT * axis.normal_force / (axis.drive_stiffness * feed)))
    drive = InputProfile((0.0, reach, YEAR), (feed, 0.0, feed), (0.0, 0.0, 0.0))
    simulator = make(axis, drive, solver=solver)
    _hold(simulator, drift, reach)
    events = simulator.advance(instant(YEAR + 2000.0))
    with workdps(CLOSED_FORM_DIGITS):
        c, h, v = mpf(axis.drive_stiffness), mpf(axis.drive_damping), mpf(feed)
        jumps = [Jump(at, order, sign * size) for at, sign in ((0, 1), (mpf(reach), -1), (mpf(YEAR), 1))
                 for order, size in ((0, h * v), (1, c * v))]
        rigid = (mpf(axis.normal_force) * mpf(_LIMIT) / abs(v) - h - c * reach) / c
        return _error(axis, events, side, jumps, rigid, rigid + 1)


def _error(axis: Axis, events: list[Event], side: float, jumps: list[Jump], rigid: Number, latest: Number) -> float:
    """Return the relative error of the time from the year to the break-away, `rigid` for a contact that is."""
    require(events and events[0].kind == EventKind.BREAKAWAY and events[0].direction == side, 'no break-away after it')
    wanted = rigid
    if isinstance(axis.contact, CompliantContact):
        pull, limit = exact_contact_force(axis, jumps), mpf(axis.normal_force) * mpf(_LIMIT)
        wanted = root_near(lambda t: side * pull(mpf(YEAR) + t) - limit, rigid * mpf('0.9'), latest)
    return abs(float((exact(*events[0].instant) - mpf(YEAR)) / wanted - 1))


def _hold(simulator: Simulator, drift: list[float], reach: float) -> None:
    """Go through the year month by month; note how far the slider moves once it is quiet."""
    require(simulator.advance(instant(reach + 60.0)) == [], 'an event while it is loaded')
    start = simulator.sample().position
    for month in range(1, 13):
        require(simulator.advance(instant(min(month * YEAR / 12.0, YEAR - 1.0))) == [], 'an event during the hold')
        sample = simulator.sample()
        drift.append(abs(sample.position - start))
        require(sample.mode == Mode.STICK, 'it does not stick')


def _ageing(solver: Solver, contact: Contact) -> float:
    """Return the relative error of mu_s after a year under a law that rises without bound."""
    law = StaticLaw(StaticLawKind.LOGARITHMIC, 0.12, 0.13, 0.2)
    axis = with_static(paper_axis(contact), law)
    force = InputProfile((0.0, YEAR), (0.0, 0.0), (0.0, _RAMP))
    events = make(axis, 0.0, force, InitialState(rest_time=0.0), solver).advance(instant(YEAR + 100.0))
    require(events and events[0].kind == EventKind.BREAKAWAY, 'no break-away')
    with workdps(CLOSED_FORM_DIGITS):
        rest = exact(*events[0].instant)
        return abs(float(events[0].static_coefficient / exact_static_coefficient(law, rest) - 1))


def rest_times(setup: Setup) -> Measurement:
    """X10: mu_s over rest times 1e-9 to 1e9 s at time constants 1e-12 to 1e12 s, of every law, and in break-aways."""
    tally = Tally(1e-14)
    rests = [0.0, *(10.0 ** k for k in range(-9, 10, setup.choose(1, 3)))]
    for kind in StaticLawKind:
        for tau in (1e-12, 1e-6, 1.0, 1e6, 1e12):
            for rest in rests:
                tally.measure(_coefficient, kind, tau, rest)
    for seed in range(setup.choose(20_000, 300)):
        rng = random.Random(seed)
        tally.measure(_coefficient, rng.choice(list(StaticLawKind)), 10 ** rng.uniform(-12, 12),
                      10 ** rng.uniform(-9, 9))
    for contact in CONTACTS:
        for tau in (1e-12, 0.2, 1e12):
            tally.measure(_of_break_away, setup.solver, paper_axis(contact, tau=tau))
    return tally.finding()


def _coefficient(kind: StaticLawKind, tau: float, rest: float) -> float:
    law = StaticLaw(kind, 0.12, 0.24, tau, 0.7)
    with workdps(CLOSED_FORM_DIGITS):
        return abs(float(law.coefficient(rest) / exact_static_coefficient(law, mpf(rest)) - 1))


def _of_break_away(solver: Solver, axis: Axis) -> float:
    """Return the largest relative error of mu_s over the break-aways of a run, at their rest times."""
    events = [event for event in run_events(axis, 0.002, 20.0, solver=solver) if event.kind == EventKind.BREAKAWAY]
    require(len(events) > 10, f'{len(events)} break-aways')
    worst = 0.0
    for event in events:
        rest = mp.inf if event.rest_time == float('inf') else mpf(event.rest_time)
        with workdps(CLOSED_FORM_DIGITS):
            wanted = exact_static_coefficient(axis.friction.static, rest)
            worst = max(worst, abs(float(event.static_coefficient / wanted - 1)))
    return worst


# Break-aways.

_BLOW, _LENGTH = 33e3, 0.002   # N, s
_OVERSHOOTS = (1e-4, 1e-6, 1e-12, -1e-12, -1e-6)


def grazing(setup: Setup) -> Measurement:
    """X1: random phases and frequencies, both contacts; a peak above the limit breaks away there, one below never."""
    tally = Tally(0.0)
    for seed in range(setup.choose(100_000, 100)):
        tally.measure(_grazes, setup.solver, seed, _OVERSHOOTS[seed % len(_OVERSHOOTS)])
    return tally.finding('missed or invented')


def _grazes(solver: Solver, seed: int, overshoot: float) -> None:
    rng = random.Random(seed)
    axis = axes.paper_axis(rng.choice(axes.CONTACTS))
    phase, frequency = rng.uniform(*axes.PHASES), rng.uniform(*axes.GRAZING_FREQUENCIES)
    drive = axes.grazing_drive(axis, overshoot, frequency, phase)
    period = 1.0 / frequency
    events = axes.make(axis, drive, solver=solver).advance(axes.instant(2.0 * period if overshoot < 0.0 else period))
    if overshoot < 0.0:
        require(not events, f'invented at {events[0].time if events else None!r} s')
        return
    require(events and events[0].kind == EventKind.BREAKAWAY, 'missed')
    turn = events[0].time * frequency + phase / 6.283185307179586
    require(abs(turn - 0.5) < 0.1, f'a break-away {abs(turn - 0.5):.3g} periods beside the peak')


def blows(setup: Setup) -> Measurement:
    """X2: 2 ms, 33 kN on a stuck axis at a random instant; rigid and compliant, pressed before or not."""
    tally = Tally(1e-12, 's')
    for seed in range(setup.choose(1000, 40)):
        for contact in axes.CONTACTS:
            tally.measure(_blow, setup.solver, contact, seed)
    return tally.finding('blows missed')


def _blow(solver: Solver, contact: axes.Contact, seed: int) -> float:
    """Return how far the break-away is from its instant, s."""
    rng = random.Random(seed)
    axis = axes.paper_axis(contact)
    begin, load = rng.uniform(0.0, 5.0), rng.choice((0.0, rng.uniform(-250.0, 400.0)))
    end = begin + _LENGTH
    blow = steps('force', [0.0, begin, end], [load, load + _BLOW, load])
    events = axes.run_events(axis, 0.0, 6.0, blow, solver=solver)
    require(events and events[0].kind == EventKind.BREAKAWAY and begin <= events[0].time <= end,
            'no break-away within the blow')
    first = events[0]
    if contact == axes.RIGID:
        return abs(float(exact(*first.instant) - begin))
    force = exact_contact_force(axis, [Jump(0, 0, load), Jump(begin, 0, (load + _BLOW) - load)])
    return _distance(first, force, axis.normal_force * mpf(0.24), begin, end)


def _distance(event: Event, force: Callable[[Number], Number], limit: Number, low: float, high: float) -> float:
    with workdps(CLOSED_FORM_DIGITS):
        root = root_near(lambda t: force(t) - limit, low, high)
        return abs(float(exact(*event.instant) - root))


def at_the_limit(setup: Setup) -> Measurement:
    """X18: the force at the first break-away over N mu_s, less one; every law, random axes, both contacts."""
    tally = Tally(1e-12)
    for seed in range(setup.choose(2000, 60)):
        for kind in StaticLawKind:
            tally.measure(_first_break, setup.solver, kind, seed)
    for share in (-1.0, 1.0):
        for contact in axes.CONTACTS:
            tally.measure(_held_at_the_limit, setup.solver, contact, share)
    return tally.finding('not at the limit')


def _first_break(solver: Solver, kind: StaticLawKind, seed: int) -> float:
    """Return | |F| / (N mu_s) − 1 | at the instant found, from the inputs and 50 digits; no other instant before it."""
    rng = random.Random(seed)
    axis = axes.random_axis(rng)
    tau, exponent = 10 ** rng.uniform(-2, 1), rng.choice((0.4, 1.0, 2.5))
    initial = axis.friction.static.initial
    axis = axes.with_static(axis, StaticLaw(kind, initial, initial + rng.uniform(0.01, 0.2), tau, exponent))
    rest, speed, rate = 10 ** rng.uniform(-3, 1), 10 ** rng.uniform(-4, -2), 10 ** rng.uniform(-5, -2)
    if axis.drive_damping * speed > 0.5 * axis.normal_force * initial:   # its start alone must not break it away
        axis = replace(axis, drive_damping=0.5 * axis.normal_force * initial / speed)
    drive = ramp(speed, rate, float('inf'))
    duration = 1.0
    while duration < 1e9:
        events = axes.run_events(axis, drive, duration, initial=InitialState(rest_time=rest), solver=solver)
        if events:
            break
        duration *= 8.0
    require(events and events[0].kind == EventKind.BREAKAWAY, 'no break-away')
    return _excess_of_force(axis, events[0], rest, speed, rate)


def _excess_of_force(axis: Axis, event: Event, rest: float, speed: float, rate: float) -> float:
    with workdps(CLOSED_FORM_DIGITS):
        t = exact(*event.instant)
        c, h = mpf(axis.drive_stiffness), mpf(axis.drive_damping)
        if isinstance(axis.contact, CompliantContact):
            jumps = [Jump(0, 0, h * speed), Jump(0, 1, c * speed + h * rate), Jump(0, 2, c * rate)]
            force = exact_contact_force(axis, jumps)(t)
        else:
            force = c * (mpf(speed) + mpf(rate) * t / 2) * t + h * (mpf(speed) + mpf(rate) * t)
        limit = axis.normal_force * exact_static_coefficient(axis.friction.static, mpf(rest) + t)
        return abs(float(force / limit - 1))


def _held_at_the_limit(solver: Solver, contact: axes.Contact, side: float) -> None:
    """See that a force within the limit, and one on it, hold for ever; a relative 1e-12 more does not."""
    axis = axes.paper_axis(contact)
    limit = side * 0.24 * axis.normal_force
    if isinstance(contact, CompliantContact):   # a step would ring over it: bring it there slowly
        limit *= 1.0 + axis.drive_stiffness / contact.stiffness   # the drive spring takes its part
        reach = 1e7
        for share, holds in ((1.0 - 1e-9, True), (1.0 + 1e-9, False)):
            slow = InputProfile((0.0, reach), (0.0, share * limit), (share * limit / reach, 0.0))
            none = axes.run_events(axis, 0.0, 2e7, slow, solver=solver) == []
            require(none == holds, f'wrong at {share!r} of the limit')
        return
    for force, holds in ((limit * (1.0 - 1e-15), True), (limit, True), (limit * (1.0 + 1e-12), False)):
        events = axes.run_events(axis, 0.0, 10.0, force, solver=solver)
        require((events == []) == holds, f'wrong under {force!r} N')


def coasting(setup: Setup) -> Measurement:
    """X4: the peak speed stays below v_gr, where the branches are apart; the run is the reference's."""
    tally = Tally(1e-12)
    for contact in axes.CONTACTS:
        for speed in setup.choose((0.001, 0.0015, 0.002, 0.003, 0.005), (0.002,)):
            tally.measure(_below_the_limit_velocity, setup.solver, contact, speed)
    for seed in range(setup.choose(60, 4)):
        tally.measure(_random_branches, setup.solver, seed)
    return tally.finding()


def _below_the_limit_velocity(solver: Solver, contact: axes.Contact, speed: float) -> float:
    axis = axes.paper_axis(contact)
    events = axes.run_events(axis, speed, 3.0, solver=solver)
    coasts = [event.velocity for event in axes.of_kind(events, EventKind.COAST)]
    require(coasts and max(coasts) < axis.friction.kinetic.velocities[-1], 'the branches are not apart at the peak')
    _check_independent_of_steps(solver, axis, speed, events)
    return error_of_run(solver, axis, speed, 3.0)


def _random_branches(solver: Solver, seed: int) -> float:
    """Both branches fall by random amounts, so that the coasting band is wide, narrow or bent by a breakpoint."""
    rng = random.Random(seed)
    top = rng.uniform(0.01, 0.05)
    kinetic = KineticTable((0.0, rng.uniform(0.2, 0.8) * top, top), (0.12, rng.uniform(0.07, 0.12), 0.05))
    axis = axes.paper_axis(rng.choice(axes.CONTACTS), tau=10 ** rng.uniform(-1.5, 0))
    axis = replace(axis, drive_damping=rng.choice((0.0, 1000.0, 4000.0)),
                   friction=replace(axis.friction, kinetic=kinetic, excess=default_excess(kinetic)))
    speed = 10 ** rng.uniform(-3.3, -2.3)
    _check_independent_of_steps(solver, axis, speed, axes.run_events(axis, speed, 3.0, solver=solver))
    return error_of_run(solver, axis, speed, 1.5)


def _check_independent_of_steps(solver: Solver, axis: Axis, speed: float, events: list[Event]) -> None:
    for steps_per_second in (7, 1000, 1024):
        seen = in_parts(axes.make(axis, speed, solver=solver),
                        (axes.instant((k + 1) / steps_per_second) for k in range(3 * steps_per_second)))
        same_bits(seen, events, f'{steps_per_second} steps a second')


def ringing(setup: Setup) -> Measurement:
    """X5: 5 to 20 mm/s, so that the next break-away comes while the contact still rings; the reference's events."""
    tally = Tally(1e-12)
    for k in range(setup.choose(31, 4)):
        speed = 0.005 + 0.015 * k / setup.choose(30, 3)
        for tau in setup.choose((0.02, 0.2), (0.2,)):
            for damping in (15000.0, 0.0):
                axis = axes.paper_axis(CompliantContact(5e6, damping), tau=tau)
                tally.measure(error_of_run, setup.solver, axis, speed, 1.5)
    return tally.finding('with other events than the reference')
