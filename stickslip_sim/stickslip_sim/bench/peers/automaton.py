# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The axis between two resets, for any integrator: right-hand side and guards, written once for all peers.

Between two resets the motion is an initial value problem of (x, ẋ) in the time τ since the last reset, smooth also a
little beyond the guard that ends it (an integrator looks there).  A guard is a function that is positive inside its
mode and whose fall through zero ends it.  Nothing here is taken from the exact engine: equations and rules are those of
docs/model.md.

numba compiles it when it is first called, and keeps it beside these sources.  The switch STICKSLIP_COMPILED is not for
it: a rival is never held back.

`p` is the array of `axis.pack`.  `m` is the state of the automaton at the last reset (below), `w` the sinusoids:
frequency in Hz, phase in turns, amplitude in m/s, amplitude in N for each.  What the motion until the next reset
depends on is taken together in a tuple `q`, which machine code keeps in registers.
"""

import hashlib
import importlib.util
import math
import os
from collections.abc import Callable
from pathlib import Path
from typing import TypeVar

from ...axis import layout
from ...axis.layout import (
    CONTACT_DAMPING,
    CONTACT_STIFFNESS,
    DAMPING,
    END_SLOPE,
    MASS,
    NORMAL,
    SEGMENT_COUNT,
    SEGMENT_FIELDS,
    SEGMENT_SIZE,
    STATIC_INITIAL,
    STATIC_LIMIT,
    STATIC_TAU,
    STIFFNESS,
    TABLE,
)
from ...core.types import Mode

_Function = TypeVar('_Function', bound=Callable[..., object])


def _digest() -> str:
    """Return a mark of these sources, and of those whose numbers they hold.

    numba itself looks at the file of a function alone, and would go on with the places of a table laid out anew.
    """
    files = [*sorted(Path(__file__).parent.glob('*.py')), Path(layout.__file__)]
    return hashlib.sha256(b''.join(file.read_bytes() for file in files)).hexdigest()[:16]


os.environ['NUMBA_CACHE_DIR'] = str(Path(__file__).parent / '__pycache__' / _digest())
try:
    import numba
    NUMBA_MISSING = None
except ImportError:
    NUMBA_MISSING = 'pip install numba'


def missing(module: str, package: str) -> str | None:
    """Return how to install what a rival needs; None when it is there."""
    return NUMBA_MISSING if importlib.util.find_spec(module) else f'pip install {package}'


def always_compiled(function: _Function) -> _Function:
    """Compile a function; without numba it stays as it is, and its contestant does not race."""
    if NUMBA_MISSING is not None:
        return function
    found: _Function = numba.njit(cache=True, error_model='numpy', _nrt=False)(function)
    return found


_MU, _PSI = SEGMENT_FIELDS.index('friction'), SEGMENT_FIELDS.index('psi')
TIME, MODE, DIRECTION, SEGMENT, EXCESS = range(5)
X, U, S, DEFLECTION, REST = range(5, 10)      # at the reset; S: drive position
V, V_RATE, F, F_RATE = range(10, 14)          # the inputs from the reset on, sinusoids apart
SIZE = 14
GUARDS = 3                                    # of a mode, at most

# q: the numbers of one mode
Q_MODE, Q_DIRECTION, Q_MASS, Q_STIFFNESS, Q_DAMPING = range(5)
Q_LOWER, Q_LOWER_SLOPE, Q_BAND, Q_BAND_SLOPE = range(5, 9)         # N mu_k and N e over the speed: N, N s/m
Q_BREAKPOINT_BELOW, Q_BREAKPOINT_ABOVE = range(9, 11)                          # m/s
Q_CONTACT_STIFFNESS, Q_CONTACT_DAMPING, Q_UNDEFLECTED = range(11, 14)   # both 0 in a rigid contact; x at δ = 0
Q_NORMAL, Q_INITIAL, Q_LIMIT, Q_TAU, Q_REST = range(14, 19)
Q_TIME, Q_S, Q_V, Q_V_RATE, Q_F, Q_F_RATE = range(19, 25)

STICK, ACCELERATING = float(Mode.STICK), float(Mode.ACCELERATING)
COASTING, DECELERATING = float(Mode.COASTING), float(Mode.DECELERATING)

TURN = 2.0 * math.pi
FORCE_ROUNDING = 1e-14   # of the forces: what a sum of them may be off by
SPEED_SCALE = 1e-17   # m/s: below that a speed counts as zero
_NEVER = 1.0       # a guard that the mode does not have


@always_compiled
def static_coefficient(low, limit, tau, rest):
    """Return mu_s(t⁻) of an exponential law."""
    return limit if rest == math.inf else low - (limit - low) * math.expm1(-rest / tau)


@always_compiled
def friction_at_rest(p):
    """Return mu_k as motion stops."""
    return p[TABLE + _MU]


@always_compiled
def breakpoint_at(p, segment):
    """Return the speed at which a segment of the friction table begins."""
    return p[TABLE + SEGMENT_SIZE * int(segment)]


@always_compiled
def segment_of(p, speed, rises):
    """Return the segment of the table that goes on from a speed, upwards or downwards."""
    segment = 0
    for i in range(1, int(p[SEGMENT_COUNT])):
        breakpoint = p[TABLE + SEGMENT_SIZE * i]
        if breakpoint < speed or (rises and breakpoint == speed):
            segment = i
    return float(segment)


@always_compiled
def friction_lines(p, segment):
    """Return mu_k, its slope, psi and its slope as lines through speed 0, along a segment of the table."""
    at = TABLE + SEGMENT_SIZE * int(segment)
    if segment + 1.0 >= p[SEGMENT_COUNT]:
        return p[at + _MU] - p[END_SLOPE] * p[at], p[END_SLOPE], p[at + _PSI], 0.0
    width = p[at + SEGMENT_SIZE] - p[at]
    mu_slope = (p[at + SEGMENT_SIZE + _MU] - p[at + _MU]) / width
    psi_slope = (p[at + SEGMENT_SIZE + _PSI] - p[at + _PSI]) / width
    return p[at + _MU] - mu_slope * p[at], mu_slope, p[at + _PSI] - psi_slope * p[at], psi_slope


@always_compiled
def motion_of(p, m):
    """Return the tuple q of the present mode."""
    normal, excess, segment = p[NORMAL], m[EXCESS], m[SEGMENT]
    mu, mu_slope, psi, psi_slope = friction_lines(p, segment)
    above = breakpoint_at(p, segment + 1.0) if segment + 1.0 < p[SEGMENT_COUNT] else math.inf
    below = breakpoint_at(p, segment) if segment > 0.0 else -math.inf
    return (m[MODE], m[DIRECTION], p[MASS], p[STIFFNESS], p[DAMPING],
            normal * mu, normal * mu_slope, normal * excess * psi, normal * excess * psi_slope, below, above,
            p[CONTACT_STIFFNESS], p[CONTACT_DAMPING], m[X] - m[DEFLECTION],
            normal, p[STATIC_INITIAL], p[STATIC_LIMIT], p[STATIC_TAU], m[REST],
            m[TIME], m[S], m[V], m[V_RATE], m[F], m[F_RATE])


@always_compiled
def inputs(q, w, t):
    """Return drive position, drive velocity and external force at τ = t."""
    s = q[Q_S] + (q[Q_V] + 0.5 * q[Q_V_RATE] * t) * t
    v = q[Q_V] + q[Q_V_RATE] * t
    f = q[Q_F] + q[Q_F_RATE] * t
    if len(w) > 0:
        ds, dv, df = _sinusoids(w, q[Q_TIME], t)
        return s + ds, v + dv, f + df
    return s, v, f


@always_compiled
def _sinusoids(w, begin, t):
    """Return what the sinusoids add to the inputs at τ = t."""
    s = v = f = 0.0
    for i in range(0, len(w), 4):
        before = TURN * (w[i] * begin + w[i + 1])
        now = TURN * (w[i] * (begin + t) + w[i + 1])
        v += w[i + 2] * math.sin(now)
        f += w[i + 3] * math.sin(now)
        if w[i + 2] != 0.0:
            # cos before − cos now, without the cancellation of short times
            s += w[i + 2] / (TURN * w[i]) * 2.0 * math.sin(0.5 * (now + before)) * math.sin(0.5 * (now - before))
    return s, v, f


@always_compiled
def applied(q, w, t, x, u):
    """Return F_d + F_e."""
    s, v, f = inputs(q, w, t)
    return q[Q_STIFFNESS] * (s - x) + q[Q_DAMPING] * (v - u) + f


@always_compiled
def contact(q, x, u):
    """Return F_c = c_c δ + h_c ẋ of the compliant contact."""
    return q[Q_CONTACT_STIFFNESS] * (x - q[Q_UNDEFLECTED]) + q[Q_CONTACT_DAMPING] * u


@always_compiled
def is_compliant(q):
    """Whether the contact yields."""
    return q[Q_CONTACT_STIFFNESS] > 0.0


@always_compiled
def rates(q, w, t, x, u):
    """Return (ẋ, ẍ) of the present mode."""
    mode = q[Q_MODE]
    if mode == COASTING:
        return u, 0.0
    if mode == STICK:
        if not is_compliant(q):
            return 0.0, 0.0
        return u, (applied(q, w, t, x, u) - contact(q, x, u)) / q[Q_MASS]
    speed = q[Q_DIRECTION] * u
    friction = q[Q_LOWER] + q[Q_LOWER_SLOPE] * speed
    if mode == ACCELERATING:
        friction += q[Q_BAND] + q[Q_BAND_SLOPE] * speed
    return u, (applied(q, w, t, x, u) - q[Q_DIRECTION] * friction) / q[Q_MASS]


@always_compiled
def static_margin(q, w, t, x, u):
    """Return by how much the force in stick is below the static limit, N."""
    force = contact(q, x, u) if is_compliant(q) else applied(q, w, t, x, u)
    limit = static_coefficient(q[Q_INITIAL], q[Q_LIMIT], q[Q_TAU], q[Q_REST] + t)
    return q[Q_NORMAL] * limit - abs(force)


@always_compiled
def guards(q, w, t, x, u):
    """Return the three guards of the present mode (in N, or m/s for a speed)."""
    mode = q[Q_MODE]
    if mode == STICK:
        return static_margin(q, w, t, x, u), _NEVER, _NEVER
    speed = q[Q_DIRECTION] * u
    lower = q[Q_DIRECTION] * applied(q, w, t, x, u) - (q[Q_LOWER] + q[Q_LOWER_SLOPE] * speed)
    band = q[Q_BAND] + q[Q_BAND_SLOPE] * speed
    if mode == ACCELERATING:
        return lower - band, q[Q_BREAKPOINT_ABOVE] - speed, _NEVER
    if mode == COASTING:
        return lower, band - lower, _NEVER
    return -lower, speed - q[Q_BREAKPOINT_BELOW], speed


@always_compiled
def force_scale(q):
    """Return below which size a force counts as zero, N."""
    return FORCE_ROUNDING * q[Q_NORMAL] * q[Q_LIMIT] + 1e-300


@always_compiled
def guard_scales(q):
    """Return below which size each guard counts as zero at a reset."""
    force, speed = force_scale(q), SPEED_SCALE
    if q[Q_MODE] == ACCELERATING:
        return force, speed, 0.0
    return force, force if q[Q_MODE] == COASTING else speed, speed
