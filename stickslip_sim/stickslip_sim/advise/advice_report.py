# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Advice as tables for people and as JSON values."""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import Any

from ..bench.measure import Cost
from ..bench.race_report import machine
from ..runs.receipt import versions
from ..scene import PARAMETERS
from ..scene.text import yaml_value
from .advice import Advice
from .figure_distance import ANOTHER_MOTION
from .numbers import number_lines, numbers_as_json
from .part import Changes
from .solver_settings import EXACT
from .trial_runs import Trial

_BY_NAME = {entry.name: entry for entry in PARAMETERS}
_Row = tuple[str, ...]


def text_lines(advice: Advice) -> Iterator[str]:
    """Yield the tables of parts, of parts that the scene leaves out, of solvers, and of numbers."""
    yield _headline(advice)
    parts = [(_named(found.trial), *_outcome(advice, found.trial), _need(advice, k))
             for k, found in enumerate(advice.parts)]
    absent = [(trial.name, 'identical to the bit' if trial.identical else _outcome(advice, trial)[0],
               *_outcome(advice, trial)[1:], '') for trial in advice.absent]
    solvers = [(trial.name, *_outcome(advice, trial), _verdict(advice, trial)) for trial in advice.solvers]
    yield from _table([
        ('without', 'changes most', 'by', 'cost', f'for {advice.tolerance:g}'), *parts,
        (), ('not in the scene', 'given without effect', 'by', 'cost', ''), *absent,
        (), ('solver', 'differs most', 'by', 'cost', f'within {advice.tolerance:g}'), *solvers])
    yield ''
    if advice.sensitivities is not None:
        yield from number_lines(advice.sensitivities)
        yield ''
    yield from notes(advice)


def notes(advice: Advice) -> Iterator[str]:
    """Yield a sentence for each limit of the tables, and for each trial without a result."""
    run, estimate = advice.reference.run, advice.estimate
    if run.summary.motion == 'at rest':
        yield f'note: nothing slips within {run.duration:g} s; a longer --duration may show more'
    if estimate.until_s < run.duration:
        yield (f'note: this motion is decided by rounding from t = {estimate.until_s:.4g} s on; '
               'choose a shorter --duration')
    if estimate.event_time_s > advice.tolerance * run.duration:
        yield f'note: rounding alone moves events by {estimate.event_time_s:.1e} s, more than the tolerance'
    for trial in advice.tables:
        if trial.difference is not None and trial.difference.largest > advice.tolerance:
            (name, value), = trial.changes.items()
            yield (f'note: the {trial.name} itself is not good enough: made ten times finer (--set {name}={value:g}), '
                   f'it changes the {trial.difference.figure} by {_amount(trial.difference.largest)}')
    for trial in (*(found.trial for found in advice.parts), *advice.solvers):
        if trial.note:
            yield f'note: {_named(trial)}: {trial.note}'


def verdict_lines(advice: Advice, overrides: Changes) -> Iterator[str]:
    """Yield the least scene and its solver in words; `overrides` change the scene into it."""
    least, (whole, reduced) = advice.least, advice.least_cost
    change = least.trial.difference
    parts = f'without {", ".join(least.parts)}' if least.parts else 'all of it'
    yield f'least scene for {advice.tolerance:g}: {parts}'
    if change is not None and not least.trial.identical:
        yield f'  that changes the {change.figure} most, by {_amount(change.largest)}' + (
            f', and costs {_ratio(reduced, whole)}' if whole and reduced else '')
    yield f'solver: {least.solver}{_reason(advice)}'
    if overrides:
        yield '  ' + ' '.join(f'--set {word}' for word in override_words(overrides))


def override_words(overrides: Changes) -> list[str]:
    """Return changes as the tool takes them after --set, quoted for a shell where they must be."""
    words = (f'{name}={yaml_value(_BY_NAME[name], value)}' for name, value in overrides.items())
    return [f"'{word}'" if '[' in word or ' ' in word else word for word in words]


def advice_as_json(advice: Advice, overrides: Changes) -> dict[str, Any]:
    """Return everything that was found; an infinite difference is the text 'inf'."""
    reference, least = advice.reference, advice.least
    return {
        'scene': reference.scene.name, 'scene_hash': reference.scene.hash, 'duration': reference.run.duration,
        'tolerance': advice.tolerance, 'versions': versions(), 'machine': machine(),
        'motion': reference.figures.motion, 'cycles': len(reference.figures.cycles),
        'cost_per_simulated_second': _cost(advice.cost), 'error_estimate': advice.estimate._asdict(),
        'parts': [{**_trial(found.trial), 'needed': is_needed(advice, k)} for k, found in enumerate(advice.parts)],
        'not_in_the_scene': [_trial(trial) for trial in advice.absent],
        'solvers': [_trial(trial) for trial in advice.solvers],
        'numbers': numbers_as_json(advice.sensitivities),
        'finer_tables': [_trial(trial) for trial in advice.tables],
        'least': {**_trial(least.trial), 'changes': _plain(overrides), 'without': list(least.parts),
                  'solver': least.solver, 'cost_of_whole': _cost(advice.least_cost[0]),
                  'cost_per_simulated_second': _cost(advice.least_cost[1])},
        'notes': list(notes(advice)),
    }


def is_needed(advice: Advice, k: int) -> bool:
    """Return whether the least scene still has the part number `k`."""
    part, scene = advice.parts[k].part, advice.least.trial.scene
    return scene is None or any(variant.changes(scene.values) for variant in part.variants)


def _need(advice: Advice, k: int) -> str:
    if is_needed(advice, k):
        return 'needed'
    return 'no' if _is_within(advice, advice.parts[k].trial) else 'goes with another'


def _headline(advice: Advice) -> str:
    figures, cost = advice.reference.figures, advice.cost
    cycles = f' ({len(figures.cycles)} cycles)' if figures.cycles else ''
    price = f'{cost.median * 1e6:.3g} µs per simulated second; ' if cost else ''
    return (f'{advice.reference.scene.name}: {figures.motion}{cycles} in {figures.duration:g} s; with everything on '
            f'{price}events right to {advice.estimate.event_time_s:.1g} s\n')


def _reason(advice: Advice) -> str:
    exact = next(trial for trial in advice.solvers if trial.name == EXACT)
    others = [trial for trial in advice.solvers if trial.name != EXACT and trial.cost and _is_within(advice, trial)]
    if advice.least.solver != EXACT or exact.cost is None:
        return ', the cheapest that keeps this tolerance'
    if not others:
        return '; no other keeps this tolerance'
    best = min(others, key=lambda trial: trial.cost.median if trial.cost else 0.0)
    return f'; the next that keeps this tolerance, {best.name}, costs {_ratio(best.cost, exact.cost)}'


def _is_within(advice: Advice, trial: Trial) -> bool:
    return trial.difference is not None and trial.difference.largest <= advice.tolerance


def _verdict(advice: Advice, trial: Trial) -> str:
    return 'yes' if _is_within(advice, trial) else 'no'


def _named(trial: Trial) -> str:
    return f'{trial.name} ({trial.how})' if trial.how else trial.name


def _outcome(advice: Advice, trial: Trial) -> tuple[str, str, str]:
    if trial.difference is None:
        return 'see the note', '', ''
    change = trial.difference
    by = '' if change.figure == ANOTHER_MOTION or change.largest == 0.0 else _amount(change.largest)
    return change.figure if change.largest > 0.0 else 'nothing', by, _ratio(trial.cost, advice.cost)


def _amount(value: float) -> str:
    return f'{value:.1e}'


def _ratio(cost: Cost | None, whole: Cost | None) -> str:
    if cost is None or whole is None or whole.median == 0.0:
        return ''
    ratio = cost.median / whole.median
    return f'× {ratio:.0f}' if ratio >= 100.0 else f'× {ratio:.3g}' if ratio >= 10.0 else f'× {ratio:.2f}'


def _table(rows: Sequence[_Row]) -> Iterable[str]:
    widths = [max(len(row[i]) for row in rows if row) for i in range(5)]
    for row in rows:
        cells = (cell.rjust(width) if i == 3 else cell.ljust(width) for i, (cell, width) in enumerate(zip(row, widths)))
        yield '  '.join(cells).rstrip()


def _trial(trial: Trial) -> dict[str, Any]:
    change = trial.difference
    return {'name': trial.name, 'how': trial.how, 'changes': _plain(trial.changes), 'identical': trial.identical,
            'figure': change.figure if change else None, 'largest': _plain_number(change.largest) if change else None,
            'by_figure': {name: _plain_number(value) for name, value in change.by_figure.items()} if change else {},
            'cost_per_simulated_second': _cost(trial.cost), 'note': trial.note}


def _plain(changes: Mapping[str, Any]) -> dict[str, Any]:
    return {name: list(value) if isinstance(value, tuple) else _plain_number(value)
            for name, value in changes.items()}


def _plain_number(value: Any) -> Any:
    return str(value) if value == float('inf') else value


def _cost(cost: Cost | None) -> dict[str, Any] | None:
    return cost._asdict() if cost else None
