# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""X7 and X10: rest that lasts, without drift, and the static coefficient over any rest time."""

import math
import random

from mpmath import mp, mpf, workdps

from ...axis import Axis, CompliantContact, InitialState
from ...core.input_profile import InputProfile
from ...core.types import Event, EventKind, Mode
from ...friction import StaticLaw, StaticLawKind
from ...simulation.simulator import Simulator
from ...solvers import Solver
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
from ..judges import Measurement, Setup, Tally, require

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
