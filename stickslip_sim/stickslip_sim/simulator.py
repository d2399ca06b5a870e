"""One axis through time: advance, sample, command.  Deterministic; knows no clock, no file and no ROS."""

import math
from collections.abc import Iterator
from typing import Any

from .axis import Axis, InitialState, check_start, pack
from .axis.layout import EVENT_SIZE, ITERATIONS, SAMPLE_SIZE, STATE_SIZE, WAVE_SIZE
from .compiled import IS_COMPILED
from .courses import Course, constant
from .errors import SolverError
from .solvers import DONE, FULL, Solver, exact
from .words import Event, EventKind, Instant, Mode, Sample

_KINDS, _MODES = tuple(EventKind), tuple(Mode)
_ROWS = 64                       # of the event table; it is emptied as often as it fills
MAX_EVENTS_PER_ADVANCE = 100_000


class Simulator:
    """The state of one axis, brought from time to time.

    `drive` (m/s) and `force` (N) are courses over simulation time; a command replaces a course by a constant from the
    present time on.  Events come back from the call in which they fall, in the order of time.
    """

    def __init__(self, axis: Axis, initial: InitialState, drive: Course, force: Course,
                 solver: Solver = exact.SOLVER) -> None:
        check_start(axis, initial)
        self._solver = solver
        self._initial = initial
        self._courses = (drive, force)
        self._axis = axis
        self._parameters = _numbers(pack(axis))
        self._state = _numbers([0.0] * (STATE_SIZE + WAVE_SIZE * (len(drive.waves) + len(force.waves))))
        self._row = _numbers([0.0] * SAMPLE_SIZE)
        self._table = _table(_ROWS, EVENT_SIZE)
        self.reset()

    def reset(self) -> list[Event]:
        """Begin anew at time 0 with the initial state and the original courses; return the events at time 0."""
        self._drive, self._force = self._courses
        self._time = Instant(0.0, 0.0)
        self._waves = _waves(self._drive, self._force)
        v, f = self._drive.piece_at(0.0), self._force.piece_at(0.0)
        self._until = min(v.end, f.end)
        start = self._initial
        rows = self._solver.start(self._parameters, self._state, start.position, start.velocity, start.rest_time,
                                  v.value, v.rate, f.value, f.rate, self._waves, self._table, 0)
        self._waiting = list(self._rows(rows))
        self._counts = dict.fromkeys(EventKind, 0)
        return self._waiting

    @property
    def time(self) -> Instant:
        """The time that the state was advanced to."""
        return self._time

    @property
    def axis(self) -> Axis:
        """The axis as it is now."""
        return self._axis

    @property
    def root_iterations(self) -> int:
        """Iterations of all searches for event times so far."""
        return int(self._state[ITERATIONS])

    @property
    def event_counts(self) -> dict[EventKind, int]:
        """Events so far, by kind."""
        return dict(self._counts)

    def advance(self, to: Instant) -> list[Event]:
        """Bring the state to a time that is not before the present one; return the events up to then.

        Raises SolverError when the events do not let time go on; the state is then that of the last event.
        """
        events, self._waiting = self._waiting, []
        while self._until <= to.seconds:
            self._advance(Instant(math.floor(self._until), self._until - math.floor(self._until)), events)
            self._enter_pieces(events)
        self._advance(to, events)
        for event in events:
            self._counts[event.kind] += 1
        return events

    def command_velocity(self, velocity: float) -> None:
        """Let the drive move at a constant velocity (m/s) from now on; events that this causes come with `advance`."""
        self._drive = constant(velocity)
        self._waves = _waves(self._drive, self._force)
        self._enter_pieces(self._waiting)

    def command_force(self, force: float) -> None:
        """Let a constant external force (N) act from now on; events that this causes come with `advance`."""
        self._force = constant(force)
        self._waves = _waves(self._drive, self._force)
        self._enter_pieces(self._waiting)

    def change_axis(self, axis: Axis) -> None:
        """Go on with other parameters from now on; position, velocity and the spring stay continuous."""
        new = _numbers(pack(axis))
        rows = self._solver.set_parameters(self._parameters, new, self._state, *self._time, self._table, 0)
        self._parameters, self._axis = new, axis
        self._waiting.extend(self._rows(rows))

    def sample(self) -> Sample:
        """Return the state at the present time; raises SolverError when it is not finite."""
        row = self._row
        self._solver.sample(self._parameters, self._state, *self._time, row)
        second, fraction, mode, direction, *rest = row.tolist() if IS_COMPILED else row
        if not all(map(math.isfinite, rest[:8])):
            raise SolverError(f'the state leaves the range of numbers at t = {second + fraction!r} s; '
                              'a parameter or an input is too extreme for this axis: check the scene')
        return Sample(second, fraction, _MODES[int(mode)], int(direction), *rest)

    def _advance(self, to: Instant, events: list[Event]) -> None:
        taken = 0
        while True:
            rows, end = self._solver.advance(self._parameters, self._state, *to, self._table, 0)
            events.extend(self._rows(rows))
            taken += rows
            if end == DONE:
                self._time = to
                return
            self._time = events[-1].instant if events else self._time
            if end != FULL or taken > MAX_EVENTS_PER_ADVANCE:
                raise SolverError(f'{taken} events up to t = {self._time.seconds!r} s and time hardly goes on; '
                                  'friction or inputs are too extreme for this axis: check the scene')

    def _enter_pieces(self, events: list[Event]) -> None:
        time = self._time.seconds
        v, f = self._drive.piece_at(time), self._force.piece_at(time)
        self._until = min(v.end, f.end)
        rows = self._solver.set_inputs(self._parameters, self._state, *self._time,
                                       v.value + v.rate * (time - v.start), v.rate,
                                       f.value + f.rate * (time - f.start), f.rate, self._waves, self._table, 0)
        events.extend(self._rows(rows))

    def _rows(self, count: int) -> Iterator[Event]:
        for i in range(count):
            row = self._table[i]
            second, fraction, kind, mode, direction, *rest = row.tolist() if IS_COMPILED else row
            yield Event(second, fraction, _KINDS[int(kind)], _MODES[int(mode)], int(direction), *rest)


def _waves(drive: Course, force: Course) -> Any:
    """Return the waves of both courses as `solvers.Solver` wants them, without those that are nothing."""
    of_drive = [(wave.frequency, wave.phase, wave.amplitude, 0.0) for wave in drive.waves]
    of_force = [(wave.frequency, wave.phase, 0.0, wave.amplitude) for wave in force.waves]
    return _numbers([number for frequency, phase, v, f in of_drive + of_force
                     if v != 0.0 or f != 0.0 for number in (frequency, 0.5 * phase / math.pi, v, f)])


def _numbers(values: Any) -> Any:
    if not IS_COMPILED:
        return list(values)
    import numpy as np
    return np.array(values, dtype=np.float64)


def _table(rows: int, columns: int) -> Any:
    if not IS_COMPILED:
        return [[0.0] * columns for _ in range(rows)]
    import numpy as np
    return np.zeros((rows, columns))
