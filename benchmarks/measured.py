# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""What was measured: the files of docs/data/, and the tables of docs/measured.md, which are made from them.

A program of this folder keeps its file, and fills the page; `make pages` does so without measuring.
"""

import json
from collections.abc import Callable, Iterable, Mapping
from pathlib import Path
from typing import Any

from stickslip_sim.report.text import markdown_table

from .page import replaced

ROOT = Path(__file__).parents[1]
PAGE, DATA = ROOT / 'docs/measured.md', ROOT / 'docs/data'
RIVALS = {
    'heyoka': ('heyoka', '1e-16'), 'DOP853, numba': ('DOP853 with events, numba', '1e-12'),
    'CVODE': ('CVODE (Adams), as from C', '1e-12'), 'scipy': ('scipy DOP853', '1e-12'),
    'MuJoCo': ('MuJoCo', 'step 1 ms'), 'Euler': ('fixed_step euler', 'step 1 ms'),
}
CASES = 'A', 'B', 'C', 'D', 'paper_fig8'    # those that the page shows
EXTREMES = 'X1', 'X2', 'X7'
CPU_MARK, LATENCY_MARK = 0.75, 1.5    # of a bare node that records; steps
Row = Mapping[str, Any]
Columns = Mapping[str, Callable[[Row], str]]


def keep(path: Path, **content: object) -> None:
    """Write content as JSON, each row of a table on a line of its own; in docs/data/, fill the page with it."""
    parts = [f'{json.dumps(name)}: {_json(value)}' for name, value in content.items()]
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text('{' + ',\n '.join(parts) + '}\n', encoding='utf-8')
    if path.parent == DATA:
        PAGE.write_text(page(), encoding='utf-8')


def kept(name: str) -> dict[str, Any]:
    """Return the content of a file of docs/data/."""
    content: dict[str, Any] = json.loads((DATA / f'{name}.json').read_text(encoding='utf-8'))
    return content


def page() -> str:
    """Return the page with its tables as the data has them."""
    text = PAGE.read_text(encoding='utf-8')
    for name, part in PARTS.items():
        text = replaced(text, name, part())
    return text


def _json(value: object) -> str:
    if isinstance(value, list) and value:
        return '[\n  ' + ',\n  '.join(json.dumps(row, ensure_ascii=False) for row in value) + ']'
    return json.dumps(value, ensure_ascii=False)


# Tables: the heads of their columns, each with what it shows of a row.

def text(name: str) -> Callable[[Row], str]:
    """Return what shows a text."""
    return lambda row: str(row[name])


def number(name: str, scale: float = 1.0, form: str = '.0f') -> Callable[[Row], str]:
    """Return what shows a number in another unit, or a dash where there is none."""
    return lambda row: '–' if row.get(name) is None else f'{row[name] * scale:{form}}'


def table(columns: Columns, rows: Iterable[Row]) -> str:
    """Return a table with a line for each row."""
    return '\n'.join(markdown_table([*columns], [[shown(row) for shown in columns.values()] for row in rows])) + '\n'


def races() -> str:
    """Return what a simulated second costs the exact engine, how much more it costs others, and how far all are off."""
    found = kept('races')
    raced = {(row['case'], row['solver'], row['setting']): row for row in found['rows']}

    def rival(solver: str, setting: str) -> Callable[[Row], str]:
        def shown(case: Row) -> str:
            row, exact = raced.get((case['name'], solver, setting)), raced[case['name'], 'exact', '']
            if row is None or row['cost'] is None:    # not installed, or gave up
                return '–'
            flaw = '†' if row['missed'] or row['invented'] else ''
            ratio = float(f'{row["cost"] / exact["cost"]:.2g}')
            return f'{ratio:,g}; {row["time_error"]:.0e}{flaw}'
        return shown

    def exactly(case: Row) -> str:
        row = raced[case['name'], 'exact', '']
        return f'{row["cost"] * 1e6:.3g} µs; {row["time_error"]:.0e}'

    return table({'case': text('name'), '`exact`': exactly, **{head: rival(*who) for head, who in RIVALS.items()}},
                 [case for case in found['cases'] if case['name'] in CASES])


def marks() -> str:
    """Return the marks of the race that are missed."""
    judged = [row for row in kept('races')['ratios'] if row['met'] is not None]
    missed: dict[str, list[str]] = {}
    for row in judged:
        if not row['met']:
            missed.setdefault(f'{row["what"]} ({row["mark"]})', []).append(f'{row["case"]} {row["measured"]:,g}')
    heading = f'{sum(row["met"] for row in judged)} of {len(judged)} marks are met.{"  Missed:" if missed else ""}'
    return '\n'.join([heading, '',
                      *(f'* {what}: {", ".join(of)}' for what, of in missed.items()), ''])


LATENESS: Columns = {'lateness p50, µs': number('lateness_p50', 1e6), 'p99': number('lateness_p99', 1e6)}


def hil() -> str:
    """Return the node beside a bare node, and the ratios that have marks."""
    rows = kept('hil')['beside']
    bare, recording, node = rows
    shown = table({'node': text('node'), 'CPU per step, µs': number('cpu', 1e6),
                   'overruns, %': number('overruns', 1e2, '.2f'), **LATENESS,
                   'latency p50, µs': number('latency_p50', 1e6), 'latency p99': number('latency_p99', 1e6)}, rows)
    cpu, latency = node['cpu'], node['latency_p50']
    return (f'{shown}\n* CPU time: {cpu / bare["cpu"]:.2f} times the bare node, {cpu / recording["cpu"]:.2f} times the'
            f' one that records (mark: {CPU_MARK:g})\n* median latency of a command: {latency * 1e3:.2f} ms,'
            f' {latency * node["rate"]:.2f} steps (mark: {LATENCY_MARK:g})\n')


def rates() -> str:
    """Return the node at higher and higher rates, without and with real-time priority."""
    found = kept('hil')['rates']
    plain, urgent = ({row['target_rate']: row for row in found if (row['priority'] > 0) == has}
                     for has in (False, True))

    def highest(rows: Mapping[float, Row], *flaws: str) -> str:
        return f'{max((rate for rate, row in rows.items() if not any(row[flaw] for flaw in flaws)), default=0):,} 1/s'

    overruns = number('overruns', 1e2, '.2f')
    return table({'rate, 1/s': number('target_rate', form=',.0f'), 'CPU per step, µs': number('cpu', 1e6),
                  'overruns, %': overruns,
                  'with `SCHED_FIFO`': lambda row: overruns(urgent.get(row['target_rate'], {}))}, plain.values()) + (
        f'\nHighest rate within the `timing.max_overruns` of the scene: {highest(plain, "is_lossy", "is_late")}, with'
        f' `SCHED_FIFO` {highest(urgent, "is_lossy", "is_late")}; without a lost step: {highest(plain, "is_lossy")}.\n')


def busy() -> str:
    """Return what keeps the time beside busy processes, at each rate."""
    rows = kept('hil')['busy']
    found = {(row['keeper'], row['target_rate']): row['lateness_max'] * 1e3 for row in rows}
    rates = sorted({rate for _, rate in found})
    return table({'maximum lateness, ms': text('keeper'), **{
        f'at {rate:g} Hz': lambda row, rate=rate: f'{found[row["keeper"], rate]:.1f}' for rate in rates}},  # type: ignore[misc]
        [row for row in rows if row['target_rate'] == rates[0]])


def identification() -> str:
    """Return what is found on synthetic axes."""
    def measured(row: Row) -> str:
        if row['unit'] == 'share':
            return f'{row["measured"] * 100.0:.4g} %'
        return f'{row["measured"]:.5g} {row["unit"]}'.rstrip()

    return table({'figure': text('figure'), 'measured': measured, 'mark': lambda row: row['mark'] or '–'},
                 [row for row in kept('identification')['synthetic']
                  if row['mark'] or row['figure'].startswith('error')])


def varied() -> str:
    """Return what is found on axes of every kind."""
    rows = [row for row in kept('identification')['varied'] if row['axes'].startswith('feed')]
    return table({'axes': text('axes'), 'rejected': lambda row: f'{row["rejected"]} of {row["number"]}',
                  'called found, %': number('found', 1e2), 'of these covered, %': number('covered', 1e2)}, rows)


def rivals() -> str:
    """Return what other methods find on the same data."""
    return table({'method': text('method'), 'within 1 %': number('close', 1e2, '.0f'),
                  'median error, %': number('error_median', 1e2, '.2g'), 'CPU, s': number('cpu', form='.1f'),
                  'simulations': number('simulations', form=',.0f')}, kept('identification')['rivals'])


def extremes() -> str:
    """Return some of the extremes."""
    rows = kept('extremes')['extremes']
    some = table({'#': text('number'), 'extreme': text('name'), 'elsewhere': text('elsewhere'),
                  '`exact`': text('figure')}, [row for row in rows if row['number'] in EXTREMES])
    return f'{sum(row["passed"] for row in rows)} of {len(rows)} marks are met.\n\n{some}'


def smooth_laws() -> str:
    """Return how far events move by the table of a smooth law."""
    rows = [row for row in kept('smooth_laws')['rows'] if row['breakpoints_lie'] == OFF]
    found: dict[float, dict[str, str]] = {}
    for row in rows:
        error = 'other events' if row['time_error'] is None else f'{row["time_error"]:.0e}'
        branches = ('one branch', 'two branches')[row['branches'] - 1]
        found.setdefault(row['tolerance'], {'tolerance': f'{row["tolerance"]:.0e}', 'breakpoints': row['breakpoints']})[
            f'{row["contact"]}, {branches}'] = error
    columns = {name: text(name) for name in next(iter(found.values()))}
    return table(columns, found.values())


OFF, ON = 'off the curve', 'on the curve'    # where breakpoints of a table lie


def soak() -> str:
    """Return the figures of the soak."""
    return table({'figure': text('figure'), 'measured': lambda row: f'{row["measured"]:.6g}',
                  'at most': number('at_most', form='g')}, [
                      row for row in kept('soak')['rows'] if row['at_most'] is not None])


PARTS: Mapping[str, Callable[[], str]] = {one.__name__: one for one in (
    races, marks, hil, rates, busy, identification, varied, rivals, extremes, smooth_laws, soak)}
