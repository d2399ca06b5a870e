# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""What a table in place of a smooth law does to the motion: docs/data/smooth_laws.json.

The paper's axis with a Stribeck law of the paper's size, 3 s at 2 mm/s from prolonged rest: the exact engine with
tables of several tolerances, against the smooth law integrated without a table (`smooth_reference`).

    python3 -m benchmarks.smooth_tables
"""

from collections.abc import Iterator
from functools import partial
from typing import NamedTuple

from stickslip_sim.axis import Axis, CompliantContact, Friction, InitialState, RigidContact
from stickslip_sim.core.input_profile import constant
from stickslip_sim.core.types import EventKind, Instant
from stickslip_sim.friction import KineticTable, StaticLaw, StaticLawKind, kinetic_table
from stickslip_sim.friction.kinetic import default_excess
from stickslip_sim.friction.refine import table_error
from stickslip_sim.friction.smooth import stribeck
from stickslip_sim.simulation.simulator import Simulator

from .measured import DATA, OFF, ON, keep
from .smooth_reference import SmoothEvent, SmoothRun

LAW = stribeck(0.12, 0.05, 0.015, 0.1)
FEED, DURATION = 0.002, 3.0
TOLERANCES = (1e-2, 1e-3, 1e-4, 1e-5, 1e-6)
CASES = [(contact, branches) for contact in (RigidContact(), CompliantContact(5e6, 15000.0))
         for branches in (True, False)]


class Comparison(NamedTuple):
    """A run with a table beside the smooth one: the worst differences over all events."""

    events: int
    same: bool       # the same kinds of events in the same order
    time: float      # s
    position: float  # m


def axis_of(kinetic: KineticTable, contact: RigidContact | CompliantContact, branches: bool) -> Axis:
    """Return the paper's axis with a kinetic table."""
    static = StaticLaw(StaticLawKind.EXPONENTIAL, 0.12, 0.24, 0.2)
    friction = Friction(static, kinetic, default_excess(kinetic) if branches else None)
    return Axis(350.0, 6e5, 4000.0, 350 * 9.80665, contact, friction)


def smooth_events(contact: RigidContact | CompliantContact, branches: bool) -> list[SmoothEvent]:
    """Return the events of the smooth law."""
    axis = axis_of(kinetic_table(LAW, TOLERANCES[0]), contact, branches)
    psi = axis.friction.excess
    return without_brief_coasts(SmoothRun(axis, FEED, LAW.coefficient, psi.fraction if psi else None).advance(DURATION))


def without_brief_coasts(events: list[SmoothEvent]) -> list[SmoothEvent]:
    """Return the events but for those that end a coast of less than a microsecond after a break-away."""
    return [event for i, event in enumerate(events) if not (
        event.kind == EventKind.ACCELERATE and events[i - 1].kind == EventKind.BREAKAWAY
        and event.time - events[i - 1].time < 1e-6)]


def breakpoints_on_the_curve(tolerance: float) -> KineticTable:
    """Return the table with the longest chords of the law within a tolerance."""
    def fits(a: float, b: float) -> bool:
        ends = [(a, LAW.coefficient(a)), (b, LAW.coefficient(b))]
        return table_error(LAW.coefficient, LAW.slope, LAW.inflection, ends) <= tolerance

    speeds, last = [0.0], LAW.stribeck_velocity * LAW.shape.reach(tolerance / (LAW.initial - LAW.limit))
    while speeds[-1] < last:
        low, high = (last, last) if fits(speeds[-1], last) else (speeds[-1], last)
        while high - low > 1e-9 * last:
            middle = 0.5 * (low + high)
            low, high = (middle, high) if fits(speeds[-1], middle) else (low, middle)
        speeds.append(low)
    coefficients = [LAW.coefficient(speed) for speed in speeds[:-1]]
    return KineticTable(tuple(speeds), (*coefficients, LAW.limit + LAW.viscous * last), LAW.viscous, LAW, tolerance)


def compared(smooth: list[SmoothEvent], contact: RigidContact | CompliantContact, branches: bool,
             table: KineticTable) -> Comparison:
    """Return how far the events of the engine with a table are from those of the smooth law."""
    simulator = Simulator(axis_of(table, contact, branches), InitialState(), constant(FEED), constant(0.0))
    events = without_brief_coasts([SmoothEvent(event.kind, event.time, event.position, event.velocity)
                                   for event in simulator.advance(Instant(DURATION, 0.0))
                                   if event.kind != EventKind.KNOT])
    pairs = list(zip(events, smooth))
    return Comparison(len(events), [e.kind for e in events] == [e.kind for e in smooth],
                      max(abs(a.time - b.time) for a, b in pairs), max(abs(a.position - b.position) for a, b in pairs))


def rows() -> Iterator[dict[str, object]]:
    """Yield how far the events of each table are off, and of one whose breakpoints lie on the curve."""
    for contact, branches in CASES:
        smooth = smooth_events(contact, branches)
        is_rigid = isinstance(contact, RigidContact)
        for kind, table_of in ((OFF, partial(kinetic_table, LAW)), (ON, breakpoints_on_the_curve))[:1 + is_rigid]:
            for tolerance in TOLERANCES:
                table = table_of(tolerance)
                result = compared(smooth, contact, branches, table)
                yield {'breakpoints_lie': kind, 'contact': 'rigid' if is_rigid else 'compliant',
                       'branches': 1 + branches, 'tolerance': tolerance, 'breakpoints': len(table.velocities),
                       'events': result.events, 'time_error': result.time if result.same else None,
                       'position_error': result.position if result.same else None}


if __name__ == '__main__':
    keep(DATA / 'smooth_laws.json', command='python3 -m benchmarks.smooth_tables', rows=list(rows()))
