# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""First event of a mode within a step: which guard falls below zero, and when."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from decimal import Decimal

from mpmath import mp, mpf

from .flow import Expansion, Flow, Place, State, after
from .modes import ACCELERATE, COAST, DECELERATE, Slip, Stick, Yield
from .physics import Physics
from .roots import first_root
from .series import Series, combine, derivative, product, reach, scaled, summed_rounding, to_decimal, value

LIMIT, HOLDS, TURNS, SURPLUS_UP, SURPLUS_DOWN, SPEED_UP, SPEED_DOWN = (
    'limit',
    'contact holds',
    'slider turns',
    'surplus up',
    'surplus down',
    'speed up',
    'speed down',
)


@dataclass(frozen=True)
class Step:
    """A proved step: its length, the place at its end, and the guard reached there (if any)."""

    length: mpf
    place: Place
    guard: str | None
    sign: int = 0


def slip_step(physics: Physics, slip: Slip, flow: Flow, state: State, h: mpf) -> Step:
    """Advance a slip by at most h, or to its first event."""
    series = flow.expand(state, h)
    guards = _coast_guards if slip.phase == COAST else _moving_guards
    step = _first(guards(physics, slip, state, series), flow, state, series, h)
    if step.guard == SURPLUS_UP and _touches_rest(physics, slip, state, step.place):
        return replace(step, guard=SPEED_DOWN)
    return step


def yield_step(physics: Physics, mode: Yield, flow: Flow, state: State, h: mpf) -> Step:
    """Advance a contact that yields by at most h, or until it holds again (s z' = 0), or the slider turns (s u = 0)."""
    series = flow.expand(state, h)
    stiffness, damping, scale = physics.axis.contact_stiffness, physics.axis.contact_damping, physics.force_scale(state)
    limit = combine((physics.side(mode.direction).at_rest, series.normal))
    speed, slow = physics.speed_rounding(state), scale * physics.time_scale(state) / physics.axis.mass
    if damping:   # h_c s z'
        slide = combine((mode.direction * damping, series.velocity), (mode.direction * stiffness, series.deflection),
                        (mpf(-1), limit))
        holds = HOLDS, slide, scale + damping * slow, physics.force_rounding(state) + damping * speed
    else:
        slide = combine((mpf(mode.direction), series.velocity), (-1 / stiffness, derivative(limit)))
        holds = HOLDS, slide, slow, speed
    turns = TURNS, combine((mpf(-mode.direction), series.velocity)), slow, speed
    return _first([holds, turns], flow, state, series, h)


def _first(guards: Iterable[_Guard], flow: Flow, state: State, series: Expansion, h: mpf) -> Step:
    """Advance by at most h, or to the first root of these guards."""
    time, best, name = _time_scale(flow, state, h), h, None
    for label, guard, scale, rounding in guards:
        root = first_root(guard, h, scale, time, rounding)
        if root is not None and (name is None or root < best):
            best, name = root, label
    return Step(best, after(state, flow, series, best), name)


def _touches_rest(physics: Physics, slip: Slip, state: State, place: Place) -> bool:
    """Return whether a speed that falls no further has touched zero: there the slider sticks."""
    slowest = slip.phase == DECELERATE and not slip.segment
    return slowest and bool(slip.direction * place.velocity <= physics.speed_rounding(state))


def _time_scale(flow: Flow, state: State, h: mpf) -> mpf:
    rate = flow.pace(state) + state.rate
    return 1 / rate if rate else h


_Guard = tuple[str, Series, mpf, mpf]   # its name, its series, the size against which it ties, its rounding
_ONE = [Decimal(1)]


def _coast_guards(physics: Physics, slip: Slip, state: State, series: Expansion) -> list[_Guard]:
    """0 <= R <= B while u is constant."""
    speed, scale = abs(state.velocity), physics.force_scale(state)
    net = physics.net_series(state, series)
    surplus = combine((mpf(slip.direction), net), (-physics.side(slip.direction).kinetic_at(speed), series.normal))
    room = combine((physics.raised(slip.direction, slip.excess, state), series.normal), (mpf(-1), surplus))
    rounding = physics.force_rounding(state)
    return [(SURPLUS_UP, room, scale, rounding), (SURPLUS_DOWN, surplus, scale, rounding)]


def _moving_guards(physics: Physics, slip: Slip, state: State, series: Expansion) -> list[_Guard]:
    """σ u' keeps its sign, and |u| its table segment (or stays above zero)."""
    rising = slip.phase == ACCELERATE
    sense = 1 if rising else -1
    acceleration = [sense * slip.direction * c for c in derivative(series.velocity)]
    rounding, scale = physics.speed_rounding(state), physics.force_scale(state) / physics.axis.mass
    guards = [(SURPLUS_DOWN if rising else SURPLUS_UP, acceleration, scale, rounding / physics.time_scale(state))]
    side = physics.side(slip.direction)
    bound = side.upper_breakpoint(slip.segment) if rising else side.lower_breakpoint(slip.segment)
    if bound is not None:
        distance = combine((sense * bound, _ONE), (mpf(-sense * slip.direction), series.velocity))
        guards.append((SPEED_UP if rising else SPEED_DOWN, distance, max(bound, abs(state.velocity)), rounding))
    return guards


def stick_step(physics: Physics, stick: Stick, flow: Flow, state: State, t: mpf, h: mpf) -> Step:
    """Advance a rest by at most h, or to the first break-away: F = N mu_s forwards, or -F = N mu_s backwards.

    mu_s never falls, so an interval is clear when F stays below mu_s at its start times the least N, either way; where
    that does not prove it, the interval is shortened until mu_s is a power series on it and the guards are solved.
    """
    series = flow.expand(state, h)
    force = physics.stick_force_series(state, series)
    normal, age = series.normal, stick.rest_time(t)
    laws = [side.static for side in physics.sides]
    lowest, span = [to_decimal(law.value(age)) for law in laws], min(law.span(age) for law in laws)
    if not any(normal):
        if stick.still and not state.drive.value and state.drive.is_constant and state.force.is_constant:
            return Step(h, Place(*state[:4]), None)
        return _out(state, flow, series, h, _unheld(physics, state, force))
    scale, time = physics.force_scale(state), _time_scale(flow, state, h)
    rounding = physics.force_rounding(state) if physics.axis.by_drive else summed_rounding(scale)
    nearly = 1 - Decimal(10) ** -9
    while True:
        way, least = reach(scaled(force, h)), (normal[0] - reach(scaled(normal, h))) * nearly
        if all(sign * force[0] + way < low * least for sign, low in zip(_SIDES, lowest)):
            return Step(h, after(state, flow, series, h), None)
        if h <= span:
            limits = [product(normal, law.series(age)) for law in laws]
            return _out(state, flow, series, h, _over(limits, force, h, scale, time, rounding))
        found = _over([product(normal, [low]) for low in lowest], force, h, scale, time, rounding)
        if found is None:
            return Step(h, after(state, flow, series, h), None)
        if h < mpf(10) ** -30 * min(law.time_constant for law in laws):
            return _out(state, flow, series, h, _at_once(physics, stick, series, force, t, h, found))
        h = max(span, h / 8)


_Found = tuple[mpf, int]
_SIDES = 1, -1   # of physics.sides


def _unheld(physics: Physics, state: State, force: Sequence[Decimal]) -> _Found | None:
    """Return when and on which side a rest without a normal force ends: at once, if it is pushed at all.

    No force is small beside a limit of 0; against the other forces of the axis the contact's may be.  That of the axis
    is rounding where a slip has come to rest without any, and how it changes decides.
    """
    now = physics.stick_force(state)
    known = not physics.axis.by_drive or abs(now) > physics.force_rounding(state)
    first = next((c for c in (now if known else 0, *force[1:], now) if c), None)
    return None if first is None else (mpf(0), 1 if first > 0 else -1)


def _over(limits: Iterable[Series], force: Series, h: mpf, scale: mpf, time: mpf, rounding: mpf) -> _Found | None:
    """Return when and on which side N mu_s ∓ F falls below 0 on [0, h], N mu_s being a power series for each."""
    best = None
    for side, limit in zip(_SIDES, limits):
        root = first_root(combine((mpf(1), limit), (mpf(-side), force)), h, scale, time, rounding)
        if root is not None and (best is None or root < best[0]):
            best = root, side
    return best


def _at_once(physics: Physics, stick: Stick, series: Expansion, force: Series, t: mpf, h: mpf, found: _Found
             ) -> _Found | None:
    """Decide a rest of no age whose law has no power series there (Kato): pass if mu_s outruns F, either way."""
    age = stick.rest_time(t)

    def holds(time: mpf, slack: mpf) -> bool:
        pull, normal = value(force, time), value(series.normal, time)
        return all(sign * pull <= normal * side.static.value(age + time) * (1 + slack)
                   for sign, side in zip(_SIDES, physics.sides))

    if holds(mpf(0), mpf(10) ** (18 - mp.dps)) and holds(h, mpf(0)):
        return None
    return mpf(0), found[1]


def _out(state: State, flow: Flow, series: Expansion, h: mpf, found: _Found | None) -> Step:
    if found is None:
        return Step(h, after(state, flow, series, h), None)
    time, side = found
    return Step(time, after(state, flow, series, time), LIMIT, side)
