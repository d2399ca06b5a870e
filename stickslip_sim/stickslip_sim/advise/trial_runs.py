# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Runs of changed scenes beside the reference: their results and their costs."""

import time
from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Any, NamedTuple

from ..bench.contestants import own_solver
from ..bench.problem import NO_SETTING, Outcome, Problem
from ..bench.race import Cost, measure
from ..core.errors import InputError, SolverError
from ..core.types import Event, Instant, Sample
from ..figures.distance import Distance, RunFigures, distance_between, run_figures
from ..runs import SimulatedRun, simulate, simulate_events
from ..scene import Scene, changed
from ..simulation.simulator import Simulator
from ..solvers import Solver, with_advance
from .parts import Changes

BY_EXACT: Changes = {'solver.name': 'exact'}

_SLOW = 0.05            # s: a run that takes longer is timed once
_LONGEST = 320.0        # s of simulation that costs are measured over
_MOMENT = 1e-3          # s of simulation
_MOST = 10              # times as many events as the reference, and
_MOST_AT_LEAST = 1000   # these: a solver that finds more chatters


class ExactRun(NamedTuple):
    """The exact run with everything on; `end` is its last sample."""

    scene: Scene
    run: SimulatedRun
    end: Sample
    figures: RunFigures

    @property
    def end_instant(self) -> Instant:
        """When it ends."""
        return Instant(self.end.second, self.end.fraction)


class Trial(NamedTuple):
    """A run of the scene with changes; without a difference `note` says why there is none.

    `identical`: its events and its end are those of the reference to the last bit.  `how` says how the changes are
    where the name does not.  `cost` is processor time for each simulated second, s.
    """

    name: str
    how: str
    changes: Changes
    scene: Scene | None
    difference: Distance | None
    identical: bool = False
    note: str = ''
    cost: Cost | None = None


def changes_between(base: Scene, other: Scene) -> Changes:
    """Return the changes that make the other scene of the base; parameters that a changed choice drops need none."""
    return {name: value for name, value in other.values.items() if base.values.get(name) != value}


def reference_of(scene: Scene, duration: float) -> ExactRun:
    """Run a scene with the exact solver, whichever it names."""
    exact = changed(scene, BY_EXACT)
    run = simulate(exact, duration, duration)   # sampled at its start and its end
    start, end = run.sample_rows()
    return ExactRun(exact, run, end, run_figures(run.events, duration, start, end))


def try_changes(reference: ExactRun, name: str, changes: Changes, how: str = '') -> Trial:
    """Run the scene of the reference with changes; a scene that is refused and a solver that gives up are results."""
    scene = None
    try:
        scene = _tabulated(changed(reference.scene, changes))
        events, start, end = _run(scene, reference)
    except (InputError, SolverError) as error:
        return Trial(name, how, changes, scene, None, note=' '.join(str(error).split()))
    figures = run_figures(events, reference.run.duration, start, end)
    return Trial(name, how, changes, scene, distance_between(reference.figures, figures),
                 identical=events == reference.run.events and end == reference.end)


def costs(scenes: Sequence[Scene], duration: float, rounds: int) -> list[Cost | None]:
    """Return the processor time of each scene per simulated second, interleaved; None where the solver gives up."""
    duration = min(duration, _LONGEST)
    for scene in scenes:
        _cost_of_one(_prepared(scene, _MOMENT))   # compile first
    runs = [_prepared(scene, duration) for scene in scenes]
    first = [_cost_of_one(run) for run in runs]
    quick = [k for k, cost in enumerate(first) if cost is not None and cost.median < _SLOW]
    # the first run of a round finds the caches full of the last one's data: a run that does not count does
    _, *measured = measure([runs[k] for k in (*quick[:1], *quick)], rounds) if quick else [None]
    found = dict(zip(quick, measured))
    return [_per_second(found.get(k, cost), duration) for k, cost in enumerate(first)]


def with_costs(reference: ExactRun, trials: Sequence[Trial], rounds: int) -> tuple[Cost | None, list[Trial]]:
    """Return the cost of the reference, and the trials with their costs; failed trials have none."""
    sound = [trial for trial in trials if trial.difference is not None]
    whole, *others = costs([reference.scene, *(trial.scene or reference.scene for trial in sound)],
                           reference.run.duration, rounds)
    coming = iter(others)
    return whole, [trial if trial.difference is None else trial._replace(cost=next(coming)) for trial in trials]


def _run(scene: Scene, reference: ExactRun) -> tuple[list[Event], Sample, Sample]:
    """Return the events of a run as long as the reference, and its first and last sample."""
    duration = reference.run.duration
    if scene.solver.name != 'adaptive':
        run = simulate(scene, duration, duration)
        begin, end = run.sample_rows()
        return run.events, begin, end
    solver = _watched(scene.solver.make(scene.axis), max(_MOST_AT_LEAST, _MOST * len(reference.run.events)))
    simulator = Simulator(scene.axis, scene.initial, scene.drive, scene.force, solver)
    start = simulator.sample()
    return simulator.advance(reference.end_instant), start, simulator.sample()


def _watched(solver: Solver, most: int) -> Solver:
    """Return a solver that gives up after too many events: chatter would go on for minutes."""
    found = 0

    def advance(*arguments: Any) -> tuple[int, int]:
        nonlocal found
        rows, end = solver.advance(*arguments)
        found += rows
        if found > most:
            time = arguments[1].second + arguments[1].fraction
            raise SolverError(f'more than {most} events up to t = {time:.4g} s, far more than with the exact solver')
        return rows, end

    return with_advance(solver, advance)


def _tabulated(scene: Scene) -> Scene:
    """Return a scene whose adaptive solver takes the table of mu_k as the others do: solvers are compared, not laws."""
    if scene.solver.name != 'adaptive':
        return scene
    friction = scene.axis.friction.with_tables(lambda table: replace(table, law=None))
    return replace(scene, axis=replace(scene.axis, friction=friction))


def _prepared(scene: Scene, duration: float) -> Callable[[], Outcome]:
    problem = Problem(scene.name, scene.summary, scene.axis, scene.initial, scene.drive, scene.force, duration)
    solver = scene.solver.make(scene.axis)
    return own_solver(scene.solver.name, (NO_SETTING,), lambda setting: solver).prepare(problem, NO_SETTING)


def _cost_of_one(run: Callable[[], Outcome]) -> Cost | None:
    begin = time.process_time()
    try:
        run()
    except SolverError:
        return None
    seconds = time.process_time() - begin
    return Cost(seconds, seconds, seconds, 1)


def _per_second(cost: Cost | None, duration: float) -> Cost | None:
    return cost and Cost(cost.median / duration, cost.low / duration, cost.high / duration, cost.samples)


# The solvers that a scene is tried with, each with settings from quick to careful.

EXACT = 'exact'


def solver_settings(scene: Scene) -> dict[str, Changes]:
    """Return the changes to a scene that choose each solver, by a name for people; that of the scene is among them."""
    found: dict[str, Changes] = {EXACT: {'solver.name': EXACT}}
    for method, steps in (('euler', (1e-3, 1e-4, 1e-5)), ('rk4', (1e-3, 1e-4))):
        for step in steps:
            _add(found, {'solver.name': 'fixed_step', 'solver.method': method, 'solver.step': step})
    for tolerance in (1e-6, 1e-9, 1e-12):
        _add(found, {'solver.name': 'adaptive', 'solver.method': 'DOP853', 'solver.rtol': tolerance,
                     'solver.atol': tolerance})
    if scene.solver.name != EXACT:
        _add(found, {'solver.name': scene.solver.name,
                     **{f'solver.{name}': value for name, value in scene.solver.settings.items()}})
    return found


def _add(found: dict[str, Changes], changes: Changes) -> None:
    found[_label(**{name.removeprefix('solver.'): value for name, value in changes.items()})] = changes


def _label(name: str, method: str, step: float | None = None, rtol: float | None = None,
           atol: float | None = None) -> str:
    if step is not None:
        return f'{name} {method}, step {step * 1e3:g} ms'
    return f'{name} {method}, {rtol:g}' if rtol == atol else f'{name} {method}, rtol {rtol:g}, atol {atol:g}'


# The duration of the runs: the longest allowed one, and one that is enough when none is given.

_CYCLES = 20
_SHORTEST, _LONGEST_TRIAL = 10.0, 320.0   # s

_MAX_DURATION = 3600.0               # s: solvers that step take minutes for it


def check_duration(duration: float) -> None:
    """Raise InputError unless all solvers can be run for `duration` s in a bearable time."""
    if not 0.0 < duration <= _MAX_DURATION:
        raise InputError('duration', duration, f'> 0 and <= {_MAX_DURATION:g} s',
                         'every solver runs it, including those with the shortest steps: use a part of it')


def default_duration(scene: Scene) -> float:
    """Return 10 s, doubled up to 320 s while the exact solver finds fewer than 20 cycles; 10 s if there are none."""
    exact, duration = changed(scene, BY_EXACT), _SHORTEST
    while True:
        cycles = simulate_events(exact, duration).summary.cycles
        if cycles >= _CYCLES:
            return duration
        if duration >= _LONGEST_TRIAL:
            return _LONGEST_TRIAL if cycles else _SHORTEST
        duration *= 2.0
