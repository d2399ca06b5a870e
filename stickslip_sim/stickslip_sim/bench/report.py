"""The race as tables for people (plain text, Markdown) and as JSON values."""

import os
import pathlib
import platform
from collections.abc import Iterable, Sequence
from typing import Any

from ..receipt import versions
from .errors import Errors
from .race import DIGITS, CaseResult, Row
from .ratios import Ratio

_HEADS = ('solver', 'setting', 'µs per simulated s', '× exact', 'missed', 'invented', 'event time, s', 'position, m')


def as_json(results: Sequence[CaseResult], claims: Sequence[Ratio], rounds: int) -> dict[str, Any]:
    """Return everything that was measured."""
    return {'versions': {**versions(), **_rivals(results)}, 'machine': machine(), 'rounds': rounds,
            'reference_digits': DIGITS, 'cases': [_case(result) for result in results],
            'ratios': [ratio._asdict() for ratio in claims]}


def machine() -> str:
    """Return what was measured on."""
    info = pathlib.Path('/proc/cpuinfo')
    lines = info.read_text().splitlines() if info.is_file() else []
    model = next((line.split(':')[1].strip() for line in lines if line.startswith('model name')), platform.machine())
    return f'{os.cpu_count()} × {model}, {platform.system()} {platform.release()}'


def text_table(result: CaseResult) -> str:
    """Return a case for the terminal."""
    rows = [_HEADS, *_cells(result)]
    widths = [max(len(row[i]) for row in rows) for i in range(len(_HEADS))]
    lines = ['  '.join(cell.ljust(width) if i < 2 else cell.rjust(width)
                       for i, (cell, width) in enumerate(zip(row, widths))).rstrip() for row in rows]
    return '\n'.join([_heading(result), *lines, *_notes(result)])


def markdown(results: Sequence[CaseResult], claims: Sequence[Ratio], rounds: int) -> str:
    """Return the page that `bench.md` holds, and docs/accuracy.md between its markers."""
    known = '; '.join(f'{name} {version}' for name, version in {**versions(), **_rivals(results)}.items())
    lines = [f'Measured on {machine()} with {known}; medians of {rounds} interleaved rounds, processor time.', '']
    if claims:
        lines += [*_markdown_table(('figure', 'case', 'measured', 'claimed', 'holds'), [
            (c.what, c.case, _short(c.measured), c.claimed or '–', {True: 'yes', False: '**no**', None: '–'}[c.holds])
            for c in claims]), '']
    for result in results:
        lines += [f'### {_heading(result)}', '', *_markdown_table(_HEADS, _cells(result)), '',
                  *(f'* {note}' for note in _notes(result)), '']
    return '\n'.join(lines).rstrip() + '\n'


def claims_table(claims: Sequence[Ratio]) -> str:
    """Return the claims for the terminal."""
    word = {True: 'holds', False: 'DOES NOT HOLD', None: ''}
    return '\n'.join(f'{c.what:62} {c.case}  {_short(c.measured):>9}  {c.claimed:9} {word[c.holds]}'.rstrip()
                     for c in claims)


def _heading(result: CaseResult) -> str:
    problem = result.problem
    return f'{problem.name}: {problem.summary} ({problem.duration:g} s, {result.reference_events} events)'


def _cells(result: CaseResult) -> list[tuple[str, ...]]:
    exact = next((row.cost.median for row in result.rows if row.contestant.startswith('exact') and row.cost), None)
    return [(row.contestant, row.setting.label, *_figures(row, row.errors, exact)) for row in result.rows
            if row.errors is not None]


def _figures(row: Row, errors: Errors | None, exact: float | None) -> tuple[str, ...]:
    assert errors is not None
    assert row.cost is not None
    cost = row.cost.median
    return (_short(cost * 1e6), _short(cost / exact) if exact else '', f'{errors.missed} of {errors.reference_events}',
            str(errors.invented), f'{errors.time:.1e}', f'{errors.position:.1e}')


def _notes(result: CaseResult) -> list[str]:
    return [' '.join(f'{row.contestant} {row.setting.label}: {row.note}'.split()) for row in result.rows if row.note]


def _case(result: CaseResult) -> dict[str, Any]:
    problem = result.problem
    return {'name': problem.name, 'summary': problem.summary, 'duration': problem.duration,
            'reference_events': result.reference_events, 'rows': [_row(row) for row in result.rows]}


def _row(row: Row) -> dict[str, Any]:
    return {'solver': row.contestant, 'setting': {row.setting.unit: row.setting.value} if row.setting.unit else {},
            'version': row.version, 'note': row.note,
            'errors': row.errors._asdict() if row.errors else None,
            'cost_per_simulated_second': row.cost._asdict() if row.cost else None}


def _rivals(results: Sequence[CaseResult]) -> dict[str, str]:
    return {row.contestant: row.version for result in results for row in result.rows if row.version}


def _markdown_table(heads: Sequence[str], rows: Iterable[Sequence[str]]) -> list[str]:
    return [f'| {" | ".join(row)} |' for row in (heads, ['---'] * len(heads), *rows)]


def _short(value: float) -> str:
    """Return three digits."""
    if 1e-3 <= value < 1e6:
        return f'{value:.0f}' if value >= 100.0 else f'{value:.3g}'
    return f'{value:.1e}'
