# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""From event to event with `scipy.integrate.solve_ivp`; the transitions are those of every solver."""

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from ...axis.layout import (
    ACCELERATION, DEFLECTION, DIRECTION, DRIVE, EVENT_FRICTION, EVENT_MODE, EXCESS, FRACTION, MODE, NORMAL, PIECE,
    POSITION, RESIDUAL, REST, SECOND, SPRING, STATIC_INITIAL, VELOCITY,
)
from ...axis.motion import ACCELERATING, COASTING, STICK, drive_force, friction_line, piece_above
from ...axis.transitions import (
    ACCELERATE, ARREST, BREAKAWAY, COAST, DECELERATE, KNOT, applied_force, apply_inputs, arrest, choose_slip,
    cross_knot, force_rounding, leave_coast, release, turn, write_event,
)
from .. import DONE, FULL, NO_PROGRESS, OUT_OF_RANGE
from ..inputs import hold_inputs, refresh_inputs, same_inputs
from ..sampling import write_sample
from ..state import begin_state, change_contact
from .mode_problem import Motion

_SAME_INSTANT = 64   # events without progress in time; a sound model needs three

_QUIET = np.errstate(all='ignore')   # what overflows ends as OUT_OF_RANGE


@dataclass(frozen=True, slots=True)
class Engine:
    """The functions of the solver; `law` is a smooth mu_k, or None for the table in the parameters."""

    method: str
    rtol: float
    atol: float
    law: Any

    @_QUIET
    def start(self, p, s, position, velocity, rest, v, v_rate, f, f_rate, waves, events, row):
        """Set the state at time 0: the spring unstretched, at rest (it may break away at once) or sliding."""
        begin_state(s, position, velocity, rest)
        hold_inputs(s, 0.0, 0.0, v, v_rate, f, f_rate, waves)
        refresh_inputs(s)
        if velocity == 0.0:
            return self._apply(p, s, events, row)
        self._choose(p, s)
        return row

    @_QUIET
    def advance(self, p, s, second, fraction, events, row):
        """Bring the state to a time; return the rows in use and how it ended."""
        same_instant = 0
        while True:
            t = float((second - s[SECOND]) + (fraction - s[FRACTION]))
            if t <= 0.0:
                return row, DONE
            if row >= len(events):
                return row, FULL
            motion = Motion(p, s, self.law)
            reached = self._integrate(motion, t, float(s[VELOCITY]))
            if reached is None:
                return row, OUT_OF_RANGE
            due, y, u, kind = reached
            if kind is None:
                _move(s, motion, second, fraction, due, (y, u))
                return row, DONE
            same_instant = same_instant + 1 if due == 0.0 else 0
            if same_instant >= _SAME_INSTANT:   # no more: the table is full with 64, and the next call counts anew
                return row, NO_PROGRESS
            later = s[FRACTION] + due
            whole = math.floor(later)
            _move(s, motion, s[SECOND] + whole, later - whole, due, (y, u))
            self._transition(p, s, events, row, kind)
            row += 1

    @_QUIET
    def set_inputs(self, p, s, second, fraction, v, v_rate, f, f_rate, waves, events, row):
        """Let the inputs be others from a time on, to which the state was advanced."""
        if same_inputs(s, v, v_rate, f, f_rate, waves):
            return row
        hold_inputs(s, second, fraction, v, v_rate, f, f_rate, waves)
        refresh_inputs(s)
        return self._apply(p, s, events, row)

    @_QUIET
    def set_parameters(self, p, new, s, second, fraction, events, row):
        """Let the axis have other parameters from a time on, to which the state was advanced with the old ones."""
        change_contact(new, s, Motion(p, s, self.law).friction(0.0, (0.0, float(s[VELOCITY]))))
        return self._apply(new, s, events, row)

    @_QUIET
    def sample(self, p, s, second, fraction, out):
        """Fill a row with the state; the time is the one that it was advanced to."""
        motion = Motion(p, s, self.law)
        now = (0.0, float(s[VELOCITY]))
        v, f = motion.inputs.at(0.0)
        write_sample(p, s, second, fraction, 0.0, 0.0, now[1], motion.rates(0.0, now)[1], 0.0, v,
                     drive_force(p, s[SPRING], v, now[1]), f,
                     motion.friction(0.0, now), out)

    def _integrate(self, motion, t, u):
        """Return time, travel, velocity and kind (None: none) of the next event up to t; None where it fails."""
        from scipy.integrate import solve_ivp   # a second that a user of the other solvers need not wait

        guards = motion.guards()
        try:
            with np.errstate(all='ignore'):
                run = solve_ivp(motion.rates, (0.0, t), (0.0, u), self.method, events=[guard for _, guard in guards],
                                rtol=self.rtol, atol=self.atol, max_step=motion.inputs.longest_step)
        except (ArithmeticError, ValueError, np.linalg.LinAlgError):   # on numbers that are not finite
            return None
        if run.status < 0 or not np.isfinite(run.y).all():
            return None
        for (kind, _), times, states in zip(guards, run.t_events, run.y_events):
            if len(times):
                return float(times[-1]), *map(float, states[-1]), kind
        return t, *map(float, run.y[:, -1]), None

    def _transition(self, p, s, events, row, kind):
        if kind == BREAKAWAY:
            release(p, s, events, row)
            self._correct_excess(p, s, events[row])
        elif kind == ARREST:
            arrest(p, s, events, row)
        elif kind == KNOT:
            cross_knot(p, s, events, row, 0.0)
        elif s[MODE] == COASTING:
            leave_coast(p, s, events, row, kind)
        else:
            self._find_piece(p, s)
            friction = self._friction(p, s)
            turn(p, s, events, row)
            events[row][EVENT_FRICTION] = friction

    def _apply(self, p, s, events, row):
        """Choose the mode anew after a jump; return the rows in use."""
        if s[MODE] == STICK:
            _set_acceleration(p, s, self.law)
            if not apply_inputs(p, s, events, row):
                return row
            self._correct_excess(p, s, events[row])
            return row + 1
        mode = s[MODE]
        if not self._choose(p, s):
            arrest(p, s, events, row)
            return row + 1
        if s[MODE] == mode:
            return row
        kind = COAST if s[MODE] == COASTING else (ACCELERATE if s[MODE] == ACCELERATING else DECELERATE)
        write_event(p, s, events, row, kind, s[DIRECTION], self._friction(p, s), p[STATIC_INITIAL])
        events[row][EVENT_MODE] = s[MODE]
        return row + 1

    def _choose(self, p, s):
        """Set the sub-mode of a slip from the forces; return False when the slider comes to rest instead."""
        coefficient, psi = self._coefficients(p, s)
        upper = coefficient + s[EXCESS] * psi
        push = s[DIRECTION] * applied_force(p, s)
        return choose_slip(p, s, push - p[NORMAL] * upper, push - p[NORMAL] * coefficient, force_rounding(p, s, upper))

    def _friction(self, p, s):
        """Return the friction force at the state, N."""
        if s[MODE] == COASTING:
            return applied_force(p, s)
        coefficient, psi = self._coefficients(p, s)
        return s[DIRECTION] * p[NORMAL] * (coefficient + (s[EXCESS] * psi if s[MODE] == ACCELERATING else 0.0))

    def _coefficients(self, p, s):
        speed = abs(float(s[VELOCITY]))
        coefficient, _, psi, _ = friction_line(p, piece_above(p, speed), speed)
        return (coefficient if self.law is None else self.law.coefficient(speed)), psi

    def _correct_excess(self, p, s, event):
        """Let E make friction continuous with the smooth law, where the transition took its table."""
        if self.law is None or s[MODE] == STICK or s[EXCESS] == 0.0:
            return
        coefficient, psi = self._coefficients(p, s)
        s[EXCESS] = (abs(float(event[EVENT_FRICTION])) / float(p[NORMAL]) - coefficient) / psi

    def _find_piece(self, p, s):
        """Set the piece for psi, which no knot keeps up to date with a smooth law."""
        if self.law is not None:
            s[PIECE] = float(piece_above(p, abs(float(s[VELOCITY]))))


def _set_acceleration(p, s, law):
    """Set the acceleration that a break-away from a compliant contact begins with."""
    s[ACCELERATION] = Motion(p, s, law).rates(0.0, (0.0, float(s[VELOCITY])))[1]


def _move(s, motion, second, fraction, t, state):
    """Bring the state to a time, t later, where travel and velocity are `state`."""
    y, u = state
    drive = motion.inputs.travel(t)
    if s[MODE] == STICK:
        s[REST] += t
        s[DEFLECTION] += y
    elif s[MODE] == COASTING:
        s[RESIDUAL] = motion.coasting_residual(t, state)
    s[POSITION] += y
    s[DRIVE] += drive
    s[SPRING] += drive - y
    s[VELOCITY] = u
    s[ACCELERATION] = motion.rates(t, state)[1]
    s[SECOND], s[FRACTION] = second, fraction
    refresh_inputs(s)
