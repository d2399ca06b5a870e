# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The report as one HTML page that needs no network: tables and pictures inside."""

import math
from collections.abc import Iterable, Sequence
from html import escape
from pathlib import Path
from typing import Any

from ..plots.html_page import figure, html_page, html_table
from ..plots.scale import labelled
from .pictures import Picture

_SHOWN = 12   # cycles of a run that are listed, the first and the last of them
_CYCLE = (('break-away', 'begin', 's', 1.0), ('period', 'period', 's', 1.0), ('stick', 'stick_time', 's', 1.0),
          ('slip', 'slip_time', 's', 1.0), ('jump', 'jump', 'mm', 1e3), ('peak speed', 'peak_speed', 'mm/s', 1e3),
          ('peak acceleration', 'peak_acceleration', 'm/s²', 1.0), ('break-away force', 'break_away_force', 'kN', 1e-3),
          ('rest time before', 'rest_time', 's', 1.0))
_RING = (('undamped frequency', 'frequency', 'Hz'), ('damped frequency', 'damped_frequency', 'Hz'),
         ('damping ratio', 'damping_ratio', ''), ('decay', 'decay', '1/s'))
_MARKS = {'holds': ('holds', '✓ holds'), 'does not hold': ('fails', '✗ does not hold'),
          'not applicable': ('other', '– not applicable')}


def page(report: dict[str, Any], pictures: Sequence[Picture], folder: Path) -> str:
    """Return the page of a report; the pictures are taken from their SVG files in the folder."""
    runs = report['runs']
    title = 'Stick-slip: ' + ', '.join(run['name'] for run in runs)
    versions = ', '.join(f'{name} {version}' for name, version in report['versions'].items())
    body = [f'<h1>{escape(title)}</h1>', _overview(runs), *_figures(pictures, '', folder)]
    for run in runs:
        body += [f'<h2>{escape(run["name"])}</h2>', _origin(run), _statements(run),
                 *_figures(pictures, run['name'], folder), _cycles(run), _ring_down(run)]
    body.append(f'<p class="other">{escape(versions)}</p>')
    return html_page(title, body)


def _overview(runs: Sequence[dict[str, Any]]) -> str:
    """Return the last cycle of each run beside those of the others."""
    rows = [[labelled(name, unit), *(_cell(run['cycles'][-1][field], scale) if run['cycles'] else '–' for run in runs)]
            for name, field, unit, scale in _CYCLE[1:]]
    motion = ['motion', *(run['motion'] + (', settled' if run['settled'] else '') for run in runs)]
    return html_table('The last complete cycle', ['', *(run['name'] for run in runs)], [motion, *rows])


def _origin(run: dict[str, Any]) -> str:
    notes = ''.join(f'<p class="note">{escape(note)}</p>' for note in run['notes'])
    return (f'<p>Scene {escape(run["scene"])} ({run["scene_hash"][:12]}), {escape(run["source"])}; '
            f't = {run["begin"]:g} … {run["end"]:g} s; {100.0 * run["stick_share"]:.4g} % of the time in stick.</p>'
            + notes)


def _statements(run: dict[str, Any]) -> str:
    rows = []
    for statement in run['statements']:
        kind, mark = _MARKS[statement['outcome']]
        rows.append(f'<tr><td>{escape(statement["text"])}</td><td class="{kind}">{mark}</td>'
                    f'<td>{escape(statement["finding"])}</td></tr>')
    return '<table><caption>What the paper says, on this run</caption>' + ''.join(rows) + '</table>'


def _cycles(run: dict[str, Any]) -> str:
    """Return the first and the last cycles, each with its difference from the one before."""
    cycles, changes = run['cycles'], ['–', *(f'{change:.1e}' for change in run['convergence'])]
    if not cycles:
        return '<p>No complete cycle.</p>'
    rows = [[str(k + 1), *(_cell(cycle[field], scale) for _, field, _, scale in _CYCLE), changes[k]]
            for k, cycle in enumerate(cycles)]
    if len(rows) > _SHOWN:
        rows = [*rows[:_SHOWN // 2], ['…'] * len(rows[0]), *rows[-_SHOWN // 2:]]
    heads = ['cycle', *(labelled(name, unit) for name, _, unit, _ in _CYCLE), 'change']
    caption = 'Cycles; the change is relative, of the figure that changes most'
    if run['contraction'] is not None:
        caption += f', and becomes {run["contraction"]:.3g} times as large with each cycle'
    return html_table(caption, heads, rows)


def _ring_down(run: dict[str, Any]) -> str:
    form, found = run['ring_down']['closed_form'], run['ring_down']['identified']
    if form is None:
        return ''
    rows = [[labelled(name, unit), _cell(found[field] if found else None, 1.0), _cell(form[field], 1.0)]
            for name, field, unit in _RING]
    return html_table('Ring-down after a slip', ['', 'identified from the motion', 'closed form'], rows)


def _figures(pictures: Sequence[Picture], run: str, folder: Path) -> Iterable[str]:
    for picture in pictures:
        if picture.run == run:
            yield figure(folder / f'{picture.name}.svg', picture.caption)


def _cell(value: Any, scale: float) -> str:
    if value is None:
        return '–'
    number = float(value) * scale   # 'inf' is a text in a report
    return f'{number:.6g}' if math.isfinite(number) else '∞'
