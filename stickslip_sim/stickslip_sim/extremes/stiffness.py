# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""X8: stiff and undamped contacts, light and heavy sliders: the same accuracy, the same cost per event."""

import statistics
import time
from dataclasses import replace

from ..axis import Axis, CompliantContact, InitialState
from ..core.input_profile import constant
from ..core.types import Event
from ..solvers import Solver
from .against import error_of_run
from .chain import error_of_chain
from .outcome import Measurement, Setup, Tally
from .shared_axes import instant, make, paper_axis

_STIFFENED = (1.0, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9)
_FEED = 0.004   # m/s
_COST = 3.0   # times the ordinary cost of an event


def stiff_contacts(setup: Setup) -> Measurement:
    """X8: against the reference, and the median CPU time of an event over that of the paper's axis."""
    tally = Tally(1e-12)
    cases = [_axis(stiffer, damper, 350.0) for stiffer in setup.choose(_STIFFENED, (1e3, 1e9))
             for damper in setup.choose((0.0, 1.0, 1e6), (0.0, 1e6))]
    cases += [_axis(1.0, 1.0, mass) for mass in (1e-3, 1e6)]
    for axis in cases:
        tally.measure(_equals_closed_forms, setup.solver, axis)
    for axis in (_axis(1.0, 0.0, 350.0), _axis(1.0, 1.0, 1e6), *setup.choose((_axis(1e3, 1.0, 350.0),), ())):
        tally.measure(_equals_the_reference, setup.solver, axis)
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


def _equals_the_reference(solver: Solver, axis: Axis) -> float:
    return error_of_run(axis, InitialState(), constant(_FEED), constant(0.0), 1.5, solver)


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
