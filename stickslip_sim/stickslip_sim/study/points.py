# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The runs behind the points of a study: thousands at once where the compiled batch can, else one after the other."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from ..analysis import Cycle, cycle_figures
from ..errors import InputError, SolverError
from ..friction import StaticLawKind
from ..offline import Trajectory, run_offline
from ..scene import Scene, scene_from_values
from ..scene.values import overridden
from ..solvers.exact.cycles import SETTLED
from ..words import Event, EventKind, Mode
from .figures import Numbers, Runs, no_runs
from .settling import PATIENCE, run_settled
from .variation import changes_at

_OF_THE_BATCH = {
    'axis.mass': 'mass', 'axis.drive_stiffness': 'drive_stiffness', 'axis.drive_damping': 'drive_damping',
    'axis.normal_force': 'normal_force', 'contact.stiffness': 'contact_stiffness',
    'contact.damping': 'contact_damping', 'friction.static.initial': 'static_initial',
    'friction.static.limit': 'static_limit', 'friction.static.time_constant': 'static_time_constant',
    'friction.static.exponent': 'static_exponent', 'drive.velocity': 'drive_velocity',
    'force.constant': 'external_force',
}
Values = Mapping[str, object]


def scene_at(values: Values, names: Sequence[str], point: Numbers) -> Scene:
    """Return the scene of a point: `values` with the numbers of the point for `names`; raises InputError."""
    return scene_from_values(overridden(values, changes_at(values, names, point)))


def works_in_batches(scene: Scene) -> bool:
    """Whether the compiled batch can run a scene: exactly solved, constant inputs, no faults."""
    return scene.solver.name == 'exact' and not scene.rig.faults and all(
        len(course.starts) == 1 and course.rates == (0.0,) and not course.waves and course.period == math.inf
        for course in (scene.drive, scene.force))


def runs_in_batches(values: Values, names: Sequence[str], points: Numbers, duration: float | None,
                    patience: int = PATIENCE) -> Runs:
    """Run points by the compiled batch: a scene for each set of numbers that it cannot vary, and all others at once."""
    others = [k for k, name in enumerate(names) if name not in _OF_THE_BATCH]
    runs = no_runs(len(points))
    sets, belongs = np.unique(points[:, others], axis=0, return_inverse=True)
    for k in range(len(sets)):
        members = np.flatnonzero(belongs.reshape(-1) == k)
        scene = scene_at(values, [names[other] for other in others], sets[k])
        inputs = _inputs(scene, names, points[members])
        runs.put(members, run_settled(scene.axis, scene.initial, inputs, duration, patience))
    return runs


def runs_alone(values: Values, names: Sequence[str], points: Numbers, duration: float) -> Runs:
    """Run points one after the other, each as `simulate` would."""
    runs = no_runs(len(points))
    for k, point in enumerate(points):
        try:
            row = _row(run_offline(scene_at(values, names, point), duration))
        except (SolverError, InputError):   # it gave up, or found more events than can be held
            row = {'complete': False}
        for name, value in {'duration': duration, **row}.items():
            getattr(runs, name)[k] = value
    return replace(runs, settled=runs.settled | runs.slides_on)


def _inputs(scene: Scene, names: Sequence[str], points: Numbers) -> dict[str, Numbers]:
    """Return the arrays for `batch.run_batch`, all of one length."""
    columns: dict[str, Any] = {'drive_velocity': scene.drive.values[0], 'external_force': scene.force.values[0]}
    columns |= {_OF_THE_BATCH[name]: points[:, k] for k, name in enumerate(names) if name in _OF_THE_BATCH}
    if scene.axis.friction.static.kind == StaticLawKind.CONSTANT and 'static_initial' in columns:
        columns['static_limit'] = columns['static_initial']   # as a scene has it
    return {name: np.array(np.broadcast_to(values, len(points)), dtype=float) for name, values in columns.items()}


def _row(run: Trajectory) -> dict[str, Any]:
    """Return the numbers of `Runs` for one run; those of a cycle are of the last one."""
    cycles, begins = cycle_figures(run.events), [event.time for event in run.events if _begins(event)]
    last = cycles[-1] if cycles else None
    row = {name: getattr(last, name) if last else math.nan
           for name in ('stick_time', 'period', 'slip_travel', 'peak_speed', 'break_away_force')}
    final = [event.mode for event in run.events] or [_start_mode(run.scene)]
    return {**row, 'complete': True, 'events': len(run.events), 'cycles': len(cycles),
            'settled': run.summary.settled, 'stick_share': run.summary.stick_share, 'final_mode': final[-1],
            'last_break_away': begins[-1] if begins else math.nan, 'settling_time': _settling_time(cycles)}


def _begins(event: Event) -> bool:
    return event.kind == EventKind.REVERSE or (event.kind == EventKind.BREAKAWAY and event.mode != Mode.STICK)


def _start_mode(scene: Scene) -> Mode:
    return scene.make_rig().simulator.sample().mode


def _settling_time(cycles: Sequence[Cycle]) -> float:
    """Return when the first of the cycles begins from which on no period differs from the one before."""
    unlike = [cycle.begin for before, cycle in zip((None, *cycles), cycles)
              if before is None or abs(cycle.period - before.period) >= SETTLED * cycle.period]
    return unlike[-1] if unlike else math.nan
