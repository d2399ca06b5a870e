# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The least scene for a tolerance, and the solver for it: from trials, and confirmed by runs of the advised scene."""

from collections.abc import Sequence
from typing import NamedTuple

from ..scene import changed
from .part import Changes, Part, Variant
from .solver_settings import EXACT
from .trial_runs import ExactRun, Trial, changes_between, try_changes

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
    trials = [PartTrial(part, variant, try_changes(reference, part.name, changes, variant.how))
              for variant in part.variants if (changes := variant.changes(reference.scene.values))]
    return min(trials, key=lambda found: _size(found.trial))


def least_scene(reference: ExactRun, trials: Sequence[PartTrial], solvers: Sequence[Trial],
                tolerance: float) -> Least:
    """Leave out one part after the other, those that change least first, as long as all together stay in tolerance.

    Then take the cheapest solver that keeps the whole in tolerance, too.
    """
    values, left_out = reference.scene, try_changes(reference, EXACT, {})
    parts: list[str] = []
    for found in sorted(trials, key=lambda found: _size(found.trial)):
        changes = found.variant.changes(values.values)
        if _size(found.trial) > tolerance or not changes:
            continue
        together = changes_between(reference.scene, changed(values, changes))
        trial = try_changes(reference, EXACT, together)
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
        trial = try_changes(reference, rival.name, changes)
        if _size(trial) <= tolerance:
            return Least(least.parts, rival.name, changes, trial)
    return least


def _size(trial: Trial) -> float:
    return trial.difference.largest if trial.difference is not None else float('inf')
