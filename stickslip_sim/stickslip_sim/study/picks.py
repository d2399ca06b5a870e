# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Points picked from the map of a study: where they stand, and the motion that they end in."""

from typing import NamedTuple

import numpy as np

from ..core.arrays import Numbers
from ..core.errors import InputError
from ..runs import SimulatedRun, simulate_events
from .borders import FEED
from .point_figures import Motion, figures_of_runs
from .points import runs_of_run
from .study import Study
from .table import TableColumns


class Ending(NamedTuple):
    """The motion that a point ends in, and the events of the run after which that was known.

    `swings_on`: it slides, and still swung when its time was over.
    """

    motion: Motion
    swings_on: bool
    run: SimulatedRun


def point_of(study: Study, text: str) -> Numbers:
    """Return the values `A,B` of the two parameters of a study; raises InputError."""
    try:
        point = np.array([float(word) for word in text.split(',')])
    except ValueError:
        point = np.array([])
    variations = study.ranges
    if len(point) != len(variations) or any(not one.low <= value <= one.high for one, value in zip(variations, point)):
        ranges = ', '.join(f'{one.name} from {one.low:g} to {one.high:g}' for one in variations)
        raise InputError('--pick', text, f'a number for each of {ranges}', 'give them with a comma: A,B')
    return point


def place_in_map(study: Study, point: Numbers) -> tuple[float, float]:
    """Return where a point stands in the map: x, y."""
    first, second = point.tolist()
    return (second, first) if study.names[1] == FEED else (first, second)


def ending_at(study: Study, columns: TableColumns, point: Numbers) -> Ending:
    """Return the ending of a point; its motion is that of the table (`columns`) where the point stands in it."""
    scene = study.scene_at(point)
    stands = np.logical_and.reduce([columns[name] == value for name, value in zip(study.names, point)])
    known = np.flatnonzero(stands & (columns['motion'] != Motion.FAILED))
    if not len(known) and study.duration is not None:
        run = simulate_events(scene, study.duration)
        return Ending(Motion(int(figures_of_runs(runs_of_run(run)).motion[0])), False, run)
    if len(known):
        motion, duration = (float(columns[name][known[0]]) for name in ('motion', 'duration'))
    else:
        runs = study.runs(point[None, :])
        motion = float(figures_of_runs(runs).motion[0])
        duration = float(runs.duration[0])
    swings_on = study.duration is None and motion == Motion.SWINGS_ON
    return Ending(Motion(int(motion)), swings_on, simulate_events(scene, duration))
