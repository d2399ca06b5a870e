"""A recorded run as a time history: states at its steps, events at their exact times, the scene that travels in it."""

import warnings
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..errors import InputError, RecordingError, RecordingWarning
from ..offline import Columns
from ..recording import Run, read_run
from ..recording.run import SCENE_FILE
from ..recording.topics import FRICTION_FORCE, MODE_EVENT, PARAMETER_EVENTS, SLIDER_STATE, Topic
from ..scene import Scene, parse_scene
from ..words import Event, EventKind, Mode
from .history import History

_STATE = ('time', 'step', 'position', 'velocity', 'acceleration', 'drive_position', 'drive_velocity', 'drive_force',
          'rest_time', 'mode', 'direction')
_FRICTION = {'force': 'friction_force', 'coefficient': 'friction_coefficient',
             'contact_deflection': 'contact_deflection'}
_EVENT = ('time', 'kind', 'mode', 'direction', 'position', 'velocity', 'drive_force', 'friction_force',
          'static_coefficient', 'rest_time')
_Table = Mapping[str, NDArray[Any]]


def history_of_run(path: Path | str) -> History:
    """Return the history of a recorded run, as far as it goes; raises RecordingError when it is none of ours."""
    with warnings.catch_warnings(record=True) as told:
        warnings.simplefilter('always', RecordingWarning)
        run = read_run(path)
    samples = _samples(run)
    topic = _named(run, PARAMETER_EVENTS)
    return History(name=Path(path).resolve().stem, source=f'recorded in {path}', scene=_scene(run), samples=samples,
                   events=_events(run, samples), notes=tuple(str(warning.message) for warning in told),
                   is_recorded=True, is_changed=topic is not None and run.counts[topic] > 0)


def _scene(run: Run) -> Scene:
    if SCENE_FILE not in run.attachments:
        raise RecordingError(f'{run.path}: no {SCENE_FILE} travels in it, so that its axis is unknown; compare a run '
                             'that the node or the tool recorded')
    try:
        return parse_scene(run.attachments[SCENE_FILE].decode(errors='replace'))
    except InputError as error:
        raise RecordingError(f'{run.path}: its {SCENE_FILE} is none of this version: {error}') from None


def _samples(run: Run) -> Columns:
    """Return states and friction of the steps that have both."""
    state = _table(run, SLIDER_STATE, _STATE)
    friction = _table(run, FRICTION_FORCE, ('step', *_FRICTION))
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
    table = _table(run, MODE_EVENT, _EVENT)
    times = table['time']
    if not (np.all(np.isin(table['kind'], list(EventKind))) and np.all(np.isin(table['mode'], list(Mode)))):
        raise RecordingError(f'{run.path}: an event of a kind that this version does not know')
    drive = np.interp(times, samples['time'], samples['drive_position'])
    inside = np.flatnonzero((times >= samples['time'][0]) & (times <= samples['time'][-1]))
    return [_event({name: column[i].item() for name, column in table.items()}, drive[i].item()) for i in inside]


def _event(row: Mapping[str, Any], drive_position: float) -> Event:
    second, fraction = divmod(row['time'], 1.0)
    return Event(second, fraction, EventKind(row['kind']), Mode(row['mode']), row['direction'], row['position'],
                 row['velocity'], drive_position, row['drive_force'], row['friction_force'], row['static_coefficient'],
                 row['rest_time'])


def _table(run: Run, topic: Topic, fields: tuple[str, ...]) -> _Table:
    """Return the columns of a topic; raises RecordingError when it is missing or lacks a field."""
    name = _named(run, topic)
    if name is None and not run.topics and not run.is_complete:
        raise RecordingError(f'{run.path}: cut off before the first of its messages was written')
    if name is None:
        raise RecordingError(f'{run.path}: no topic {topic.name} of type {topic.type}, so it is no run of ours; there '
                             f'are {", ".join(run.topics) or "none"}')
    table = run.columns(name)
    missing = [field for field in fields if field not in table]
    if missing:
        raise RecordingError(f'{run.path}: {topic.type} has no {", ".join(missing)} there: it was recorded with '
                             'another version of stickslip_msgs')
    return table


def _named(run: Run, topic: Topic) -> str | None:
    """Return the name of a topic in the namespace of the recorded node; raises RecordingError when there are two."""
    relative = topic.name.lstrip('/')
    names = [name for name, type_name in run.topics.items()
             if type_name == topic.type and name.rpartition('/')[2] == relative]
    if len(names) > 1:
        raise RecordingError(f'{run.path}: {" and ".join(names)}: the runs of {len(names)} axes; give a bag of one')
    return names[0] if names else None
