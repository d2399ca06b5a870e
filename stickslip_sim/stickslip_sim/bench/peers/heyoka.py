# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""heyoka: Taylor series of high order, events by the isolation of the roots of their polynomials.

Its best form on this problem: one integrator for all modes, whose coefficients are run-time parameters; what happens
at an event is done in its callback, which goes on; rigid stick and coasting are solved in closed form, so that the
integrator's own time passes in motion alone.

The motion after a reset is (y, ẏ): ẏ = u, u̇ = a + b y + c u + d τ + e τ², with y the travel and τ the time since the
reset.  Every guard is of that form, in stick with an exponential of τ; those that a mode does not have are 1.
  Reference: Biscani and Izzo, MNRAS 504 (2021) 2614.
"""

import importlib.metadata
import math
from collections.abc import Callable
from typing import Any

import numpy as np

from ...axis.layout import COMPLIANT
from ...core.errors import SolverError
from ..problem import Outcome, Peer, Problem, Setting, tolerances
from .automaton import (
    ACCELERATING,
    COASTING,
    DEFLECTION,
    MODE,
    Q_BAND,
    Q_BAND_SLOPE,
    Q_BREAKPOINT_ABOVE,
    Q_BREAKPOINT_BELOW,
    Q_CONTACT_DAMPING,
    Q_CONTACT_STIFFNESS,
    Q_DAMPING,
    Q_DIRECTION,
    Q_F,
    Q_F_RATE,
    Q_INITIAL,
    Q_LIMIT,
    Q_LOWER,
    Q_LOWER_SLOPE,
    Q_MASS,
    Q_NORMAL,
    Q_REST,
    Q_S,
    Q_STIFFNESS,
    Q_TAU,
    Q_V,
    Q_V_RATE,
    SIZE,
    STICK,
    TIME,
    U,
    X,
    always_compiled,
    missing,
    motion_of,
)
from .resets import end_of_piece, enter_piece, move, note, reset

# the parameters of the integrator
ORIGIN = 0            # its own time at the reset
ACCELERATION_PLACE = 1      # five coefficients
PULL = 6              # five of the first guard: force left in slip, static limit minus force in stick
FADING = 11           # coefficient of exp(RATE τ) in the first two guards
RATE = 12             # 1/s
BEYOND = 13           # three of the second guard: speed to the next breakpoint, static limit plus force in stick
SPEED_GUARDS = 16            # two of the third guard: speed left to standstill
LEFT = 18             # s, to the end of the piece of the inputs: the fourth guard
ALL = 19

ENDED, NO_ROOM = -1, -2  # instead of a piece
_END_OF_PIECE = 3     # the guard
_STEPS = 100
_FOREVER = 1e9   # s, of the integrator's own time


def _integrator(tolerance: float, fallen: Callable[[int, Any], bool]) -> Any:
    """Return the integrator; `fallen` is called with the guard that fell and says whether to go on."""
    import heyoka as hy

    def par(first: int, count: int) -> list[Any]:
        return [hy.par[first + k] for k in range(count)]

    y, u = hy.make_vars('y', 'u')   # travel since the reset, velocity
    t = hy.time - hy.par[ORIGIN]
    constant, of_y, of_u, of_t, of_t2 = par(ACCELERATION_PLACE, 5)
    motion = [(y, u), (u, constant + of_y * y + of_u * u + (of_t + of_t2 * t) * t)]
    fading = hy.par[FADING] * hy.exp(hy.par[RATE] * t)
    constant, of_y, of_u, of_t, of_t2 = par(PULL, 5)
    pull = constant + of_y * y + of_u * u + (of_t + of_t2 * t) * t + fading
    constant, of_y, of_u = par(BEYOND, 3)
    beyond = constant + of_y * y + of_u * u + fading
    constant, of_u = par(SPEED_GUARDS, 2)
    guards = (pull, beyond, constant + of_u * u, hy.par[LEFT] - t)

    def event(which: int) -> Any:
        return hy.t_event(guards[which], callback=lambda ta, _: fallen(which, ta),
                          direction=hy.event_direction.negative)

    return hy.taylor_adaptive(motion, [0.0, 0.0], pars=[0.0] * ALL, tol=tolerance, fast_math=True,
                              t_events=[event(which) for which in range(len(guards))])


def _prepare(problem: Problem, setting: Setting) -> Callable[[], Outcome]:
    if len(problem.sinusoids) or np.any(problem.pieces[:, 2]):
        raise SolverError('written here for inputs that are constant between jumps')
    p, w, start, pieces, end = (problem.parameters, problem.sinusoids, problem.start, problem.pieces,
                                problem.duration)
    m, events, pars = np.zeros(SIZE), problem.event_rows(), np.zeros(ALL)
    place = np.zeros(2)
    at = [0, 0]   # rows in use, and the piece

    def fallen(which: int, ta: Any) -> bool:
        state = ta.state
        at[:] = follow(p, m, w, pieces, end, start, which, ta.time, state[0], state[1], at[1], events, at[0], pars,
                       place)
        state[:] = place
        ta.pars[:] = pars
        return at[1] >= 0

    integrator = _integrator(setting.value, fallen)

    def simulate() -> Outcome:
        integrator.time = 0.0
        at[:] = begin_outputs(p, m, w, pieces, end, start, events, pars, place)
        integrator.state[:] = place
        integrator.pars[:] = pars
        integrator.reset_cooldowns()
        if at[1] >= 0:
            integrator.propagate_until(_FOREVER)
        if at[1] != ENDED:
            raise SolverError('more events than the table holds' if at[1] == NO_ROOM else 'it stopped before the end')
        return Outcome(events[:at[0]].copy(), float(m[X]))

    return simulate


@always_compiled
def begin_outputs(p, m, w, pieces, duration, start, events, pars, place):
    """Begin a run; return the rows in use and the piece, or how it ended."""
    kind, direction = enter_piece(p, m, w, start, pieces, 0)
    return _go_on(p, m, w, pieces, duration, start, 0, 0.0, events, note(events, 0, m, kind, direction), pars, place)


@always_compiled
def follow(p, m, w, pieces, duration, start, guard, own_time, y, u, piece, events, rows, pars, place):
    """Go on after a guard fell at a time of the integrator, after a travel y, at a velocity u."""
    if guard == _END_OF_PIECE:
        return _next_piece(p, m, w, pieces, duration, start, pars[LEFT], m[X] + y, u, piece, own_time, events, rows,
                           pars, place)
    move(p, m, w, own_time - pars[ORIGIN], m[X] + y, u)
    kind, direction = reset(p, m, w, guard)
    return _go_on(p, m, w, pieces, duration, start, piece, own_time, events, note(events, rows, m, kind, direction),
                  pars, place)


@always_compiled
def _next_piece(p, m, w, pieces, duration, start, left, x, u, piece, own_time, events, rows, pars, place):
    move(p, m, w, left, x, u)
    m[TIME] = end_of_piece(pieces, piece, duration)
    if piece + 1 == len(pieces):
        return rows, ENDED
    kind, direction = enter_piece(p, m, w, start, pieces, piece + 1)
    return _go_on(p, m, w, pieces, duration, start, piece + 1, own_time, events,
                  note(events, rows, m, kind, direction), pars, place)


@always_compiled
def _go_on(p, m, w, pieces, duration, start, piece, own_time, events, rows, pars, place):
    """Pass the modes that have a closed form; write the coefficients of the one that is integrated."""
    while rows >= 0:
        left = end_of_piece(pieces, piece, duration) - m[TIME]
        q = motion_of(p, m)
        if m[MODE] != COASTING and (m[MODE] != STICK or p[COMPLIANT] != 0.0):
            _write_motion(q, m, pars)
            pars[ORIGIN], pars[LEFT] = own_time, left
            place[0], place[1] = 0.0, m[U]
            return rows, piece
        t, guard = _coasting(q, m) if m[MODE] == COASTING else _rigid_stick(q, m)
        if t < left:
            move(p, m, w, t, m[X] + m[U] * t, m[U])
            kind, direction = reset(p, m, w, guard)
        else:
            move(p, m, w, left, m[X] + m[U] * left, m[U])
            m[TIME] = end_of_piece(pieces, piece, duration)
            piece += 1
            if piece == len(pieces):
                return rows, ENDED
            kind, direction = enter_piece(p, m, w, start, pieces, piece)
        rows = note(events, rows, m, kind, direction)
    return 0, NO_ROOM


@always_compiled
def _force_line(q, m):
    """Return F_d + F_e along the motion after the reset: constant, over y, u, τ and τ²."""
    c, h = q[Q_STIFFNESS], q[Q_DAMPING]
    return (c * (q[Q_S] - m[X]) + h * q[Q_V] + q[Q_F], -c, -h, c * q[Q_V] + h * q[Q_V_RATE] + q[Q_F_RATE],
            0.5 * c * q[Q_V_RATE])


@always_compiled
def _write_motion(q, m, pars):
    """Write the coefficients of a slip, or of a stick in a compliant contact."""
    force, of_y, of_u, of_t, of_t2 = _force_line(q, m)
    pars[FADING] = pars[RATE] = 0.0
    pars[SPEED_GUARDS], pars[SPEED_GUARDS + 1] = 1.0, 0.0
    if m[MODE] == STICK:
        stiffness, damping = q[Q_CONTACT_STIFFNESS], q[Q_CONTACT_DAMPING]
        held = stiffness * m[DEFLECTION]
        _write(pars, ACCELERATION_PLACE, 1.0 / q[Q_MASS], force - held, of_y - stiffness, of_u - damping, of_t, of_t2)
        top = q[Q_NORMAL] * q[Q_LIMIT]
        if q[Q_REST] < math.inf:
            pars[RATE] = -1.0 / q[Q_TAU]
            pars[FADING] = -q[Q_NORMAL] * (q[Q_LIMIT] - q[Q_INITIAL]) * math.exp(-q[Q_REST] / q[Q_TAU])
        _write(pars, PULL, 1.0, top - held, -stiffness, -damping, 0.0, 0.0)
        pars[BEYOND], pars[BEYOND + 1], pars[BEYOND + 2] = top + held, stiffness, damping
        return
    direction, friction, slope = q[Q_DIRECTION], q[Q_LOWER], q[Q_LOWER_SLOPE]
    if m[MODE] == ACCELERATING:
        friction += q[Q_BAND]
        slope += q[Q_BAND_SLOPE]
        gap, of_speed = q[Q_BREAKPOINT_ABOVE], -direction
        sense = direction
    else:
        gap, of_speed = -q[Q_BREAKPOINT_BELOW], direction
        sense = -direction
        pars[SPEED_GUARDS], pars[SPEED_GUARDS + 1] = 0.0, direction
    force -= direction * friction
    _write(pars, ACCELERATION_PLACE, 1.0 / q[Q_MASS], force, of_y, of_u - slope, of_t, of_t2)
    _write(pars, PULL, sense, force, of_y, of_u - slope, of_t, of_t2)
    pars[BEYOND], pars[BEYOND + 1], pars[BEYOND + 2] = gap, 0.0, of_speed
    if not abs(gap) < math.inf:
        pars[BEYOND], pars[BEYOND + 2] = 1.0, 0.0
    elif gap + of_speed * m[U] == 0.0:
        # a guard that is 0 at the beginning of a step hides a root within that step
        pars[BEYOND] = math.nextafter(gap, math.inf)


@always_compiled
def _write(pars, at, scale, constant, of_y, of_u, of_t, of_t2):
    pars[at], pars[at + 1], pars[at + 2] = scale * constant, scale * of_y, scale * of_u
    pars[at + 3], pars[at + 4] = scale * of_t, scale * of_t2


@always_compiled
def _coasting(q, m):
    """Return when the force leaves the band between the branches, and the guard that falls there."""
    force, of_y, of_u, of_t, _ = _force_line(q, m)
    direction, speed = q[Q_DIRECTION], q[Q_DIRECTION] * m[U]
    lower = direction * (force + of_u * m[U]) - (q[Q_LOWER] + q[Q_LOWER_SLOPE] * speed)
    band = q[Q_BAND] + q[Q_BAND_SLOPE] * speed
    rate = direction * (of_t + of_y * m[U])
    if rate == 0.0:
        return math.inf, 0
    return (max(lower, 0.0) / -rate, 0) if rate < 0.0 else (max(band - lower, 0.0) / rate, 1)


@always_compiled
def _rigid_stick(q, m):
    """Return when the force reaches the static limit: Newton's steps down a concave guard, from beyond its root."""
    force, _, _, rate, _ = _force_line(q, m)
    if rate == 0.0:
        return math.inf, 0
    sense = 1.0 if rate > 0.0 else -1.0
    force, rate = sense * force, abs(rate)
    top, growth = q[Q_NORMAL] * q[Q_LIMIT], 0.0
    if q[Q_REST] < math.inf:
        growth = q[Q_NORMAL] * (q[Q_LIMIT] - q[Q_INITIAL]) * math.exp(-q[Q_REST] / q[Q_TAU])
    t = max(top - force, 0.0) / rate
    if growth == 0.0:
        return t, 0
    for _ in range(_STEPS):
        fading = growth * math.exp(-t / q[Q_TAU])
        step = (top - fading - force - rate * t) / (fading / q[Q_TAU] - rate)
        if not t - step < t:
            break
        t -= step
    return max(t, 0.0), 0


def _version() -> str:
    return f'heyoka {importlib.metadata.version("heyoka")}'


PEER = Peer('heyoka', tolerances(1e-16), missing('heyoka', 'heyoka'), _version, _prepare)
