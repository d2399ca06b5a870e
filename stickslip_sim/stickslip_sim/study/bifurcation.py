# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Where the cycles of a scene go as one of its parameters changes: a bifurcation diagram, in numbers."""

import math
from typing import NamedTuple

import numpy as np

from ..core.arrays import Numbers
from ..core.callbacks import Progress
from ..core.types import Event, Instant
from ..runs import simulate_events
from ..scene import Scene
from ..simulation.cycles import Cycle, cycle_figures
from .point_figures import Figures, Motion
from .points import scene_at, works_in_batches
from .steady import sliding_slope
from .study import Study

_LAST = 40     # cycles of each point that are shown, or half of all
_REACH = 1.5   # times as long as they take on average: where that was not enough all of the run is looked at


class Bifurcation(NamedTuple):
    """`cycles`: a row (value, drive force at break-away and at arrest in N, jump in m) for each of the last cycles.

    `sliding`: a row (value, drive force of steady sliding in N, 1 where it is stable) for each value, NaN where the
    drive rests; empty for inputs that change with time.
    """

    cycles: Numbers
    sliding: Numbers


def bifurcation(study: Study, figures: Figures, progress: Progress = None) -> Bifurcation:
    """Return the last cycles of each point of a study of one parameter that sticks and slips.

    Such a point is run again, for the duration of its `figures`: the table has one round alone, without the arrest.
    Only its last cycles are looked at.
    """
    cycles, sliding = [], []
    values = study.points(0, study.count)[:, 0].tolist()
    for k, value in enumerate(values):
        scene = scene_at(study.values, study.names, np.array([value]))
        if figures.motion[k] == Motion.STICK_SLIP:
            cycles += [_row(value, cycle) for cycle in _last_cycles(
                scene, float(figures.duration[k]), int(figures.cycles[k]))]
        feed = scene.drive.values[0]
        if study.works_in_batches:
            friction = scene.axis.normal_force * scene.axis.friction.along(feed).kinetic.coefficient(abs(feed))
            slope = sliding_slope(scene.axis, {'drive_velocity': np.array([feed])})[0]
            force = np.copysign(friction, feed) - scene.force.values[0] if feed else np.nan
            sliding.append((value, force, float(slope >= 0.0)))
        if progress:
            progress((k + 1) / len(values))
    return Bifurcation(np.array(cycles).reshape(-1, 4), np.array(sliding).reshape(-1, 3))


def _last_cycles(scene: Scene, duration: float, count: int) -> list[Cycle]:
    """Return the last cycles of a scene that has so many in its duration (s)."""
    wanted = min(count - count // 2, _LAST)
    if works_in_batches(scene):
        begin = duration * (1.0 - _REACH * (wanted + 2) / count)
        found = cycle_figures(_events_from(scene, begin, duration)) if begin > 0.0 else []
        if len(found) >= wanted:
            return found[-wanted:]
    return cycle_figures(simulate_events(scene, duration).events)[-wanted:]


def _events_from(scene: Scene, begin: float, end: float) -> list[Event]:
    """Return the events of a scene from a time on (s); those before are not looked at, which takes most of the time."""
    simulator = scene.make_simulator()
    simulator.skip(Instant(math.floor(begin), begin % 1.0))
    return simulator.advance(Instant(math.floor(end), end % 1.0))


def _row(value: float, cycle: Cycle) -> tuple[float, float, float, float]:
    return value, cycle.break_away_drive_force, cycle.arrest_drive_force, cycle.jump
