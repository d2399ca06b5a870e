# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""How far a run may be off: an estimate, with how it was obtained.

The exact solver makes rounding errors only.  It runs again with every number of the scene off by one rounding unit,
which also gives every operation of the run another rounding; how far the events move apart is what rounding does to
this very run.  What the sums of time and position lose in every run alike is added, and so is what rounding of the
speed does to a slip that ends with almost no deceleration: its time is a double root, which symmetric data keep.

Other solvers are compared with the exact one on the same scene, and its own estimate is added.  A repeat with half the
step or a tenth of the tolerances says nothing: an event is noticed up to a step late, so that two runs may be late
alike.  With Kato's law under a normal force that varies smoothly there is no exact one: the adaptive solver is compared
with itself at a thousandth of its tolerances.
"""

import dataclasses
import math
import random
from collections.abc import Sequence
from typing import Any, NamedTuple

from ..core.errors import InputError, SolverError, check_kind
from ..core.input_profile import Sinusoid
from ..core.types import Event, EventKind
from ..figures.distance import MOMENT, Shift, lasting, shift_between
from ..friction import ExcessTable, KineticTable, kinetic_table
from ..scene import Scene, SolverSettings
from ..solvers.adaptive import MIN_RTOL
from ..solvers.normal_load import exact_follows
from .simulated import SimulatedRun, simulate_events

# A scene whose every number is off by one rounding unit: what the digits of the data decide shows in the difference.
#
# Numbers that are equal move alike, since an equality is part of the model: mu_s(0) = mu_k(0), a reversal to the same
# speed.  Zeros, infinities and the ends 1 and 0 of psi stay.

ROUNDING_UNIT = 2.0 ** -52


def perturbed(scene: Scene, seed: str) -> Scene:
    """Return the scene with every number of axis, start and input profiles times 1 ± 2⁻⁵², signs drawn from the seed.

    Raises InputError in the rare case that breakpoints of a table or a profile change places by that.
    """
    move = _Mover(seed)
    return dataclasses.replace(scene, axis=move.moved(scene.axis), initial=move.moved(scene.initial),
                               drive=move.moved(scene.drive), force=move.moved(scene.force),
                               normal_load=move.moved(scene.normal_load))


class _Mover:
    """Moves numbers, equal ones alike; walks through the frozen types that a scene is made of."""

    def __init__(self, seed: str) -> None:
        self._random = random.Random(seed)
        self._factors: dict[float, float] = {0.0: 1.0, math.inf: 1.0}

    def moved(self, value: Any) -> Any:
        """Return a value with all its numbers moved."""
        if isinstance(value, float):
            return value * self._factor(abs(value))
        if isinstance(value, ExcessTable):
            inner = tuple(self.moved(fraction) for fraction in value.fractions[1:-1])
            return ExcessTable(self.moved(value.velocities), (1.0, *inner, 0.0))
        if isinstance(value, Sinusoid):
            return Sinusoid(*map(self.moved, value))
        if type(value) is tuple:
            return tuple(map(self.moved, value))
        if dataclasses.is_dataclass(value) and not isinstance(value, type):
            changes = {field.name: self.moved(getattr(value, field.name)) for field in dataclasses.fields(value)}
            return dataclasses.replace(value, **changes)
        return value

    def _factor(self, size: float) -> float:
        return self._factors.setdefault(size, 1.0 + self._random.choice((-1.0, 1.0)) * ROUNDING_UNIT)


REPEATS = 3
_SAFETY = 4.0   # of the largest shift among so few repeats
_OF_SPEEDS = 2.0 ** -50   # what rounding leaves of a speed, as a part of the fastest of its slip
_HALF_ULP = 2.0 ** -54   # of a number below 1: the most that storing it can lose
_BREAKPOINTS = 800   # of the table that stands for a smooth law; many, and below the most that there can be
_COARSER = 10.0   # the error of another such table, which is compared with it
_FINER = 1e-3           # of the tolerances of a run


class ErrorEstimate(NamedTuple):
    """How far the events of a run may be off, up to the time `until_s`; behind it nothing is known.

    Two runs whose events differ in kind or direction have nothing to compare from there on: a chaotic run, one that
    grazes a limit to within rounding, or a solver that missed or invented an event.
    """

    event_time_s: float
    position_m: float   # of an event
    until_s: float
    how: str


def error_estimate(run: SimulatedRun) -> ErrorEstimate:
    """Return the estimate for a run; it costs three more runs, or four to six of the exact solver.

    Raises InputError on a closed loop, whose controller would be in these runs.
    """
    check_kind('run', run, SimulatedRun, 'a run that was simulated just now', 'simulate the scene again')
    if run.is_commanded:
        raise InputError('run', run.source, 'of a scene alone', 'simulate the scene: a controller answers anew')
    if run.scene.solver.name == 'exact':
        return _of_rounding(run)
    return _of_steps(run) if exact_follows(run.scene.axis, run.scene.normal_force) else _of_tolerances(run)


def _of_rounding(run: SimulatedRun) -> ErrorEstimate:
    """Return the estimate for a run of the exact solver, from repeats with every number moved."""
    others = _perturbed_scenes(run.scene)
    shifts = [_repeat(run, other) for other in others]
    until = min((shift.until for shift in shifts), default=0.0)
    # times and positions are sums over the events; equal steps round alike, so that a repeat does not show what is lost
    lost = _HALF_ULP * (1 + len(run.events))
    size = 2.0 * max((abs(event.position) for event in run.events), default=0.0)
    estimate = ErrorEstimate(
        lost * min(run.duration, 1.0) + _of_soft_stops(run) + _SAFETY * max(
            (shift.time for shift in shifts), default=0.0),
        lost * size + _SAFETY * max((shift.position for shift in shifts), default=0.0), until,
        f'{_SAFETY:g} times the largest shift of an event in {len(others)} repeats with every number of the scene '
        'moved by 2^-52 of itself')
    if until >= run.duration:
        return estimate
    return estimate._replace(how=f'{estimate.how}; the events differ from t = {until:.6g} s: unknown from there')


def _of_soft_stops(run: SimulatedRun) -> float:
    """Return how far rounding of the speed may move the softest arrest, s: δ/|ẍ|, or √(2δ/|x⃛|) without deceleration."""
    axis, drive, force = run.scene.axis, run.scene.drive, run.scene.force
    worst = fastest = 0.0
    for event in run.events:
        fastest = max(fastest, abs(event.velocity))
        if event.kind == EventKind.BREAKAWAY:
            fastest = abs(event.velocity)
        elif event.kind == EventKind.STICK and fastest > 0.0:
            left = abs(event.drive_force + force.value_at(event.time) - event.friction_force)
            jerk = axis.drive_stiffness * abs(drive.value_at(event.time))
            off = _OF_SPEEDS * fastest * axis.mass
            moved = min(off / left if left > 0.0 else math.inf, math.sqrt(2.0 * off / jerk) if jerk > 0.0 else math.inf)
            worst = max(worst, min(moved, run.duration))
    return worst


def _perturbed_scenes(scene: Scene) -> list[Scene]:
    scenes = []
    for repeat in range(REPEATS):
        try:
            scenes.append(perturbed(scene, f'{scene.seed}/{repeat}'))
        except InputError:   # breakpoints so close that they change places
            continue
    return scenes


def _repeat(run: SimulatedRun, scene: Scene) -> Shift:
    try:
        return shift_between(run.events, simulate_events(scene, run.duration).events, run.duration)
    except (InputError, SolverError):
        return Shift(0.0, 0.0, 0.0)


def _of_steps(run: SimulatedRun) -> ErrorEstimate:
    """Return the estimate for a run of another solver: its distance to the exact one, and how far that may be off."""
    scene = dataclasses.replace(run.scene, solver=SolverSettings('exact'))
    law = _integrates_the_law(run.scene)
    try:
        better = simulate_events(_with_table(scene, 1.0) if law else scene, run.duration)
        own = _of_rounding(better)
        if law:
            own = _plus(own, _shift(simulate_events(_with_table(scene, _COARSER), run.duration), better, own.until_s),
                        'what a table of mu_k ten times as coarse moves them by')
    except SolverError as reason:
        return ErrorEstimate(0.0, 0.0, 0.0, f'the exact solver gives up: unknown ({reason})')
    shift = _shift(run, better, own.until_s)
    estimate = _plus(own, shift, 'the largest difference of an event from one of the exact solver on the same scene '
                                 f'(coasts of less than {MOMENT:g} s after a break-away left out)')
    if shift.until >= own.until_s:
        return estimate
    return estimate._replace(how=f'{estimate.how}; from t = {shift.until:.6g} s the events are others than those of '
                                 'the exact solver: one is missed, invented, or falls behind the end of the run')


def _of_tolerances(run: SimulatedRun) -> ErrorEstimate:
    """Return the estimate for an adaptive run that no exact one can be compared with, from one with finer steps."""
    given = run.scene.solver
    finer = SolverSettings('adaptive', 'DOP853', rtol=max(_FINER * (given.rtol or 0.0), MIN_RTOL),
                           atol=max(_FINER * (given.atol or 0.0), 1e-300))
    try:
        better = simulate_events(dataclasses.replace(run.scene, solver=finer), run.duration)
    except SolverError as reason:
        return ErrorEstimate(0.0, 0.0, 0.0, f'the finer run gives up: unknown ({reason})')
    shift = _shift(run, better, run.duration)
    how = (f'twice the largest difference of an event from a run with {_FINER:g} of the tolerances (DOP853, rtol '
           f'{finer.rtol:g}); a limit that is touched for less than a step may be missed by both')
    if shift.until < run.duration:
        how += f'; the events differ from t = {shift.until:.6g} s: unknown from there'
    return ErrorEstimate(2.0 * shift.time, 2.0 * shift.position, shift.until, how)


def _integrates_the_law(scene: Scene) -> bool:
    """Whether a run takes the smooth law of mu_k itself, where all others take its table."""
    return scene.solver.name == 'adaptive' and _has_law(scene)


def _has_law(scene: Scene) -> bool:
    """Whether kinetic friction follows a smooth law, in a direction at least."""
    return any(side.kinetic.law is not None for side in scene.axis.friction.sides)


def _with_table(scene: Scene, coarser: float) -> Scene:
    """Return the scene with another table for its smooth law: one as fine as can be had, or `coarser` than that."""
    friction = scene.axis.friction.with_tables(lambda table: _table(table, coarser))
    return dataclasses.replace(scene, axis=dataclasses.replace(scene.axis, friction=friction))


def _table(table: KineticTable, coarser: float) -> KineticTable:
    if table.law is None or table.error == 0.0:
        return table
    share = min((len(table.velocities) / _BREAKPOINTS) ** 2, 1.0)   # breakpoints go with 1/sqrt(tolerance)
    try:
        return kinetic_table(table.law, coarser * share * table.error)
    except InputError:   # rounding alone is more
        return kinetic_table(table.law, coarser * table.error)


def _shift(run: SimulatedRun, better: SimulatedRun, until: float) -> Shift:
    """Return how far the events of two runs are apart before a time; events of kind knot count where both have them."""
    with_knots = run.scene.solver.name != 'fixed_step' and not _has_law(run.scene)

    def compared(events: Sequence[Event]) -> list[Event]:
        return [event for event in lasting(events)
                if event.time <= until and (with_knots or event.kind != EventKind.KNOT)]

    return shift_between(compared(run.events), compared(better.events), until)


def _plus(own: ErrorEstimate, shift: Shift, what: str) -> ErrorEstimate:
    return ErrorEstimate(own.event_time_s + shift.time, own.position_m + shift.position, shift.until,
                         f'{what}, plus {own.how}')
