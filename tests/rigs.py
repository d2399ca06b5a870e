# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Rigs without ROS, and orders for them by step, which can be given again."""

import random
from collections.abc import Callable, Iterable, Mapping
from dataclasses import replace
from typing import Any

from stickslip_sim.axis import Axis, InitialState
from stickslip_sim.core.input_profile import Course, constant
from stickslip_sim.core.time_grid import Grid
from stickslip_sim.rig import Fault, NoteKind, Product, Rig
from stickslip_sim.rig.faults import RULES
from stickslip_sim.rig.settings import RigSettings
from stickslip_sim.solvers import Solver, exact
from tests.axes import COMPLIANT, RIGID, paper_axis

Order = Callable[[Rig], object]
Script = Mapping[int, Iterable[Order]]

RATE = 1000.0
STUCK = paper_axis(RIGID)       # breaks away at 823.8 N after prolonged rest
AXIS = paper_axis(COMPLIANT)


def make(axis: Axis = AXIS, drive: Course | float = 0.002, force: Course | float = 0.0, rate: float = RATE,
         **settings: Any) -> Rig:
    def course(given: Course | float) -> Course:
        return given if isinstance(given, Course) else constant(given)

    return Rig(axis, InitialState(), course(drive), course(force), exact.SOLVER, Grid(rate), RigSettings(**settings))


def tired_after(time: float) -> Solver:
    """Return the exact solver, which gives up at a time."""
    def advance(p: Any, s: Any, second: float, fraction: float, events: Any, row: int) -> Any:
        if second + fraction > time:
            return row, -1
        return exact.SOLVER.advance(p, s, second, fraction, events, row)

    return exact.SOLVER._replace(advance=advance)


def run(rig: Rig, steps: int, script: Script | None = None) -> list[Product]:
    """Make steps; orders of a step are given before it."""
    products = []
    for _ in range(steps):
        for order in (script or {}).get(rig.step + 1, ()):
            order(rig)
        products.append(rig.make_step())
    return products


def inject(kind: str, start: float = 0.0, duration: float = 0.05, value: float = 0.0, name: str = '') -> Order:
    return lambda rig: rig.inject(Fault(name, kind, start, duration, value))


def told(products: Iterable[Product]) -> list[tuple[int, NoteKind]]:
    """Return what the notes tell, by step."""
    return [(product.step, note.kind) for product in products for note in product.notes]


def bits(products: Iterable[Any]) -> list[str]:
    """Return what differs when a single bit does, −0.0 and 0.0 included."""
    return [repr(product) for product in products]


def random_script(seed: int, steps: int) -> Script:
    """Return orders of all kinds, about one in ten steps."""
    luck = random.Random(seed)
    return {step: [_random_order(luck) for _ in range(luck.randint(1, 3))]
            for step in sorted(luck.sample(range(steps), steps // 10))}


def _random_order(luck: random.Random) -> Order:
    velocity, force, mass = luck.uniform(-0.02, 0.02), luck.uniform(-900.0, 900.0), luck.uniform(300.0, 400.0)
    kind = luck.choice([*RULES])
    value = {'friction_scale': luck.uniform(0.1, 3.0), 'force_pulse': luck.uniform(-500.0, 500.0),
             'encoder_step': 1e-4, 'encoder_dropout': 0.5, 'command_loss': 0.5, 'command_delay': 0.007}.get(kind, 0.0)
    fault = Fault('', kind, luck.choice([0.0, 0.01]), luck.choice([0.001, 0.02]), value)
    return luck.choice([
        lambda rig: rig.command_velocity(velocity), lambda rig: rig.command_velocity(velocity),
        lambda rig: rig.command_force(force), lambda rig: rig.inject(fault),
        lambda rig: rig.change_axis(replace(AXIS, mass=mass)), lambda rig: rig.time_out(0.5),
        lambda rig: rig.clear_faults()])
