# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The outcome of a check as a table for people."""

from collections.abc import Iterator

from ..check.check_report import Checked, checked_line, real_time_verdict
from ..check.observed_run import gaps_in
from ..check.outcomes import LimitOutcome
from ..runs.wording import quantity

_HEADS = ('limit', 'measured', 'at most', 'margin', '', '')
_NUMBERS = (1, 2, 3)   # columns to the right


def table_lines(checked: Checked) -> Iterator[str]:
    """Yield the checked run, whether it kept real time, its missing parts, and a line for each limit."""
    yield checked_line(checked)
    yield from filter(None, [real_time_verdict(checked.run)])
    yield from (f'note: {note}' for note in gaps_in(checked.run))
    rows = [_HEADS, *map(_cells, checked.outcomes)]
    widths = [max(map(len, column)) for column in zip(*rows)]
    for row in rows:
        yield '  '.join(cell.rjust(width) if i in _NUMBERS else cell.ljust(width)
                        for i, (cell, width) in enumerate(zip(row, widths))).rstrip()


def _cells(outcome: LimitOutcome) -> tuple[str, ...]:
    verdict = 'PASS' if outcome.passed else 'FAIL'
    if outcome.limit is None or outcome.value is None or outcome.margin is None:
        return outcome.name, '–', '–', '–', verdict, outcome.remark
    numbers = (quantity(number, outcome.limit.kind.unit)
               for number in (outcome.value, outcome.limit.maximum, outcome.margin))
    return outcome.name, *numbers, verdict, outcome.remark
