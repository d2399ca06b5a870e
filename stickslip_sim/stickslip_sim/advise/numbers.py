# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Which numbers of a scene matter most: by how many percent its motion changes for one percent of each."""

from collections.abc import Iterator
from typing import Any

import numpy as np

from ..core.errors import InputError
from ..sensitivity.rounds import Round
from ..sensitivity.sensitivities import Sensitivities, sensitivities
from ..study.points import works_in_batches
from .trial_runs import ExactRun

_LEAST = 5e-4      # percent for one percent: less is not listed
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


def number_lines(found: Sensitivities) -> Iterator[str]:
    """Yield the table of numbers, those that matter most first."""
    rows = [(name, [f'{value:.3f}' if np.isfinite(value) else 'none' for value in found.relative[:, k]])
            for k, name in _by_size(found)]
    if not rows:
        return
    heads = [name.replace('break_away', 'break-away').replace('_', ' ').replace('.', ' ') for name in found.figures]
    first = max(len('percent for one percent of'), *(len(name) for name, _ in rows))
    yield f'{"percent for one percent of":{first}}  ' + '  '.join(heads)
    for name, cells in rows:
        yield f'{name:{first}}  ' + '  '.join(cell.rjust(len(head)) for cell, head in zip(cells, heads))
    if found.changes:
        yield 'none: the sequence of events changes within a hundred-thousandth of that number (docs/sensitivities.md)'


def numbers_as_json(found: Sensitivities | None) -> dict[str, Any] | None:
    """Return the table as JSON values; a figure without a derivative has null."""
    if found is None:
        return None
    return {name: {figure: float(value) if np.isfinite(value) else None
                   for figure, value in zip(found.figures, found.relative[:, k])} for k, name in _by_size(found)}


def _by_size(found: Sensitivities) -> list[tuple[int, str]]:
    """Return place and name of the numbers that matter, the largest effect first.

    What has no derivative counts 0, and of a number that is 0 there is no percent.
    """
    sizes = np.abs(np.nan_to_num(found.relative, posinf=0.0, neginf=0.0)).max(axis=0)
    jumps = np.isnan(found.derivatives).any(axis=0) & (found.numbers != 0.0)
    return [(int(k), found.parameters[k]) for k in np.argsort(-sizes, kind='stable') if sizes[k] >= _LEAST or jumps[k]]
