# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Advice as tables for people and as JSON values."""

from collections.abc import Iterator
from typing import Any

import numpy as np

from ..bench.race import Cost
from ..bench.report import machine
from ..figures.distance import ANOTHER_MOTION
from ..report.model import NOTE, Part, Section, Sentence, Table
from ..report.values import versions
from ..scene import PARAMETERS, scene_from_values
from ..scene.load import values_in_file
from ..scene.values import scene_text, yaml_value
from ..sensitivity.sensitivities import Sensitivities
from .advice import Advice
from .parts import Changes, without_idle_sinusoids
from .trial_runs import EXACT, Trial

_BY_NAME = {entry.name: entry for entry in PARAMETERS}
_LEAST = 5e-4      # percent for one percent: less is not listed


def advice_report(advice: Advice) -> Iterator[Part]:
    """Yield the tables of parts, of parts that the scene leaves out, of solvers, and of numbers."""
    yield from (_headline(advice), '')
    parts = [(_named(found.trial), *_outcome(advice, found.trial), _need(advice, k))
             for k, found in enumerate(advice.parts)]
    absent = [(trial.name, 'identical to the bit' if trial.identical else _outcome(advice, trial)[0],
               *_outcome(advice, trial)[1:]) for trial in advice.absent]
    solvers = [(trial.name, *_outcome(advice, trial), 'yes' if _is_within(advice, trial) else 'no')
               for trial in advice.solvers]
    yield Table(('without', 'changes most', 'by', 'cost', f'for {advice.tolerance:g}'), [
        *parts,
        (), ('not in the scene', 'given without effect', 'by', 'cost'), *absent,
        (), ('solver', 'differs most', 'by', 'cost', f'within {advice.tolerance:g}'), *solvers], texts=(0, 1, 2, 4))
    yield ''
    if advice.sensitivities is not None:
        yield from (*numbers_report(advice.sensitivities), '')
    yield from (Sentence(note, NOTE) for note in notes(advice))


def numbers_report(found: Sensitivities) -> Iterator[Part]:
    """Yield the table of numbers, those that matter most first."""
    rows = [(name, *(f'{value:.3f}' if np.isfinite(value) else 'none' for value in found.relative[:, k]))
            for k, name in _by_size(found)]
    if rows:
        heads = (name.replace('break_away', 'break-away').replace('_', ' ').replace('.', ' ') for name in found.figures)
        yield Table(('percent for one percent of', *heads), rows)
        if found.changes:
            yield ('none: the sequence of events changes within a hundred-thousandth of that number '
                   '(docs/sensitivities.md)')


def numbers_as_values(found: Sensitivities | None) -> dict[str, Any] | None:
    """Return the table of numbers; a figure without a derivative has None."""
    return None if found is None else {
        name: {figure: value if np.isfinite(value) else None
               for figure, value in zip(found.figures, found.relative[:, k].tolist())} for k, name in _by_size(found)}


def _by_size(found: Sensitivities) -> list[tuple[int, str]]:
    """Return place and name of the numbers that matter, the largest effect first.

    What has no derivative counts 0, and of a number that is 0 there is no percent.
    """
    sizes = np.abs(np.nan_to_num(found.relative, posinf=0.0, neginf=0.0)).max(axis=0)
    jumps = np.isnan(found.derivatives).any(axis=0) & (found.numbers != 0.0)
    return [(int(k), found.parameters[k]) for k in np.argsort(-sizes, kind='stable') if sizes[k] >= _LEAST or jumps[k]]


def notes(advice: Advice) -> Iterator[str]:
    """Yield a sentence for each limit of the tables, and for each trial without a result."""
    run, estimate = advice.reference.run, advice.estimate
    if run.summary.motion == 'at rest':
        yield f'nothing slips within {run.duration:g} s; a longer --duration may show more'
    if estimate.until_s < run.duration:
        yield (f'this motion is decided by rounding from t = {estimate.until_s:.4g} s on; '
               'choose a shorter --duration')
    if estimate.event_time_s > advice.tolerance * run.duration:
        yield f'rounding alone moves events by {estimate.event_time_s:.1e} s, more than the tolerance'
    for trial in advice.tables:
        if trial.difference is not None and trial.difference.largest > advice.tolerance:
            (name, value), = trial.changes.items()
            yield (f'the {trial.name} itself is not good enough: made ten times finer (--set {name}={value:g}), '
                   f'it changes the {trial.difference.figure} by {_amount(trial.difference.largest)}')
    for trial in (*(found.trial for found in advice.parts), *advice.solvers):
        if trial.note:
            yield f'{_named(trial)}: {trial.note}'


def verdict_report(advice: Advice, overrides: Changes) -> Iterator[Part]:
    """Yield the least scene and its solver in words; `overrides` change the scene into it."""
    least, (whole, reduced) = advice.least, advice.least_cost
    change = least.trial.difference
    parts = f'without {", ".join(least.parts)}' if least.parts else 'all of it'
    costs = f', and costs {_ratio(reduced, whole)}' if whole and reduced else ''
    yield Section(f'least scene for {advice.tolerance:g}: {parts}', [] if change is None or least.trial.identical else [
        f'that changes the {change.figure} most, by {_amount(change.largest)}{costs}'])
    yield Section(f'solver: {least.solver}{_reason(advice)}', [
        ' '.join(f'--set {word}' for word in override_words(overrides))] if overrides else [])


def override_words(overrides: Changes) -> list[str]:
    """Return changes as the tool takes them after --set, quoted for a shell where they must be."""
    words = (f'{name}={yaml_value(_BY_NAME[name], value)}' for name, value in overrides.items())
    return [f"'{word}'" if '[' in word or ' ' in word else word for word in words]


def least_scene_lines(advice: Advice) -> list[str]:
    """Return the file of the least scene, with a comment that says what it is."""
    least = advice.least
    scene = scene_from_values(without_idle_sinusoids((least.trial.scene or advice.reference.scene).values))
    without = f' without {", ".join(least.parts)}' if least.parts else ''
    return [f'# {scene.name}{without}: the least for a relative error of {advice.tolerance:g}.\n',
            scene_text(values_in_file(scene))]


def advice_as_values(advice: Advice, overrides: Changes) -> dict[str, Any]:
    """Return everything that was found."""
    reference, least = advice.reference, advice.least
    return {
        'scene': reference.scene.name, 'scene_hash': reference.scene.hash, 'duration': reference.run.duration,
        'tolerance': advice.tolerance, 'versions': versions(), 'machine': machine(),
        'motion': reference.figures.motion, 'cycles': len(reference.figures.cycles),
        'cost_per_simulated_second': advice.cost, 'error_estimate': advice.estimate,
        'parts': [{**_trial(found.trial), 'needed': is_needed(advice, k)} for k, found in enumerate(advice.parts)],
        'not_in_the_scene': [*map(_trial, advice.absent)], 'solvers': [*map(_trial, advice.solvers)],
        'numbers': numbers_as_values(advice.sensitivities), 'finer_tables': [*map(_trial, advice.tables)],
        'least': {**_trial(least.trial), 'changes': overrides, 'without': least.parts, 'solver': least.solver,
                  'cost_of_whole': advice.least_cost[0], 'cost_per_simulated_second': advice.least_cost[1]},
        'notes': [f'note: {note}' for note in notes(advice)],
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
            f'{price}events right to {advice.estimate.event_time_s:.1g} s')


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


def _trial(trial: Trial) -> dict[str, Any]:
    change = trial.difference
    return {'name': trial.name, 'how': trial.how, 'changes': trial.changes, 'identical': trial.identical,
            'figure': change and change.figure, 'largest': change and change.largest,
            'by_figure': change.by_figure if change else {}, 'cost_per_simulated_second': trial.cost,
            'note': trial.note}
