# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""One step of Dormand and Prince's order 8(5,3) for the two states of the axis, its error and its dense output.

Source: Hairer, Nørsett and Wanner, Solving Ordinary Differential Equations I, sections II.5 and II.10; the coefficients
are those of scipy.  The sums of a step are written out without their zeros, as in the authors' code.
"""

import math

import numpy as np

from .always_compiled import NUMBA_MISSING, always_compiled
from .automaton import rates

_A = _B = _C = _E3 = _E5 = _D = np.zeros(0)
MISSING: str | None = NUMBA_MISSING
try:
    from scipy.integrate._ivp import dop853_coefficients as _table
    _A, _B, _C, _E3, _E5, _D = _table.A, _table.B, _table.C, _table.E3, _table.E5, _table.D
except ImportError:
    MISSING = 'pip install scipy'

STAGES, MORE = 12, 16   # of a step with its end; with those of the dense output


@always_compiled
def dop853_step(q, w, t, h, x, u, kx, ku):
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
def error_norm(x, u, xn, un, h, tolerance, kx, ku):
    """Return the norm of the error over the tolerance."""
    size_x = tolerance + tolerance * max(abs(x), abs(xn))
    size_u = tolerance + tolerance * max(abs(u), abs(un))
    x5 = u5 = x3 = u3 = 0.0
    for j in range(STAGES + 1):
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
def fill_interpolant(q, w, t, h, x, u, xn, un, kx, ku, fx, fu):
    """Fill the seven coefficients of the dense output of order 7."""
    for i in range(STAGES + 1, MORE):
        dx = du = 0.0
        for j in range(i):
            dx += _A[i, j] * kx[j]
            du += _A[i, j] * ku[j]
        kx[i], ku[i] = rates(q, w, t + _C[i] * h, x + h * dx, u + h * du)
    for f, k, old, new in ((fx, kx, x, xn), (fu, ku, u, un)):
        d = new - old
        f[0] = d
        f[1] = h * k[0] - d
        f[2] = 2.0 * d - h * (k[STAGES] + k[0])
        for i in range(4):
            total = 0.0
            for j in range(MORE):
                total += _D[i, j] * k[j]
            f[3 + i] = h * total


@always_compiled
def between(f, old, share):
    """Return a state within the step, at a share of it, from the seven coefficients."""
    y = 0.0
    for i in range(7):
        y += f[6 - i]
        y *= share if i % 2 == 0 else 1.0 - share
    return old + y
