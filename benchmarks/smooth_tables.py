# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""What a table in place of a smooth law does to the motion: docs/data/smooth_laws.json.

The paper's axis with a Stribeck law of the paper's size, 3 s at 2 mm/s from prolonged rest: the exact engine with
tables of several tolerances, against the smooth law integrated without a table.

    python3 -m benchmarks.smooth_tables
"""

import math
from collections.abc import Callable, Iterator
from functools import partial
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

from stickslip_sim.axis import Axis, CompliantContact, Friction, InitialState, RigidContact
from stickslip_sim.core.input_profile import constant
from stickslip_sim.core.types import EventKind, Instant, Mode
from stickslip_sim.friction import KineticTable, StaticLaw, StaticLawKind, kinetic_table
from stickslip_sim.friction.kinetic import default_excess
from stickslip_sim.friction.refine import table_error
from stickslip_sim.friction.smooth import stribeck
from stickslip_sim.simulation.simulator import Simulator

from .measured import DATA, OFF, ON, keep

# The motion under a smooth law, integrated without a table.
#
# Independent of the engine: the equations of docs/model.md, mode by mode, with DOP853 (Hairer, Nørsett and Wanner 1993)
# at a relative tolerance of 1e-13 and short steps, whose dense output gives the times of the events.  It can do what
# the comparison needs and no more: a drive at constant velocity from a prolonged rest, slips in positive direction.

State = NDArray[np.float64]   # position, velocity
Guard = Callable[[float, State], float]

_RTOL, _ATOL, _STEP = 1e-13, 1e-19, 5e-4
_SCAN = 1e-3   # s, between looks at the force on a rigid contact


class SmoothEvent(NamedTuple):
    """A transition of the smooth axis."""

    kind: EventKind
    time: float       # s
    position: float   # m
    velocity: float   # m/s


class SmoothRun:
    """One run; `kinetic` is mu_k(speed), `excess` is psi(speed) or None without acceleration dependence."""

    def __init__(self, axis: Axis, speed: float, kinetic: Callable[[float], float],
                 excess: Callable[[float], float] | None) -> None:
        self._axis, self._v, self._kinetic, self._psi = axis, speed, kinetic, excess
        self._contact = axis.contact if isinstance(axis.contact, CompliantContact) else None
        self._mode, self._time = Mode.STICK, 0.0
        self._state: State = np.zeros(2)
        self._excess = 0.0                                    # E of this slip
        self._arrest, self._deflection = -math.inf, 0.0       # when, and δ then
        self.events: list[SmoothEvent] = []

    def advance(self, duration: float) -> list[SmoothEvent]:
        """Return all events up to a time (s)."""
        move = {Mode.STICK: self._stick, Mode.ACCELERATING: self._accelerate, Mode.COASTING: self._coast,
                Mode.DECELERATING: self._decelerate}
        while self._time < duration:
            move[self._mode](duration)
        return self.events

    def _drive_force(self, t: float, y: State) -> float:
        spring, rate = self._v * t - float(y[0]), self._v - float(y[1])
        return self._axis.drive_stiffness * spring + self._axis.drive_damping * rate

    def _residual(self, t: float, y: State) -> float:
        """Return R, the drive force beyond the lower branch of friction."""
        return self._drive_force(t, y) - self._axis.normal_force * self._kinetic(abs(y[1]))

    def _band(self, speed: float) -> float:
        return self._axis.normal_force * self._excess * self._psi(abs(speed)) if self._psi else 0.0

    def _limit(self, t: float) -> float:
        return self._axis.normal_force * self._axis.friction.static.coefficient(t - self._arrest)

    def _stick(self, end: float) -> None:
        if self._contact is None:
            self._wait(end)
        else:
            c, h, x0, d0 = self._contact.stiffness, self._contact.damping, self._state[0], self._deflection
            self._integrate(end, lambda t, y: self._drive_force(t, y) - c * (d0 + y[0] - x0) - h * y[1],
                            (lambda t, y: c * (d0 + y[0] - x0) + h * y[1] - self._limit(t), 1.0, self._break_away))

    def _wait(self, end: float) -> None:
        """Let a rigid contact hold until the force reaches its limit."""
        def beyond(t: float) -> float:
            return self._drive_force(t, self._state) - self._limit(t)

        t = self._time
        while t < end and beyond(t + _SCAN) < 0.0:
            t += _SCAN
        self._time = min(end, brentq(beyond, t, t + _SCAN, xtol=1e-16, rtol=1e-15) if t < end else end)
        if self._time < end:
            self._break_away()

    def _break_away(self) -> None:
        speed = abs(self._state[1])
        coefficient, self._excess = self._limit(self._time) / self._axis.normal_force, 0.0
        if self._psi is not None:
            self._excess = (coefficient - self._kinetic(speed)) / self._psi(speed)
        self._note(EventKind.BREAKAWAY)
        residual = self._residual(self._time, self._state) - self._band(speed)
        held = self._contact is not None and residual < 0.0
        self._mode = Mode.COASTING if held else Mode.ACCELERATING

    def _accelerate(self, end: float) -> None:
        def force(t: float, y: State) -> float:
            return self._residual(t, y) - self._band(y[1])

        self._integrate(end, force, (force, -1.0, self._peak))

    def _peak(self) -> None:
        coasts = self._psi is not None
        self._mode = Mode.COASTING if coasts else Mode.DECELERATING
        self._note(EventKind.COAST if coasts else EventKind.DECELERATE)

    def _coast(self, end: float) -> None:
        """Let the force pass through the band at its constant rate."""
        (x, u), residual = map(float, self._state), self._residual(self._time, self._state)
        falls = u > self._v
        gap = -residual if falls else self._band(u) - residual
        due = gap / (self._axis.drive_stiffness * (self._v - u))
        step = min(due, end - self._time)
        self._time, self._state = self._time + step, np.array([x + u * step, u])
        if step == due:
            self._mode = Mode.DECELERATING if falls else Mode.ACCELERATING
            self._note(EventKind.DECELERATE if falls else EventKind.ACCELERATE)

    def _decelerate(self, end: float) -> None:
        self._integrate(end, self._residual, (lambda t, y: y[1], -1.0, self._stop), (self._residual, 1.0, self._turn))

    def _turn(self) -> None:
        coasts = self._psi is not None
        self._mode = Mode.COASTING if coasts else Mode.ACCELERATING
        self._note(EventKind.COAST if coasts else EventKind.ACCELERATE)

    def _stop(self) -> None:
        self._state = np.array([self._state[0], 0.0])
        self._mode, self._arrest = Mode.STICK, self._time
        self._note(EventKind.STICK)
        if self._contact is not None:
            self._deflection = self._axis.normal_force * self._kinetic(0.0) / self._contact.stiffness

    def _note(self, kind: EventKind) -> None:
        self.events.append(SmoothEvent(kind, self._time, float(self._state[0]), float(self._state[1])))

    def _integrate(self, end: float, force: Guard, *guards: tuple[Guard, float, Callable[[], None]]) -> None:
        """Move under a force until one of the guards (function, its direction, what then) vanishes."""
        def rates(t: float, y: State) -> list[float]:
            return [y[1], force(t, y) / self._axis.mass]

        functions = []
        for function, direction, _ in guards:
            def guard(t: float, y: State, function: Guard = function) -> float:
                return function(t, y)
            guard.terminal, guard.direction = True, direction   # type: ignore[attr-defined]
            functions.append(guard)
        run = solve_ivp(rates, (self._time, end), self._state, 'DOP853', events=functions, rtol=_RTOL, atol=_ATOL,
                        max_step=_STEP)
        self._time, self._state = float(run.t[-1]), run.y[:, -1]
        for (_, _, follow), times in zip(guards, run.t_events):
            if len(times):
                follow()
                return


# The engine with tables beside it.

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
