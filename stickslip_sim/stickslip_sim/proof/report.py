# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The table of the extremes as text for people, as Markdown and as JSON."""

import json
import math
from collections.abc import Sequence

from ..report.markdown import markdown_lines
from ..report.model import Section, Table
from ..report.values import versions
from .judges import ExtremeResult

_MARK = 52   # columns


def table_head() -> str:
    """Return the head of the table."""
    return f'{"":4} {"":6} {"mark":{_MARK}}  measured'


def row(outcome: ExtremeResult) -> list[str]:
    """Return the lines of an extreme: its name, verdict, mark and measured figure, and the cases that missed."""
    verdict = 'met' if outcome.passed else 'MISSED'
    lines = [f'{outcome.extreme.number:4} {outcome.extreme.name}',
             f'{"":4} {verdict:6} {outcome.extreme.mark:{_MARK}}  {outcome.finding.figure}  ({outcome.seconds:.1f} s)']
    return lines + [f'{"":11} {example}' for example in outcome.finding.examples]


def markdown_text(outcomes: Sequence[ExtremeResult], quick: bool) -> str:
    """Return the page `docs/extremes.md`."""
    met = sum(outcome.passed for outcome in outcomes)
    size = ' --quick' if quick else ''
    known = ', '.join(f'{name} {version}' for name, version in versions().items())
    rows = [(found.extreme.number, found.extreme.name, found.extreme.elsewhere, found.extreme.mark,
             found.finding.figure, 'yes' if found.passed else '**no**') for found in outcomes]
    page = Section('The extremes', [
        'See here how this engine does in the cases that break other simulators: each case has a mark and the\n'
        f'measured figure.  `stickslip extremes{size} --out docs/extremes.md` writes this page; `make extremes`\n'
        'measures again and fails when a mark is missed.',
        f'{met} of {len(outcomes)} marks met; {known}.',
        'The column "elsewhere" was measured on the paper\'s data with scipy 1.17, SUNDIALS CVODE (scikit-sundae\n'
        '1.2), heyoka 7.13, MuJoCo 4.0 and Drake 1.51, or is taken from their documentation and issues.  From X22\n'
        'on it has the results of stickslip 0.1.0; [an attack](accuracy_method.md#what-an-attack-found) found\n'
        'these.',
        Table(('#', 'extreme', 'elsewhere', 'mark', 'measured', 'met'), rows)])
    return '\n'.join(markdown_lines([page], level=1))


def json_text(outcomes: Sequence[ExtremeResult], quick: bool) -> str:
    """Return the table as JSON, with the versions it holds for."""
    rows = [_row(outcome) for outcome in outcomes]
    document = {'size': 'reduced' if quick else 'full', 'versions': versions(),
                'passed': all(outcome.passed for outcome in outcomes), 'extremes': rows}
    return json.dumps(document, indent=2, allow_nan=False, ensure_ascii=False) + '\n'


def _row(outcome: ExtremeResult) -> dict[str, object]:
    extreme, finding = outcome.extreme, outcome.finding
    worst = str(finding.worst) if math.isnan(finding.worst) else finding.worst
    return {'number': extreme.number, 'name': extreme.name, 'elsewhere': extreme.elsewhere, 'mark': extreme.mark,
            'passed': outcome.passed, 'seconds': outcome.seconds, 'figure': finding.figure, 'cases': finding.cases,
            'misses': finding.misses, 'worst': worst, 'limit': finding.limit, 'examples': list(finding.examples)}
