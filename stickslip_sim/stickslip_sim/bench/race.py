# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The race: every contestant and setting over every case, in one process; errors first, then interleaved cost.

What counts as an error are the events at which the slider starts or stops (break-away, stick, reverse), because every
solver has them; the sub-modes of a slip are compared too, apart.  Events of one kind and direction are paired in order,
so that the sum of their distances in time is least; a pair further apart than half the usual distance of such events is
none.
"""

import statistics
import time
from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import NamedTuple

from ..core.errors import SolverError
from ..core.types import Event, EventKind, Progress
from ..figures.distance import CYCLE_EVENTS, pair, window
from ..reference import simulate as simulate_reference
from .problem import Outcome, Peer, Problem, Setting

SHORTEST = 2e-3   # s: shorter runs are repeated until a sample takes as long
ENOUGH = 2.5      # s: when the samples of a run have taken that long together, no more are taken


class Cost(NamedTuple):
    """Of one run: median and quartiles over `samples`, s."""

    median: float
    low: float
    high: float
    samples: int


def measure(runs: Sequence[Callable[[], object]], rounds: int) -> list[Cost]:
    """Return the cost of each run; in each round each has its turn, so that none has the quiet minutes to itself.

    The runs must have run once already.
    """
    repeats = [_repeats(run) for run in runs]
    samples: list[list[float]] = [[] for _ in runs]
    for _ in range(rounds):
        for run, count, costs in zip(runs, repeats, samples):
            if sum(costs) < ENOUGH:
                costs.append(cost_sample(run, count))
    return [_cost(costs) for costs in samples]


def cost_sample(run: Callable[[], object], count: int = 1) -> float:
    """Return the cost of a run, the mean of `count` in a row."""
    begin = time.process_time()
    for _ in range(count):
        run()
    return (time.process_time() - begin) / count


def _repeats(run: Callable[[], object]) -> int:
    return max(1, round(SHORTEST / max(cost_sample(run), 1e-7)))


def _cost(samples: Sequence[float]) -> Cost:
    if len(samples) == 1:
        return Cost(samples[0], samples[0], samples[0], 1)
    low, median, high = statistics.quantiles(samples, n=4, method='inclusive')
    return Cost(median, low, high, len(samples))


RACE_DIGITS = 30        # of the reference
RACE_PATIENCE = 30.0    # s of processor time: a run that would take longer is marked as such, and not waited for
_PARTS = (64, 8)   # of the duration that is run first, to foresee the cost of all of it
_SUB_MODES = (EventKind.COAST, EventKind.ACCELERATE, EventKind.DECELERATE)


class Errors(NamedTuple):
    """Of one run against the reference; times in s, positions in m, the worst over the pairs."""

    events: int
    reference_events: int
    missed: int
    invented: int
    time: float
    position: float
    end_position: float
    sub_modes_missed: int
    sub_modes_invented: int
    sub_modes_time: float


class Truth(NamedTuple):
    """The result of the reference: events, and the position at the end, m."""

    events: list[Event]
    position: float


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


class _Pairing(NamedTuple):
    missed: int
    invented: int
    time: float
    position: float


def errors_of(outcome: Outcome, truth: Truth, duration: float) -> Errors:
    """Compare a run of `duration` seconds with the reference."""
    boundaries = _compare(outcome, truth, CYCLE_EVENTS, duration)
    sub_modes = _compare(outcome, truth, _SUB_MODES, duration)
    kinds = [int(kind) for kind in outcome.events[:, 1]]
    return Errors(sum(kind in CYCLE_EVENTS for kind in kinds), sum(e.kind in CYCLE_EVENTS for e in truth.events),
                  boundaries.missed, boundaries.invented, boundaries.time, boundaries.position,
                  abs(outcome.position - truth.position), sub_modes.missed, sub_modes.invented, sub_modes.time)


def _compare(outcome: Outcome, truth: Truth, kinds: Sequence[EventKind], duration: float) -> _Pairing:
    missed = invented = 0
    time = position = 0.0
    for kind in kinds:
        for direction in (-1, 1):
            want = [(e.time, e.position) for e in truth.events if e.kind == kind and e.direction == direction]
            got = [(row[0], row[3]) for row in outcome.events.tolist() if row[1] == kind and row[2] == direction]
            pairs = pair(want, got, window(want, duration))
            missed += len(want) - len(pairs)
            invented += len(got) - len(pairs)
            time = max([time, *(abs(a[0] - b[0]) for a, b in pairs)])
            position = max([position, *(abs(a[1] - b[1]) for a, b in pairs)])
    return _Pairing(missed, invented, time, position)
