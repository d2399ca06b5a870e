# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The motion under a smooth friction law, integrated without a table: what the error of tables is measured against.

Independent of the engine: the equations of docs/model.md, mode by mode, with DOP853 (Hairer, Nørsett and Wanner 1993)
at a relative tolerance of 1e-13 and short steps, whose dense output gives the times of the events.  It can do what the
comparison needs and no more: a drive at constant velocity from a prolonged rest, slips in positive direction.
"""

import math
from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

from stickslip_sim.axis import Axis, CompliantContact
from stickslip_sim.core.types import EventKind, Mode

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
