# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Measure what docs/paper.md shows, and put it between its markers: `python3 -m benchmarks.paper` (seconds).

All figures behind the page go to docs/data/paper_choices.csv and docs/data/paper_classics.csv.
"""

import csv
import io
import pathlib
from collections import Counter
from collections.abc import Iterable, Sequence

from stickslip_sim.report.text import markdown_table
from stickslip_sim.study.critical import critical_drop, critical_feed

from . import naive_switching, sensitivity
from .classics import DAMPING_RATIOS, DROP, EXACT, GROUPS, PAPER, Result, damped
from .closed_forms import light_damping_feed
from .page import replace_generated

PAGE, DATA = pathlib.Path('docs/paper.md'), pathlib.Path('docs/data')


def made() -> tuple[dict[str, str], dict[str, str]]:
    """Return the tables of the page by the names of their markers, and the text of each file of data by its name."""
    choices, results = sensitivity.outcomes(), [result for group in GROUPS for result in group()]
    shown = {'sensitivity': sensitivity.table(choices), 'switching': naive_switching.table(),
             'classics': closeness(results), 'critical': critical_table()}
    return shown, {'paper_choices.csv': _as_csv(sensitivity.all_rows(choices)),
                   'paper_classics.csv': _as_csv(all_results(results))}


def closeness(results: Iterable[Result]) -> str:
    """Return in a sentence how many figures the engine has within each bound."""
    counts = Counter(map(_bound, results))
    return 'The engine agrees with ' + ', with '.join(f'{n} figures to {bound}' for bound, n in counts.items()) + '.\n'


def all_results(results: Iterable[Result]) -> list[tuple[str, ...]]:
    """Return each figure of the classical results, and how close the engine is to it, under heads."""
    return [('result', 'value', 'unit', 'engine within'),
            *((one.name, f'{one.expected:.10g}', one.unit, _bound(one)) for one in results)]


def critical_table() -> str:
    """Return critical feeds beside the usual estimate of them."""
    heads = 'ζ', 'A_c', 'v_c / (mm/s) for ΔF = 412 N', 'error of the estimate'
    return '\n'.join(markdown_table(heads, [
        (f'{zeta:.4g}', f'{critical_drop(zeta):.6f}', f'{critical_feed(damped(zeta), DROP) * 1e3:.4f}',
         f'{light_damping_feed(damped(zeta), DROP) / critical_feed(damped(zeta), DROP) - 1.0:+.0%}')
        for zeta in (*DAMPING_RATIOS, PAPER.damping_ratio)])) + '\n'


def _bound(result: Result) -> str:
    return f'{EXACT:.0e}' if result.tolerance == EXACT else f'{result.tolerance * abs(result.expected):.0e} absolute'


def _as_csv(rows: Sequence[Sequence[str]]) -> str:
    text = io.StringIO()
    csv.writer(text, lineterminator='\n').writerows(rows)
    return text.getvalue()


if __name__ == '__main__':
    page_parts, files = made()
    for name, text in page_parts.items():
        replace_generated(PAGE, text, name)
    for name, text in files.items():
        (DATA / name).write_text(text, encoding='utf-8')
