# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Advice on a scene: everything on, without each part, with each solver; then the least that a tolerance needs."""

from collections.abc import Iterable, Iterator
from typing import NamedTuple, TypeVar

from ..bench.measure import Cost
from ..core.callbacks import Progress
from ..core.errors import InputError
from ..runs.error_estimate import ErrorEstimate, error_estimate
from ..scene import Scene
from ..sensitivity.sensitivities import Sensitivities
from .absent import absent_parts
from .numbers import sensitivities_of
from .parts import parts_of
from .recommendation import Least, PartTrial, best_trial, least_scene
from .solver_settings import solver_settings
from .trial_runs import ExactRun, Trial, costs, reference_of, try_changes, with_costs

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
        raise InputError('--tolerance', tolerance, '> 0 and < 1', 'give the relative error that is allowed, as 1e-3')


def advise(scene: Scene, tolerance: float, duration: float, rounds: int, progress: Progress = None) -> Advice:
    """Run a scene of `duration` s in all its variants; `rounds` are the samples of each cost.

    `progress` is called with the share that is done.  Raises InputError, and SolverError when the scene itself cannot
    be run.
    """
    check_tolerance(tolerance)
    if scene.rig.faults:
        raise InputError('faults.ids', [fault.id for fault in scene.rig.faults], 'left out for advice',
                         'the effect of faults belongs to no part of the model')
    if scene.normal_load is not None:
        raise InputError('normal_load.course', scene.values['normal_load.course'], 'left out for advice',
                         'the solvers are compared under a normal force that does not vary')
    reference = reference_of(scene, duration)
    parts, absent, settings = parts_of(reference.scene), absent_parts(reference.scene), solver_settings(scene)
    report = _Progress(len(parts) + len(absent) + len(settings) + _MEASURING, progress)
    found = [best_trial(reference, part) for part in report.through(parts)]
    given = [try_changes(reference, part.name, part.changes) for part in report.through(absent)]
    solved = [try_changes(reference, name, settings[name]) for name in report.through(settings)]
    cost, trials = with_costs(reference, [*(part.trial for part in found), *given, *solved], rounds)
    report.done(_MEASURING)
    coming = iter(trials)
    found = [part._replace(trial=next(coming)) for part in found]
    given, solved = [next(coming) for _ in given], list(coming)
    least = least_scene(reference, found, solved, tolerance)
    side_by_side = costs([reference.scene, least.trial.scene or reference.scene], duration, rounds)
    return Advice(reference, cost, error_estimate(reference.run), tolerance, found, given, solved,
                  _finer_tables(reference), least, (side_by_side[0], side_by_side[1]),
                  sensitivities_of(reference))


def _finer_tables(reference: ExactRun) -> list[Trial]:
    """Return the scene with each table of a smooth law ten times as fine, to see the rest of its error."""
    values = reference.scene.values
    return [try_changes(reference, what, {name: _FINER * float(values[name])})  # type: ignore[arg-type]
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
