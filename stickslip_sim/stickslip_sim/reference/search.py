"""First event of a mode within a step: which guard falls below zero, and when."""

from __future__ import annotations

from dataclasses import dataclass

from mpmath import mp, mpf

from .linear import D, F, Flow, U, V, W, X
from .modes import ACCELERATE, COAST, Physics, Slip, Stick
from .series import Series, combine, derivative, first_root, reach, scaled, value

LIMIT, SURPLUS_UP, SURPLUS_DOWN, SPEED_UP, SPEED_DOWN = (
    'limit',
    'surplus up',
    'surplus down',
    'speed up',
    'speed down',
)


@dataclass(frozen=True)
class Step:
    """A proved step: its length, the state at its end, and the guard reached there (if any)."""

    length: mpf
    state: list[mpf]
    guard: str | None
    sign: int = 0


def slip_step(physics: Physics, slip: Slip, flow: Flow, state: list[mpf], h: mpf) -> Step:
    """Advance a slip by at most h, or to its first event."""
    series = flow.series(state, h)
    if slip.phase == COAST:
        guards, time = _coast_guards(physics, slip, state, series), h
    else:
        guards, time = _moving_guards(physics, slip, state, series), 1 / flow.rate if flow.rate else h
    best, name = h, None
    for label, guard, scale in guards:
        root = first_root(guard, h, scale, time)
        if root is not None and (name is None or root < best):
            best, name = root, label
    return Step(best, _end(series, best), name)


Guard = tuple[str, Series, mpf]


def _coast_guards(physics: Physics, slip: Slip, state: list[mpf], series: list[Series]) -> list[Guard]:
    """0 <= R <= B while u is constant."""
    speed, scale = abs(state[U]), physics.force_scale(state)
    net = physics.net_series(series)
    friction = physics.axis.normal * physics.kinetic_line(physics.locate(speed, True)).at(speed)
    surplus = combine((mpf(slip.direction), net), (-friction, [mpf(1)]))
    room = combine((physics.band(slip.excess, speed), [mpf(1)]), (mpf(-1), surplus))
    return [(SURPLUS_UP, room, scale), (SURPLUS_DOWN, surplus, scale)]


def _moving_guards(physics: Physics, slip: Slip, state: list[mpf], series: list[Series]) -> list[Guard]:
    """σ u' keeps its sign, and |u| its table piece (or stays above zero)."""
    rising = slip.phase == ACCELERATE
    way = mpf(1 if rising else -1)
    acceleration = [way * slip.direction * c for c in derivative(series[U])]
    scale = physics.force_scale(state) / physics.axis.mass
    guards = [(SURPLUS_DOWN if rising else SURPLUS_UP, acceleration, scale)]
    knot = physics.upper_knot(slip.piece) if rising else physics.lower_knot(slip.piece)
    if knot is not None:
        distance = combine((way * knot, [mpf(1)]), (-way * slip.direction, series[U]))
        guards.append((SPEED_UP if rising else SPEED_DOWN, distance, max(knot, abs(state[U]))))
    return guards


def stick_step(physics: Physics, stick: Stick, flow: Flow, state: list[mpf], t: mpf, h: mpf) -> Step:
    """Advance a rest by at most h, or to the first break-away |F| = N mu_s.

    mu_s never falls, so an interval is clear when |F| stays below N mu_s at its start; where that does
    not prove it, the interval is shortened until mu_s is a power series on it and the guards are solved.
    """
    series = flow.series(state, h)
    force = physics.stick_force_series(series)
    law, normal, age = physics.axis.static, physics.axis.normal, stick.rest_time(t)
    lowest, span = normal * law.value(age), law.span(age)
    full: Series | None = None
    while True:
        if abs(force[0]) + reach(scaled(force, h)) < lowest * (1 - mpf(10) ** -9):
            return Step(h, _end(series, h), None)
        time = 1 / flow.rate if flow.rate else h
        if h <= span:
            full = full or [normal * c for c in law.series(age)]
            return _limit_step(full, force, series, h, physics.force_scale(state), time)
        step = _limit_step([lowest], force, series, h, physics.force_scale(state), time)
        if step.guard is None:
            return step
        if h < mpf(10) ** -30 * law.time_constant:
            return _first_instant(physics, stick, force, series, t, h, step)
        h = max(span, h / 8)


def _limit_step(limit: Series, force: Series, series: list[Series], h: mpf, scale: mpf, time: mpf) -> Step:
    """Solve N mu_s ∓ F = 0 on [0, h] with N mu_s as a power series."""
    best, name, sign = h, None, 0
    for side in (1, -1):
        root = first_root(combine((mpf(1), limit), (mpf(-side), force)), h, scale, time)
        if root is not None and (name is None or root < best):
            best, name, sign = root, LIMIT, side
    return Step(best, _end(series, best), name, sign)


def _first_instant(
    physics: Physics, stick: Stick, force: Series, series: list[Series], t: mpf, h: mpf, step: Step
) -> Step:
    """Decide a rest of no age whose law has no power series there (Kato): pass if mu_s outruns |F|."""
    limit = physics.axis.normal * physics.axis.static.value(stick.rest_time(t) + h)
    end = _end(series, h)
    if abs(value(force, h)) <= limit and abs(force[0]) <= physics.axis.normal * (
        physics.axis.static.value(stick.rest_time(t)) * (1 + mpf(10) ** (18 - mp.dps))
    ):
        return Step(h, end, None)
    return Step(mpf(0), _end(series, mpf(0)), LIMIT, step.sign)


def _end(series: list[Series], tau: mpf) -> list[mpf]:
    """Return the state after τ; only the components that move are summed."""
    return [value(c, tau) if i in _MOVING else c[0] for i, c in enumerate(series)]


_MOVING = (W, U, D, X, V, F)
