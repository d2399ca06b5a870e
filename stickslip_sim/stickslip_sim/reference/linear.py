"""Closed-form motion of a linear mode: the action of exp(A τ) on the augmented state as a power series.

    y = [w, u, d, x, v, a, F, G, 1],   y' = A y

w = s - x spring stretch, u = ẋ, d contact deflection, x position; the input polynomials are states too:
v' = a (drive velocity), F' = G (external force).  exp(A τ) y = Σ (A^k y / k!) τ^k, taken to the order at
which (ρ τ)^k / k! drops below the working precision, ρ >= every |eigenvalue| of A.
"""

from __future__ import annotations

from dataclasses import dataclass

from mpmath import mp, mpf

from .series import Series

W, U, D, X, V, A, F, G, ONE = range(9)
SPAN = 4  # a step is at most SPAN / ρ

Row = tuple[tuple[int, mpf], ...]


@dataclass(frozen=True)
class Flow:
    """Linear dynamics: the sparse rows of A, and ρ bounding its eigenvalues."""

    rows: tuple[Row, ...]
    rate: mpf

    def longest_step(self, limit: mpf) -> mpf:
        """Return the longest step not above ``limit`` on which the series is used."""
        return min(limit, SPAN / self.rate) if self.rate else limit

    def series(self, state: list[mpf], h: mpf) -> list[Series]:
        """Return the power series in τ of every component, exact to the working precision on [0, h]."""
        out = [[c] for c in state]
        vector = state
        for k in range(1, order(self.rate * h) + 1):
            vector = [_product(row, vector) / k for row in self.rows]
            for series, c in zip(out, vector):
                series.append(c)
        return out


def _product(row: Row, vector: list[mpf]) -> mpf:
    total = mpf(0)
    for j, a in row:
        if vector[j]:
            total += a * vector[j]
    return total


def order(z: mpf) -> int:
    """Return the least K >= 4 with z^K / K! < 10^-(dps + 5)."""
    bound, k, x = 1.0, 0, float(z)
    log_limit = 10.0 ** -(mp.dps + 5)
    while bound > log_limit or k < 4:
        k += 1
        bound *= x / k
    return k


def row(**entries: mpf) -> Row:
    """Build a row from named components, leaving zeros out."""
    names = {'w': W, 'u': U, 'd': D, 'x': X, 'v': V, 'a': A, 'F': F, 'G': G, 'one': ONE}
    return tuple((names[n], mpf(c)) for n, c in entries.items() if c)


def motion(acceleration: Row, *, moves: bool, deflects: bool, rate: mpf) -> Flow:
    """Return the flow with the given row for u'; w' = v - u, x' = u, d' = u when the contact sticks."""
    return Flow(
        rows=(
            row(v=1, u=-1 if moves else 0),
            acceleration,
            row(u=1 if deflects else 0),
            row(u=1 if moves else 0),
            row(a=1),
            (),
            row(G=1),
            (),
            (),
        ),
        rate=rate,
    )
