# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""X26: the error estimate of a run, for every solver, against the true error.

The truth is that of the reference.  Looked at are the events up to the time `until_s` that the estimate speaks of: they
must be those of the reference, and no further off than it says.  An `until_s` before the end must have its reason.
"""

import math
import random
from collections.abc import Iterator, Sequence
from dataclasses import replace
from fractions import Fraction
from statistics import median
from typing import NamedTuple

from ..core.errors import InputError, SolverError
from ..core.types import Event, EventKind
from ..inputs import load_scene
from ..reference import simulate
from ..runs import SimulatedRun, simulate_events
from ..runs.error_estimate import ErrorEstimate, error_estimate
from ..scene import Scene, SolverSettings, scene_names
from .against import DIGITS
from .outcome import Measurement, Setup, Tally, require
from .shared_axes import random_axis, random_profiles

_DURATION = 2.0   # s
_TOLERANCES = (1e-3, 1e-6, 1e-9, 1e-12)
_STEPS = (1e-2, 1e-3, 1e-4, 1e-5)   # s
_PER_RTOL = 1e-2   # atol, m and m/s
_MOMENT = 1e-6   # s
_TIGHT, _CLAIMED = 0.9, 0.5   # no estimate is to be honest by claiming too much, or nothing
_FEW = ('paper_fig7', 'paper_fig8')


class _Worth(NamedTuple):
    """The worth of an estimate of steps: the error over it, and how many of the events it covered."""

    ratio: float
    covered: int
    events: int


def estimates(setup: Setup) -> Measurement:
    """X26: shipped and random scenes with every solver and setting; the true error over the estimate."""
    tally = Tally(1.0, 'of the estimate')
    worths: list[_Worth] = []
    for scene in _scenes(setup):
        wanted = simulate(scene.axis, scene.initial, scene.drive, scene.force, _DURATION, DIGITS).events
        if not wanted:
            continue
        for solver in _settings(setup):
            run = _run(replace(scene, solver=solver))
            if run:
                tally.measure(_ratio, f'{scene.name} with {solver.name} {solver.settings}', run, wanted, worths)
    half = median(case.ratio for case in worths if case.covered)
    share = sum(case.covered for case in worths) / sum(case.events for case in worths)
    return tally.finding('with an error beyond the estimate', f'of steps half are at least {half:.3g} of it, for '
                         f'{share:.0%} of the events', kept=half >= _TIGHT and share >= _CLAIMED)


def _scenes(setup: Setup) -> Iterator[Scene]:
    for name in setup.choose(tuple(scene_names()), _FEW):
        yield _with_table(load_scene(name))
    for seed in range(setup.count(40, 2)):
        rng = random.Random(seed)
        axis = random_axis(rng)
        drive, force = random_profiles(rng)
        yield replace(load_scene(_FEW[0]), name=f'random {seed}', axis=axis, drive=drive, force=force)


def _with_table(scene: Scene) -> Scene:
    """Return the scene with the table for all solvers, which is what the reference knows, also where it has a law."""
    friction = scene.axis.friction.with_tables(lambda table: replace(table, law=None))
    return replace(scene, axis=replace(scene.axis, friction=friction))


def _settings(setup: Setup) -> Iterator[SolverSettings]:
    yield SolverSettings('exact')
    for method in ('DOP853', 'RK45'):
        for rtol in setup.choose(_TOLERANCES, _TOLERANCES[1:3]):
            yield SolverSettings('adaptive', method, rtol=rtol, atol=rtol * _PER_RTOL)
    for method in ('euler', 'rk4'):
        for step in setup.choose(_STEPS, _STEPS[1:3]):
            yield SolverSettings('fixed_step', method, step)


def _run(scene: Scene) -> SimulatedRun | None:
    """Return the run; None where a step is too long for the axis, or a guard of the adaptive solver fires for ever."""
    try:
        return simulate_events(scene, _DURATION)
    except (InputError, SolverError):
        return None


def _ratio(_: str, run: SimulatedRun, wanted: Sequence[Event], worths: list[_Worth]) -> float:
    """Return the largest error of an event over its estimate."""
    solver = run.scene.solver.name
    with_knots = solver != 'fixed_step'   # which finds no such events
    left = [event for event in wanted if with_knots or event.kind != EventKind.KNOT]
    events, wanted = (run.events, left) if solver == 'exact' else (_lasting(run.events), _lasting(left))
    estimate = error_estimate(run)
    sure = [(a, b) for a, b in zip(events, wanted) if a.time < estimate.until_s or estimate.until_s == _DURATION]
    for a, b in sure:
        require((a.kind, a.direction) == (b.kind, b.direction), f'{a.kind.name} at {a.time} s is none')
    before = [event for event in wanted if event.time < estimate.until_s - 2.0 * estimate.event_time_s]
    require(len(before) <= len(sure), f'{len(before) - len(sure)} events missed before {estimate.until_s} s')
    require(estimate.until_s == _DURATION or _has_reason(estimate, events, wanted),
            f'events differ from {estimate.until_s} s, it says')
    time = max((_apart(a, b) for a, b in sure), default=0.0)
    position = max((abs(a.position - b.position) for a, b in sure), default=0.0)
    if solver != 'exact':
        worths.append(_Worth(time / estimate.event_time_s, len(sure), len(wanted)))
    return max(time / estimate.event_time_s, position / estimate.position_m if position > 0.0 else 0.0)


def _lasting(events: Sequence[Event]) -> list[Event]:
    """Return the events without the ends of coasts of a moment after a break-away, as the estimate of steps does."""
    kept: list[Event] = []
    away = -math.inf
    for event in events:
        away = event.time if event.kind == EventKind.BREAKAWAY else away
        if event.kind == EventKind.BREAKAWAY or event.time > away + _MOMENT:
            kept.append(event)
    return kept


def _has_reason(estimate: ErrorEstimate, events: Sequence[Event], wanted: Sequence[Event]) -> bool:
    """Whether two runs differ by more than an estimate says."""
    return len(events) != len(wanted) or any(
        (a.kind, a.direction) != (b.kind, b.direction) or _apart(a, b) > estimate.event_time_s
        for a, b in zip(events, wanted))


def _apart(event: Event, other: Event) -> float:
    """Return the seconds between two events, in exact arithmetic."""
    return abs(float(Fraction(event.second) - Fraction(other.second)
                     + (Fraction(event.fraction) - Fraction(other.fraction))))
