# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The runs behind the points of a study: thousands at once where the compiled batch can, else one after the other."""

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import astuple, replace
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..axis import Axis, InitialState
from ..axis.rows import EventRow
from ..core.arrays import Flags, Numbers
from ..core.errors import InputError, SolverError
from ..core.types import Mode
from ..figures.cycles import SWINGS_ON
from ..figures.point_figures import RUN_FIELDS, Runs, no_runs
from ..figures.rounds import drifts, ends_alike, group_size
from ..friction import StaticLawKind
from ..runs import SimulatedRun, simulate_events
from ..runs.batch import BatchFigures, Rounds, figures_in, rounds_in, run_rounds
from ..scene import Scene, scene_from_values
from ..scene.schema import BACKWARD
from ..scene.values import overridden
from ..solvers.exact import many_axes
from ..solvers.exact.axis_figures import ROUND_SIZE, AxisFigures
from .variation import changes_at

# Runs of as many axes as asked for, each long enough that it is known which motion stays.
#
# An axis runs for at least eight times a natural period and the time in which its drive loads the spring to the static
# limit, rounded up to a power of two.  It runs twice as long, from the start, until one of these is known:
#
# * it sticks and slips for ever: in this run and in the one before the latest rounds repeat, one by one or in groups,
#   and end alike (`figures.rounds`);
# * it never sticks again: the least speed of the slip that goes on grows from swing to swing (the argument is that of
#   `solvers.exact.many_axes`), or a slip took more than half of the run and twice the time brought no event more, nor
#   will more time, as it does where the slider coasts a little faster or slower than its drive;
# * it is at rest for ever: nothing pulls.
#
# With the events of `patience` cycles, or after so many `doublings`, it is left as it is, not settled.  Then it sticks
# and slips where sticks came all through the second half of the run, no pause between them _PAUSE times as long as the
# mean one, and took no smaller share of it than of the first half.  It slides where the slider came to rest only for a
# moment, if at all, and turned.  Anything else is undecided: sticks that come again after long pauses, or wane, and
# swings that come ever closer to standstill.

# Steady sliding at the speed of the drive, and whether it lasts.
#
# m ẍ = c (s − x) + h (v − ẋ) + F_e − N mu_k(ẋ): disturbances of ẋ = v die out where h + N mu_k′(v) > 0 and grow where
# it is negative, at any mass and stiffness.
#
# At a breakpoint each swing is half on either side.  With γ = (h + N mu_k′)/2m below and above it, a turn multiplies
# the swing by exp(−π γ/√(ω² − γ²)) of both halves: it grows exactly where the two γ have a negative sum, so that their
# mean counts.  A side without half swings, |γ| ≥ ω, decides alone.

def sliding_slope(axis: Axis, inputs: Mapping[str, Numbers]) -> Numbers:
    """Return h + N mu_k′(v), N s/m, for each of `inputs` as of `batch.run_batch`; NaN where the drive rests."""
    def given(name: str) -> Numbers:
        return inputs.get(name, np.array(getattr(axis, name)))

    below, above = np.array([axis.friction.along(v).kinetic.slopes(abs(v))
                             for v in inputs['drive_velocity'].tolist()]).reshape(-1, 2).T
    low, high = (given('drive_damping') + given('normal_force') * side
                 for side in (np.minimum(below, above), np.maximum(below, above)))
    swings = 2.0 * np.sqrt(given('drive_stiffness') * given('mass'))
    found = np.where(low <= -swings, low, np.where(high >= swings, high, 0.5 * (low + high)))
    result: Numbers = np.where(inputs['drive_velocity'] == 0.0, np.nan, found)
    return result


PATIENCE = 400     # cycles
DOUBLINGS = 10
_LOADINGS = 8.0    # of the spring, and natural periods, that a run has at least
_EVENTS = 8        # of a cycle, or of a swing without a stick, as a rule
_WINDOW = 64       # rounds
_REPEATED, _STILL = 1e-6, 1e-11   # of their numbers, in all and in the later half: rounds that are the same
_NEARLY = 1e-2     # of the same: an axis that drifts
_PAUSE = 4.0
_LEAST_ROUNDS = 8  # with a stick in the second half, to speak of a mean pause
_FADING = 0.95     # of the share of stick, from a run to one twice as long
_CALMED = 0.5      # of the least speed's distance from the drive's, from a run to one twice as long
_WANED = 0.99      # the same, at least: it is on its way
_CALM = 1e-6       # of the drive's speed
_SAME_SWING = 1e-9
_MORE = 1.5        # times the events, in a run twice as long
_SINGLE = 1.5      # rounds of one length, where they do not come in groups
_LATE = 64.0       # first runs before the slip that lasts


def run_settled(axis: Axis, initial: InitialState, inputs: Mapping[str, Numbers], duration: float | None = None,
                patience: int = PATIENCE, doublings: int = DOUBLINGS) -> Runs:
    """Run an axis under `inputs` as of `batch.run_batch`, of one length, for `duration` s or until it settles."""
    count = len(inputs['drive_velocity'])
    if duration is not None:
        runs, _ = _runs(axis, initial, inputs, duration)
        return replace(runs, settled=np.where(runs.slides_on | runs.lasts, _calms(runs, axis, initial, inputs),
                                              runs.settled))
    runs, windows = no_runs(count), np.full((count, _WINDOW, ROUND_SIZE), np.nan)
    exponents = _first_exponents(axis, inputs)
    first, last = 2.0 ** exponents, exponents + doublings
    pending = np.arange(count)
    while len(pending):
        before = _Stage(_taken(runs, pending), windows[pending])
        for exponent in np.unique(exponents[pending]):
            some = pending[exponents[pending] == exponent]
            of_some = {name: values[some] for name, values in inputs.items()}
            found, windows[some] = _runs(axis, initial, of_some, 2.0 ** float(exponent))
            runs.put(some, found)
        now = _Stage(_taken(runs, pending), windows[pending])
        of_pending = {name: values[pending] for name, values in inputs.items()}
        known, settled = _known(before, now, axis, of_pending)
        runs.settled[pending] = settled
        single = now.runs.last_stick - now.runs.round_settling > _SINGLE * now.runs.round_period
        runs.round_settling[pending] = np.where(single, now.runs.round_settling, np.nan)
        runs.undecided[pending] = False
        if not known.all():
            runs.undecided[pending] = ~known & (_is_open(before.runs, now.runs)
                                                | _drifts(before, now, axis, of_pending))
        goes_on = ~known & now.runs.complete & (now.runs.events < _EVENTS * patience) & (
            exponents[pending] < last[pending])
        pending = pending[goes_on]
        exponents[pending] += 1
    return replace(runs, late=runs.lasts & (runs.sticks > 0.0) & (runs.last_break_away > _LATE * first))


def _calms(runs: Runs, axis: Axis, initial: InitialState, inputs: Mapping[str, Numbers]) -> Flags:
    """Return which slips of runs of one length, if any, come nearer to steady sliding than they were at half of it."""
    calm: Flags = sliding_slope(axis, inputs) >= 0.0
    slides = np.flatnonzero(calm & runs.slides_on)
    if len(slides):
        of_slides = {name: values[slides] for name, values in inputs.items()}
        half, _ = _runs(axis, initial, of_slides, 0.5 * float(runs.duration[0]))
        now, speed = _taken(runs, slides), np.abs(of_slides['drive_velocity'])
        gaps = [np.abs(speed - one.least_speed) for one in (half, now)]
        calm[slides] = ((half.last_break_away != now.last_break_away) | (now.events < _MORE * half.events)
                        | ~(gaps[1] > np.maximum(_WANED * gaps[0], _CALM * speed)))
    return calm


class _Stage(NamedTuple):
    """Runs of one length, and the latest rounds of each."""

    runs: Runs
    windows: Numbers


def _known(before: _Stage, now: _Stage, axis: Axis, inputs: Mapping[str, Numbers]) -> tuple[Flags, Flags]:
    """Return which runs have a known ending, by those half as long, and which have reached it, or nearly."""
    runs = now.runs
    is_stable = sliding_slope(axis, inputs) >= 0.0
    swings_on, wanes, calms = _swings(before.runs, runs, np.abs(inputs['drive_velocity']))
    pulls_no_more = inputs['drive_velocity'] * _number(axis, inputs, 'drive_stiffness') == 0.0
    stays: Flags = (_repeats(before, now, _static_force(axis, inputs)) | (is_stable & calms)
                    | (runs.slides_on & (runs.events == before.runs.events) & _is_steady(runs, inputs, is_stable))
                    | (pulls_no_more & (runs.final_mode == Mode.STICK)))
    return stays | swings_on | (runs.lasts & ~is_stable), stays | (is_stable & wanes)


def _is_steady(runs: Runs, inputs: Mapping[str, Numbers], is_stable: Flags) -> Flags:
    """Return which slips without a further event are steady: any but those that coast at another speed than the drive.

    Such coasting ends, however late; close to the drive's speed, where steady sliding is stable, that changes nothing.
    """
    apart = np.abs(runs.last_velocity - inputs['drive_velocity'])
    close = np.where(is_stable, _CALM, 0.0) * np.abs(inputs['drive_velocity'])
    steady: Flags = (runs.final_mode != Mode.COASTING) | (runs.events == 0.0) | (apart <= close)
    return steady


def _swings(before: Runs, now: Runs, speed: Numbers) -> tuple[Flags, Flags, Flags]:
    """Return which slips that last swing on as they are, which wane, and which calm down.

    `speed` is the drive's.
    """
    gaps = [np.abs(speed - one.least_speed) for one in (before, now)]
    same_slip = now.lasts & (before.duration > 0.0) & (before.last_break_away == now.last_break_away)
    goes_on = now.events >= _MORE * before.events   # there were swings since
    swings_on = same_slip & goes_on & (np.abs(gaps[1] - gaps[0]) <= _SAME_SWING * gaps[1]) & (gaps[1] > _CALM * speed)
    wanes, calms = (same_slip & (gaps[1] <= np.maximum(share * gaps[0], _CALM * speed)) for share in (_WANED, _CALMED))
    return swings_on, wanes, calms


def _repeats(before: _Stage, now: _Stage, force: Numbers) -> Flags:
    """Return which runs stick and slip in a cycle, or a group of cycles, that stays."""
    counts = np.where(before.runs.duration > 0.0, now.runs.round_count - before.runs.round_count, 0.0)
    size = group_size(now.windows, np.minimum(counts, _WINDOW), force, _REPEATED, _STILL)
    if not size.any():
        return size > 0.0
    same_end = ends_alike(before.windows, now.windows, size, force, _REPEATED)
    repeats: Flags = (size > 0.0) & ~now.runs.slides_on & same_end
    return repeats


def _drifts(before: _Stage, now: _Stage, axis: Axis, inputs: Mapping[str, Numbers]) -> Flags:
    """Return which runs change little from round to round, by which a cycle may still vanish."""
    counts = np.minimum(now.runs.round_count - before.runs.round_count, _WINDOW)
    return drifts(now.windows, counts, _static_force(axis, inputs), _NEARLY) & ~(now.runs.lasts | now.runs.rests_on)


def _is_open(before: Runs, now: Runs) -> Flags:
    """Return which runs that did not settle may or may not go on to stick and slip."""
    late = now.sticks - before.sticks
    with np.errstate(divide='ignore', invalid='ignore'):
        pause = np.maximum(now.longest_pause, now.duration - now.last_stick)
        sticks = (late >= _LEAST_ROUNDS) & (pause * late <= _PAUSE * (now.duration - before.duration))
    sticks &= now.stick_share >= _FADING * before.stick_share
    turns = (now.sticks == 0.0) & (now.cycles > before.cycles)
    is_open: Flags = ~(sticks | turns | now.lasts | now.rests_on)
    return is_open


def _first_exponents(axis: Axis, inputs: Mapping[str, Numbers]) -> Any:
    """Return of which power of two the shortest run is, for each axis."""
    stiffness = _number(axis, inputs, 'drive_stiffness')
    force = _static_force(axis, inputs)
    with np.errstate(divide='ignore', invalid='ignore', over='ignore'):
        swing = 2.0 * np.pi * np.sqrt(_number(axis, inputs, 'mass') / stiffness)
        load = (force + np.abs(inputs['external_force'])) / (stiffness * np.abs(inputs['drive_velocity']))
    scale = np.where(np.isfinite(swing), swing, 1.0) + np.where(np.isfinite(load), load, 0.0)
    return np.ceil(np.log2(_LOADINGS * np.clip(scale, _SHORTEST, _LONGEST))).astype(int)


_SHORTEST, _LONGEST = 1e-9, 1e15   # s


def _static_force(axis: Axis, inputs: Mapping[str, Numbers]) -> Numbers:
    """Return the largest force that static friction can hold, N."""
    most = np.maximum(_number(axis, inputs, 'static_limit'), _number(axis, inputs, 'static_initial'))
    for name in ('static_backward_limit', 'static_backward_initial'):
        if axis.friction.backward is not None or name in inputs:
            most = np.maximum(most, _number(axis, inputs, name))
    force: Numbers = _number(axis, inputs, 'normal_force') * most
    return np.broadcast_to(force, len(inputs['drive_velocity']))


def _number(axis: Axis, inputs: Mapping[str, Numbers], name: str) -> Numbers:
    """Return a number of each axis; it may be among the inputs."""
    if name in inputs:
        return inputs[name]
    if not name.startswith('static_'):
        return np.array(getattr(axis, name))
    static = axis.friction.along(-1.0 if '_backward_' in name else 1.0).static
    return np.array(getattr(static, name.removeprefix('static_').removeprefix('backward_')))


def runs_of(figures: BatchFigures, rounds: Rounds, duration: float) -> Runs:
    """Return runs of one length from their figures and rounds."""
    no = np.zeros((2, len(figures.cycles)), dtype=bool)
    known = {name: getattr(one, name) for one in (figures, rounds) for name in one.__slots__ if name in RUN_FIELDS}
    return Runs(np.full(len(figures.cycles), duration), **known, undecided=no[0], late=no[1])


def _runs(axis: Axis, initial: InitialState, inputs: Mapping[str, Numbers], duration: float) -> tuple[Runs, Numbers]:
    """Return runs of one length, and the latest rounds of each."""
    figures, rounds = run_rounds(axis, duration, _WINDOW, initial=initial, threads=1, **inputs)
    return runs_of(figures, rounds, duration), rounds.window


def _taken(runs: Runs, places: Any) -> Runs:
    return replace(runs, **{name: getattr(runs, name)[places] for name in RUN_FIELDS})


_OF_THE_BATCH = {
    'axis.mass': 'mass', 'axis.drive_stiffness': 'drive_stiffness', 'axis.drive_damping': 'drive_damping',
    'axis.normal_force': 'normal_force', 'contact.stiffness': 'contact_stiffness',
    'contact.damping': 'contact_damping', 'friction.static.initial': 'static_initial',
    'friction.static.limit': 'static_limit', 'friction.static.time_constant': 'static_time_constant',
    'friction.static.exponent': 'static_exponent', 'friction.static.backward.initial': 'static_backward_initial',
    'friction.static.backward.limit': 'static_backward_limit',
    'friction.static.backward.time_constant': 'static_backward_time_constant',
    'friction.static.backward.exponent': 'static_backward_exponent', 'drive.velocity': 'drive_velocity',
    'force.constant': 'external_force',
}
_OF_STATIC = ('initial', 'limit', 'time_constant', 'exponent')
_COEFFICIENTS = frozenset({'static_initial', 'static_limit', 'static_backward_initial', 'static_backward_limit'})
Values = Mapping[str, object]


def scene_at(values: Values, names: Sequence[str], point: Numbers) -> Scene:
    """Return the scene of a point: `values` with the numbers of the point for `names`; raises InputError."""
    return scene_from_values(overridden(values, changes_at(values, names, point)))


def works_in_batches(scene: Scene) -> bool:
    """Whether the compiled batch can run a scene: exactly solved, constant inputs, no faults, no normal load."""
    return scene.solver.name == 'exact' and not scene.rig.faults and scene.normal_load is None and all(
        len(profile.starts) == 1 and profile.rates == (0.0,) and not profile.sinusoids and profile.period == math.inf
        for profile in (scene.drive, scene.force))


def runs_in_batches(values: Values, names: Sequence[str], points: Numbers, duration: float | None,
                    patience: int = PATIENCE, doublings: int = DOUBLINGS) -> Runs:
    """Run points by the compiled batch: a scene for each set of numbers that it cannot vary, and all others at once."""
    runs = no_runs(len(points))
    for members, scene, inputs in batches(values, names, points):
        runs.put(members, run_settled(scene.axis, scene.initial, inputs, duration, patience, doublings))
    return runs


def batches(values: Values, names: Sequence[str], points: Numbers
            ) -> Iterator[tuple[NDArray[np.int64], Scene, dict[str, Numbers]]]:
    """Yield the places of points of one scene, the scene, and the arrays of `batch.run_batch` that vary it."""
    others = [k for k, name in enumerate(names) if name not in _OF_THE_BATCH]
    sets, belongs = np.unique(points[:, others], axis=0, return_inverse=True)
    for k in range(len(sets)):
        members = np.flatnonzero(belongs.reshape(-1) == k)
        scene = scene_at(values, [names[other] for other in others], sets[k])
        yield members, scene, _inputs(scene, names, points[members])


def runs_alone(values: Values, names: Sequence[str], points: Numbers, duration: float) -> Runs:
    """Run points one after the other, each as `simulate` would."""
    runs = no_runs(len(points))
    runs.duration[:] = duration
    for k, point in enumerate(points):
        try:
            scene = scene_at(values, names, point)
            run = simulate_events(scene, duration)
        except (SolverError, InputError):   # it gave up, or found more events than can be held
            continue
        runs.put([k], runs_of_run(run))
    return runs


def runs_of_run(run: SimulatedRun) -> Runs:
    """Return a complete run as one entry of `Runs`."""
    figures = AxisFigures(final_mode=float(run.scene.make_rig().simulator.sample().mode))
    for event in run.events:
        many_axes.book(figures, [], 0, EventRow(*map(float, event)), 0.5 * run.duration)
    figures.complete = 1.0
    out = np.array([astuple(figures)])
    found = runs_of(figures_in(out), rounds_in(out), run.duration)
    found.stick_share[0] = run.summary.stick_share
    found.settled[0] |= found.slides_on[0] and run.summary.motion != SWINGS_ON
    found.lasts[0] &= works_in_batches(run.scene)   # with other inputs and solvers a slip may still end
    return found


def _backwards(scene: Scene, columns: Mapping[str, Any]) -> dict[str, Any]:
    """Return the columns of static friction backwards for those forwards: what a scene leaves out is as forwards."""
    found = {}
    for name in _OF_STATIC:
        ahead, back = f'static_{name}', f'static_backward_{name}'
        if ahead in columns and back not in columns:
            given: Any = scene.values.get(f'friction.static.{BACKWARD}.{name}')
            scale: Any = scene.values.get('friction.scale', 1.0) if back in _COEFFICIENTS else 1.0
            found[back] = columns[ahead] if given is None else scale * given
    return found


def _inputs(scene: Scene, names: Sequence[str], points: Numbers) -> dict[str, Numbers]:
    """Return the arrays for `batch.run_batch`, all of one length."""
    columns: dict[str, Any] = {'drive_velocity': scene.drive.values[0], 'external_force': scene.force.values[0]}
    columns |= {_OF_THE_BATCH[name]: points[:, k] for k, name in enumerate(names) if name in _OF_THE_BATCH}
    for name in _COEFFICIENTS & set(columns):
        columns[name] = scene.values.get('friction.scale', 1.0) * columns[name]   # the axis of the scene has it already
    if any(f'.{BACKWARD}.' in name for name in scene.values):
        columns |= _backwards(scene, columns)
    if scene.axis.friction.static.kind == StaticLawKind.CONSTANT:
        columns |= {f'{side}limit': columns[f'{side}initial'] for side in ('static_', 'static_backward_')
                    if f'{side}initial' in columns}   # as a scene has it
    return {name: np.array(np.broadcast_to(values, len(points)), dtype=float) for name, values in columns.items()}
