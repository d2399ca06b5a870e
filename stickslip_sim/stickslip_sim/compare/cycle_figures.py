# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The cycle figures of a run, its ring-down, and how it converges: what `report.json` holds."""

from collections.abc import Sequence
from itertools import pairwise
from typing import Any

import numpy as np

from ..runs import Run
from ..runs.receipt import plain
from ..simulation.cycles import Cycle
from .long_runs import difference
from .ring_down import RING_DOWN, closed_form, identified
from .slip_peaks import SLIP_PEAKS, peak_accelerations
from .statement import Finding, Statement
from .statements import observed

_ROUNDING = 1e-10   # relative: a smaller difference of two cycles says nothing of how they converge


def convergence(cycles: Sequence[Cycle]) -> list[float]:
    """Return by how much each cycle differs from the one before, relative."""
    return [difference(before, cycle) for before, cycle in pairwise(cycles)]


def contraction(changes: Sequence[float]) -> float | None:
    """Return the factor by which the difference from cycle to cycle shrinks; None while there are no two to compare."""
    ratios = [after / before for before, after in pairwise(changes) if after > _ROUNDING]
    return float(np.median(ratios)) if ratios else None


def figures_of(name: str, run: Run, findings: Sequence[tuple[Statement, Finding]]) -> dict[str, Any]:
    """Return all figures of a run by its name, as JSON values, in SI; an infinite number is the text 'inf'."""
    outline, form, found = run.summary, closed_form(run.scene.axis), observed(run).found
    ring = identified(found[RING_DOWN])
    changes = convergence(run.cycles())
    figures = {
        'name': name, 'source': run.source, 'notes': list(run.notes),
        'scene': run.scene.name, 'scene_hash': run.scene.hash,
        'begin': run.begin, 'end': run.end, 'motion': outline.motion, 'settled': outline.settled,
        'stick_share': outline.stick_share,
        'cycles': [{**cycle._asdict(), 'peak_acceleration': peak}
                   for cycle, peak in zip(run.cycles(), peak_accelerations(run, found[SLIP_PEAKS]))],
        'convergence': changes, 'contraction': contraction(changes),
        'ring_down': {'identified': ring and ring._asdict(), 'closed_form': form and form._asdict()},
        'statements': [{'name': statement.name, 'text': statement.text, 'outcome': finding.outcome.value,
                        'finding': finding.text, 'figures': finding.figures} for statement, finding in findings],
    }
    result: dict[str, Any] = plain(figures)
    return result
