# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""X2 and X18: a break-away is where it is, under a blow and exactly at the limit."""

import random
from collections.abc import Callable
from dataclasses import replace

from mpmath import mpf, workdps

from ..axis import Axis, CompliantContact, InitialState
from ..core.input_profile import InputProfile, ramp, steps
from ..core.types import Event, EventKind
from ..friction import StaticLaw, StaticLawKind
from ..solvers import Solver
from .closed_form import (
    CLOSED_FORM_DIGITS,
    Jump,
    Number,
    exact,
    exact_contact_force,
    exact_static_coefficient,
    root_near,
)
from .outcome import Measurement, Setup, Tally, require
from .shared_axes import CONTACTS, RIGID, Contact, paper_axis, random_axis, run_events, with_static

_BLOW, _LENGTH = 33e3, 0.002   # N, s


def blows(setup: Setup) -> Measurement:
    """X2: 2 ms, 33 kN on a stuck axis at a random instant; rigid and compliant, pressed before or not."""
    tally = Tally(1e-12, 's')
    for seed in range(setup.count(1000, 40)):
        for contact in CONTACTS:
            tally.measure(_blow, setup.solver, contact, seed)
    return tally.finding('blows missed')


def _blow(solver: Solver, contact: Contact, seed: int) -> float:
    """Return how far the break-away is from its instant, s."""
    rng = random.Random(seed)
    axis = paper_axis(contact)
    begin, load = rng.uniform(0.0, 5.0), rng.choice((0.0, rng.uniform(-250.0, 400.0)))
    end = begin + _LENGTH
    events = run_events(axis, 0.0, 6.0, steps('force', [0.0, begin, end], [load, load + _BLOW, load]), solver=solver)
    require(events and events[0].kind == EventKind.BREAKAWAY and begin <= events[0].time <= end,
            'no break-away within the blow')
    first = events[0]
    if contact == RIGID:
        return abs(float(exact(first.second, first.fraction) - begin))
    force = exact_contact_force(axis, [Jump(0, 0, load), Jump(begin, 0, (load + _BLOW) - load)])
    return _distance(first, force, axis.normal_force * mpf(0.24), begin, end)


def _distance(event: Event, force: Callable[[Number], Number], limit: Number, low: float, high: float) -> float:
    with workdps(CLOSED_FORM_DIGITS):
        root = root_near(lambda t: force(t) - limit, low, high)
        return abs(float(exact(event.second, event.fraction) - root))


def at_the_limit(setup: Setup) -> Measurement:
    """X18: the force at the first break-away over N mu_s, less one; every law, random axes, both contacts."""
    tally = Tally(1e-12)
    for seed in range(setup.count(2000, 60)):
        for kind in StaticLawKind:
            tally.measure(_first_break, setup.solver, kind, seed)
    for share in (-1.0, 1.0):
        for contact in CONTACTS:
            tally.measure(_held_at_the_limit, setup.solver, contact, share)
    return tally.finding('not at the limit')


def _first_break(solver: Solver, kind: StaticLawKind, seed: int) -> float:
    """Return | |F| / (N mu_s) − 1 | at the instant found, from the inputs and 50 digits; no other instant before it."""
    rng = random.Random(seed)
    axis = random_axis(rng)
    tau, exponent = 10 ** rng.uniform(-2, 1), rng.choice((0.4, 1.0, 2.5))
    initial = axis.friction.static.initial
    axis = with_static(axis, StaticLaw(kind, initial, initial + rng.uniform(0.01, 0.2), tau, exponent))
    rest, speed, rate = 10 ** rng.uniform(-3, 1), 10 ** rng.uniform(-4, -2), 10 ** rng.uniform(-5, -2)
    if axis.drive_damping * speed > 0.5 * axis.normal_force * initial:   # its start alone must not break it away
        axis = replace(axis, drive_damping=0.5 * axis.normal_force * initial / speed)
    drive = ramp(speed, rate, float('inf'))
    duration = 1.0
    while duration < 1e9:
        events = run_events(axis, drive, duration, initial=InitialState(rest_time=rest), solver=solver)
        if events:
            break
        duration *= 8.0
    require(events and events[0].kind == EventKind.BREAKAWAY, 'no break-away')
    return _excess_of_force(axis, events[0], rest, speed, rate)


def _excess_of_force(axis: Axis, event: Event, rest: float, speed: float, rate: float) -> float:
    with workdps(CLOSED_FORM_DIGITS):
        t = exact(event.second, event.fraction)
        c, h = mpf(axis.drive_stiffness), mpf(axis.drive_damping)
        if isinstance(axis.contact, CompliantContact):
            jumps = [Jump(0, 0, h * speed), Jump(0, 1, c * speed + h * rate), Jump(0, 2, c * rate)]
            force = exact_contact_force(axis, jumps)(t)
        else:
            force = c * (mpf(speed) + mpf(rate) * t / 2) * t + h * (mpf(speed) + mpf(rate) * t)
        limit = axis.normal_force * exact_static_coefficient(axis.friction.static, mpf(rest) + t)
        return abs(float(force / limit - 1))


def _held_at_the_limit(solver: Solver, contact: Contact, side: float) -> float:
    """See that a force within the limit, and one on it, hold for ever; a relative 1e-12 more does not."""
    axis = paper_axis(contact)
    limit = side * 0.24 * axis.normal_force
    if isinstance(contact, CompliantContact):   # a step would ring over it: bring it there slowly
        limit *= 1.0 + axis.drive_stiffness / contact.stiffness   # the drive spring takes its part
        reach = 1e7
        for share, holds in ((1.0 - 1e-9, True), (1.0 + 1e-9, False)):
            slow = InputProfile((0.0, reach), (0.0, share * limit), (share * limit / reach, 0.0))
            none = run_events(axis, 0.0, 2e7, slow, solver=solver) == []
            require(none == holds, f'wrong at {share!r} of the limit')
        return 0.0
    for force, holds in ((limit * (1.0 - 1e-15), True), (limit, True), (limit * (1.0 + 1e-12), False)):
        events = run_events(axis, 0.0, 10.0, force, solver=solver)
        require((events == []) == holds, f'wrong under {force!r} N')
    return 0.0
