# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Sweeps, critical values and uncertain scenes: for people, and as JSON values."""

import math
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

import numpy as np

from ..core.arrays import Numbers
from ..figures.catalogue import unit_of
from ..figures.point_figures import MOTIONS, Motion
from ..report.model import Part, Section, Table, facts
from ..report.quantity import counted, quantities
from ..scene import Scene
from . import critical
from .answer_changes import NO, YES, Findings, Transition
from .critical import ACCURACY, STARTS, Critical, CriticalSpread, CriticalStudy, TableFact
from .sample import LAWS, Saltelli
from .study import Study
from .sweep import Swept
from .table import TableColumns
from .uncertainty import PERCENTS, Index, Uncertainty
from .variation import with_place

_LABEL, _CELL = 22, 11    # columns of a terminal
_START = 13
_DIGITS = 12              # of ends that are too small or large to be written out


def sweep_report(study: Study, swept: Swept) -> Iterator[Part]:
    """Yield how many points move how."""
    columns = swept.columns
    counts = Counter(MOTIONS[Motion(int(motion))] for motion in columns['motion'])
    motions = ', '.join(f'{count} {word}' for word, count in counts.most_common())
    named = np.isin(columns['motion'], (Motion.UNDECIDED, Motion.SWINGS_ON))
    unsettled = int(((columns['settled'] == 0.0) & ~named).sum())
    yield (f'{study.scene.name}: {study.count} points, {swept.ran} of them run now: {motions}'
           + (f'; {unsettled} had not settled' if unsettled else ''))
    yield from failed_report(study, columns)


def failed_report(study: Study, columns: TableColumns) -> Iterator[Part]:
    """Yield how many points of a study failed, if any did."""
    failed = int((columns['motion'] == Motion.FAILED).sum())
    if failed:
        yield (f'{failed} of {study.count} points failed: the {study.scene.solver.name} engine gave up; see column '
               'motion')


# The critical values of one scene.

def critical_report(scene: Scene, found: Critical) -> Iterator[Part]:
    """Yield the transitions from rest and from sliding, what decides them, and the closed form where there is one."""
    over = found.over
    unit, digits = _unit(over.unit), max(3, math.ceil(-math.log10(found.accuracy)) + 1)
    yield (f'{scene.name}: {with_place(scene.values, over.name)} from {over.low:g} to {over.high:g}{unit}, '
           f'to {found.accuracy:g} of the value')
    rows = [*_of_start('from rest', found.from_rest, unit, digits, 'stick-slip', 'no stick-slip'),
            *_of_start('from sliding', found.from_sliding, unit, digits, 'sliding is lost', 'sliding lasts'),
            *(('bistable', f'from {low:.6g} to {high:.6g}{unit} both go on: the start decides')
              for low, high in found.both),
            *(('by the table', _decided(fact, unit, digits)) for fact in found.by_table)]
    if found.by_table and critical.breakpoints_between(scene):
        rows.append(('', 'a smooth law may have another value; stickslip friction fits one to points'))
    theory = critical.feed_of_theory(scene.axis) if over.name == 'drive.velocity' else None
    if theory is not None:
        rows.append(('closed form', f'{theory:.{digits + 2}g}{unit}, from rest'))
    yield facts(rows, _START)


def _unit(unit: str) -> str:
    return f' {unit}'.rstrip()


def _decided(fact: TableFact, unit: str, digits: int) -> str:
    """Return what of a table of friction decides a critical value."""
    which = f'{fact.value:.{digits}g}{unit} from {"sliding" if fact.from_sliding else "rest"}: '
    if fact.breakpoint is not None:
        return f'{which}the feed is a breakpoint, {fact.table}[{fact.breakpoint}]; there the slope of mu_k jumps'
    end = 'm/s on' if math.isinf(fact.high) else f'to {fact.high:g} m/s'
    return f'{which}the straight segment of mu_k from {fact.low:g} {end} decides'


def _of_start(start: str, findings: Findings, unit: str, digits: int, yes: str, no: str) -> list[tuple[str, str]]:
    """Return each transition of the findings, or that there is none, and each stretch in doubt."""
    found = [(one.low, f'{_value(one, unit, digits)}: '
              + (f'{no} below, {yes} above' if one.rises else f'{yes} below, {no} above'))
             for one in findings.transitions]
    if not found and findings.first >= NO:
        where = 'elsewhere in' if findings.doubts else 'all over'
        found = [(-math.inf, f'no transition: {yes if findings.first == YES else no} {where} the range')]
    found += [(one.low, f'{_stretch("from {} to {}", one.low, one.high, unit)}: {_why(one.failed)}')
              for one in findings.doubts]
    return [(start, text) for _, text in sorted(found)]


def _value(one: Transition, unit: str, digits: int) -> str:
    if one.resolved:
        return f'{one.value:.{digits}g}{unit}'
    return f'{_stretch("between {} and {}", one.low, one.high, unit)}, {_why(one.failed)}'


def _why(failed: bool) -> str:
    return 'not known, the exact engine gave up' if failed else 'undecided'


def _stretch(words: str, low: float, high: float, unit: str) -> str:
    """Return a stretch with as many digits as its length has a use for, rounded outwards."""
    step = 10.0 ** (math.floor(math.log10(high - low)) - 1)
    decimals = max(0, -round(math.log10(step)))
    ends = math.floor(low / step) * step, math.ceil(high / step) * step
    return words.format(*(f'{end:.{decimals}f}' if 1e-4 <= abs(end) < 1e9 else f'{end:.{_DIGITS}g}' for end in ends)
                        ) + unit


# Scenes that are known only roughly: how their motion spreads, or a critical value.

def uncertainty_report(study: Study, sample: Saltelli, swept: Swept, found: Uncertainty) -> Iterator[Part]:
    """Yield the distributions, the share of stick-slip, percentiles and indices."""
    yield f'{_size(study, sample)}, {swept.ran} run now'
    yield from failed_report(study, swept.columns)
    yield from (*_laws(study, sample), '')
    if study.scene.axis.friction.static.scatter is not None:
        yield f'static friction scatters: each sample has a seed of its own, from {study.scene.seed} on'
    share = 'a share that is not known' if found.stick_slip is None else f'{found.stick_slip:.2%}'
    points = f'{found.points} independent points'
    known = points if found.known == found.points else f'those {found.known} of {points} where it is known'
    doubts = ((found.failed, 'failed'), (found.undecided, 'undecided'), (found.unsettled, 'had not settled'))
    yield f'stick-slip in {share} of {known}' + ''.join(f', {count} {what}' for count, what in doubts if count)
    yield percentiles_table('of those', [(name, unit_of(name), values) for name, values in found.percentiles.items()])
    yield from ('', *_indices(study, sample, found.indices), '')


def spread_report(sought: CriticalStudy, sample: Saltelli, spreads: Mapping[str, CriticalSpread]) -> Iterator[Part]:
    """Yield the distributions, percentiles of the critical values, and indices."""
    study, over = sought.study, sought.over
    yield _size(study, sample)
    yield (f'critical {over.name} from {over.low:g} to {over.high:g}{_unit(over.unit)}, the highest one, '
           f'to {ACCURACY:g} of the value')
    yield from (*_laws(study, sample), '')
    title: str | None = f'critical {over.name}'
    for start, one in spreads.items():
        yield percentiles_table(title, [(_words(start), over.unit, one.percentiles)])
        title = None
        does = 'sticks and slips' if start == 'from_rest' else 'loses sliding'
        others = [f'{count} {what}' for count, what in (
            (one.all_over, f'where it {does} all over the range'), (one.nowhere, f'where it nowhere {does}'),
            (one.unknown, 'where it is not decided')) if count]
        if others:
            yield f'{"":{_LABEL}} of {one.points} independent points, but ' + ', '.join(others)
    yield from ('', *_indices(study, sample, {_words(start): one.indices for start, one in spreads.items()}), '')


def uncertainty_values(sample: Saltelli, found: Uncertainty) -> dict[str, Any]:
    """Return all that was found of a scene."""
    return {'samples': sample.samples, 'seed': sample.seed, 'points': found.points, 'known': found.known,
            'failed': found.failed, 'undecided': found.undecided, 'unsettled': found.unsettled, **_kept(sample),
            'stick_slip': found.stick_slip,
            'percentiles': {name: _by_percent(values) for name, values in found.percentiles.items()},
            'indices': found.indices}


def spread_values(sought: CriticalStudy, sample: Saltelli, spreads: Mapping[str, CriticalSpread]) -> dict[str, Any]:
    """Return all that was found of a critical value."""
    scene, over = sought.study.scene, sought.over
    return {'scene': scene.name, 'scene_hash': scene.hash, 'samples': sample.samples, 'seed': sample.seed,
            'critical': over.name, 'unit': over.unit, 'between': [over.low, over.high], **_kept(sample),
            **{start: {'points': one.points, 'all_over': one.all_over, 'nowhere': one.nowhere, 'unknown': one.unknown,
                       'percentiles': _by_percent(one.percentiles), 'indices': one.indices}
               for start, one in spreads.items()}}


def critical_lines(study: CriticalStudy, values: Numbers) -> Iterator[str]:
    """Yield a line of names, then a line for each point; a value that is not known stays empty."""
    yield ','.join((*study.study.names, *(f'critical_{start}' for start in STARTS))) + '\n'
    for row in np.column_stack([study.study.points(0, study.study.count), values]).tolist():
        yield ','.join('' if number != number else repr(number) for number in row) + '\n'


def _size(study: Study, sample: Saltelli) -> str:
    return (f'{study.scene.name}: {sample.samples} samples of {counted(len(study.names), "parameter")}, '
            f'{study.count} points')


def _labels(study: Study) -> dict[str, str]:
    return {name: with_place(study.values, name) for name in study.names}


def _laws(study: Study, sample: Saltelli) -> Iterator[str]:
    """Yield the distribution of each parameter, the share that was cut off, and the pair that is correlated most."""
    labels = _labels(study)
    for one in sample.variations:
        numbers = ', '.join(f'{name} {number:g}' for name, number in zip(LAWS[one.law].numbers, one.numbers))
        cut = f', cut to {one.low:g} .. {one.high:g} ({1.0 - one.kept:.2g} off)' if LAWS[one.law].ends else ''
        unit = f' ({one.unit})' if one.unit else ''
        yield f'  {labels[one.name]}{unit}: {one.law}, {numbers}{cut}'
    if sample.correlations is not None:
        names = list(labels.values())
        size, number, first, second = max((abs(number), number, names[i], names[j])
                                          for i, row in enumerate(sample.correlations)
                                          for j, number in enumerate(row[:i]))
        yield '  correlated: ' + (f'most of all {first} with {second}, {number:+.3g}' if size else 'none')


def percentiles_table(title: str | None, rows: Sequence[tuple[str, str, Sequence[float] | None]]) -> Table:
    """Return the percentiles of quantities with their units, below a title unless that is None."""
    heads = () if title is None else (title, *(f'{percent} %' for percent in PERCENTS))
    return Table(heads, [(name, *(quantities(values, unit, 4) if values else ['none'])) for name, unit, values in rows],
                 least=(_LABEL, *[_CELL] * len(PERCENTS)))


def _indices(study: Study, sample: Saltelli, indices: Mapping[str, Mapping[str, Index] | None]) -> Iterator[Part]:
    """Yield the first-order indices of each figure that has them."""
    if sample.correlations:
        yield 'share of the variance that one parameter explains: none of correlated ones, which vary together'
        return
    yield 'share of the variance that one parameter explains by itself (and with its interactions)'
    labels = _labels(study)
    width = max(_LABEL, *map(len, labels.values()))
    for figure, of in indices.items():
        if of is None:
            yield facts([(figure, 'none: not every point has it, or all have the same')], _LABEL - 1)
        else:
            ordered = sorted(of.items(), key=lambda each: -each[1].first_order)
            yield Section(figure, [facts([(labels[name], _index(one)) for name, one in ordered], width)])


def _index(one: Index) -> str:
    return f'{one.first_order:6.3f} ± {one.error:.3f}  ({one.total:.3f} ± {one.total_error:.3f})'


def _kept(sample: Saltelli) -> dict[str, Any]:
    return {'kept_of_distributions': {one.name: one.kept for one in sample.variations}}


def _by_percent(values: Sequence[float] | None) -> dict[str, float] | None:
    return dict(zip(map(str, PERCENTS), values)) if values else None


def _words(start: str) -> str:
    return start.replace('_', ' ')
