# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""X8 and X11: stiff and undamped contacts, light and heavy sliders; 1 nm/s to 1 m/s, a clock at 1e9 s, 1000 km away."""

import random
import statistics
import time
from collections.abc import Sequence
from dataclasses import replace
from itertools import pairwise

from mpmath import mpf, workdps

from ...axis import Axis, CompliantContact, InitialState
from ...core.input_profile import InputProfile, constant
from ...core.types import Event, EventKind, Instant
from ...figures.distance import seconds_between
from ...reference import simulate
from ...solvers import Solver
from ..axes import CONTACTS, RIGID, Contact, instant, make, paper_axis
from ..closed_form import CLOSED_FORM_DIGITS, error_of_chain, exact
from ..judges import Measurement, Setup, Tally, error_of_events, error_of_run, require, same_bits

_STIFFENED = (1.0, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9)
_FEED = 0.004   # m/s
_COST = 3.0   # times the ordinary cost of an event
_LATE, _FAR = 1e9, 1e6   # s, m


def stiff_contacts(setup: Setup) -> Measurement:
    """X8: against the reference, and the median CPU time of an event over that of the paper's axis."""
    tally = Tally(1e-12)
    cases = [_axis(stiffer, damper, 350.0) for stiffer in setup.choose(_STIFFENED, (1e3, 1e9))
             for damper in setup.choose((0.0, 1.0, 1e6), (0.0, 1e6))]
    cases += [_axis(1.0, 1.0, mass) for mass in (1e-3, 1e6)]
    for axis in cases:
        tally.measure(_equals_closed_forms, setup.solver, axis)
    for axis in (_axis(1.0, 0.0, 350.0), _axis(1.0, 1.0, 1e6), *setup.choose((_axis(1e3, 1.0, 350.0),), ())):
        tally.measure(error_of_run, setup.solver, axis, _FEED, 1.5)
    if not setup.full:   # a figure of time belongs to a quiet machine
        return tally.finding()
    ordinary = _cost(setup.solver, _axis(1.0, 1.0, 350.0))
    ratio = max(_cost(setup.solver, axis) for axis in cases) / ordinary
    return tally.finding('wrong', f'at most {ratio:.2g} x the ordinary cost of an event', kept=ratio <= _COST)


def _axis(stiffer: float, damper: float, mass: float) -> Axis:
    """Return the paper's axis with a stiffer contact, its damper times a factor, and another slider."""
    contact = CompliantContact(5e6 * stiffer, 15000.0 * damper)
    return replace(paper_axis(contact), mass=mass)


def _equals_closed_forms(solver: Solver, axis: Axis) -> float:
    duration = 20.0 if axis.mass > 1e5 else 1.5
    events = make(axis, _FEED, solver=solver).advance(instant(duration))
    return error_of_chain(axis, _FEED, events, duration)


def _cost(solver: Solver, axis: Axis) -> float:
    """Return the CPU seconds of an event, the median of several runs."""
    costs = []
    for _ in range(7):
        simulator = make(axis, _FEED, solver=solver)
        begin, events = time.process_time(), list[Event]()
        while len(events) < 400 and simulator.time.seconds < 1e4:
            events += simulator.advance(instant(simulator.time.seconds + 50.0))
        costs.append((time.process_time() - begin) / max(len(events), 1))
    return statistics.median(costs)


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
    for seed in range(setup.choose(100, 5)):
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
    return max((abs(a - b) for a, b in zip(_intervals(late), _intervals(at_zero))), default=0.0)


def _intervals(events: Sequence[Event]) -> list[float]:
    """Return the times between neighbouring events, s."""
    return [seconds_between(b, a) for a, b in pairwise(events)]


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
        error = abs(exact(*events[0].instant) - at)
        return max(0.0, float(error - at * mpf(10) ** -15))


def _slow_against_the_reference(solver: Solver, contact: Contact, feed: float) -> float:
    """Return the error of the times between events, s; 1e-15 of the length of a double is allowed beyond the mark."""
    length = _length_of(feed)
    drive = constant(feed)
    events = _events(solver, contact, drive, 0.0, 0.0, length)
    wanted = simulate(paper_axis(contact), InitialState(), drive, constant(0.0), length).events
    error_of_events(events, wanted, length)
    return max((max(0.0, abs(a - b) - 1e-15 * b) for a, b in zip(_intervals(events), _intervals(wanted))), default=0.0)


def _late_and_far_in_parts(solver: Solver, seed: int) -> None:
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
    same_bits(seen, whole, f'feed {feed!r} m/s')
