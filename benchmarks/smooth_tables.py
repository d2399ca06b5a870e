# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""What a table in place of a smooth law does to the motion: `python3 -m benchmarks.smooth_tables > docs/smooth.md`.

The paper's axis with a Stribeck law of the paper's size, 3 s at 2 mm/s from prolonged rest: the exact engine with
tables of several tolerances, against the smooth law integrated without a table (`smooth_reference`).
"""

import sys
from typing import NamedTuple

from stickslip_sim.axis import Axis, CompliantContact, Friction, InitialState, RigidContact
from stickslip_sim.core.input_profile import constant
from stickslip_sim.core.types import EventKind, Instant
from stickslip_sim.friction import KineticTable, StaticLaw, StaticLawKind, kinetic_table
from stickslip_sim.friction.kinetic import default_excess
from stickslip_sim.friction.refine import table_error
from stickslip_sim.friction.smooth import stribeck
from stickslip_sim.simulation.simulator import Simulator

from .smooth_reference import SmoothEvent, SmoothRun

LAW = stribeck(0.12, 0.05, 0.015, 0.1)
FEED, DURATION = 0.002, 3.0
TOLERANCES = (1e-2, 1e-3, 1e-4, 1e-5, 1e-6)
CASES = [(contact, branches) for contact in (RigidContact(), CompliantContact(5e6, 15000.0))
         for branches in (True, False)]

_BRANCHES = {True: 'two', False: 'one'}
_HEAD = """\
# Smooth friction laws, and the effect of their tables

Choose here the tolerance of a smooth friction law: the tables show how far the events move.
`python3 -m benchmarks.smooth_tables > docs/smooth.md` makes this page.

The engine is exact for friction that is linear between breakpoints.  A smooth law (`friction.kinetic.law: stribeck`,
`exponential`, `hyperbolic`; `friction.excess.law: cosine`, `power`) becomes a table whose difference to the law is at
most `tolerance` at every speed, from rest to infinity.  The bound is proven, not sampled: between inflections the
difference has its extremes at the breakpoints and where the law has the slope of the segment, and these are computed
from the finished table.  A tolerance that takes more than 1000 breakpoints is refused, with one that fits.

The breakpoints lie off the curve, on its outer side, by the tolerance (less a margin for rounding).  In the middle of a
segment the difference is half as much, on the other side.  So it has zero mean in first order, and over a segment the
table takes the same energy out of a slip as the law.  At rest and at infinite speed the table is the law.

**Measured:** the paper's axis with mu_k = 0.05 + 0.07 exp(−(w/15 mm/s)²) + (0.1 s/m) w, static friction as in
`paper_fig8`, 3 s at 2 mm/s from prolonged rest, with acceleration dependence (two branches) and without.  All events
are compared with those of the smooth law, integrated without a table (`benchmarks/smooth_reference.py`: DOP853,
relative tolerance 1e-13).  On the whole the error falls in proportion to the tolerance or faster: segment by segment
the differences cancel, but the slip ends within a segment, and lingers at its peak speed.  The last column is the
largest error in time over the tolerance.

| contact | branches | tolerance | breakpoints | events | worst in time / s | worst in position / m | s per unit of mu |
|---|---|---|---|---|---|---|---|
"""
_TAIL = """
Rows with "other" have another sequence of events than the smooth law: the table is too coarse.  The comparison leaves
out a coast of nanoseconds after a break-away of the compliant contact: the last remains of its ring-down decide whether
there is one.

For comparison, the same with the usual table, whose breakpoints lie on the curve (as few as the tolerance allows; rigid
contact):

| branches | tolerance | breakpoints | worst in time / s | worst in position / m | s per unit of mu |
|---|---|---|---|---|---|
"""


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


def _rows() -> list[str]:
    rows = []
    for contact, branches in CASES:
        smooth = smooth_events(contact, branches)
        name = 'compliant' if isinstance(contact, CompliantContact) else 'rigid'
        for tolerance in TOLERANCES:
            table = kinetic_table(LAW, tolerance)
            result = compared(smooth, contact, branches, table)
            rows.append(f'| {name} | {_BRANCHES[branches]} | {tolerance:.0e} | {len(table.velocities)} | '
                        f'{result.events} | {_errors(result, tolerance)} |\n')
    return rows


def _rows_on_the_curve() -> list[str]:
    rows = []
    for branches in (True, False):
        smooth = smooth_events(RigidContact(), branches)
        for tolerance in TOLERANCES:
            table = breakpoints_on_the_curve(tolerance)
            result = compared(smooth, RigidContact(), branches, table)
            rows.append(f'| {_BRANCHES[branches]} | {tolerance:.0e} | {len(table.velocities)} | '
                        f'{_errors(result, tolerance)} |\n')
    return rows


def _errors(result: Comparison, tolerance: float) -> str:
    if not result.same:
        return 'other | other |'
    return f'{result.time:.1e} | {result.position:.1e} | {result.time / tolerance:.2g}'


if __name__ == '__main__':
    sys.stdout.write(_HEAD + ''.join(_rows()) + _TAIL + ''.join(_rows_on_the_curve()))
