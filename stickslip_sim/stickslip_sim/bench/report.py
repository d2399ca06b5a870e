# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The race as JSON values, and those as tables for people (plain text, Markdown)."""

import os
import pathlib
import platform
from collections.abc import Iterator, Sequence
from typing import Any

from ..report.model import NOTE, Part, Section, Sentence, Table
from ..report.text import markdown_lines, text_lines
from ..report.values import versions
from .outside import Ratio
from .problem import Setting
from .race import RACE_DIGITS, CaseResult, Row

_HEADS = ('solver', 'setting', 'µs per simulated s', '× exact', 'missed', 'invented', 'event time, s', 'position, m')
_MARK_HEADS = ('figure', 'case', 'measured', 'mark', 'aim', 'mark met')

Json = dict[str, Any]


def race_as_json(results: Sequence[CaseResult], figures: Sequence[Ratio], rounds: int) -> Json:
    """Return everything that was measured."""
    return {'versions': {**versions(), **_rivals(results)}, 'machine': machine(), 'rounds': rounds,
            'reference_digits': RACE_DIGITS, 'cases': [as_case(result) for result in results],
            'ratios': [ratio._asdict() for ratio in figures]}


def as_case(result: CaseResult) -> Json:
    """Return a case as JSON values."""
    problem = result.problem
    return {'name': problem.name, 'summary': problem.summary, 'duration': problem.duration,
            'reference_events': result.reference_events, 'rows': [_row(row) for row in result.rows]}


def machine() -> str:
    """Return the machine of the measurement."""
    info = pathlib.Path('/proc/cpuinfo')
    lines = info.read_text().splitlines() if info.is_file() else []
    model = next((line.split(':')[1].strip() for line in lines if line.startswith('model name')), platform.machine())
    return f'{os.cpu_count()} × {model}, {platform.system()} {platform.release()}'


def text_table(case: Json) -> str:
    """Return a case for the terminal."""
    return '\n'.join(text_lines([_heading(case), _table(case), *_notes(case)]))


def marks_table(figures: Sequence[Json]) -> str:
    """Return the figures beside their marks for the terminal."""
    return '\n'.join(text_lines([_marks(figures, 'NO')]))


def markdown(data: Json) -> str:
    """Return the page that `bench.md` holds."""
    return '\n'.join(markdown_lines(_page(data), level=3))


def _page(data: Json) -> Iterator[Part]:
    known = '; '.join(f'{name} {version}' for name, version in data['versions'].items())
    yield (f'Measured on {data["machine"]} with {known}; medians of {data["rounds"]} interleaved rounds (fewer of'
           ' what takes seconds), processor time.')
    if data['ratios']:
        yield _marks(data['ratios'], '**no**')
    for case in data['cases']:
        yield Section(_heading(case), [_table(case), *(Sentence(note, NOTE) for note in _notes(case))])


def _heading(case: Json) -> str:
    return f'{case["name"]}: {case["summary"]} ({case["duration"]:g} s, {case["reference_events"]} events)'


def _table(case: Json) -> Table:
    raced = [row for row in case['rows'] if row['errors']]
    exact = next((_cost(row) for row in raced if row['solver'].startswith('exact')), None)
    return Table(_HEADS, [
        (row['solver'], row['label'], _short(_cost(row) * 1e6), _short(_cost(row) / exact) if exact else '',
         f'{row["errors"]["missed"]} of {row["errors"]["reference_events"]}', str(row['errors']['invented']),
         f'{row["errors"]["time"]:.1e}', f'{row["errors"]["position"]:.1e}') for row in raced], texts=(0, 1))


def _cost(row: Json) -> float:
    return float(row['cost_per_simulated_second']['median'])


def _marks(figures: Sequence[Json], missed: str) -> Table:
    return Table(_MARK_HEADS, [
        (figure['what'], figure['case'], _short(figure['measured']), figure['mark'] or '–', figure['aim'] or '–',
         {True: 'yes', False: missed, None: '–'}[figure['met']]) for figure in figures], texts=(0, 1))


def _notes(case: Json) -> list[str]:
    return [' '.join(f'{row["solver"]} {row["label"]}: {row["note"]}'.split()) for row in case['rows'] if row['note']]


def _row(row: Row) -> Json:
    return {'solver': row.contestant, 'setting': _setting(row.setting), 'label': row.setting.label,
            'version': row.version, 'note': row.note,
            'errors': row.errors._asdict() if row.errors else None,
            'cost_per_simulated_second': row.cost._asdict() if row.cost else None}


def _setting(setting: Setting) -> Json:
    return {setting.unit: setting.value} if setting.unit else {}


def _rivals(results: Sequence[CaseResult]) -> dict[str, str]:
    return {row.contestant: row.version for result in results for row in result.rows if row.version}


def _short(value: float) -> str:
    """Return three digits."""
    if 1e-3 <= value < 1e6:
        return f'{value:.0f}' if value >= 100.0 else f'{value:.3g}'
    return f'{value:.1e}'
