# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""A recorded run as a time history: states at its steps, events at their exact times, the scene that travels in it."""

import warnings
from pathlib import Path

import numpy as np

from ..core.errors import RecordingError, RecordingWarning
from ..core.types import Event, Mode
from ..recording import Run, columns_of, read_run
from ..recording.topics import FRICTION_FORCE, PARAMETER_EVENTS, SLIDER_STATE
from ..runs.offline import Columns
from .history import History

_STATE = ('time', 'step', 'position', 'velocity', 'acceleration', 'drive_position', 'drive_velocity', 'drive_force',
          'rest_time', 'mode', 'direction')
_FRICTION = {'force': 'friction_force', 'coefficient': 'friction_coefficient',
             'contact_deflection': 'contact_deflection'}


def history_of_run(path: Path | str) -> History:
    """Return the history of a recorded run, as far as it goes; raises RecordingError when it is none of ours."""
    with warnings.catch_warnings(record=True) as told:
        warnings.simplefilter('always', RecordingWarning)
        run = read_run(path)
    samples = _samples(run)
    return History(name=Path(path).resolve().stem, source=f'recorded in {path}', scene=run.scene, samples=samples,
                   events=_events(run, samples), notes=tuple(str(warning.message) for warning in told),
                   is_recorded=True, is_changed=run.counts.get(PARAMETER_EVENTS.name, 0) > 0)


def _samples(run: Run) -> Columns:
    """Return states and friction of the steps that have both."""
    state = columns_of(run, SLIDER_STATE, _STATE)
    friction = columns_of(run, FRICTION_FORCE, ('step', *_FRICTION))
    _, rows, others = np.intersect1d(state['step'], friction['step'], return_indices=True)
    if len(rows) < 2:
        raise RecordingError(f'{run.path}: {len(rows)} states with their friction force; a run has at least 2')
    columns: Columns = {name: state[name][rows].astype(np.float64) for name in _STATE}
    columns |= {name: friction[field][others].astype(np.float64) for field, name in _FRICTION.items()}
    if np.any(np.diff(columns['time']) <= 0.0) or not np.all(np.isin(columns['mode'], list(Mode))):
        raise RecordingError(f'{run.path}: its steps do not follow each other in time, or are in unknown modes')
    return columns


def _events(run: Run, samples: Columns) -> list[Event]:
    """Return the events within the samples; the drive's position then is between those at the steps."""
    begin, end = samples['time'][0], samples['time'][-1]
    events = [event for event in run.events if begin <= event.time <= end]
    drive = np.interp([event.time for event in events], samples['time'], samples['drive_position'])
    return [event._replace(drive_position=position) for event, position in zip(events, drive.tolist())]
