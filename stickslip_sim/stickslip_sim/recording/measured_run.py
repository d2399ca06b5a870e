# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""A run that was measured: its modes, events and cycles are derived from the speed, and nothing is known of a scene."""

import os
import warnings
from collections.abc import Iterator, Mapping, Sequence
from functools import cached_property
from pathlib import Path
from typing import Any, NoReturn

import numpy as np
from numpy.typing import NDArray

from ..bags import topics
from ..bags.bag import AT_ONCE, METADATA, BagWriter
from ..bags.message_layout import MessageRows
from ..bags.schemas import flat_layout
from ..bags.topics import EXTERNAL_FORCE, FRICTION_FORCE, SLIDER_STATE
from ..core.arrays import Columns, Numbers
from ..core.errors import InputError, RecordingError, RecordingWarning, check_kind
from ..core.types import Event, Mode
from ..core.version import __version__
from ..figures.slips import SLIP_TIMES, events_of_slips, slips_of
from ..runs import COLUMNS, Run
from ..scene import Scene
from ..simulation.step_result import Mark
from .offline_bag import interleaved
from .reader import Bag
from .recorded_run import RecordedRun

# Writes a run that was measured into a bag: what was measured, and nothing else.

MEASURED = 'measured'            # the origin in the metadata of such a bag, and there the names of what was measured
NO_MODE = 255                    # of a state whose mode nobody measured
OF_STATE = ('position', 'velocity', 'acceleration', 'drive_position', 'drive_velocity', 'drive_force')
OF_FORCES = {'friction_force': topics.FRICTION_FORCE, 'external_force': topics.EXTERNAL_FORCE}
_BLOCK = 1 << 16                  # rows that are written together
_RATED = 1 << 20                  # rows that are differentiated together
_LATEST = 9.2e9                   # s: log times are whole nanoseconds of 64 bits


def write_measured(folder: Path | str, times: Numbers, columns: Mapping[str, Numbers], facts: Mapping[str, str]
                   ) -> None:
    """Write columns over time (s, rising) in SI, named as in OF_STATE and OF_FORCES; a state that is lacking is NaN.

    `facts` say where they come from.  Raises InputError on times that no bag can have, and RecordingError.
    """
    if not 0.0 <= times[0] <= times[-1] <= _LATEST:
        raise InputError('time', float(times[0]), f'0 to {_LATEST:g} s', 'let time begin at 0 or later')
    used = [topics.SLIDER_STATE, *(topic for name, topic in OF_FORCES.items() if name in columns)]
    rows = [MessageRows(channel, flat_layout(topic.type)) for channel, topic in enumerate(used, 1)]
    metadata = {'version': __version__, 'origin': MEASURED, MEASURED: ','.join(columns), **facts}
    bag = BagWriter(folder, [topic.resolved() for topic in used], {}, metadata, packing=AT_ONCE)
    try:
        for first in range(0, len(times), _BLOCK):
            part = slice(first, first + _BLOCK)
            stamps = np.rint(times[part] * 1e9).astype(np.int64)
            steps = np.arange(first, first + len(stamps))
            numbers = _numbers(steps, times[part], {name: column[part] for name, column in columns.items()})
            bag.write_block(interleaved([
                of.packed(stamps, stamps, steps, numbers if topic != topics.EXTERNAL_FORCE else
                          {'force': columns['external_force'][part]}) for of, topic in zip(rows, used)], stamps, []))
        bag.close()
    except BaseException:
        bag.abandon()
        raise


def _numbers(steps: NDArray[np.int64], times: Numbers, columns: Mapping[str, Numbers]) -> dict[str, NDArray[Any]]:
    """Return the fields of the messages of states and friction."""
    count = len(times)
    unknown = _unknown(count)
    return {
        'step': steps, 'time': times, **{name: columns.get(name, unknown) for name in OF_STATE},
        'rest_time': unknown, 'mode': np.full(count, NO_MODE), 'direction': np.zeros(count, np.int64),
        'force': columns.get('friction_force', unknown), 'coefficient': unknown, 'contact_deflection': unknown,
    }


def _unknown(count: int) -> Numbers:
    """Return so many NaN, in the room of one."""
    return np.broadcast_to(np.nan, count)


def _rates(values: Numbers, times: Numbers) -> Numbers:
    """Return the rates of change, part by part: the room for those of all at once is that of six columns."""
    found = np.empty(len(values))
    for first in range(0, len(values), _RATED):
        begin, end = max(first - 1, 0), first + _RATED
        found[first:end] = np.gradient(values[begin:end + 1], times[begin:end + 1])[first - begin:][:_RATED]
    return found


STICK_SHARE = 0.05   # of the largest speed: the threshold where none is stated


class MeasuredRun(RecordedRun):
    """A run folder of `stickslip import`; columns that were not measured are NaN in its `samples`.

    The velocity follows from the position where it was not measured itself.  What is `known` of its columns, the time
    among them, is not read again.
    """

    def __init__(self, bag: Bag, path: Path | str, known: Mapping[str, Numbers] | None = None) -> None:
        super().__init__(bag, path)
        self._known = known
        self.measured = tuple(bag.metadata[METADATA].get(MEASURED, '').split(','))
        self.notes = (*self.notes, *self._derived())

    @property
    def telling(self) -> tuple[str, ...]:
        """What was measured, but for the drive force where the position was derived from it and says the same."""
        is_derived = 'derived' in self.bag.metadata[METADATA]
        return tuple(name for name in self.measured if not (is_derived and name == 'drive_force'))

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
            raise RecordingError(f'{self.bag.path}: its stick_velocity is not a number: {given}') from None
        velocity = self._velocity
        return STICK_SHARE * max(float(velocity.max()), -float(velocity.min())) if stated is None else stated

    def state_columns(self, fields: Sequence[str]) -> Columns:
        """Return columns of `states`, with modes and directions that are derived."""
        return {name: self._derived_states[name] for name in fields}

    def state_blocks(self, fields: Sequence[str]) -> Iterator[Columns]:
        """Yield columns of `states` as one block."""
        yield self.state_columns(fields)

    @cached_property
    def _derived_states(self) -> Columns:
        states = {**self._recorded, 'velocity': self._velocity}
        modes: Any = np.full(len(self._velocity), int(Mode.STICK), np.int8)   # of ten million rows
        directions: Any = np.zeros(len(self._velocity), np.int8)
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
        return {name: known.get(name, _unknown(count)) for name in COLUMNS}

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
        wanted = ('time', *(name for name in OF_STATE if name in self.measured))
        columns = ({name: self._known[name] for name in wanted} if self._known is not None else
                   self.bag.columns_of(SLIDER_STATE, wanted))
        times, count = columns['time'], len(columns['time'])
        if count < 2 or not (times[1:] > times[:-1]).all():
            raise RecordingError(f'{self.bag.path}: a measured run has at least 2 states, one after the other')
        unknown = dict.fromkeys((*OF_STATE, 'rest_time'), _unknown(count))
        return {'step': np.arange(count, dtype=np.int32), **unknown, **columns}

    @cached_property
    def _velocity(self) -> Numbers:
        states = self._recorded
        velocity = states['velocity'] if 'velocity' in self.measured else _rates(states['position'], states['time'])
        if not np.isfinite(velocity).all():
            self._lack('position or velocity')
        return np.asarray(velocity, dtype=np.float64)

    def _force(self, type_name: str, name: str) -> Numbers:
        if name not in self.measured:
            return _unknown(len(self._velocity))
        if self._known is not None:
            return self._known[name]
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


# Reads any run folder: of a simulation, or of a measurement.

def run_of(given: Run | str | os.PathLike[str]) -> Run:
    """Return a run, or the one in a folder; raises InputError on what is neither."""
    if isinstance(given, str | os.PathLike):
        return read_run(os.fspath(given))
    if not hasattr(given, 'samples'):
        raise InputError('run', type(given).__name__, 'a run, or the path of its folder', 'make one of arrays first: '
                         'Measurement.from_arrays(...).write(FOLDER)')
    return given


def read_run(path: Path | str) -> RecordedRun:
    """Return the run in a folder, or in an MCAP file by itself; raises RecordingError when there is none, or damaged.

    A run without an end (its process was killed, its disk was full, or it is still being written) is read as far as it
    goes, with a RecordingWarning; its `notes` say so too.  One that was measured is a MeasuredRun.
    """
    check_kind('path', path, str | os.PathLike, 'the path of a run folder', 'arrays: Measurement.from_arrays')
    bag = Bag(path)
    is_measured = bag.metadata.get(METADATA, {}).get('origin') == MEASURED
    run = MeasuredRun(bag, path) if is_measured else RecordedRun(bag, path)
    for note in bag.shortfalls:
        warnings.warn(note, RecordingWarning, stacklevel=2)
    return run
