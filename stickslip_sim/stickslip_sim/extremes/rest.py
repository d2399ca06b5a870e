# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""X7 and X10: rest that lasts, without drift, and the static coefficient over any rest time."""

import random

from mpmath import mp, mpf, workdps

from ..axis import Axis, InitialState
from ..core.input_profile import InputProfile
from ..core.types import EventKind, Mode
from ..friction import StaticLaw, StaticLawKind
from ..simulation.simulator import Simulator
from ..solvers import Solver
from .closed_form import CLOSED_FORM_DIGITS, Jump, exact, exact_contact_force, exact_static_coefficient, root_near
from .outcome import Measurement, Setup, Tally, require
from .shared_axes import CONTACTS, RIGID, Contact, instant, make, paper_axis, run_events, with_static

YEAR = 3.15576e7     # s, 365.25 days
_RAMP = 100.0        # N/s, after the year
_SHARES = (0.1, 0.5, 0.9, 0.99)


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
    load = share * 0.24 * axis.normal_force
    side = 1.0 if share > 0.0 else -1.0
    reach = 100.0   # s, so slowly that the contact rings little
    force = InputProfile((0.0, reach, YEAR), (0.0, load, load), (load / reach, 0.0, side * _RAMP))
    simulator = make(axis, 0.0, force, solver=solver)
    _hold(simulator, drift, reach)
    jumps = [Jump(0, 1, mpf(load / reach)), Jump(reach, 1, -mpf(load / reach)), Jump(YEAR, 1, side * mpf(_RAMP)),
             Jump(reach, 0, mpf(load) - mpf(load / reach) * mpf(reach))]
    events = simulator.advance(instant(YEAR + 20.0))
    require(events and events[0].kind == EventKind.BREAKAWAY and events[0].direction == side, 'no break-away after it')
    with workdps(CLOSED_FORM_DIGITS):
        limit = mpf(axis.normal_force) * mpf(0.24)
        if contact == RIGID:
            expected = (limit - abs(mpf(load))) / _RAMP
        else:
            pull = exact_contact_force(axis, jumps)
            low = (limit - abs(mpf(load))) / _RAMP
            expected = root_near(lambda t: side * pull(mpf(YEAR) + t) - limit, low * mpf('0.9'), 2 * low + 2)
        found = exact(events[0].second, events[0].fraction) - mpf(YEAR)
        return abs(float(found / expected - 1))


def _held_by_drive(solver: Solver, contact: Contact, share: float, drift: list[float]) -> float:
    """Let the drive pull up to the share, stand for a year and go on; error as above."""
    axis = paper_axis(contact)
    c, h, v = axis.drive_stiffness, axis.drive_damping, 1e-6 if share > 0.0 else -1e-6
    reach = float(round(share * 0.24 * axis.normal_force / (c * v)))
    drive = InputProfile((0.0, reach, YEAR), (v, 0.0, v), (0.0, 0.0, 0.0))
    simulator = make(axis, drive, solver=solver)
    _hold(simulator, drift, reach)
    events = simulator.advance(instant(YEAR + 2000.0))
    side = 1.0 if v > 0.0 else -1.0
    require(events and events[0].kind == EventKind.BREAKAWAY and events[0].direction == side, 'no break-away after it')
    with workdps(CLOSED_FORM_DIGITS):
        limit = mpf(axis.normal_force) * mpf(0.24)
        c, h, v = mpf(c), mpf(h), mpf(v)
        low = (limit / abs(v) - h - c * reach) / c
        expected = low
        if contact != RIGID:
            jumps = [Jump(at, order, sign * size) for at, sign in ((0, 1), (mpf(reach), -1), (mpf(YEAR), 1))
                     for order, size in ((0, h * v), (1, c * v))]
            pull = exact_contact_force(axis, jumps)
            expected = root_near(lambda t: side * pull(mpf(YEAR) + t) - limit, low * mpf('0.9'), low + 1)
        found = exact(events[0].second, events[0].fraction) - mpf(YEAR)
        return abs(float(found / expected - 1))


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
        rest = exact(events[0].second, events[0].fraction)
        return abs(float(events[0].static_coefficient / exact_static_coefficient(law, rest) - 1))


def rest_times(setup: Setup) -> Measurement:
    """X10: mu_s over rest times 1e-9 to 1e9 s at time constants 1e-12 to 1e12 s, of every law, and in break-aways."""
    tally = Tally(1e-14)
    rests = [0.0, *(10.0 ** k for k in range(-9, 10, setup.choose(1, 3)))]
    for kind in StaticLawKind:
        for tau in (1e-12, 1e-6, 1.0, 1e6, 1e12):
            for rest in rests:
                tally.measure(_coefficient, kind, tau, rest)
    for seed in range(setup.count(20_000, 300)):
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
