# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The hybrid automaton of one axis with friction, event to event, in multiple precision."""

from __future__ import annotations

from dataclasses import replace

import mpmath
from mpmath import mpf

from ..core.errors import SolverError
from .exact_run import Event, Run, Stretch, sample
from .flow import Flow, State
from .modes import ACCELERATE, COAST, DECELERATE, Mode, Slip, Stick, Yield, word
from .physics import Physics
from .problem import Input, Problem, Signal
from .search import HOLDS, LIMIT, SPEED_DOWN, SPEED_UP, SURPLUS_UP, TURNS, Step, slip_step, stick_step, yield_step
from .series import working

GUARD_DIGITS = 12
UNSEEN_COAST = mpf(10) ** -15  # |R - B| against N mu_b after a compliant break-away
DIED_OUT = mpf(2) ** -49  # of the largest force that turned a slider which nothing holds: at less it rests
_MOST_EVENTS = 200_000
_ZERO = mpf(0)


def run(problem: Problem, duration: float, digits: int) -> Run:
    """Return the events from t = 0 up to `duration`; raises SolverError when they do not end."""
    with working(digits + GUARD_DIGITS):
        return _Automaton(problem, mpf(duration), digits + GUARD_DIGITS).run()


class _Automaton:
    """A running simulation: time, state, mode."""

    def __init__(self, axis: Problem, duration: mpf, digits: int) -> None:
        self.axis, self.physics, self.duration = axis, Physics(axis), duration
        self.inputs = [Input(profile) for profile in axis.inputs]
        self.result = Run(self.physics, digits)
        self.t = mpf(0)
        self.state = State(axis.stretch, axis.velocity, axis.deflection, axis.position, *self._signals())
        self.mode: Mode = Stick(self.t, axis.rest_time)
        self.swing = mpf(0)
        self.sticks = -1
        self.flow: Flow
        self._begin_stick()

    def _begin_stick(self) -> None:
        """Draw the static law of the next stick, where it scatters."""
        self.sticks += 1
        if self.axis.scatter is not None:
            for side in self.physics.sides:
                side.begin_stick(self.axis.scatter.factor(self.sticks))

    def run(self) -> Run:
        """Follow the modes and the segments of the inputs to the end."""
        if self.axis.velocity and not self.axis.deflection:
            self._enter_slip(1 if self.axis.velocity > 0 else -1, mpf(0))
        self.flow = self.physics.flow(self.mode)
        while (stop := min(one.until for one in self.inputs)) <= self.duration:
            self._advance_to(stop)
            self._change_inputs()
        self._advance_to(self.duration)
        self.result.final = sample(self.physics, self.mode, self.t, self.state)
        return self.result

    def _advance_to(self, stop: mpf) -> None:
        while self.t < stop:
            left = stop - self.t
            step = self._step(self.flow.longest_step(self.state, left))
            self.result.stretches.append(Stretch(self.t, step.length, self.state, self.flow, self.mode))
            self.t = stop if step.length == left else self.t + step.length
            self.state = State(*step.place, *self._signals())
            if step.guard:
                self._transition(step)
                self.flow = self.physics.flow(self.mode)

    def _step(self, h: mpf) -> Step:
        if isinstance(self.mode, Slip):
            return slip_step(self.physics, self.mode, self.flow, self.state, h)
        if isinstance(self.mode, Yield):
            return yield_step(self.physics, self.mode, self.flow, self.state, h)
        return stick_step(self.physics, self.mode, self.flow, self.state, self.t, h)

    def _signals(self) -> list[Signal]:
        return [one.at(self.t) for one in self.inputs]

    def _change_inputs(self) -> None:
        """Load the new inputs and re-classify a slip; a rest leaves by its own guard, at once if need be.

        The normal force jumps with them, and the state, the rest time and E of a slip stay.
        """
        for one in self.inputs:
            one.enter(self.t)
        self.state = State(*self.state[:4], *self._signals())
        if isinstance(self.mode, Slip):
            phase = self.physics.phase(self.mode.direction, self.mode.excess, self.state)
            if phase != self.mode.phase:
                self._change_phase(phase)
        elif isinstance(self.mode, Yield) and not self.axis.contact_damping:
            self._follow_limit(self.mode)
        elif isinstance(self.mode, Stick) and self.mode.still:
            self.mode = replace(self.mode, still=self._died_out())
        self.flow = self.physics.flow(self.mode)

    # ---- transitions --------------------------------------------------------------------------

    def _transition(self, step: Step) -> None:
        if step.guard == LIMIT:
            self._leave_rest(step.sign)
        elif step.guard == HOLDS:
            self._hold(self._yielding())
        elif step.guard == TURNS:
            self._turn(self._yielding())
        elif step.guard == SPEED_UP:
            self._cross_breakpoint(1)
        elif step.guard == SPEED_DOWN and self._slip().segment > 0:
            self._cross_breakpoint(-1)
        elif step.guard == SPEED_DOWN:
            self._arrest()
        else:
            self._change_phase(self._phase_after(step.guard == SURPLUS_UP))

    def _slip(self) -> Slip:
        assert isinstance(self.mode, Slip)
        return self.mode

    def _phase_after(self, upward: bool) -> str:
        """Return the sub-mode beyond a border of the band; an empty band is jumped over."""
        slip = self._slip()
        if slip.phase == COAST:
            return ACCELERATE if upward else DECELERATE
        if self.physics.band(slip.direction, slip.excess, self.state) > self.physics.tiny(self.state):
            return COAST
        return ACCELERATE if upward else DECELERATE

    def _change_phase(self, phase: str) -> None:
        old = self._slip()
        segment = self.physics.side(old.direction).locate(abs(self.state.velocity), phase == ACCELERATE)
        self.mode = replace(old, phase=phase, segment=segment, silent=False)
        if not (old.silent and phase == ACCELERATE):
            self._emit(phase, old.direction, self.physics.friction(self.mode, self.state))

    def _cross_breakpoint(self, sense: int) -> None:
        slip = self._slip()
        side = self.physics.side(slip.direction)
        bound = (side.upper_breakpoint if sense > 0 else side.lower_breakpoint)(slip.segment)
        assert bound is not None
        self.state = self.state._replace(velocity=slip.direction * bound)
        self.mode = replace(slip, segment=slip.segment + sense)
        self._emit('knot', slip.direction, self.physics.friction(self.mode, self.state))

    def _enter_slip(self, direction: int, excess: mpf) -> None:
        phase = self.physics.phase(direction, excess, self.state)
        segment = self.physics.side(direction).locate(abs(self.state.velocity), phase == ACCELERATE)
        self.state = self.state._replace(deflection=mpf(0))
        self.mode = Slip(direction, phase, excess, segment)

    # ---- a contact that yields ------------------------------------------------------------------

    def _leave_rest(self, sign: int) -> None:
        """Leave the rest at |F| = N mu_s on a side: the slider breaks away, or the contact yields."""
        assert isinstance(self.mode, Stick)
        age = self.mode.rest_time(self.t)
        static = self.physics.side(sign).static.value(age)
        if self.axis.by_drive or self._goes_along(sign):
            self._break_away(sign, static, age)
            return
        force = self.physics.stick_force(self.state)
        self.mode = Yield(sign)
        if not self.axis.contact_damping:
            self._deflect(self.mode)
        self._emit('yield', sign, force, static, age)

    def _goes_along(self, sign: int) -> bool:
        """Return whether the slider moves in the direction of the contact's force, or is about to."""
        u = self.state.velocity
        if abs(u) * self.flow.rate * self.axis.mass > self.physics.tiny(self.state):
            return bool(sign * u > 0)
        left = sign * self.physics.net_force(self.state) - self.state.normal.value * self.physics.side(sign).at_rest
        return bool(left >= 0)

    def _deflect(self, mode: Yield) -> None:
        """Let the deflection of a contact without a damper be that of its force."""
        self.state = self.state._replace(deflection=self.physics.friction(mode, self.state)
                                         / self.axis.contact_stiffness)

    def _follow_limit(self, mode: Yield) -> None:
        """Let the deflection of a contact without a damper follow a normal force that has jumped: up, it holds."""
        kept = mode.direction * self.axis.contact_stiffness * self.state.deflection
        if kept < mode.direction * self.physics.friction(mode, self.state) - self.physics.tiny(self.state):
            self._hold(mode)
        else:
            self._deflect(mode)

    def _yielding(self) -> Yield:
        assert isinstance(self.mode, Yield)
        return self.mode

    def _hold(self, mode: Yield) -> None:
        """Stick again, with no rest time."""
        self._begin_stick()
        self.mode = Stick(self.t, mpf(0))
        self._emit('stick', mode.direction, self.physics.friction(mode, self.state))

    def _turn(self, mode: Yield) -> None:
        """Let the slider, which has come to stand, slip along the force."""
        self.state = self.state._replace(velocity=mpf(0))
        friction = self.physics.friction(mode, self.state)
        self._enter_slip(mode.direction, mpf(0))
        self._emit('breakaway', mode.direction, friction)

    # ---- slips ----------------------------------------------------------------------------------

    def _break_away(self, sign: int, static: mpf, age: mpf) -> None:
        """Begin a slip in the direction of F, or of the motion where the drive's force ends the rest."""
        direction = self._direction(sign)
        speed, side = abs(self.state.velocity), self.physics.side(direction)
        self.result.disputed += direction != sign or bool(side.kinetic_at(speed) > static)
        self._enter_slip(direction, side.excess_at(static, speed))
        self._hide_short_coast(static)
        self._emit('breakaway', direction, sign * self.state.normal.value * static, static, age)

    def _direction(self, sign: int) -> int:
        """σ = sign(ẋ); at rest the sign of the force."""
        u = self.state.velocity
        if abs(u) * self.flow.rate * self.axis.mass <= self.physics.tiny(self.state):
            return sign
        return 1 if u > 0 else -1

    def _hide_short_coast(self, static: mpf) -> None:
        """Mark a coast that exists only by 1e-15 of the force and ends by accelerating."""
        slip = self._slip()
        if slip.phase != COAST or self.axis.by_drive:
            return
        gap = self.physics.surplus(slip.direction, self.state) - self.physics.band(slip.direction, slip.excess,
                                                                                   self.state)
        if (
            abs(gap) <= UNSEEN_COAST * self.state.normal.value * static
            and self.physics.surplus_rate(slip.direction, self.state, slip.excess) > 0
        ):
            self.mode = replace(slip, silent=True)

    def _arrest(self) -> None:
        """End a slip at ẋ = 0: reverse at once (F_d + F_e beyond N mu_s(0) of the other way, if it may) or stick."""
        sigma = self._slip().direction
        self._begin_stick()
        self.state = self.state._replace(velocity=mpf(0))
        back = self.physics.side(-sigma)
        static = back.static.value(mpf(0))
        friction = sigma * self.state.normal.value * self.physics.side(sigma).at_rest
        still = self._died_out()
        self.swing = max(self.swing, abs(self.physics.net_force(self.state))) if self.physics.holds_nothing(
            self.state) else mpf(0)
        if self.axis.by_drive and not still and self._pulled_back(sigma, static):
            self._enter_slip(-sigma, back.excess_at(static, mpf(0)))
            self._emit('reverse', -sigma, friction)
            return
        if self.axis.contact == 'compliant':
            deflection = mpf(0) if self.axis.undeflected else friction / self.axis.contact_stiffness
            self.state = self.state._replace(deflection=deflection)
        self.mode = Stick(self.t, mpf(0), still)
        self._emit('stick', sigma, friction)

    def _died_out(self) -> bool:
        """Return whether nothing holds the slider, and the force is rounding of the largest that ever turned it."""
        force = abs(self.physics.net_force(self.state))
        return self.physics.holds_nothing(self.state) and bool(force <= DIED_OUT * self.swing)

    def _pulled_back(self, sigma: int, static: mpf) -> bool:
        excess = -sigma * self.physics.net_force(self.state) - self.state.normal.value * static
        return bool(excess > self.physics.tiny(self.state))

    def _emit(self, kind: str, direction: int, friction: mpf, static: mpf | None = None, rest: mpf = _ZERO) -> None:
        """List an event; its static coefficient is that of its direction at no rest, if none is given."""
        if len(self.result) >= _MOST_EVENTS:
            raise SolverError(f'{_MOST_EVENTS} events up to t = {mpmath.nstr(self.t, 17)} s: check the scene')
        self.result.append(
            Event(
                self.t,
                kind,
                word(self.mode),
                direction,
                self.state.position,
                self.state.velocity,
                self.state.position + self.state.stretch,
                self.physics.drive_force(self.state),
                friction,
                self.physics.side(direction).static.value(_ZERO) if static is None else static,
                rest,
            )
        )
