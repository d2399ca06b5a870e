# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""From event to event with `scipy.integrate.solve_ivp`; the transitions are those of every solver."""

import math
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from functools import partial
from typing import Any, ClassVar, NamedTuple

import numpy as np
from numpy.polynomial import chebyshev

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
from ...axis.forces import drive_force, static_at_once, take_stick
from ...axis.layout import Parameters
from ...axis.records import PLAIN
from ...axis.rows import Events, SampleRow, Sinusoids
from ...axis.state_record import State
from ...axis.transitions import apply_inputs, arrest, cross_breakpoint, leave_coast, release, turn, write_event
from ...core.input_profile import InputProfile
from .. import DONE, FULL, NO_PROGRESS, OUT_OF_RANGE
from ..stepping import begin_state, change_contact, held_force, hold_inputs, refresh_inputs, same_inputs, write_sample
from .mode_problem import (
    ModeGuard,
    ModeLoad,
    ModeMotion,
    SmoothLaw,
    Tolerance,
    choose_sub_mode,
    correct_excess,
    find_segment,
    slip_friction_force,
)

# The integration of one mode from its segment start on, as far as it was asked for.
#
# Its steps do not depend on when that was: between two of them a motion is looked up on their interpolant.

# Where a guard first falls through 0 within a step of the integration, also where it comes back within that step.
#
# The guard is sampled at the points where Chebyshev's polynomial of degree 8 has its extremes; steps are short against
# all that it is made of.  Where the coefficients of the polynomial through the samples do not show that it stays above
# 0, the guard is looked at where that polynomial has its extremes, too.

_DEGREE = 8
_POINTS = -np.cos(math.pi * np.arange(_DEGREE + 1) / _DEGREE)
_TO_COEFFICIENTS = np.linalg.inv(chebyshev.chebvander(_POINTS, _DEGREE))
_NARROW = 4.0 * 2.220446049250313e-16   # s and relative, as in solve_ivp
SAMPLED_AT = 0.5 * (1.0 + _POINTS)      # of the step


def first_fall(guard: Callable[[float], float], begin: float, end: float, samples: list[float], error: float
               ) -> float | None:
    """Return when a guard falls below 0 by more than its error; None where it does not.

    `samples` are its values at `SAMPLED_AT` from `begin` to `end`, s.
    """
    from scipy.optimize import brentq  # a second that a user of the other solvers need not wait

    coefficients = _TO_COEFFICIENTS @ samples
    if not coefficients[0] - np.abs(coefficients[1:]).sum() < -error:
        return None
    seen = [(begin + (end - begin) * float(share), value) for share, value in zip(SAMPLED_AT, samples)]
    slope = np.trim_zeros(chebyshev.chebder(coefficients), 'b')
    turns = chebyshev.chebroots(slope) if len(slope) else slope
    for place in turns[np.isreal(turns)].real:
        if -1.0 < place < 1.0:
            time = begin + (end - begin) * 0.5 * (1.0 + float(place))
            seen.append((time, guard(time)))
    above = begin
    for time, value in sorted(seen):
        if value < -error:
            return float(brentq(guard, above, time, xtol=_NARROW, rtol=_NARROW)) if guard(above) > 0.0 else above
        if value >= 0.0:
            above = time
    return None


_NEVER = 1e10   # s, after all times; LSODA takes no infinity,
_FIRST = 1e-6   # s, and would begin with a share of it


class Reached(NamedTuple):
    """Where an integration came to."""

    time: float          # s, after the segment start
    travel: float        # m
    velocity: float      # m/s
    kind: float | None   # of the event there; None: none


class ModeIntegration:
    """The motion of the mode that a state is in, up to the event that ends it."""

    def __init__(self, motion: ModeMotion, s: State) -> None:
        from scipy import integrate  # a second that a user of the other solvers need not wait

        self.motion = motion
        self._state, self._begin = s, _place(s)
        self._guards = motion.guards()
        now = (0.0, s.velocity)
        self._event = next((Reached(0.0, *now, guard.kind) for guard in self._guards if guard.value(0.0, now) < 0.0),
                           None)
        self._integrator: Any = None
        tolerance = motion.tolerance
        first = {'first_step': _FIRST} if tolerance.method == 'LSODA' else {}
        self._make = partial(getattr(integrate, tolerance.method), motion.rates, 0.0, now, _NEVER,
                             rtol=tolerance.rtol, atol=tolerance.atol, **first)
        self._dense: Any = None     # of the latest step

    def is_from(self, s: State) -> bool:
        """Return whether it is that of a state, which has not changed since."""
        return s is self._state and _place(s) == self._begin

    def reach(self, t: float) -> Reached | None:
        """Return the event up to t, or t; None where the integration fails.  No t may come before an earlier one."""
        try:
            while self._event is None and (self._integrator is None or self._integrator.t < t):
                if not self._step():
                    return None
        except (ArithmeticError, ValueError, np.linalg.LinAlgError):   # on numbers that are not finite
            return None
        if self._event is not None and self._event.time <= t:
            return self._event
        travel, velocity = map(float, self._dense(t))
        return Reached(t, travel, velocity, None)

    def _step(self) -> bool:
        """Make a step; return whether its end is a state."""
        if self._integrator is None:
            self._integrator = self._make(max_step=self.motion.longest_step(0.0))
        solver = self._integrator
        solver.max_step = self.motion.longest_step(solver.t)
        solver.step()
        if solver.status == 'failed' or not np.isfinite(solver.y).all():
            return False
        self._dense = solver.dense_output()
        self._event = _event_within(self._dense, self._guards)
        return True


def _place(s: State) -> tuple[float, ...]:
    return s.second, s.fraction, s.mode, s.position, s.velocity


def _value_on(guard: ModeGuard, dense: Any, time: float) -> float:
    return guard.value(time, dense(time))


def _event_within(dense: Any, guards: list[ModeGuard]) -> Reached | None:
    """Return the first event within a step of the integration, if there is one."""
    begin, end = float(dense.t_old), float(dense.t)
    times = [begin + (end - begin) * float(share) for share in SAMPLED_AT]
    states = [(float(y), float(u)) for y, u in dense(np.array(times)).T]
    first = None
    for guard in guards:
        samples = [guard.value(time, state) for time, state in zip(times, states)]
        error = max(guard.error(begin, states[0]), guard.error(end, states[-1]))
        root = first_fall(partial(_value_on, guard, dense), begin, end, samples, error)
        if root is not None and (first is None or root < first.time):
            y, u = map(float, dense(root))
            first = Reached(root, y, u, guard.kind)
    return first


_SAME_INSTANT = 64   # events without progress in time; a sound model needs three

_QUIET = np.errstate(all='ignore')   # what overflows ends as OUT_OF_RANGE


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
    _latest: list[ModeIntegration] = field(default_factory=list, init=False, repr=False, compare=False)   # at most one

    name: ClassVar[str] = 'adaptive'
    records: ClassVar[Any] = PLAIN
    advice: ClassVar[str] = 'try another solver.method or other tolerances, or check the scene'
    energy: ClassVar[None] = None
    is_sound: ClassVar[None] = None
    walk: ClassVar[None] = None
    step: ClassVar[None] = None

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
            reached = self._integration(p, s).reach(t)
            if reached is None:
                return row, OUT_OF_RANGE
            if reached.kind is None:
                return row, DONE
            same_instant = same_instant + 1 if reached.time == 0.0 else 0
            if same_instant >= _SAME_INSTANT:   # no more: the table is full with 64, and the next call counts anew
                return row, NO_PROGRESS
            later = s.fraction + reached.time
            whole = math.floor(later)
            self._move(p, s, s.second + whole, later - whole, reached)
            self._transition(p, s, events, row, reached.kind)
            row += 1

    @_QUIET
    def bring(self, p: Parameters, s: State, second: float, fraction: float) -> None:
        """Let the segment of the state begin anew at a time that it was advanced to."""
        t = float((second - s.second) + (fraction - s.fraction))
        if t > 0.0 and (reached := self._integration(p, s).reach(t)) is not None:
            self._move(p, s, second, fraction, reached)

    @_QUIET
    def set_inputs(self, p: Parameters, s: State, second: float, fraction: float, v: float, v_rate: float, f: float,
                   f_rate: float, sinusoids: Sinusoids, events: Events, row: int) -> int:
        """Let the inputs be others from a time on, to which the state was advanced."""
        if same_inputs(s, v, v_rate, f, f_rate, sinusoids):
            return row
        self.bring(p, s, second, fraction)
        hold_inputs(s, second, fraction, v, v_rate, f, f_rate, sinusoids)
        self._refresh(p, s)
        return self._apply(p, s, events, row)

    @_QUIET
    def set_parameters(self, p: Parameters, new: Parameters, s: State, second: float, fraction: float, events: Events,
                       row: int) -> int:
        """Let the axis have other parameters from a time on, to which `bring` brought the state with the old ones."""
        change_contact(new, s, held_force(p, s))
        self._press(new, second + fraction)
        return self._apply(new, s, events, row)

    @_QUIET
    def set_load(self, p: Parameters, s: State, second: float, fraction: float, _normal_force: float,
                 _normal_rate: float, v: float, v_rate: float, f: float, f_rate: float, sinusoids: Sinusoids,
                 events: Events, row: int) -> int:
        """Let the normal force, which is that of the solver, and the inputs be others from a time on, both at once."""
        self.bring(p, s, second, fraction)
        self._press(p, second + fraction)
        hold_inputs(s, second, fraction, v, v_rate, f, f_rate, sinusoids)
        self._refresh(p, s)
        return self._apply(p, s, events, row)

    @_QUIET
    def sample(self, p: Parameters, s: State, second: float, fraction: float, out: SampleRow) -> None:
        """Fill a row with the state; the time is the one that it was advanced to."""
        t = float((second - s.second) + (fraction - s.fraction))
        integration = self._integration(p, s)
        motion, reached = integration.motion, integration.reach(t)
        y, u = (math.nan, math.nan) if reached is None else (reached.travel, reached.velocity)
        v, f = motion.inputs.at(t)
        drive, pressed = motion.inputs.travel(t), p.normal_force
        p.normal_force = motion.load.at(t)
        write_sample(p, s, second, fraction, t, y, u, motion.rates(t, (y, u))[1], drive, v,
                     drive_force(p, s.spring + drive - y, v, u), f, motion.friction(t, (y, u)), out)
        if s.mode == YIELDING:
            out.deflection = motion.deflection(t)
        p.normal_force = pressed

    def _integration(self, p: Parameters, s: State) -> ModeIntegration:
        """Return the integration of the mode from the segment start on: the latest, or a new one that is the same."""
        if not (self._latest and self._latest[0].is_from(s)):
            self._latest[:] = [ModeIntegration(self._motion(p, s), s)]
        return self._latest[0]

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
        take_stick(p, s)
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
        take_stick(p, s)
        return ModeMotion(p, s, self._law(s), self.normal_force, Tolerance(self.method, self.rtol, self.atol))

    def _move(self, p: Parameters, s: State, second: float, fraction: float, reached: Reached) -> None:
        """Bring the state to a time that its integration has reached."""
        motion = self._integration(p, s).motion
        t, y, u, _ = reached
        state, drive = (y, u), motion.inputs.travel(t)
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
