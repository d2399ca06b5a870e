# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""X24: the stick-slip that studies report, and the values where it begins and ends, against long runs."""

import random
from collections.abc import Mapping
from functools import cache

import numpy as np

from ...core.types import EventKind, Mode
from ...inputs import load_scene
from ...scene import Scene
from ...solvers import Solver
from ...study import EvenGrid, Motion, Study, Variation
from ...study.answer_changes import Transition
from ...study.critical import critical_of
from ...study.points import scene_at
from ..axes import instant, make, of_kind
from ..judges import Measurement, Setup, Tally, require

_LONG, _LATE = 1e4, 5e3    # s: a run, and its last part that sticks are counted in
_ACCURACY = 1e-9
_STEPS = (0.0, 1e-7, 1e-4, 1e-2)   # beyond the reported end, of the value
_HEAVY = 20000.0, 32000.0          # kg, on which a slip reverses before it sticks
_CONVENTIONAL = {'contact.model': 'compliant', 'contact.stiffness': 5e6, 'contact.damping': 15000.0}
_BORDERS: tuple[tuple[str, Mapping[str, object], str, float, float], ...] = (
    ('paper_fig4_constant', {}, 'axis.mass', 5.0, 500.0),
    ('paper_fig8', {'drive.velocity': 0.02}, 'axis.normal_force', 500.0, 5000.0),
    ('paper_fig8', {'drive.velocity': 0.01}, 'axis.drive_damping', 1e3, 4e4),
    ('paper_fig8', {}, 'axis.drive_damping', 1e3, 4e4),    # the longest to narrow down
    ('paper_fig8', {}, 'axis.normal_force', 500.0, 5000.0),
    ('paper_fig8', {}, 'drive.velocity', 1e-3, 0.1),
    ('paper_fig7', {}, 'drive.velocity', 1e-3, 0.1),
    ('paper_fig7', {}, 'axis.drive_damping', 1e3, 4e4),
    ('paper_fig7', {'drive.velocity': 0.025}, 'axis.normal_force', 500.0, 5000.0),
    ('paper_fig4_falling', {}, 'axis.drive_damping', 1e3, 4e4),
    ('paper_fig4_falling', {}, 'axis.normal_force', 500.0, 5000.0),
    ('paper_fig4_falling', {}, 'drive.velocity', 1e-3, 0.1),
    ('paper_fig4_falling', _CONVENTIONAL, 'axis.drive_damping', 1e3, 4e4),
    ('paper_fig4_constant', {}, 'drive.velocity', 1e-3, 0.1),
    ('paper_fig4_constant', {'drive.velocity': 0.005}, 'axis.drive_damping', 100.0, 1e4),
)


def answers(setup: Setup) -> Measurement:
    """X24: sticks and reversals by turns, sticks after long pauses, cycles about to vanish; sweep and critical."""
    tally = Tally(0.0)
    for mass in np.linspace(*_HEAVY, setup.choose(41, 2)).tolist():
        tally.measure(_motion, setup.solver, 'paper_fig7', 0.02, mass)
    for seed in range(setup.choose(40, 2)):
        rng = random.Random(seed)
        tally.measure(_motion, setup.solver, rng.choice(('paper_fig7', 'paper_fig8', 'paper_fig4_falling')),
                    10.0 ** rng.uniform(-3.0, -1.3), 10.0 ** rng.uniform(1.5, 4.5))
    for k in range(setup.choose(len(_BORDERS), 1)):
        for side in (-1, 1):
            for step in setup.choose(_STEPS, _STEPS[:1]):
                tally.measure(_border, setup.solver, k, side, step)
    return tally.finding('contradicted by a run of 10,000 s')


def _motion(solver: Solver, name: str, feed: float, mass: float) -> None:
    """Run a scene as a point of a sweep; the reported motion should go on."""
    scene = load_scene(name, {'drive.velocity': feed})
    study = Study(scene.values, EvenGrid((Variation('axis.mass', mass, 1.1 * mass, 2),)))
    motion = study.figures(0, 1).motion[0]
    count = _sticks(solver, scene_at(scene.values, ['axis.mass'], np.array([mass])))
    require(motion not in (Motion.AT_REST, Motion.FAILED), f'a motion without a run: {motion}')
    require(motion == Motion.UNDECIDED or (motion == Motion.STICK_SLIP) == (count > 0),
            f'called {Motion(int(motion)).name}, with {count} sticks late')


def _border(solver: Solver, k: int, side: int, step: float) -> None:
    """Run a scene beside, or a share of the value beyond, an end that `critical` reports."""
    name, changes, parameter, low, high = _BORDERS[k]
    transition = _transition(k)
    value = transition.low * (1.0 - step) if side < 0 else transition.high * (1.0 + step)
    require(low < value < high, 'beyond the range')
    scene = load_scene(name, dict(changes))
    count = _sticks(solver, scene_at(scene.values, [parameter], np.array([value])))
    require((count > 0) == ((side > 0) == transition.rises), f'{count} sticks late at {value!r}')


@cache
def _transition(k: int) -> Transition:
    name, changes, parameter, low, high = _BORDERS[k]
    found = critical_of(load_scene(name, dict(changes)), Variation(parameter, low, high, log=True), _ACCURACY).from_rest
    require(len(found.transitions) == 1, f'{len(found.transitions)} transitions')
    return found.transitions[0]


def _sticks(solver: Solver, scene: Scene) -> int:
    """Return how many sticks begin in the last part of a long run."""
    simulator = make(scene.axis, scene.drive, scene.force, scene.initial, solver)
    simulator.skip(instant(_LONG - _LATE))
    return sum(event.mode == Mode.STICK for event in of_kind(simulator.advance(instant(_LONG)), EventKind.STICK))
