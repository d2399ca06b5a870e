# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""How far a run may be off: an estimate from repeating it, with how it was obtained.

The exact solver makes rounding errors only.  It runs again with every number of the scene off by one rounding unit,
which also gives every operation of the run another rounding; how far the events move apart is what rounding does to
this very run.  What the sums of time and position lose in every run alike is added.  Other solvers run again with half
the step or a tenth of the tolerances.
"""

import dataclasses
from collections.abc import Sequence
from typing import NamedTuple

from .errors import InputError, SolverError
from .offline import Trajectory, run_offline
from .perturbation import perturbed
from .scene import Scene
from .words import Event

REPEATS = 3
_SAFETY = 4.0        # for the exact solver: of the largest shift among so few repeats
_REFINED = {'step': 0.5, 'rtol': 0.1, 'atol': 0.1}
_REFINED_SAFETY = 2.0   # a method of first order, as events make it, halves its error with half the step
_HALF_ULP = 2.0 ** -54   # of a number below 1: the most that storing it can lose


class ErrorEstimate(NamedTuple):
    """How far the events of a run may be off, up to the time `until_s`; behind it nothing is known.

    Two runs whose events differ in kind or direction have nothing to compare from there on: a chaotic run, or one that
    grazes a limit to within rounding.
    """

    event_time_s: float
    position_m: float   # of an event
    until_s: float
    how: str


class _Shift(NamedTuple):
    time: float
    position: float
    until: float


def error_estimate(run: Trajectory) -> ErrorEstimate:
    """Return the estimate for a run; it costs one to three more runs."""
    scene = run.scene
    settings = dataclasses.asdict(scene.solver)
    finer = {name: settings[name] * factor for name, factor in _REFINED.items() if settings.get(name)}
    if finer:
        others = [dataclasses.replace(scene, solver=dataclasses.replace(scene.solver, **finer))]
        safety, how = _REFINED_SAFETY, 'the largest shift of an event when run again with ' + ' and '.join(
            f'{name} {value:g}' for name, value in finer.items())
    else:
        others = _perturbed_scenes(scene)
        safety, how = _SAFETY, (f'the largest shift of an event in {len(others)} repeats with every number of the '
                                'scene moved by 2^-52 of itself')
    shifts = [_repeat(run, other) for other in others]
    until = min((shift.until for shift in shifts), default=0.0)
    # times and positions are sums over the events; equal steps round alike, so that a repeat does not show what is lost
    lost = _HALF_ULP * (1 + len(run.events))
    size = 2.0 * max((abs(event.position) for event in run.events), default=0.0)
    estimate = ErrorEstimate(
        lost * min(run.duration, 1.0) + safety * max((shift.time for shift in shifts), default=0.0),
        lost * size + safety * max((shift.position for shift in shifts), default=0.0), until,
        f'{safety:g} times {how}')
    if until >= run.duration:
        return estimate
    return estimate._replace(how=f'{estimate.how}; the events differ from t = {until:.6g} s: unknown from there')


def _perturbed_scenes(scene: Scene) -> list[Scene]:
    scenes = []
    for repeat in range(REPEATS):
        try:
            scenes.append(perturbed(scene, f'{scene.seed}/{repeat}'))
        except InputError:   # knots so close that they change places
            continue
    return scenes


def _repeat(run: Trajectory, scene: Scene) -> _Shift:
    try:
        return _compare(run.events, run_offline(scene, run.duration).events, run.duration)
    except (InputError, SolverError):
        return _Shift(0.0, 0.0, 0.0)


def _compare(events: Sequence[Event], others: Sequence[Event], duration: float) -> _Shift:
    """Return how far two runs are apart while their events are of the same kinds and directions."""
    time = position = 0.0
    for a, b in zip(events, others):
        if (a.kind, a.direction) != (b.kind, b.direction):
            return _Shift(time, position, min(a.time, b.time))
        time = max(time, abs((a.second - b.second) + (a.fraction - b.fraction)))
        position = max(position, abs(a.position - b.position))
    common = min(len(events), len(others))
    rest = [*events[common:], *others[common:]]
    return _Shift(time, position, rest[0].time if rest else duration)
