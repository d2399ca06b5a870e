# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""X4 and X5: branches apart below the limit velocity, and a break-away while the contact still rings."""

import random
from dataclasses import replace

from ..axis import Axis, CompliantContact, InitialState
from ..core.input_profile import constant
from ..core.types import Event, EventKind
from ..friction import KineticTable, StaticLaw, StaticLawKind
from ..friction.kinetic import default_excess
from ..solvers import Solver
from .against import error_of_run
from .outcome import Measurement, Setup, Tally, require
from .shared_axes import CONTACTS, Contact, instant, make, of_kind, paper_axis, run_events, with_static


def coasting(setup: Setup) -> Measurement:
    """X4: the peak speed stays below v_gr, where the branches are apart; the run is the reference's."""
    tally = Tally(1e-12)
    for contact in CONTACTS:
        for speed in setup.choose((0.001, 0.0015, 0.002, 0.003, 0.005), (0.002,)):
            tally.measure(_below_the_limit_velocity, setup.solver, contact, speed)
    for seed in range(setup.count(60, 4)):
        tally.measure(_random_branches, setup.solver, seed)
    return tally.finding()


def _below_the_limit_velocity(solver: Solver, contact: Contact, speed: float) -> float:
    axis = paper_axis(contact)
    events = run_events(axis, speed, 3.0, solver=solver)
    coasts = [event.velocity for event in of_kind(events, EventKind.COAST)]
    require(coasts and max(coasts) < axis.friction.kinetic.velocities[-1], 'the branches are not apart at the peak')
    _check_independent_of_steps(solver, axis, speed, events)
    return error_of_run(axis, InitialState(), constant(speed), constant(0.0), 3.0, solver)


def _random_branches(solver: Solver, seed: int) -> float:
    """Both branches fall by random amounts, so that the coasting band is wide, narrow or bent by a breakpoint."""
    rng = random.Random(seed)
    top = rng.uniform(0.01, 0.05)
    kinetic = KineticTable((0.0, rng.uniform(0.2, 0.8) * top, top), (0.12, rng.uniform(0.07, 0.12), 0.05))
    axis = paper_axis(rng.choice(CONTACTS), tau=10 ** rng.uniform(-1.5, 0))
    axis = replace(axis, drive_damping=rng.choice((0.0, 1000.0, 4000.0)),
                   friction=replace(axis.friction, kinetic=kinetic, excess=default_excess(kinetic)))
    speed = 10 ** rng.uniform(-3.3, -2.3)
    _check_independent_of_steps(solver, axis, speed, run_events(axis, speed, 3.0, solver=solver))
    return error_of_run(axis, InitialState(), constant(speed), constant(0.0), 1.5, solver)


def _check_independent_of_steps(solver: Solver, axis: Axis, speed: float, events: list[Event]) -> None:
    for steps_per_second in (7, 1000, 1024):
        simulator = make(axis, speed, solver=solver)
        seen = [event for k in range(3 * steps_per_second)
                for event in simulator.advance(instant((k + 1) / steps_per_second))]
        require(seen == events, f'{steps_per_second} steps a second change the events')


def ringing(setup: Setup) -> Measurement:
    """X5: 5 to 20 mm/s, so that the next break-away comes while the contact still rings; the reference's events."""
    tally = Tally(1e-12)
    for k in range(setup.count(31, 4)):
        speed = 0.005 + 0.015 * k / setup.count(30, 3)
        for tau in setup.choose((0.02, 0.2), (0.2,)):
            tally.measure(_while_it_rings, setup.solver, speed, tau, 15000.0)
            tally.measure(_while_it_rings, setup.solver, speed, tau, 0.0)
    return tally.finding('with other events than the reference')


def _while_it_rings(solver: Solver, speed: float, tau: float, damping: float) -> float:
    axis = with_static(paper_axis(CompliantContact(5e6, damping), tau=tau),
                       StaticLaw(StaticLawKind.EXPONENTIAL, 0.12, 0.24, tau))
    return error_of_run(axis, InitialState(), constant(speed), constant(0.0), 1.5, solver)
