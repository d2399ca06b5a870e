# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""X11: from a nanometre a second to a metre, a clock at 1e9 s, a slider 1000 km from the origin."""

import random
from itertools import pairwise

from mpmath import mpf, workdps

from ..axis import InitialState
from ..core.input_profile import InputProfile, constant
from ..core.types import Event, EventKind, Instant
from ..solvers import Solver
from .against import error_of_events
from .closed_form import CLOSED_FORM_DIGITS, exact
from .outcome import Measurement, Setup, Tally, require
from .shared_axes import CONTACTS, RIGID, Contact, elapsed, make, paper_axis

_LATE, _FAR = 1e9, 1e6   # s, m


def late_far_slow_fast(setup: Setup) -> Measurement:
    """X11: times between events at a late clock and a far place against those at 0, and against the reference."""
    tally = Tally(1e-11, 's')
    feeds = [10.0 ** k for k in range(-9, 1)]
    for contact in CONTACTS:
        for feed in setup.choose(feeds, feeds[::3]):
            tally.measure(_late_and_far, setup.solver, contact, feed)
            if contact == RIGID:
                tally.measure(_first_break_away, setup.solver, feed)
        for feed in setup.choose((1e-9, 1e-7, 1e-5, 1e-3, 0.1, 1.0), (1e-9, 1e-3)):
            if contact == RIGID or feed >= 1e-3:   # the reference goes through every swing of a contact that rings
                tally.measure(_slow_against_the_reference, setup.solver, contact, feed)
    for seed in range(setup.count(100, 5)):
        tally.measure(_late_and_far_in_parts, setup.solver, seed)
    return tally.finding()


def _length_of(feed: float) -> float:
    """Return the seconds in which a feed brings about a few cycles, whole."""
    return max(3.0, round(8e-3 / feed))


def _late_and_far(solver: Solver, contact: Contact, feed: float) -> float:
    """Return the largest difference of the times between events: clock at 1e9 s and position at 1e6 m, or both at 0."""
    axis = paper_axis(contact)
    at_zero = _events(solver, contact, InputProfile((0.0,), (feed,), (0.0,)), 0.0, 0.0, _length_of(feed))
    held = InputProfile((0.0, _LATE), (0.0, feed), (0.0, 0.0))
    late = _events(solver, contact, held, _FAR, _LATE, _length_of(feed))
    require(len(at_zero) > 0 or feed > axis.friction.kinetic.velocities[-1], 'no events')
    require([(e.kind, e.direction) for e in late] == [(e.kind, e.direction) for e in at_zero], 'other events')
    return max((abs(elapsed(a, b) - elapsed(c, d))
                for (a, b), (c, d) in zip(pairwise(late), pairwise(at_zero))), default=0.0)


def _events(solver: Solver, contact: Contact, drive: InputProfile, place: float, begin: float,
            length: float) -> list[Event]:
    simulator = make(paper_axis(contact), drive, initial=InitialState(position=place), solver=solver)
    events = simulator.advance(Instant(begin, 0.0))
    require(all(event.instant == (begin, 0.0) for event in events), 'an event during the hold')
    return events + simulator.advance(Instant(begin + length, 0.0))


def _first_break_away(solver: Solver, feed: float) -> float:
    """Return the error of the first break-away, at (N mu_s − h v)/(c v) if rigid, s; 1e-15 of it is allowed."""
    axis = paper_axis(RIGID)
    with workdps(CLOSED_FORM_DIGITS):
        at = (mpf(axis.normal_force) * mpf(0.24) / mpf(feed) - axis.drive_damping) / axis.drive_stiffness
        if at <= 0:
            return 0.0
        simulator = make(axis, feed, solver=solver)
        events = simulator.advance(Instant(float(int(at) + 2), 0.0))
        require(events and events[0].kind == EventKind.BREAKAWAY, 'no break-away')
        error = abs(exact(events[0].second, events[0].fraction) - at)
        return max(0.0, float(error - at * mpf(10) ** -15))


def _slow_against_the_reference(solver: Solver, contact: Contact, feed: float) -> float:
    """Return the error of the times between events, s; 1e-15 of the length of a double is allowed beyond the mark."""
    from ..reference import simulate

    length = _length_of(feed)
    drive = constant(feed)
    events = _events(solver, contact, drive, 0.0, 0.0, length)
    wanted = simulate(paper_axis(contact), InitialState(), drive, constant(0.0), length).events
    error_of_events(events, wanted, length)
    return max((max(0.0, abs(elapsed(a, b) - elapsed(c, d)) - 1e-15 * elapsed(c, d))
                for (a, b), (c, d) in zip(pairwise(events), pairwise(wanted))), default=0.0)


def _late_and_far_in_parts(solver: Solver, seed: int) -> float:
    """Random ticks late in the run change no bit of the events."""
    rng = random.Random(seed)
    contact, feed = rng.choice(CONTACTS), 10 ** rng.uniform(-4, -2)
    held = InputProfile((0.0, _LATE), (0.0, feed), (0.0, 0.0))
    whole = _events(solver, contact, held, _FAR, _LATE, 3.0)
    simulator = make(paper_axis(contact), held, initial=InitialState(position=_FAR), solver=solver)
    seen, offset = list[Event](), 0.0
    while offset < 3.0:
        offset = min(offset + rng.choice((1e-9, 1e-3, 0.3)) * rng.random(), 3.0)
        seen += simulator.advance(Instant(_LATE + float(int(offset)), offset - int(offset)))
    require(seen == whole, f'{len(seen)} events in parts, {len(whole)} in one call, feed {feed!r} m/s')
    return 0.0
