# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""States and transitions of a recorded run, whatever the namespace of its node."""

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ..core.errors import RecordingError
from ..core.types import Event, EventKind, Mode
from .topics import MODE_EVENT, Topic

if TYPE_CHECKING:
    from .reader import Run

_EVENT_FIELDS = ('time', 'kind', 'mode', 'direction', 'position', 'velocity', 'drive_force', 'friction_force',
                 'static_coefficient', 'rest_time')


def name_of(run: 'Run', topic: Topic) -> str:
    """Return the name of the one topic of this type; raises RecordingError when there is none, or more than one."""
    names = [name for name, type_name in run.topics.items() if type_name == topic.type]
    if not run.topics and not run.is_complete:
        raise RecordingError(f'{run.path}: cut off before the first of its messages was written')
    if not names:
        raise RecordingError(f'{run.path}: no topic of type {topic.type}; there are {", ".join(run.topics) or "none"}')
    if len(names) > 1:
        raise RecordingError(f'{run.path}: {" and ".join(names[:2])} are both of type {topic.type}; give a recording '
                             'of one axis')
    return names[0]


def columns_of(run: 'Run', topic: Topic, fields: Sequence[str]) -> dict[str, NDArray[Any]]:
    """Return fields of the one topic of this type; raises RecordingError when topic or fields are not there."""
    name = name_of(run, topic)
    columns = run.columns(name)
    missing = [field for field in fields if field not in columns]
    if missing:
        raise RecordingError(f'{run.path}: {name} has no {", ".join(missing)}; recorded by another version?')
    return {field: columns[field] for field in fields}


def events_of(run: 'Run') -> list[Event]:
    """Return the transitions of a run; the drive position is not recorded with them (NaN).  Raises RecordingError."""
    columns = columns_of(run, MODE_EVENT, _EVENT_FIELDS)
    if not (np.isin(columns['kind'], list(EventKind)).all() and np.isin(columns['mode'], list(Mode)).all()):
        raise RecordingError(f'{run.path}: transitions of unknown kinds; recorded by another version?')
    return [_event(*row) for row in zip(*(column.tolist() for column in columns.values()))]


def _event(time: float, kind: int, mode: int, direction: int, position: float, velocity: float, *rest: float) -> Event:
    second = math.floor(time)
    return Event(float(second), time - second, EventKind(kind), Mode(mode), direction, position, velocity, math.nan,
                 *rest)
