# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The race: every contestant and setting over every case, in one process; errors first, then interleaved cost."""

from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import NamedTuple

from ..core.errors import SolverError
from ..core.types import Progress
from ..reference import simulate as simulate_reference
from .accuracy import Errors, Truth, errors_of
from .measure import Cost, cost_sample, measure
from .peers.peer import Peer, Setting
from .problem import Outcome, Problem

RACE_DIGITS = 30        # of the reference
RACE_PATIENCE = 30.0    # s of processor time: a run that would take longer is marked as such, and not waited for
_PARTS = (64, 8)   # of the duration that is run first, to foresee the cost of all of it


class Row(NamedTuple):
    """One contestant with one setting on one case; without errors and cost, `note` says why."""

    contestant: str
    setting: Setting
    version: str
    errors: Errors | None
    cost: Cost | None      # s of processor time for each simulated second
    note: str


class CaseResult(NamedTuple):
    """All rows of a case, in the order of the contestants."""

    problem: Problem
    reference_events: int
    rows: list[Row]


def race(problems: Sequence[Problem], contestants: Sequence[Peer], rounds: int,
         progress: Progress = None) -> list[CaseResult]:
    """Run all; `progress` is called with the share that is done.  Raises InputError when mpmath is missing."""
    results = []
    for k, problem in enumerate(problems):
        results.append(_race_case(problem, contestants, rounds))
        if progress:
            progress((k + 1) / len(problems))
    return results


def truth_of(problem: Problem) -> Truth:
    """Return the result of the reference, right to DIGITS digits."""
    run = simulate_reference(problem.axis, problem.initial, problem.drive, problem.force, problem.duration, RACE_DIGITS)
    return Truth(list(run.events), run.final.position)


def _race_case(problem: Problem, contestants: Sequence[Peer], rounds: int) -> CaseResult:
    truth = truth_of(problem)
    rows: list[Row] = []
    runs: list[Callable[[], Outcome]] = []
    places = []
    for peer in contestants:
        if peer.missing is not None:
            rows.append(Row(peer.name, peer.settings[0], '', None, None, f'not installed ({peer.missing})'))
            continue
        for setting in peer.settings:
            try:
                foreseen = _foresee(peer, problem, setting)
                if foreseen > RACE_PATIENCE:
                    rows.append(Row(peer.name, setting, peer.version(), None, None,
                                    f'left out: a run would take {foreseen:.0f} s or more'))
                    continue
                run = peer.prepare(problem, setting)
                errors = errors_of(run(), truth, problem.duration)
            except SolverError as error:
                rows.append(Row(peer.name, setting, peer.version(), None, None, f'gave up: {error}'))
                continue
            places.append(len(rows))
            runs.append(run)
            rows.append(Row(peer.name, setting, peer.version(), errors, None, ''))
    for place, cost in zip(places, measure(runs, rounds)):
        rows[place] = rows[place]._replace(cost=_per_second(cost, problem.duration))
    return CaseResult(problem, sum(event.kind.name != 'KNOT' for event in truth.events), rows)


def _foresee(peer: Peer, problem: Problem, setting: Setting) -> float:
    """Return the expected cost of a run, from its beginning, s of processor time."""
    foreseen = 0.0
    for part in _PARTS:
        run = peer.prepare(replace(problem, duration=problem.duration / part), setting)
        if part == _PARTS[0]:
            run()   # compilation at the first run does not count
        foreseen = part * cost_sample(run)
        if foreseen > RACE_PATIENCE:
            break
    return foreseen


def _per_second(cost: Cost, duration: float) -> Cost:
    return Cost(cost.median / duration, cost.low / duration, cost.high / duration, cost.samples)
