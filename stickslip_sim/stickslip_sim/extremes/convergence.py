# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""X15: the order of the fixed-step solvers, inside a mode and across events, against what they declare."""

import math
from collections.abc import Callable

from ..axis import InitialState
from ..core.types import Mode
from ..simulation.simulator import Simulator
from ..solvers import Solver
from .outcome import Measurement, Setup, Tally, require
from .shared_axes import CONTACTS, RIGID, Contact, instant, make, paper_axis

# as `solvers.fixed_step` declares it: inside a mode, and across events, which it sees at the end of a step
DECLARED = {'euler': (1, 1), 'rk4': (4, 1)}
_NEAR = 0.35   # how far a measured order may be from the declared one
_SHIFTS = (1.0, 0.95, 0.9, 0.85, 0.8, 0.75, 0.7, 0.65)
_Make = Callable[[Solver], Simulator]


def orders(setup: Setup) -> Measurement:
    """X15: the order from errors at steps that halve, over a slip and over a second with all its events."""
    tally = Tally(_NEAR, 'off the declared order')
    shown = []
    for method, (inside, across) in DECLARED.items():
        measured: list[float] = []
        tally.measure(_order_inside, method, inside, measured)
        for contact in CONTACTS:
            tally.measure(_order_across, method, across, contact, setup.choose(8, 6), measured)
        shown.append(f'{method} ' + ', '.join(f'{order:.2f}' for order in measured))
    return tally.finding('with another order', 'measured in a mode and across events: ' + '; '.join(shown))


def _order_inside(method: str, declared: int, measured: list[float]) -> float:
    """One decelerating slip, read before it ends: the slope between two steps."""
    axis = paper_axis(RIGID, branches=False)

    def begin(solver: Solver) -> Simulator:
        return make(axis, 0.0, initial=InitialState(velocity=0.2), solver=solver)

    errors = [_error(begin, method, step, 0.015) for step in (1e-3, 5e-4)]
    measured.append(math.log2(errors[0] / errors[1]))
    return abs(measured[-1] - declared)


def _order_across(method: str, declared: int, contact: Contact, halvings: int, measured: list[float]) -> float:
    """Several cycles in which friction drops at once: the slope of a line through the errors, which scatter.

    With the branches of the paper the force has no jump, and a compliant contact may do better than what is declared.
    """
    axis = paper_axis(contact, branches=False)

    def begin(solver: Solver) -> Simulator:
        return make(axis, 0.002, solver=solver)

    points = []
    for k in range(halvings):
        step = 2.5e-4 * 0.5 ** k
        mean = math.fsum(_error(begin, method, step * shift, 1.4) for shift in _SHIFTS) / len(_SHIFTS)
        points.append((math.log2(step), math.log2(mean)))
    x = math.fsum(a for a, _ in points) / len(points)
    y = math.fsum(b for _, b in points) / len(points)
    slope = math.fsum((a - x) * (b - y) for a, b in points) / math.fsum((a - x) ** 2 for a, _ in points)
    measured.append(slope)
    return abs(slope - declared)


def _error(begin: _Make, method: str, step: float, end: float) -> float:
    """Return the error of the position at the end, m, against the exact solver."""
    from ..solvers import exact, fixed_step

    stepped, wanted = begin(fixed_step.solver(method, step)), begin(exact.SOLVER)
    for simulator in (stepped, wanted):
        simulator.advance(instant(end))
    one, other = stepped.sample(), wanted.sample()
    require(one.mode != Mode.STICK or other.mode == Mode.STICK, 'it sticks elsewhere')
    return abs(one.position - other.position)
