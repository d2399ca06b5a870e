# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""A run that was measured: its modes, events and cycles are derived from the speed, and nothing is known of a scene."""

from collections.abc import Iterator, Sequence
from functools import cached_property
from pathlib import Path
from typing import NoReturn

import numpy as np

from ..core.arrays import Numbers
from ..core.errors import RecordingError
from ..core.types import Event, Mode
from ..rig.marks import Mark
from ..runs import COLUMNS, Columns
from ..runs.slips import SLIP_TIMES, events_of_slips, slips_of
from ..scene import Scene
from .bag import METADATA
from .measured_bag import MEASURED, OF_STATE
from .reader import Bag
from .recorded_run import RecordedRun
from .topics import EXTERNAL_FORCE, FRICTION_FORCE, SLIDER_STATE

STICK_SHARE = 0.05   # of the largest speed: the threshold where none is stated


class MeasuredRun(RecordedRun):
    """A run folder of `stickslip import`; columns that were not measured are NaN in its `samples`.

    The velocity follows from the position where it was not measured itself.
    """

    def __init__(self, bag: Bag, path: Path | str) -> None:
        super().__init__(bag, path)
        self.measured = tuple(bag.metadata[METADATA].get(MEASURED, '').split(','))
        self.notes = (*self.notes, *self._derived())

    @property
    def title(self) -> str:
        """Of a picture."""
        return f'{self.name} (measured)'

    @property
    def _outline(self) -> None:
        """None: all of a measurement is held."""

    @property
    def source(self) -> str:
        """Where it comes from."""
        return f'measured: {self.bag.metadata[METADATA].get("file", "")}, imported as {self._given}'

    @property
    def scene(self) -> Scene:
        """None: raises RecordingError."""
        self._lack('a scene')

    @cached_property
    def stick_velocity(self) -> float:
        """The speed below which the slider is taken to be at rest, m/s; raises RecordingError when it is none."""
        given = self.bag.metadata[METADATA].get('stick_velocity')
        try:
            stated = None if given is None else float(given)
        except ValueError:
            raise RecordingError(f'{self.bag.path}: its stick_velocity is no number: {given}') from None
        return STICK_SHARE * float(np.abs(self._velocity).max()) if stated is None else stated

    def state_columns(self, fields: Sequence[str]) -> Columns:
        """Return columns of `states`, with modes and directions that are derived."""
        return {name: self._derived_states[name] for name in fields}

    def state_blocks(self, fields: Sequence[str]) -> Iterator[Columns]:
        """Yield columns of `states` as one block."""
        yield self.state_columns(fields)

    @cached_property
    def _derived_states(self) -> Columns:
        states = {**self._recorded, 'velocity': self._velocity}
        modes, directions = np.full(len(self._velocity), float(Mode.STICK)), np.zeros(len(self._velocity))
        for first, last, peak, direction in slips_of(self._velocity, self.stick_velocity):
            modes[first:peak + 1], modes[peak + 1:last] = Mode.ACCELERATING, Mode.DECELERATING
            directions[first:last] = direction
        return {**states, 'mode': modes, 'direction': directions}

    @cached_property
    def samples(self) -> Columns:
        """All of COLUMNS; NaN what was not measured."""
        count = len(self._velocity)
        known = {**self._derived_states, 'friction_force': self._force(FRICTION_FORCE.type, 'friction_force'),
                 'external_force': self._force(EXTERNAL_FORCE.type, 'external_force')}
        return {name: known.get(name, np.full(count, np.nan)) for name in COLUMNS}

    @cached_property
    def events(self) -> list[Event]:
        """Break-away and standstill where the speed passes the threshold, and between them its peak."""
        return events_of_slips(self.samples, self.stick_velocity)

    @cached_property
    def commands(self) -> Columns:
        """None."""
        return {'time': np.empty(0), 'velocity': np.empty(0)}

    def command_blocks(self) -> Iterator[Columns]:
        """Yield none."""
        yield self.commands

    @cached_property
    def marks(self) -> list[Mark]:
        """None."""
        return []

    @cached_property
    def _recorded(self) -> Columns:
        columns = self.bag.columns_of(SLIDER_STATE, ('time', 'step', *OF_STATE, 'rest_time'))
        if len(columns['time']) < 2 or not (np.diff(columns['time']) > 0.0).all():
            raise RecordingError(f'{self.bag.path}: a measured run has at least 2 states, one after the other')
        return columns

    @cached_property
    def _velocity(self) -> Numbers:
        states = self._recorded
        velocity = states['velocity'] if 'velocity' in self.measured else np.gradient(states['position'],
                                                                                       states['time'])
        if not np.isfinite(velocity).all():
            self._lack('position or velocity')
        return np.asarray(velocity, dtype=np.float64)

    def _force(self, type_name: str, name: str) -> Numbers:
        if name not in self.measured:
            return np.full(len(self._velocity), np.nan)
        topic = next((topic for topic, kind in self.bag.topics.items() if kind == type_name), None)
        force = np.empty(0) if topic is None else self.bag.columns(topic)['force']
        if len(force) != len(self._velocity):
            raise RecordingError(f'{self.bag.path}: {len(force)} messages with {name}, {len(self._velocity)} states')
        return np.asarray(force, dtype=np.float64)

    def _derived(self) -> Iterator[str]:
        yield (f'modes and cycles are derived: a slip is faster than {self.stick_velocity * 1e3:.4g} mm/s, and at its'
               f' peak than {SLIP_TIMES:g} times that')
        if 'velocity' not in self.measured:
            yield 'the velocity follows from the position'
        if remark := self.bag.metadata[METADATA].get('remark'):
            yield remark

    def _lack(self, what: str) -> NoReturn:
        raise RecordingError(f'{self.bag.path}: a measured run without {what}; it has {", ".join(self.measured)}')
