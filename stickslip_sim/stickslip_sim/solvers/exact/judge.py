# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Whether a run still obeys itself: by the ends of the mode that it is in, and by its balance of energy.

The engine goes from root to root.  A root that is none leaves a state off the limit that it was to reach; one that was
passed over leaves a state beyond the ends of its mode; an overflow leaves the balance open.  A run with an account is
judged at each event, before that is written, and at its end; one that is off ends there, and has no figures to give.
What is allowed is far above rounding, and far below what a figure would show.
"""

import math

from ...axis.layout import (
    ACCELERATION, CONTACT_DAMPING, CONTACT_STIFFNESS, DAMPING, DEFLECTION, DIRECTION, DRIVE, F, FRACTION, F_RATE, GAMMA,
    KNOTS, MASS, MODE, NEXT, NEXT_KIND, NORMAL, PIECE, POSITION, REST, SECOND, SPRING, STATIC_INITIAL, STATIC_LIMIT,
    STIFFNESS, V, VELOCITY, V_RATE, WAVES,
)
from ...axis.motion import (
    ACCELERATING, COASTING, STICK, contact_force, drive_force, drive_travel, friction_line, is_rigid_stick, knot_speed,
    spring_after, static_limit, travel,
)
from ...axis.transitions import ACCELERATE, COAST, band_of
from ...axis.waves import inputs_at
from ...core.jit import compiled, inlined
from .account import balance

ALLOWED = 1e-6   # of the throughput of energy; of the forces that add up; of the speeds that were passed
_ROUNDING = 64.0 * 2.220446049250313e-16   # of forces that add up
_TIME = 8.0 * 2.220446049250313e-16        # of a time


@compiled
def event_is_sound(p, s, begin):
    """Whether the anchor, moved to an event that began at the velocity `begin`, is where the event says, in balance."""
    if s[MODE] == STICK:
        sound = _holds(p, s, s[NEXT], s[SPRING], s[DEFLECTION], s[VELOCITY], s[ACCELERATION], s[V], s[F], s[REST], 1.0)
    elif s[MODE] == COASTING:
        end = band_of(p, s) if s[NEXT_KIND] == ACCELERATE else 0.0
        sound = _coasts(p, s, 0.0, s[SPRING], s[V], s[F], end, end)
    else:
        sound = _slips(p, s, s[VELOCITY], begin, s[NEXT_KIND] != COAST)
    return sound and _balances(p, s, 0.0, s[SPRING], s[V], s[VELOCITY], begin, s[F])


@compiled
def is_sound(p, s, second, fraction):
    """Whether the state at a time between the anchor and the next event is within its mode, and in balance."""
    t = (second - s[SECOND]) + (fraction - s[FRACTION])
    y, u, a = travel(p, s, t)
    v, force = s[V] + s[V_RATE] * t, s[F] + s[F_RATE] * t
    if s[WAVES] != 0.0:
        v, force = inputs_at(s, second, fraction, t)
    spring = spring_after(p, s, t, drive_travel(s, t), y, u, a)
    if s[MODE] == STICK:
        sound = _holds(p, s, t, spring, s[DEFLECTION] + y, u, a, v, force, s[REST] + t, 0.0)
    elif s[MODE] == COASTING:
        sound = _coasts(p, s, t, spring, v, force, 0.0, band_of(p, s))
    else:
        sound = _slips(p, s, u, s[VELOCITY], False)
    return sound and _balances(p, s, t, spring, v, u, s[VELOCITY], force)


@inlined
def _holds(p, s, t, spring, deflection, u, a, v, force, rest, share):
    """Whether the force in stick is at most N mu_s, and at least `share` of that."""
    pull = drive_force(p, spring, v, u) + force
    top = p[NORMAL] * static_limit(p, rest)
    slack = ALLOWED * _forces(p, spring, v, u, force, top)
    if not is_rigid_stick(p, s):   # what a stiff one does within the rounding of the time
        pull = contact_force(p, deflection, u)
        slack += _TIME * t * (p[CONTACT_STIFFNESS] * abs(u) + p[CONTACT_DAMPING] * abs(a))
    return share * top - slack <= abs(pull) <= top + slack


@inlined
def _coasts(p, s, t, spring, v, force, low, high):
    """Whether the residual while coasting is between two ends of its band.

    It began at one of them; the spring's stretch is the difference of two ways, and knows that end no better.
    """
    u = s[VELOCITY]
    friction = p[NORMAL] * friction_line(p, int(s[PIECE]), abs(u))[0]
    residual = s[DIRECTION] * (drive_force(p, spring, v, u) + force) - friction
    slack = ALLOWED * _forces(p, spring, v, u, force, p[NORMAL] * p[STATIC_INITIAL])
    slack += _ROUNDING * p[STIFFNESS] * _way(s, t, v, u)
    return low - slack <= residual <= high + slack


@inlined
def _slips(p, s, u, begin, at_an_end):
    """Whether the speed of a slip is on its piece of the table, or at the end of it to which it goes."""
    speed, piece = s[DIRECTION] * u, int(s[PIECE])
    slack = ALLOWED * (abs(u) + abs(begin) + abs(s[V]))
    low = knot_speed(p, piece)
    if at_an_end:
        end = knot_speed(p, piece + 1) if s[MODE] == ACCELERATING else low
        return abs(speed - end) <= slack
    return low - slack <= speed and (piece + 1.0 >= p[KNOTS] or speed <= knot_speed(p, piece + 1) + slack)


@inlined
def _balances(p, s, t, spring, v, u, begin, force):
    """Whether the balance of energy is open by no more than a share of what went through, or than forces round to.

    A load that comes and goes within one stick goes through without a trace: what the spring holds at the limit counts.
    What rounding leaves of the forces at the velocity `begin`, where the motion began, is lost along its whole way.
    """
    left, scale = balance(p, s, t)
    top = p[NORMAL] * p[STATIC_LIMIT]
    if p[STIFFNESS] > 0.0:
        scale = max(scale, 0.5 * top * top / p[STIFFNESS])
    fastest = max(abs(u), abs(begin))
    forces = _forces(p, spring, v, fastest, force, top)
    if s[MODE] != STICK and s[MODE] != COASTING:   # on a steep piece of the table
        forces += 2.0 * p[MASS] * abs(s[GAMMA]) * (abs(v) + fastest)
    return left <= ALLOWED * scale + _ROUNDING * forces * _way(s, t, v, u) and scale < math.inf


@inlined
def _way(s, t, v, u):
    """Return how far drive and slider went, m."""
    return abs(s[DRIVE]) + abs(s[POSITION]) + (abs(v) + abs(u)) * t


@inlined
def _forces(p, spring, v, u, force, friction):
    """Return the size of the forces that add up."""
    return p[STIFFNESS] * abs(spring) + p[DAMPING] * (abs(v) + abs(u)) + abs(force) + friction
