# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The same run with one solver or another."""

import math

from stickslip_sim.axis import Axis, InitialState
from stickslip_sim.core.input_profile import InputProfile, constant
from stickslip_sim.core.types import Event, EventKind, Sample
from stickslip_sim.scene import Scene
from stickslip_sim.simulation.simulator import Simulator
from stickslip_sim.solvers import Solver, exact
from tests.support.axes import instant

_A_MOMENT = 1e-6   # s; a coast this short after a break-away is decided by rounding (docs/model.md)


def simulate(solver: Solver, axis: Axis, drive: float | InputProfile, duration: float,
             force: float | InputProfile = 0.0,
             initial: InitialState | None = None) -> tuple[list[Event], Sample]:
    """Return the events but those of kind knot, and the state at the end."""
    simulator = make(solver, axis, drive, force, initial)
    events = simulator.advance(instant(duration))
    return [event for event in events if event.kind != EventKind.KNOT], simulator.sample()


def make(solver: Solver, axis: Axis, drive: float | InputProfile, force: float | InputProfile = 0.0,
         initial: InitialState | None = None) -> Simulator:
    return Simulator(axis, initial or InitialState(), drive if isinstance(drive, InputProfile) else constant(drive),
                     force if isinstance(force, InputProfile) else constant(force), solver)


def of_scene(solver: Solver, scene: Scene, duration: float) -> tuple[list[Event], Sample]:
    return simulate(solver, scene.axis, scene.drive, duration, scene.force, scene.initial)


def firm(events: list[Event]) -> list[Event]:
    """Return the events without those within a moment after a break-away, whose kind is decided by rounding."""
    kept: list[Event] = []
    for event in events:
        if not kept or kept[-1].kind != EventKind.BREAKAWAY or event.time - kept[-1].time > _A_MOMENT:
            kept.append(event)
    return kept


def order(steps: list[float], errors: list[float]) -> float:
    """Return the slope of log error over log step, by least squares."""
    xs, ys = [math.log(step) for step in steps], [math.log(error) for error in errors]
    x, y = sum(xs) / len(xs), sum(ys) / len(ys)
    return sum((a - x) * (b - y) for a, b in zip(xs, ys)) / sum((a - x) ** 2 for a in xs)


EXACT = exact.SOLVER
