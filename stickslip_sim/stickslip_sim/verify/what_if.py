# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""A recorded run beside what would have been with other parameters, under the same orders."""

from collections.abc import Mapping
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..core.errors import InputError, RecordingError
from ..core.types import Event, Mode, Sample
from ..recording import columns_of
from ..recording.topics import FRICTION_FORCE, SLIDER_STATE
from ..scene import Scene, changed
from ..scene.schema import BY_NAME
from ..simulation.cycles import Summary, summary
from .original import Original
from .remake import Progress, maker_of
from .steps import steps_of

COLUMNS = 'time', 'position', 'velocity', 'friction_force'
_STATE = 'step', 'time', 'position', 'velocity', 'mode'


class Side(NamedTuple):
    """One of the two runs: COLUMNS with a row for each step, and its figures."""

    columns: dict[str, NDArray[np.float64]]
    figures: Summary


def other_scene(original: Original, changes: Mapping[str, object]) -> Scene:
    """Return the scene with changes; raises InputError on those that this recording leaves no room for."""
    for name, value in changes.items():
        entry = BY_NAME.get(name)
        if original.offline is None and name.startswith('time.'):
            raise InputError(name, value, 'as in the recording', 'its orders are counted in steps')
        if original.checkpoint is not None and entry is not None and not entry.live:
            raise InputError(name, value, 'a parameter that can change while the axis runs',
                             'this recording begins in mid-run; take one from the start')
    return changed(original.scene, changes)


def recorded_side(original: Original) -> Side:
    """Return the run as it was recorded; raises RecordingError when there is too little of it."""
    run = original.run
    state = columns_of(run, SLIDER_STATE, _STATE)
    friction = columns_of(run, FRICTION_FORCE, ('step', 'force'))
    _, rows, others = np.intersect1d(state['step'], friction['step'], return_indices=True)
    if len(rows) < 2:
        raise RecordingError(f'{run.path}: {len(rows)} whole steps in it; there is nothing to set beside it')
    columns = {name: state[name][rows].astype(np.float64) for name in COLUMNS[:-1]}
    columns['friction_force'] = friction['force'][others]
    return Side(columns, _figures(columns, run.events, Mode(int(state['mode'][rows[0]]))))


def other_side(original: Original, scene: Scene, changes: Mapping[str, object], progress: Progress = None) -> Side:
    """Return the same steps under the same orders with another scene, which `changes` made of that of the recording.

    Raises RecordingError when an order makes no sense any more, SolverError when the solver gives up.
    """
    maker = maker_of(original, scene, changes.keys(), progress)
    samples: list[Sample] = []
    events: list[Event] = []
    for step in steps_of(original, maker.start):
        for made in maker.make(step):
            samples.append(made.sample)
            events += made.events
    columns = {name: np.array([getattr(sample, name) for sample in samples]) for name in COLUMNS}
    return Side(columns, _figures(columns, events, samples[0].mode))


def _figures(columns: Mapping[str, NDArray[np.float64]], events: list[Event], mode: Mode) -> Summary:
    begin, end = float(columns['time'][0]), float(columns['time'][-1])
    return summary([event for event in events if begin <= event.time <= end], end - begin, mode, begin)
