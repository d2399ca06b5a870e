# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""From event to event with `scipy.integrate.solve_ivp`; the transitions are those of every solver."""

import math
from dataclasses import dataclass, replace
from functools import partial
from typing import Any, ClassVar, NamedTuple

import numpy as np

from ...axis.codes import (
    ACCELERATE,
    ACCELERATING,
    ARREST,
    BREAKAWAY,
    COAST,
    COASTING,
    DECELERATE,
    KNOT,
    STICK,
    YIELDING,
)
from ...axis.forces import drive_force
from ...axis.layout import Parameters
from ...axis.records import PLAIN
from ...axis.rows import Events, SampleRow, Sinusoids
from ...axis.state_record import State
from ...axis.static_limits import static_at_once
from ...axis.transitions import apply_inputs, arrest, cross_breakpoint, leave_coast, release, turn, write_event
from ...core.input_profile import InputProfile
from .. import DONE, FULL, NO_PROGRESS, OUT_OF_RANGE
from ..inputs import hold_inputs, refresh_inputs, same_inputs
from ..sampling import write_sample
from ..state import begin_state, change_contact, held_force
from .first_fall import SAMPLED_AT, first_fall
from .mode_problem import ModeGuard, ModeLoad, ModeMotion, SmoothLaw
from .smooth_friction import choose_sub_mode, correct_excess, find_segment, slip_friction_force

_SAME_INSTANT = 64   # events without progress in time; a sound model needs three

_QUIET = np.errstate(all='ignore')   # what overflows ends as OUT_OF_RANGE


class _Reached(NamedTuple):
    """Where an integration came to."""

    time: float          # s
    travel: float        # m
    velocity: float      # m/s
    kind: float | None   # of the event there; None: none


@dataclass(frozen=True, slots=True)
class Engine:
    """The solver; `laws` are the smooth mu_k forwards and backwards, each None for the table in the parameters.

    `normal_force` is N where it varies; the normal force of the parameters is then that at the state.
    """

    method: str
    rtol: float
    atol: float
    laws: tuple[SmoothLaw | None, SmoothLaw | None]
    normal_force: InputProfile | None = None

    name: ClassVar[str] = 'adaptive'
    records: ClassVar[Any] = PLAIN
    advice: ClassVar[str] = 'try another solver.method or other tolerances, or check the scene'
    energy: ClassVar[None] = None
    is_sound: ClassVar[None] = None
    walk: ClassVar[None] = None

    def with_normal_force(self, normal_force: InputProfile) -> 'Engine':
        """Return the solver for a normal force that varies, N."""
        return replace(self, normal_force=normal_force)

    @_QUIET
    def start(self, p: Parameters, s: State, position: float, velocity: float, rest: float, stretch: float,
              deflection: float, v: float, v_rate: float, f: float, f_rate: float, sinusoids: Sinusoids, events: Events,
              row: int) -> int:
        """Set the state at time 0: in stick (it may break away at once) or sliding."""
        begin_state(s, position, velocity, rest, stretch, deflection)
        self._press(p, 0.0)
        hold_inputs(s, 0.0, 0.0, v, v_rate, f, f_rate, sinusoids)
        self._refresh(p, s)
        if s.mode == STICK:
            return self._apply(p, s, events, row)
        choose_sub_mode(self._law(s), p, s)
        return row

    @_QUIET
    def advance(self, p: Parameters, s: State, second: float, fraction: float, events: Events, row: int
                ) -> tuple[int, int]:
        """Bring the state to a time; return the rows in use and how it ended."""
        same_instant = 0
        while True:
            t = float((second - s.second) + (fraction - s.fraction))
            if t <= 0.0:
                return row, DONE
            if row >= events.count:
                return row, FULL
            motion = self._motion(p, s)
            reached = self._integrate(motion, t, s.velocity)
            if reached is None:
                return row, OUT_OF_RANGE
            due, y, u, kind = reached
            if kind is None:
                self._move(p, s, motion, second, fraction, due, (y, u))
                return row, DONE
            same_instant = same_instant + 1 if due == 0.0 else 0
            if same_instant >= _SAME_INSTANT:   # no more: the table is full with 64, and the next call counts anew
                return row, NO_PROGRESS
            later = s.fraction + due
            whole = math.floor(later)
            self._move(p, s, motion, s.second + whole, later - whole, due, (y, u))
            self._transition(p, s, events, row, kind)
            row += 1

    @_QUIET
    def set_inputs(self, p: Parameters, s: State, second: float, fraction: float, v: float, v_rate: float, f: float,
                   f_rate: float, sinusoids: Sinusoids, events: Events, row: int) -> int:
        """Let the inputs be others from a time on, to which the state was advanced."""
        if same_inputs(s, v, v_rate, f, f_rate, sinusoids):
            return row
        hold_inputs(s, second, fraction, v, v_rate, f, f_rate, sinusoids)
        self._refresh(p, s)
        return self._apply(p, s, events, row)

    @_QUIET
    def set_parameters(self, p: Parameters, new: Parameters, s: State, second: float, fraction: float, events: Events,
                       row: int) -> int:
        """Let the axis have other parameters from a time on, to which the state was advanced with the old ones."""
        change_contact(new, s, held_force(p, s))
        self._press(new, second + fraction)
        return self._apply(new, s, events, row)

    @_QUIET
    def set_load(self, p: Parameters, s: State, second: float, fraction: float, _normal_force: float,
                 _normal_rate: float, v: float, v_rate: float, f: float, f_rate: float, sinusoids: Sinusoids,
                 events: Events, row: int) -> int:
        """Let the normal force, which is that of the solver, and the inputs be others from a time on, both at once."""
        self._press(p, second + fraction)
        hold_inputs(s, second, fraction, v, v_rate, f, f_rate, sinusoids)
        self._refresh(p, s)
        return self._apply(p, s, events, row)

    @_QUIET
    def sample(self, p: Parameters, s: State, second: float, fraction: float, out: SampleRow) -> None:
        """Fill a row with the state; the time is the one that it was advanced to."""
        motion = self._motion(p, s)
        now = (0.0, s.velocity)
        v, f = motion.inputs.at(0.0)
        write_sample(p, s, second, fraction, 0.0, 0.0, now[1], motion.rates(0.0, now)[1], 0.0, v,
                     drive_force(p, s.spring, v, now[1]), f,
                     motion.friction(0.0, now), out)

    def _integrate(self, motion: ModeMotion, t: float, u: float) -> _Reached | None:
        """Return the next event up to t, or t; None where the integration fails."""
        from scipy import integrate  # a second that a user of the other solvers need not wait

        guards = motion.guards()
        for guard in guards:
            if guard.value(0.0, (0.0, u)) < 0.0:
                return _Reached(0.0, 0.0, u, guard.kind)
        try:
            solver = getattr(integrate, self.method)(motion.rates, 0.0, (0.0, u), t, rtol=self.rtol, atol=self.atol,
                                                     max_step=motion.longest_step(0.0))
            while solver.status == 'running':
                solver.max_step = motion.longest_step(solver.t)
                solver.step()
                if solver.status == 'failed' or not np.isfinite(solver.y).all():
                    return None
                reached = _event_within(solver.dense_output(), guards)
                if reached is not None:
                    return reached
        except (ArithmeticError, ValueError, np.linalg.LinAlgError):   # on numbers that are not finite
            return None
        y, velocity = map(float, solver.y)
        return _Reached(t, y, velocity, None)

    def _transition(self, p: Parameters, s: State, events: Events, row: int, kind: float) -> None:
        if kind == BREAKAWAY:
            release(p, s, events, row)
            correct_excess(self._law(s), p, s, events.rows[row])
        elif kind == ARREST:
            arrest(p, s, events, row)
        elif kind == KNOT:
            cross_breakpoint(p, s, events, row, 0.0)
        elif s.mode == COASTING:
            leave_coast(p, s, events, row, kind)
        else:
            find_segment(self._law(s), p, s)
            friction = slip_friction_force(self._law(s), p, s)
            turn(p, s, events, row)
            events.rows[row].friction = friction

    def _apply(self, p: Parameters, s: State, events: Events, row: int) -> int:
        """Choose the mode anew after a jump; return the rows in use."""
        if s.mode in (STICK, YIELDING):
            s.acceleration = self._motion(p, s).rates(0.0, (0.0, s.velocity))[1]   # that a break-away begins with
            if not apply_inputs(p, s, events, row):
                return row
            correct_excess(self._law(s), p, s, events.rows[row])
            return row + 1
        mode = s.mode
        if not choose_sub_mode(self._law(s), p, s):
            arrest(p, s, events, row)
            return row + 1
        if s.mode == mode:
            return row
        kind = COAST if s.mode == COASTING else (ACCELERATE if s.mode == ACCELERATING else DECELERATE)
        write_event(p, s, events, row, kind, s.direction, slip_friction_force(self._law(s), p, s),
                    static_at_once(p, s.direction))
        events.rows[row].mode = s.mode
        return row + 1

    def _law(self, s: State) -> SmoothLaw | None:
        """Return the smooth mu_k of the present direction, if there is one."""
        return self.laws[1 if s.direction < 0.0 else 0]

    def _motion(self, p: Parameters, s: State) -> ModeMotion:
        return ModeMotion(p, s, self._law(s), self.normal_force)

    def _move(self, p: Parameters, s: State, motion: ModeMotion, second: float, fraction: float, t: float,
              state: tuple[float, float]) -> None:
        """Bring the state to a time, t later, where travel and velocity are `state`."""
        y, u = state
        drive = motion.inputs.travel(t)
        if s.mode == STICK:
            s.rest += t
            s.deflection += y
        elif s.mode == COASTING:
            s.residual = motion.coasting_residual(t, state)
        elif s.mode == YIELDING:
            s.deflection = motion.deflection(t)
        s.position += y
        s.drive += drive
        s.spring += drive - y
        s.velocity = u
        s.acceleration = motion.rates(t, state)[1]
        s.second, s.fraction = second, fraction
        p.normal_force = motion.load.at(t)
        self._refresh(p, s)

    def _refresh(self, p: Parameters, s: State) -> None:
        """Set the inputs and the rates to those at the time of the state."""
        refresh_inputs(s)
        s.inputs.n_rate = ModeLoad(p.normal_force, s, self.normal_force).rate(0.0)

    def _press(self, p: Parameters, time: float) -> None:
        """Let the parameters have the normal force from a time on, s."""
        if self.normal_force is not None:
            p.normal_force = self.normal_force.value_at(time)


def _value_on(guard: ModeGuard, dense: Any, time: float) -> float:
    return guard.value(time, dense(time))


def _event_within(dense: Any, guards: list[ModeGuard]) -> _Reached | None:
    """Return the first event within a step of the integration, if there is one."""
    begin, end = float(dense.t_old), float(dense.t)
    times = [begin + (end - begin) * float(share) for share in SAMPLED_AT]
    states = [(float(y), float(u)) for y, u in dense(np.array(times)).T]
    first = None
    for guard in guards:
        samples = [guard.value(time, state) for time, state in zip(times, states)]
        rounding = max(guard.rounding(begin, states[0]), guard.rounding(end, states[-1]))
        root = first_fall(partial(_value_on, guard, dense), begin, end, samples, rounding)
        if root is not None and (first is None or root < first.time):
            y, u = map(float, dense(root))
            first = _Reached(root, y, u, guard.kind)
    return first
