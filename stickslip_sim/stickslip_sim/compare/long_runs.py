# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Runs of the same axis from other starts or with another contact, by the exact solver, for statements that compare."""

from collections.abc import Sequence

from ..axis import Axis, InitialState
from ..core.input_profile import constant
from ..core.types import Instant
from ..simulation.cycles import Cycle, cycle_figures
from ..simulation.simulator import Simulator
from .drawn import SteadyInputs

CYCLES = 100                                                          # that a run has to find its limit cycle
_IN_TURN = 8                                                          # slips that one limit cycle may consist of
_PATIENCE = 3.0                                                       # periods from a break-away to the end of a run
COMPARED = ('period', 'jump', 'peak_speed', 'break_away_force')       # of a cycle


def last_cycles(axis: Axis, initial: InitialState, inputs: SteadyInputs, period: float) -> list[Cycle]:
    """Return the last few of about CYCLES cycles of `period` s; none when stick-slip does not last."""
    simulator = Simulator(axis, initial, constant(inputs.velocity), constant(inputs.force), accounting=True)
    end = Instant(float(int(CYCLES * period) + 1), 0.0)
    cycles = cycle_figures(simulator.advance(end))
    simulator.require_sound()
    return cycles[-_IN_TURN:] if lasts(cycles, end.seconds) else []


def lasts(cycles: Sequence[Cycle], end: float) -> bool:
    """Return whether there are cycles up to the end of a run (s), so that its last motion is stick-slip."""
    return bool(cycles) and end - cycles[-1].begin < _PATIENCE * longest_period(cycles)


def longest_period(cycles: Sequence[Cycle]) -> float:
    """Return the longest period among the last few cycles, s."""
    return max(cycle.period for cycle in cycles[-_IN_TURN:])


def distance(cycle: Cycle, others: Sequence[Cycle]) -> float:
    """Return the difference of a cycle to the one of others that is most like it."""
    return min(difference(cycle, other) for other in others)


def difference(one: Cycle, other: Cycle) -> float:
    """Return the largest relative difference of two cycles in any of the figures COMPARED."""
    pairs = [(getattr(one, name), getattr(other, name)) for name in COMPARED]
    return max(abs(b - a) / max(abs(a), abs(b)) if a != b else 0.0 for a, b in pairs)
