# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Many closed loops for people: how many pass, each limit, percentiles, and why points failed."""

from collections import Counter
from collections.abc import Iterator

import numpy as np

from ..report.model import NOTE, Part, Sentence, Table
from ..report.quantity import counted, quantities, quantity
from ..study.uncertainty import PERCENTS
from .many import ClosedLoops

_LABEL, _CELL = 22, 11   # columns of a terminal
_ROWS = 20               # of the matrix on a terminal
_REASONS = 5


def loops_report(found: ClosedLoops) -> Iterator[Part]:
    """Yield the pass rate, what each limit came to, the matrix of the points that failed, percentiles and reasons."""
    study, rate = found.study, found.pass_rate
    counts = ', '.join(f'{count} {word}' for word, count in Counter(found.outcomes).most_common())
    yield (f'{study.scene.name}: {counted(study.count, "point")} of {", ".join(study.names)}, {found.ran} run now: '
           f'{counts}')
    yield (f'{rate.passed} of {rate.points} pass: {rate.passed / rate.points:.2%}, between {rate.low:.2%} and '
           f'{rate.high:.2%} with 95 % confidence')
    yield from _limits(found)
    yield from _matrix(found)
    yield _percentiles(found)
    for i, reason in list(found.reasons.items())[:_REASONS]:
        at = ', '.join(f'{name} = {number:g}' for name, number in found.point(i).items())
        yield Sentence(f'point {i} ({at}): {reason}', NOTE)
    failed = sum(word not in ('passed', 'limits missed') for word in found.outcomes)
    if failed > _REASONS:
        yield Sentence(f'{failed - _REASONS} more points failed: see column outcome', NOTE)


def _limits(found: ClosedLoops) -> Iterator[Part]:
    limits = found.study.limits
    if not limits:
        return
    rows = []
    for limit, kept in zip(limits.limits, found.matrix.sum(axis=0).tolist()):
        worst = found.worst.get(limit.name)
        value = '–' if worst is None else quantity(float(found.columns[limit.name][worst]), limit.kind.unit)
        bound = quantity(limit.bound, limit.kind.unit)
        rows.append((limit.name, f'{kept} of {found.study.count}',
                     f'at least {bound}' if limit.kind.is_least else bound, value,
                     '–' if worst is None else str(worst)))
    yield Table(('limit', 'kept', 'at most', 'worst', 'at point'), rows)


def _matrix(found: ClosedLoops) -> Iterator[Part]:
    """Yield which limits the first points that failed have missed."""
    failed = np.flatnonzero(found.columns['outcome'] != 0.0).tolist()
    if not failed or not found.study.limit_names:
        return
    caption = f'the first {_ROWS} of {len(failed)} points that fail' if len(failed) > _ROWS else ''
    yield Table(('point', *found.study.names, *found.study.limit_names),
                [(str(i), *(f'{number:.5g}' for number in found.point(i).values()),
                  *('PASS' if kept else 'FAIL' for kept in found.matrix[i].tolist())) for i in failed[:_ROWS]], caption)


def _percentiles(found: ClosedLoops) -> Table:
    limits = found.study.limits
    units = {limit.name: limit.kind.unit for limit in (limits.limits if limits else ())}
    return Table(('', *(f'{percent} %' for percent in PERCENTS)),
                 [(name, *(quantities(list(of.values()), units.get(name, 's' if name == 'until' else 'm'), 4)
                           if of else ['none'])) for name, of in found.percentiles.items()],
                 least=(_LABEL, *[_CELL] * len(PERCENTS)))
