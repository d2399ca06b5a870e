# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The strong generic rival: Dormand and Prince's order 8(5,3) with dense output and event location, all of it compiled.

Events: change of sign over an accepted step, then a bracketed root on the interpolant.  Each mode begins with the step
that it began with when it was last visited, so that no event costs a new search for one.

Source: Hairer, Nørsett and Wanner, Solving Ordinary Differential Equations I, sections II.5 and II.10; the coefficients
are those of scipy.  The sums of a step are written out without their zeros, as in the authors' code.
"""

import math
from collections.abc import Callable

import numpy as np

from ...core.errors import SolverError
from ..problem import Outcome, Peer, Problem, Setting, tolerances
from .automaton import (
    GUARDS,
    MODE,
    NUMBA_MISSING,
    SIZE,
    TIME,
    U,
    X,
    always_compiled,
    guard_scales,
    guards,
    motion_of,
    rates,
)
from .resets import end_of_piece, enter_piece, move, note, reset

_A = _B = _C = _E3 = _E5 = _D = np.zeros(0)
_MISSING = NUMBA_MISSING
try:
    from scipy.integrate._ivp import dop853_coefficients as _table
    _A, _B, _C, _E3, _E5, _D = _table.A, _table.B, _table.C, _table.E3, _table.E5, _table.D
except ImportError:
    _MISSING = 'pip install scipy'

_STAGES, _MORE = 12, 16   # of a step with its end; with those of the dense output
_SAFETY, _SHRINK, _GROW = 0.9, 0.2, 10.0
_SCAN = 8             # looks into a step that begins on a guard
_LOOKS = 100
_WIDTH = 4e-16       # of a bracket, relative to the step


@always_compiled
def _step(q, w, t, h, x, u, kx, ku):
    """Return the state at the end of a step; stage 0 is given, the others and the rates at the end are filled in."""
    x0, u0 = kx[0], ku[0]
    dx = h * (_A[1, 0] * x0)
    du = h * (_A[1, 0] * u0)
    x1, u1 = rates(q, w, t + _C[1] * h, x + dx, u + du)
    dx = h * (_A[2, 0] * x0 + _A[2, 1] * x1)
    du = h * (_A[2, 0] * u0 + _A[2, 1] * u1)
    x2, u2 = rates(q, w, t + _C[2] * h, x + dx, u + du)
    dx = h * (_A[3, 0] * x0 + _A[3, 2] * x2)
    du = h * (_A[3, 0] * u0 + _A[3, 2] * u2)
    x3, u3 = rates(q, w, t + _C[3] * h, x + dx, u + du)
    dx = h * (_A[4, 0] * x0 + _A[4, 2] * x2 + _A[4, 3] * x3)
    du = h * (_A[4, 0] * u0 + _A[4, 2] * u2 + _A[4, 3] * u3)
    x4, u4 = rates(q, w, t + _C[4] * h, x + dx, u + du)
    dx = h * (_A[5, 0] * x0 + _A[5, 3] * x3 + _A[5, 4] * x4)
    du = h * (_A[5, 0] * u0 + _A[5, 3] * u3 + _A[5, 4] * u4)
    x5, u5 = rates(q, w, t + _C[5] * h, x + dx, u + du)
    dx = h * (_A[6, 0] * x0 + _A[6, 3] * x3 + _A[6, 4] * x4 + _A[6, 5] * x5)
    du = h * (_A[6, 0] * u0 + _A[6, 3] * u3 + _A[6, 4] * u4 + _A[6, 5] * u5)
    x6, u6 = rates(q, w, t + _C[6] * h, x + dx, u + du)
    dx = h * (_A[7, 0] * x0 + _A[7, 3] * x3 + _A[7, 4] * x4 + _A[7, 5] * x5 + _A[7, 6] * x6)
    du = h * (_A[7, 0] * u0 + _A[7, 3] * u3 + _A[7, 4] * u4 + _A[7, 5] * u5 + _A[7, 6] * u6)
    x7, u7 = rates(q, w, t + _C[7] * h, x + dx, u + du)
    dx = h * (_A[8, 0] * x0 + _A[8, 3] * x3 + _A[8, 4] * x4 + _A[8, 5] * x5 + _A[8, 6] * x6 + _A[8, 7] * x7)
    du = h * (_A[8, 0] * u0 + _A[8, 3] * u3 + _A[8, 4] * u4 + _A[8, 5] * u5 + _A[8, 6] * u6 + _A[8, 7] * u7)
    x8, u8 = rates(q, w, t + _C[8] * h, x + dx, u + du)
    dx = h * (_A[9, 0] * x0 + _A[9, 3] * x3 + _A[9, 4] * x4 + _A[9, 5] * x5 + _A[9, 6] * x6 + _A[9, 7] * x7
              + _A[9, 8] * x8)
    du = h * (_A[9, 0] * u0 + _A[9, 3] * u3 + _A[9, 4] * u4 + _A[9, 5] * u5 + _A[9, 6] * u6 + _A[9, 7] * u7
              + _A[9, 8] * u8)
    x9, u9 = rates(q, w, t + _C[9] * h, x + dx, u + du)
    dx = h * (_A[10, 0] * x0 + _A[10, 3] * x3 + _A[10, 4] * x4 + _A[10, 5] * x5 + _A[10, 6] * x6 + _A[10, 7] * x7
              + _A[10, 8] * x8 + _A[10, 9] * x9)
    du = h * (_A[10, 0] * u0 + _A[10, 3] * u3 + _A[10, 4] * u4 + _A[10, 5] * u5 + _A[10, 6] * u6 + _A[10, 7] * u7
              + _A[10, 8] * u8 + _A[10, 9] * u9)
    x10, u10 = rates(q, w, t + _C[10] * h, x + dx, u + du)
    dx = h * (_A[11, 0] * x0 + _A[11, 3] * x3 + _A[11, 4] * x4 + _A[11, 5] * x5 + _A[11, 6] * x6 + _A[11, 7] * x7
              + _A[11, 8] * x8 + _A[11, 9] * x9 + _A[11, 10] * x10)
    du = h * (_A[11, 0] * u0 + _A[11, 3] * u3 + _A[11, 4] * u4 + _A[11, 5] * u5 + _A[11, 6] * u6 + _A[11, 7] * u7
              + _A[11, 8] * u8 + _A[11, 9] * u9 + _A[11, 10] * u10)
    x11, u11 = rates(q, w, t + _C[11] * h, x + dx, u + du)
    xn = x + h * (_B[0] * x0 + _B[5] * x5 + _B[6] * x6 + _B[7] * x7 + _B[8] * x8 + _B[9] * x9 + _B[10] * x10
                  + _B[11] * x11)
    un = u + h * (_B[0] * u0 + _B[5] * u5 + _B[6] * u6 + _B[7] * u7 + _B[8] * u8 + _B[9] * u9 + _B[10] * u10
                  + _B[11] * u11)
    x12, u12 = rates(q, w, t + h, xn, un)
    kx[5], kx[6], kx[7], kx[8], kx[9], kx[10], kx[11], kx[12] = x5, x6, x7, x8, x9, x10, x11, x12
    ku[5], ku[6], ku[7], ku[8], ku[9], ku[10], ku[11], ku[12] = u5, u6, u7, u8, u9, u10, u11, u12
    return xn, un


@always_compiled
def _error_norm(x, u, xn, un, h, tolerance, kx, ku):
    """Return the norm of the error over the tolerance."""
    size_x = tolerance + tolerance * max(abs(x), abs(xn))
    size_u = tolerance + tolerance * max(abs(u), abs(un))
    x5 = u5 = x3 = u3 = 0.0
    for j in range(_STAGES + 1):
        x5 += _E5[j] * kx[j]
        u5 += _E5[j] * ku[j]
        x3 += _E3[j] * kx[j]
        u3 += _E3[j] * ku[j]
    five = (x5 / size_x) ** 2 + (u5 / size_u) ** 2
    three = (x3 / size_x) ** 2 + (u3 / size_u) ** 2
    if five == 0.0 and three == 0.0:
        return 0.0
    return h * five / math.sqrt((five + 0.01 * three) * 2.0)


@always_compiled
def _fill_interpolant(q, w, t, h, x, u, xn, un, kx, ku, fx, fu):
    """Fill the seven coefficients of the dense output of order 7."""
    for i in range(_STAGES + 1, _MORE):
        dx = du = 0.0
        for j in range(i):
            dx += _A[i, j] * kx[j]
            du += _A[i, j] * ku[j]
        kx[i], ku[i] = rates(q, w, t + _C[i] * h, x + h * dx, u + h * du)
    for f, k, old, new in ((fx, kx, x, xn), (fu, ku, u, un)):
        d = new - old
        f[0] = d
        f[1] = h * k[0] - d
        f[2] = 2.0 * d - h * (k[_STAGES] + k[0])
        for i in range(4):
            total = 0.0
            for j in range(_MORE):
                total += _D[i, j] * k[j]
            f[3 + i] = h * total


@always_compiled
def _between(f, old, share):
    """Return a state within the step, at a share of it, from the seven coefficients."""
    y = 0.0
    for i in range(7):
        y += f[6 - i]
        y *= share if i % 2 == 0 else 1.0 - share
    return old + y


@always_compiled
def _guard_within(q, w, t, h, x, u, fx, fu, share, which):
    return guards(q, w, t + share * h, _between(fx, x, share), _between(fu, u, share))[which]


@always_compiled
def _fall(q, w, t, h, x, u, fx, fu, which, before, after, armed):
    """Return where within the step (0 to 1) a guard falls through zero; at its start if it is never positive."""
    low = 0.0
    if not armed:
        for i in range(1, _SCAN):
            value = _guard_within(q, w, t, h, x, u, fx, fu, i / _SCAN, which)
            if value > 0.0:
                low, before = i / _SCAN, value
        if low == 0.0:
            return 0.0
    return _root(q, w, t, h, x, u, fx, fu, which, low, before, after)


@always_compiled
def _root(q, w, t, h, x, u, fx, fu, which, b, fb, fa):
    """Return the root between b and 1 by Chandrupatla's method: inverse quadratic steps where they are safe."""
    a, share, best = 1.0, 0.5, 1.0
    for _ in range(_LOOKS):
        at = a + share * (b - a)
        value = _guard_within(q, w, t, h, x, u, fx, fu, at, which)
        c, fc = a, fa
        if (value > 0.0) != (fa > 0.0):
            c, fc, b, fb = b, fb, a, fa
        a, fa = at, value
        best = a if abs(fa) < abs(fb) else b
        edge = _WIDTH / abs(b - a) if b != a else 1.0
        if fa == 0.0 or edge > 0.5:
            break
        share = 0.5
        xi, phi = (a - b) / (c - b), (fa - fb) / (fc - fb)
        if phi * phi < xi and (1.0 - phi) * (1.0 - phi) < 1.0 - xi:
            share = fa / (fb - fa) * fc / (fb - fc) + (c - a) / (b - a) * fa / (fc - fa) * fb / (fc - fb)
        share = min(max(share, edge), 1.0 - edge)
    return best


@always_compiled
def _first_step(q, w, x, u, longest):
    """Return a step that changes the state by about a hundredth."""
    dx, du = rates(q, w, 0.0, x, u)
    change = math.hypot(dx, du)
    size = math.hypot(x, u)
    return min(0.01 * size / change if size > 1e-5 and change > 1e-5 else 1e-6, longest)


@always_compiled
def _to_event(p, m, w, limit, tolerance, longest, steps, work):
    """Integrate from the reset to the next event or for `limit`; return the guard that fell, or −1."""
    q = motion_of(p, m)
    kx, ku, fx, fu, armed = work[0], work[1], work[2], work[3], work[4]
    x, u, t = m[X], m[U], 0.0
    mode = int(m[MODE])
    before, scales = guards(q, w, t, x, u), guard_scales(q)
    for i in range(GUARDS):
        armed[i] = 1.0 if before[i] > scales[i] else 0.0
    h = steps[mode] if steps[mode] > 0.0 else _first_step(q, w, x, u, longest)
    kx[0], ku[0] = rates(q, w, t, x, u)
    while t < limit:
        wanted = min(h, longest)
        h = min(wanted, limit - t)
        xn, un = _step(q, w, t, h, x, u, kx, ku)
        error = _error_norm(x, u, xn, un, h, tolerance, kx, ku)
        factor = _GROW if error == 0.0 else min(_GROW, max(_SHRINK, _SAFETY * error ** -0.125))
        if error > 1.0:
            h *= factor
            continue
        if t == 0.0:
            steps[mode] = wanted
        following = h * factor if h == wanted else max(h * factor, wanted)
        after = guards(q, w, t + h, xn, un)
        fallen, share = -1, 2.0
        for i in range(GUARDS):
            if after[i] < (0.0 if armed[i] > 0.0 else -scales[i]):
                if share == 2.0:
                    _fill_interpolant(q, w, t, h, x, u, xn, un, kx, ku, fx, fu)
                    share = 1.5
                at = _fall(q, w, t, h, x, u, fx, fu, i, before[i], after[i], armed[i] > 0.0)
                if at < share:
                    fallen, share = i, at
        if fallen >= 0:
            move(p, m, w, t + share * h, _between(fx, x, share), _between(fu, u, share))
            return fallen
        for i in range(GUARDS):
            if after[i] > scales[i]:
                armed[i] = 1.0
        t = limit if h == limit - t else t + h
        x, u, before = xn, un, after
        kx[0], ku[0] = kx[_STAGES], ku[_STAGES]
        h = following
    move(p, m, w, limit, x, u)
    return -1


@always_compiled
def run(p, begin, pieces, w, duration, tolerance, longest, m, events, steps, work):
    """Simulate; return the number of events (rows: time, kind, direction, x, ẋ; −1 when the table is full)."""
    steps[:] = 0.0
    rows = 0
    for k in range(len(pieces)):
        end = end_of_piece(pieces, k, duration)
        kind, direction = enter_piece(p, m, w, begin, pieces, k)
        rows = note(events, rows, m, kind, direction)
        while m[TIME] < end and rows >= 0:
            fallen = _to_event(p, m, w, end - m[TIME], tolerance, longest, steps, work)
            if fallen < 0:
                m[TIME] = end
            else:
                kind, direction = reset(p, m, w, fallen)
                rows = note(events, rows, m, kind, direction)
        if rows < 0:
            return rows
    return rows


def _prepare(problem: Problem, setting: Setting) -> Callable[[], Outcome]:
    p, begin, pieces, sinusoids = problem.parameters, problem.start, problem.pieces, problem.sinusoids
    m, events, steps, work = np.zeros(SIZE), problem.event_rows(), np.zeros(4), np.zeros((5, _MORE))

    def simulate() -> Outcome:
        rows = run(p, begin, pieces, sinusoids, problem.duration, setting.value, problem.longest_step, m, events,
                   steps, work)
        if rows < 0:
            raise SolverError('more events than the table holds')
        return Outcome(events[:rows].copy(), float(m[X]))

    return simulate


def _version() -> str:
    import numba
    return f'this repository, numba {numba.__version__}'


PEER = Peer('DOP853 with events, numba', tolerances(1e-4, 1e-6, 1e-8, 1e-10, 1e-12), _MISSING, _version, _prepare)
