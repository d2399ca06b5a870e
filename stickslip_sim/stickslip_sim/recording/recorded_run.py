# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""A recorded run: states at its steps, events at their exact times, the scene that travels in it."""

import os
from collections.abc import Callable, Iterator, Mapping, Sequence
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np

from ..bags.topics import (
    DRIVE_VELOCITY,
    FRICTION_FORCE,
    MODE_EVENT,
    PARAMETER_EVENTS,
    RIG_EVENT,
    SLIDER_STATE,
    TIMING,
    Topic,
)
from ..core.arrays import Columns
from ..core.errors import RecordingError, one_line
from ..core.types import Event, Mode
from ..figures.cycles import Summary, summary
from ..runs import COLUMNS
from ..runs.run import Views, recorded_normal_force
from ..runs.samples import MOST_HELD, joined
from ..scene import Scene
from ..simulation import RigEventKind
from ..simulation.step_result import Mark, TimedRigEvent, marks_of_events, marks_of_faults
from .messages import SETPOINT, setpoint_layout, slider_joint
from .reader import EVENT_FIELDS, Bag
from .run_outline import (
    LATE_FIELDS,
    RunOutline,
    check_samples,
    gap_marks,
    late_marks,
    of_the_same_steps,
    outline_of,
    paired_blocks,
)

# The normal force beside the friction forces of a bag, where its scene lets it vary: no message has it.

def is_changed(bag: Bag) -> bool:
    """Whether parameters were changed while a run was recorded."""
    return any(bag.counts.get(name) for name, kind in bag.topics.items() if kind == PARAMETER_EVENTS.type)


def normal_force_beside(bag: Bag, topic: str) -> Callable[[Mapping[str, Any]], Columns]:
    """Return what makes the column for columns of a topic; none for other topics, or where N does not vary."""
    try:
        varies = bag.topics[bag.resolved(topic)] == FRICTION_FORCE.type and bag.scene.normal_load is not None
    except RecordingError:   # no scene that this version can read
        varies = False
    if not varies:
        return lambda _: {}
    changed = is_changed(bag)
    return lambda columns: recorded_normal_force(bag.scene, {
        'time': np.asarray(columns['log_time']) / 1e9, 'friction_force': np.asarray(columns['force']),
        'friction_coefficient': np.asarray(columns['coefficient'])}, changed)


_STATE = ('time', 'step', 'position', 'velocity', 'acceleration', 'drive_position', 'drive_velocity', 'drive_force',
          'rest_time', 'mode', 'direction')
_FRICTION = {'force': 'friction_force', 'coefficient': 'friction_coefficient',
             'contact_deflection': 'contact_deflection'}
_RIG_EVENT = ('time', 'kind', 'id', 'fault', 'count')   # the fields of TimedRigEvent
_NO_FORCE = 1e-9   # of the other forces: what rounding leaves where no external force acts


class RecordedRun(Views):
    """A run from a bag, read when it is asked for; `bag` has all its messages.

    `samples` are the steps of which state and friction were recorded; their external force is that of the balance of
    forces, m ẍ = F_d + F_e − F.
    """

    is_recorded = True

    def __init__(self, bag: Bag, path: Path | str) -> None:
        self.bag = bag
        self.notes = bag.shortfalls
        self.is_complete = bag.is_complete
        self.is_changed = is_changed(bag)
        self._given = path
        self._columns: dict[Topic, Columns] = {}

    @property
    def name(self) -> str:
        """Of the folder or file."""
        return one_line(Path(os.path.abspath(self._given)).name)

    @property
    def title(self) -> str:
        """Of a picture; raises RecordingError."""
        return f'{self.name} ({self.scene.name}, recorded)'

    @property
    def source(self) -> str:
        """Where it was read from."""
        return f'recorded in {self._given}'

    @cached_property
    def scene(self) -> Scene:
        """The scene that travels in the bag; raises RecordingError when there is none that this version can read."""
        return self.bag.scene

    @cached_property
    def receipt(self) -> dict[str, Any]:
        """The final figures; empty when the run was cut off.  Raises RecordingError when they are none."""
        return self.bag.receipt

    @cached_property
    def begin(self) -> float:
        """Time of the first sample, s."""
        return self._outline.begin if self._outline else float(self.samples['time'][0])

    @cached_property
    def end(self) -> float:
        """Time of the last sample, s."""
        return self._outline.end if self._outline else float(self.samples['time'][-1])

    @property
    def states(self) -> Columns:
        """The recorded states, with their `step`."""
        return self.state_columns(_STATE)

    def state_columns(self, fields: Sequence[str]) -> Columns:
        """Return columns of `states`; those that were asked for are held, and no others."""
        return self._held({SLIDER_STATE: fields})[SLIDER_STATE]

    def state_blocks(self, fields: Sequence[str]) -> Iterator[Columns]:
        """Yield columns of `states` block by block, the first of them empty, in memory that does not grow."""
        return (block for _, block in self.bag.blocks_of({SLIDER_STATE: fields}))

    @cached_property
    def missing_steps(self) -> int:
        """How many steps have no recorded state between the first and the last that has."""
        if self._outline:
            return self._outline.missing_steps
        steps = self.state_columns(['step'])['step']
        return int(steps[-1]) - int(steps[0]) + 1 - len(steps) if len(steps) else 0

    @cached_property
    def samples(self) -> Columns:
        """The steps of which state and friction were recorded; raises RecordingError on fewer than 2."""
        events = {MODE_EVENT: EVENT_FIELDS} if list(self.bag.topics.values()).count(MODE_EVENT.type) == 1 else {}
        held = self._held({SLIDER_STATE: _STATE, FRICTION_FORCE: ('step', *_FRICTION), **events})
        states, friction = of_the_same_steps(held[SLIDER_STATE], held[FRICTION_FORCE])
        del self._columns[FRICTION_FORCE], held
        columns = _columns(states, friction)
        check_samples(self.bag, len(columns['time']), bool((np.diff(columns['time']) > 0.0).all()),
                      np.unique(columns['mode']))
        largest = max(np.abs(columns[name]).max() for name in ('friction_force', 'drive_force'))
        return self._completed(columns, float(largest))

    def sample_blocks(self) -> Iterator[Columns]:
        """Yield the samples block by block: those of a long run are read again, those of a short one are held."""
        outline = self._outline
        if outline is None:
            yield self.samples
            return
        left = outline.samples    # more have come meanwhile to one that is being written
        for pair in paired_blocks(self.bag.blocks_of({SLIDER_STATE: _STATE, FRICTION_FORCE: ('step', *_FRICTION)})):
            columns = {name: column[:left] for name, column in _columns(*pair).items()}
            left -= len(columns['time'])
            if len(columns['time']):
                yield self._completed(columns, outline.largest_force)

    @cached_property
    def _outline(self) -> RunOutline | None:
        """What one look through a long run found; None of a run whose samples are held."""
        return outline_of(self.bag) if self.bag.counts[self.bag.name_of(SLIDER_STATE)] > MOST_HELD else None

    def _completed(self, columns: Columns, largest: float) -> Columns:
        """Add what the other forces, at most so large in all of the run, leave of m ẍ, N; 0 where it is rounding.

        And the normal force, where it varies.
        """
        axis = self.scene.axis
        force = axis.mass * columns['acceleration'] + columns['friction_force'] - columns['drive_force']
        force += axis.slideway_damping * columns['velocity']
        columns = {**columns, 'external_force': np.where(np.abs(force) > _NO_FORCE * largest, force, 0.0)}
        return {**columns, **recorded_normal_force(self.scene, columns, self.is_changed)}

    @cached_property
    def events(self) -> list[Event]:
        """The transitions up to the last state; the drive's position then is between those at the steps."""
        if self._outline and self._outline.events is not None:
            return self._outline.events
        held = self._held({SLIDER_STATE: ('time', 'drive_position'), MODE_EVENT: EVENT_FIELDS})
        states, events = held[SLIDER_STATE], self.bag.events_in(held[MODE_EVENT])
        time = states['time']
        events = [event for event in events if len(time) and time[0] <= event.time <= time[-1]]
        times = [event.time for event in events]
        drive = np.interp(times, time, states['drive_position']).tolist() if events else []
        return [event._replace(drive_position=position) for event, position in zip(events, drive)]

    @cached_property
    def commands(self) -> Columns:
        """The drive velocities as they were taken, each at the start of the first step in which it holds.

        A run of the tool has none: its scene decides.
        """
        return joined(self.command_blocks())

    def command_blocks(self) -> Iterator[Columns]:
        """Yield the commands block by block, the first of them empty."""
        yield {'time': np.empty(0), 'velocity': np.empty(0)}
        if self._is_of_the_tool or DRIVE_VELOCITY.type not in self.bag.topics.values():
            return
        for _, block in self.bag.blocks_of({DRIVE_VELOCITY: ('sequence', 'velocity')}):
            times = np.maximum(block['sequence'].astype(np.float64) - 1.0, 0.0) / self.scene.time.rate
            yield {'time': times, 'velocity': block['velocity'].astype(np.float64)}

    @cached_property
    def setpoint(self) -> Columns:
        """Where the slider should have been, of a closed loop that recorded it; messages of others are passed over."""
        found = [name for name, kind in self.bag.topics.items()
                 if kind == SETPOINT.type and name.rpartition('/')[2] == SETPOINT.name]
        if len(found) != 1:
            return {}
        layout = setpoint_layout(slider_joint(self.scene.joint_prefix))
        messages = [message for message in self.bag.messages(found) if len(message.data) == layout.size]
        if not messages:
            return {}
        rows = layout.unpack([message.data for message in messages])
        return {'time': np.array([message.log_time for message in messages]) / 1e9,
                **{name: rows[name].astype(np.float64) for name in layout.names}}

    @cached_property
    def marks(self) -> list[Mark]:
        """When faults were in force, and commands refused, limited, lost or missing; raises RecordingError.

        And where steps in real time were later than `timing.max_lateness`, or commands stayed away.  A run of the tool
        has the faults of its scene, and no rig events.
        """
        if self._is_of_the_tool:
            return marks_of_faults(self.scene.rig.faults, self.end)
        columns = self._columns_of_any(RIG_EVENT, _RIG_EVENT)
        if not np.isin(columns['kind'], list(RigEventKind)).all():
            raise RecordingError(f'{self.bag.path}: rig events of unknown kinds; recorded by another version?')
        rows = zip(*(columns[name].tolist() for name in _RIG_EVENT))
        marks = marks_of_events((TimedRigEvent(time, RigEventKind(kind), *rest) for time, kind, *rest in rows),
                                self.begin, self.end)
        if self.scene.time.mode != 'realtime':
            return marks
        rate, limit = self.scene.time.rate, self.scene.timing.max_lateness
        late = late_marks(self._columns_of_any(TIMING, LATE_FIELDS), rate, limit)
        return [*marks, *late, *gap_marks(self.command_blocks(), rate, limit)]

    @property
    def _is_of_the_tool(self) -> bool:
        return self.bag.metadata.get('stickslip', {}).get('origin') == 'offline'

    def _held(self, fields: Mapping[Topic, Sequence[str]]) -> dict[Topic, Columns]:
        """Return columns of topics; those that are not held yet are read, in one pass over the bag."""
        known = {topic: self._columns.get(topic, {}) for topic in fields}
        missing = {topic: new for topic, names in fields.items()
                   if (new := [name for name in names if name not in known[topic]])}
        for topic, columns in self.bag.columns_of_all(missing).items() if missing else ():
            known[topic] = self._columns[topic] = {**known[topic], **columns}
        return {topic: {name: known[topic][name] for name in names} for topic, names in fields.items()}

    def _columns_of_any(self, topic: Topic, fields: Sequence[str]) -> Columns:
        """Return fields of a topic that a recording need not have."""
        if topic.type not in self.bag.topics.values():
            return {name: np.empty(0) for name in fields}
        return self.bag.columns_of(topic, fields)

    @cached_property
    def summary(self) -> Summary:
        """What the run amounts to, from its first sample to its last."""
        events = [event for event in self.events if self.begin <= event.time <= self.end]
        start = self._outline.mode if self._outline else Mode(int(self.samples['mode'][0]))
        return summary(events, self.duration, start, self.begin)


def _columns(states: Columns, friction: Columns) -> Columns:
    """Return the columns of samples, all but the external force, from states and friction of the same steps."""
    columns = {name: states[name].astype(np.float64, copy=False) for name in _STATE if name in COLUMNS}
    return columns | {name: friction[field].astype(np.float64, copy=False) for field, name in _FRICTION.items()}
