# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Two axes that follow a circle: their path out of two runs, or out of a bag of both, and what limits on it come to."""

import math
from collections.abc import Sequence
from os.path import normpath
from typing import NamedTuple

import numpy as np

from ..bags.topics import SLIDER_STATE
from ..core.arrays import Columns, Numbers, rows_between
from ..core.errors import InputError, RecordingError
from ..figures.circular import Circle, CircularTest, least_squares_circle, turns_of
from ..recording import Bag, RecordedRun
from ..recording.messages import SETPOINT
from ..runs import Run
from .limits import CheckedSpan, LimitOutcome, Limits, NominalCircle, check_fit
from .observed_run import Reference, setpoint_of
from .report import Checked

_FIELDS = ('time', 'position', 'drive_position')
OPTION = '--circle'


class Path(NamedTuple):
    """Two axes at times (s); columns of `actual` and `commanded` are x and y, m.

    Actual are the sliders, commanded their setpoints, or else their drives.
    """

    name: str
    time: Numbers
    actual: Numbers
    commanded: Numbers

    def cut(self, span: CheckedSpan) -> 'Path':
        """Return the part within a span."""
        rows = rows_between(self.time, -math.inf if span.begin is None else span.begin,
                            math.inf if span.end is None else span.end)
        return Path(self.name, self.time[rows], self.actual[rows], self.commanded[rows])


class _Axis(NamedTuple):
    name: str
    columns: Sequence[Numbers]   # of _FIELDS; of a run with a setpoint that, not the drive


def paths_of(runs: Sequence[tuple[str, Run]]) -> list[Path]:
    """Return the paths of axes in pairs, x before y; a bag of two axes has them in the order of their topics.

    Raises InputError and RecordingError.
    """
    axes = [axis for name, run in runs for axis in _axes_of(name, run)]
    if len(axes) not in (2, 4):
        raise InputError(OPTION, ', '.join(axis.name for axis in axes), 'two axes: RUN_X RUN_Y, or a bag of both; four '
                         'with those of the other sense', 'give each axis as a run')
    return [_path(x, y) for x, y in zip(axes[::2], axes[1::2])]


def _axes_of(name: str, run: Run) -> list[_Axis]:
    if isinstance(run, RecordedRun):
        topics = sorted(topic for topic, kind in run.bag.topics.items() if kind == SLIDER_STATE.type)
        if len(topics) > 1:
            return [_axis(f'{name}:{topic}', run.bag.columns(topic), _setpoint_beside(run.bag, topic))
                    for topic in topics]
        return [_axis(name, run.state_columns(_FIELDS), setpoint_of(run))]
    return [_axis(name, run.states, setpoint_of(run))]


def _axis(name: str, columns: Columns, wanted: Reference | None) -> _Axis:
    return _Axis(name, [columns['time'], columns['position'],
                        wanted.at(columns['time']) if wanted else columns['drive_position']])


def _setpoint_beside(bag: Bag, states: str) -> Reference | None:
    """Return the setpoint in the namespace of a topic of states; None without one."""
    topic = f'{states.rpartition("/")[0]}/{SETPOINT.name}'
    found = [(message.log_time / 1e9, *bag.decode(message).position) for message in bag.messages([topic])
             ] if bag.topics.get(topic) == SETPOINT.type else []
    rows = [row for row in found if len(row) == 2]    # others have no joint, or several
    return Reference(*np.array(rows).T) if rows else None


def _path(x: _Axis, y: _Axis) -> Path:
    """Return the path of two axes, at the times that both have."""
    if normpath(x.name) == normpath(y.name):
        raise InputError(OPTION, f'{x.name}, {y.name}', 'two runs: this is the same twice', 'give the run of y behind '
                         'that of x, or once a bag of both')
    for axis in (x, y):
        if not np.isfinite(axis.columns[1]).all():
            raise RecordingError(f'{axis.name}: its position was not measured; import that column too')
    time, rows_x, rows_y = np.intersect1d(x.columns[0], y.columns[0], return_indices=True)
    if not len(time) or 2 * len(time) < len(x.columns[0]):
        raise InputError(OPTION, f'{x.name}, {y.name}', f'states of both axes at the same times; {len(time)} of '
                         f'{len(x.columns[0])} are', 'record or simulate both at one rate, from one time on')
    actual, commanded = (np.column_stack([x.columns[of][rows_x], y.columns[of][rows_y]]) for of in (1, 2))
    return Path(f'{x.name}, {y.name}', time, actual, commanded)


def circular_test(paths: Sequence[Path], given: NominalCircle) -> CircularTest:
    """Return the test of the last whole turn of each sense; raises InputError where there is none."""
    nominal = _nominal(paths, given)
    found = {turn.sense: turn for path in paths for turn in turns_of(path.actual[:, 0], path.actual[:, 1], nominal)}
    if not found:
        raise _no_turn(paths)
    return CircularTest(nominal, tuple(found[sense] for sense in sorted(found, reverse=True)))


def _no_turn(paths: Sequence[Path]) -> InputError:
    return InputError(OPTION, '; '.join(path.name for path in paths), 'a whole turn of 360 degrees',
                      'check a longer run, or give circle: {radius: R, centre: [X, Y]} in the limits')


def _nominal(paths: Sequence[Path], given: NominalCircle) -> Circle:
    """Return the circle that is given; what is not, of the last turns of the drives."""
    if given.radius is not None and given.centre is not None:
        return Circle(*given.centre, given.radius)
    points = np.concatenate([path.commanded for path in paths])
    if not np.isfinite(points).all() and given.radius is None:
        raise InputError('radius', None, 'given: no drive position was measured', 'add --radius R in m')
    if not np.isfinite(points).all():
        points = np.concatenate([path.actual for path in paths])
    middle = 0.5 * (points.min(axis=0) + points.max(axis=0))
    turns = turns_of(points[:, 0], points[:, 1], Circle(float(middle[0]), float(middle[1]), 0.0))
    if not turns:
        raise _no_turn(paths)
    x, y = (np.concatenate([getattr(turn, name) for turn in turns]) for name in ('x', 'y'))
    circle = least_squares_circle(x, y)
    centre = given.centre or (circle.x, circle.y)
    return Circle(centre[0], centre[1], circle.radius if given.radius is None else given.radius)


def check_circle(limits: Limits, runs: Sequence[tuple[str, Run]]) -> Checked:
    """Return a circle of axes, whose runs come with names, as it was checked; raises InputError and RecordingError."""
    paths = paths_of(runs)
    outcomes = circle_outcomes(limits, paths)
    test = circular_test([path.cut(limits.window.at(None) or CheckedSpan()) for path in paths], limits.circle)
    return Checked('; '.join(path.name for path in paths), None, outcomes, test)


def circle_outcomes(limits: Limits, paths: Sequence[Path]) -> list[LimitOutcome]:
    """Return the outcome of every limit on a circle; raises InputError when one does not fit."""
    limits.check_axes(are_two=True)
    check_fit(limits, max(float(path.time[0]) for path in paths), min(float(path.time[-1]) for path in paths),
              has_timing=False, commands=None)
    tests: dict[CheckedSpan, CircularTest] = {}
    outcomes = []
    for limit in limits.limits:
        span = limit.window.at(None) or CheckedSpan()
        if span not in tests:
            tests[span] = circular_test([path.cut(span) for path in paths], limits.circle)
        with limit.named():
            outcomes.append(limit.outcome(limit.kind.measure(tests[span]), span))
    return outcomes
