# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The strong generic rival: Dormand and Prince's order 8(5,3) with dense output and event location, all of it compiled.

Events: change of sign over an accepted step, then a bracketed root on the interpolant.  Each
mode begins with the step that it began with when it was last visited, so that no event costs a new search for one.
"""

import math
from collections.abc import Callable

import numpy as np

from .always_compiled import always_compiled
from ...core.errors import SolverError
from ..problem import Outcome, Problem
from .automaton import GUARDS, MODE, SIZE, TIME, U, X, guard_scales, guards, motion_of, rates
from .dop853_step import MISSING, MORE, STAGES, between, error_norm, fill_interpolant, dop853_step
from .peer import Peer, Setting, tolerances
from .resets import end_of_piece, enter_piece, move, note, reset

_SAFETY, _SHRINK, _GROW = 0.9, 0.2, 10.0
_SCAN = 8             # looks into a step that begins on a guard
_LOOKS = 100
_WIDTH = 4e-16       # of a bracket, relative to the step


@always_compiled
def _guard_within(q, w, t, h, x, u, fx, fu, share, which):
    return guards(q, w, t + share * h, between(fx, x, share), between(fu, u, share))[which]


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
        xn, un = dop853_step(q, w, t, h, x, u, kx, ku)
        error = error_norm(x, u, xn, un, h, tolerance, kx, ku)
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
                    fill_interpolant(q, w, t, h, x, u, xn, un, kx, ku, fx, fu)
                    share = 1.5
                at = _fall(q, w, t, h, x, u, fx, fu, i, before[i], after[i], armed[i] > 0.0)
                if at < share:
                    fallen, share = i, at
        if fallen >= 0:
            move(p, m, w, t + share * h, between(fx, x, share), between(fu, u, share))
            return fallen
        for i in range(GUARDS):
            if after[i] > scales[i]:
                armed[i] = 1.0
        t = limit if h == limit - t else t + h
        x, u, before = xn, un, after
        kx[0], ku[0] = kx[STAGES], ku[STAGES]
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
    m, events, steps, work = np.zeros(SIZE), problem.event_rows(), np.zeros(4), np.zeros((5, MORE))

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


PEER = Peer('DOP853 with events, numba', tolerances(1e-4, 1e-6, 1e-8, 1e-10, 1e-12), MISSING, _version, _prepare)
