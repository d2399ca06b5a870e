# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Advice on a scene: everything on, without each part, with each solver; then the least that a tolerance needs."""

from collections.abc import Iterable, Iterator, Sequence
from typing import NamedTuple, TypeVar

from ..bench.race import Cost
from ..core.errors import InputError
from ..core.types import Progress
from ..figures.cycles import Round
from ..runs.error_estimate import ErrorEstimate, error_estimate
from ..scene import Scene, changed
from ..sensitivity.sensitivities import Sensitivities, sensitivities
from ..study.points import works_in_batches
from . import trial_runs
from .parts import Changes, Part, Variant, absent_parts, parts_of
from .trial_runs import EXACT, ExactRun, Trial

# Which numbers of a scene matter most: by how many percent its motion changes for one percent of each.

_MOST_EVENTS = 10  # the last event that is looked at


def sensitivities_of(reference: ExactRun) -> Sensitivities | None:
    """Return the sensitivities of the limit cycle, or of an early event where there is none; None without any."""
    events = reference.run.events
    if not events:
        return None
    if len(reference.figures.cycles) > 1 and works_in_batches(reference.scene):
        try:
            return sensitivities(reference.scene, Round._fields)
        except InputError:   # no round repeats the one before
            pass
    return sensitivities(reference.scene, [f'event.{min(len(events), _MOST_EVENTS)}.time'])


# The least scene for a tolerance, and the solver for it: from trials, and confirmed by runs of the advised scene.

_WORTH = 0.9   # a solver must cost less than this share of the exact one, which is right at any tolerance


class PartTrial(NamedTuple):
    """A part, the best way to leave it out, and the result."""

    part: Part
    variant: Variant
    trial: Trial


class Least(NamedTuple):
    """The least scene: `parts` are out, `trial` is the rest, with the solver `solver`.

    `changes` turn the scene into it.
    """

    parts: tuple[str, ...]
    solver: str
    changes: Changes
    trial: Trial


def best_trial(reference: ExactRun, part: Part) -> PartTrial:
    """Leave a part out in each of its ways and return the one that changes least; one that is refused comes last."""
    trials = [PartTrial(part, variant, trial_runs.try_changes(reference, part.name, changes, variant.how))
              for variant in part.variants if (changes := variant.changes(reference.scene.values))]
    return min(trials, key=lambda found: _size(found.trial))


def least_scene(reference: ExactRun, trials: Sequence[PartTrial], solvers: Sequence[Trial],
                tolerance: float) -> Least:
    """Leave out one part after the other, those that change least first, as long as all together stay in tolerance.

    Then take the cheapest solver that keeps the whole in tolerance, too.
    """
    values, left_out = reference.scene, trial_runs.try_changes(reference, EXACT, {})
    parts: list[str] = []
    for found in sorted(trials, key=lambda found: _size(found.trial)):
        changes = found.variant.changes(values.values)
        if _size(found.trial) > tolerance or not changes:
            continue
        together = trial_runs.changes_between(reference.scene, changed(values, changes))
        trial = trial_runs.try_changes(reference, EXACT, together)
        if _size(trial) <= tolerance and trial.scene is not None:
            values, left_out = trial.scene, trial
            parts.append(found.part.name if not found.variant.how else f'{found.part.name} ({found.variant.how})')
    return _with_solver(reference, Least(tuple(parts), EXACT, left_out.changes, left_out), solvers, tolerance)


def _with_solver(reference: ExactRun, least: Least, solvers: Sequence[Trial], tolerance: float) -> Least:
    """Return the same parts with the cheapest solver that is in tolerance with them."""
    exact = next(trial for trial in solvers if trial.name == EXACT)
    if exact.cost is None:
        return least
    limit = _WORTH * exact.cost.median
    rivals = [(trial.cost.median, trial) for trial in solvers
              if trial.cost is not None and trial.cost.median < limit and _size(trial) <= tolerance]
    for _, rival in sorted(rivals, key=lambda pair: pair[0]):
        changes = {**least.changes, **rival.changes}
        trial = trial_runs.try_changes(reference, rival.name, changes)
        if _size(trial) <= tolerance:
            return Least(least.parts, rival.name, changes, trial)
    return least


def _size(trial: Trial) -> float:
    return trial.difference.largest if trial.difference is not None else float('inf')


_FINER = 0.1   # of the stated error of a table, to see its effect
_MEASURING = 10   # items of work, about, that all costs together are

_T = TypeVar('_T')


class Advice(NamedTuple):
    """All that was found out about a scene; costs are processor time for each simulated second, s."""

    reference: ExactRun
    cost: Cost | None
    estimate: ErrorEstimate
    tolerance: float
    parts: list[PartTrial]
    absent: list[Trial]
    solvers: list[Trial]
    tables: list[Trial]    # of smooth laws, made finer
    least: Least
    least_cost: tuple[Cost | None, Cost | None]   # of the whole scene and of the least one, measured side by side
    sensitivities: Sensitivities | None   # of the motion to all numbers of the scene; None without an event


def check_tolerance(tolerance: float) -> None:
    """Raise InputError unless a relative error can be that."""
    if not 0.0 < tolerance < 1.0:
        raise InputError('--tolerance', tolerance, '> 0 and < 1', 'give the allowed relative error, such as 1e-3')


def advise(scene: Scene, tolerance: float, duration: float, rounds: int, progress: Progress = None) -> Advice:
    """Run a scene of `duration` s in all its variants; `rounds` are the samples of each cost.

    `progress` is called with the share that is done.  Raises InputError, and SolverError when the scene itself cannot
    be run.
    """
    check_tolerance(tolerance)
    if scene.rig.faults:
        raise InputError('faults.ids', [fault.id for fault in scene.rig.faults], 'omitted for advise',
                         'the effect of faults belongs to no part of the model')
    if scene.normal_load is not None:
        raise InputError('normal_load.course', scene.values['normal_load.course'], 'omitted for advise',
                         'the solvers are compared under a normal force that does not vary')
    reference = trial_runs.reference_of(scene, duration)
    parts, absent = parts_of(reference.scene), absent_parts(reference.scene)
    settings = trial_runs.solver_settings(scene)
    report = _Progress(len(parts) + len(absent) + len(settings) + _MEASURING, progress)
    found = [best_trial(reference, part) for part in report.through(parts)]
    given = [trial_runs.try_changes(reference, part.name, part.changes) for part in report.through(absent)]
    solved = [trial_runs.try_changes(reference, name, settings[name]) for name in report.through(settings)]
    cost, trials = trial_runs.with_costs(reference, [*(part.trial for part in found), *given, *solved], rounds)
    report.done(_MEASURING)
    coming = iter(trials)
    found = [part._replace(trial=next(coming)) for part in found]
    given, solved = [next(coming) for _ in given], list(coming)
    least = least_scene(reference, found, solved, tolerance)
    side_by_side = trial_runs.costs([reference.scene, least.trial.scene or reference.scene], duration, rounds)
    return Advice(reference, cost, error_estimate(reference.run), tolerance, found, given, solved,
                  _finer_tables(reference), least, (side_by_side[0], side_by_side[1]),
                  sensitivities_of(reference))


def _finer_tables(reference: ExactRun) -> list[Trial]:
    """Return the scene with each table of a smooth law ten times as fine, to see the rest of its error."""
    values = reference.scene.values
    return [trial_runs.try_changes(reference, what, {name: _FINER * float(values[name])})  # type: ignore[arg-type]
            for what, name in (('table of mu_k', 'friction.kinetic.tolerance'),
                               ('table of psi', 'friction.excess.tolerance')) if name in values]


class _Progress:
    """Reports how far the work has come."""

    def __init__(self, count: int, progress: Progress) -> None:
        self._count, self._progress, self._done = count, progress, 0

    def through(self, items: Iterable[_T]) -> Iterator[_T]:
        """Yield the items; each counts as done when the next is asked for."""
        for item in items:
            yield item
            self.done(1)

    def done(self, count: int) -> None:
        """Report that so many more items are done."""
        self._done += count
        if self._progress:
            self._progress(self._done / self._count)
