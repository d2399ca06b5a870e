# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The runs behind the points of a study: thousands at once where the compiled batch can, else one after the other."""

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import astuple
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..axis.rows import EventRow
from ..core.arrays import Numbers
from ..core.errors import InputError, SolverError
from ..figures.cycles import SWINGS_ON
from ..figures.point_figures import Runs, no_runs
from ..friction import StaticLawKind
from ..runs import SimulatedRun, simulate_events
from ..runs.batch import figures_in, rounds_in
from ..scene import Scene, scene_from_values
from ..scene.friction_schema import BACKWARD
from ..scene.values import overridden
from ..solvers.exact import many_axes
from ..solvers.exact.axis_figures import AxisFigures
from .settling import DOUBLINGS, PATIENCE, run_settled, runs_of
from .variation import changes_at

_OF_THE_BATCH = {
    'axis.mass': 'mass', 'axis.drive_stiffness': 'drive_stiffness', 'axis.drive_damping': 'drive_damping',
    'axis.normal_force': 'normal_force', 'contact.stiffness': 'contact_stiffness',
    'contact.damping': 'contact_damping', 'friction.static.initial': 'static_initial',
    'friction.static.limit': 'static_limit', 'friction.static.time_constant': 'static_time_constant',
    'friction.static.exponent': 'static_exponent', 'friction.static.backward.initial': 'static_backward_initial',
    'friction.static.backward.limit': 'static_backward_limit',
    'friction.static.backward.time_constant': 'static_backward_time_constant',
    'friction.static.backward.exponent': 'static_backward_exponent', 'drive.velocity': 'drive_velocity',
    'force.constant': 'external_force',
}
_OF_STATIC = ('initial', 'limit', 'time_constant', 'exponent')
_COEFFICIENTS = frozenset({'static_initial', 'static_limit', 'static_backward_initial', 'static_backward_limit'})
Values = Mapping[str, object]


def scene_at(values: Values, names: Sequence[str], point: Numbers) -> Scene:
    """Return the scene of a point: `values` with the numbers of the point for `names`; raises InputError."""
    return scene_from_values(overridden(values, changes_at(values, names, point)))


def works_in_batches(scene: Scene) -> bool:
    """Whether the compiled batch can run a scene: exactly solved, constant inputs, no faults, no normal load."""
    return scene.solver.name == 'exact' and not scene.rig.faults and scene.normal_load is None and all(
        len(profile.starts) == 1 and profile.rates == (0.0,) and not profile.sinusoids and profile.period == math.inf
        for profile in (scene.drive, scene.force))


def runs_in_batches(values: Values, names: Sequence[str], points: Numbers, duration: float | None,
                    patience: int = PATIENCE, doublings: int = DOUBLINGS) -> Runs:
    """Run points by the compiled batch: a scene for each set of numbers that it cannot vary, and all others at once."""
    runs = no_runs(len(points))
    for members, scene, inputs in batches(values, names, points):
        runs.put(members, run_settled(scene.axis, scene.initial, inputs, duration, patience, doublings))
    return runs


def batches(values: Values, names: Sequence[str], points: Numbers
            ) -> Iterator[tuple[NDArray[np.int64], Scene, dict[str, Numbers]]]:
    """Yield the places of points of one scene, the scene, and the arrays of `batch.run_batch` that vary it."""
    others = [k for k, name in enumerate(names) if name not in _OF_THE_BATCH]
    sets, belongs = np.unique(points[:, others], axis=0, return_inverse=True)
    for k in range(len(sets)):
        members = np.flatnonzero(belongs.reshape(-1) == k)
        scene = scene_at(values, [names[other] for other in others], sets[k])
        yield members, scene, _inputs(scene, names, points[members])


def runs_alone(values: Values, names: Sequence[str], points: Numbers, duration: float) -> Runs:
    """Run points one after the other, each as `simulate` would."""
    runs = no_runs(len(points))
    runs.duration[:] = duration
    for k, point in enumerate(points):
        try:
            scene = scene_at(values, names, point)
            run = simulate_events(scene, duration)
        except (SolverError, InputError):   # it gave up, or found more events than can be held
            continue
        runs.put([k], runs_of_run(run))
    return runs


def runs_of_run(run: SimulatedRun) -> Runs:
    """Return a complete run as one entry of `Runs`."""
    figures = AxisFigures(final_mode=float(run.scene.make_rig().simulator.sample().mode))
    for event in run.events:
        many_axes.book(figures, [], 0, EventRow(*map(float, event)), 0.5 * run.duration)
    figures.complete = 1.0
    out = np.array([astuple(figures)])
    found = runs_of(figures_in(out), rounds_in(out), run.duration)
    found.stick_share[0] = run.summary.stick_share
    found.settled[0] |= found.slides_on[0] and run.summary.motion != SWINGS_ON
    found.lasts[0] &= works_in_batches(run.scene)   # with other inputs and solvers a slip may still end
    return found


def _backwards(scene: Scene, columns: Mapping[str, Any]) -> dict[str, Any]:
    """Return the columns of static friction backwards for those forwards: what a scene leaves out is as forwards."""
    found = {}
    for name in _OF_STATIC:
        ahead, back = f'static_{name}', f'static_backward_{name}'
        if ahead in columns and back not in columns:
            given: Any = scene.values.get(f'friction.static.{BACKWARD}.{name}')
            scale: Any = scene.values.get('friction.scale', 1.0) if back in _COEFFICIENTS else 1.0
            found[back] = columns[ahead] if given is None else scale * given
    return found


def _inputs(scene: Scene, names: Sequence[str], points: Numbers) -> dict[str, Numbers]:
    """Return the arrays for `batch.run_batch`, all of one length."""
    columns: dict[str, Any] = {'drive_velocity': scene.drive.values[0], 'external_force': scene.force.values[0]}
    columns |= {_OF_THE_BATCH[name]: points[:, k] for k, name in enumerate(names) if name in _OF_THE_BATCH}
    for name in _COEFFICIENTS & set(columns):
        columns[name] = scene.values.get('friction.scale', 1.0) * columns[name]   # the axis of the scene has it already
    if any(f'.{BACKWARD}.' in name for name in scene.values):
        columns |= _backwards(scene, columns)
    if scene.axis.friction.static.kind == StaticLawKind.CONSTANT:
        columns |= {f'{side}limit': columns[f'{side}initial'] for side in ('static_', 'static_backward_')
                    if f'{side}initial' in columns}   # as a scene has it
    return {name: np.array(np.broadcast_to(values, len(points)), dtype=float) for name, values in columns.items()}
