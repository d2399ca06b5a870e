# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The records of the hot path in C: structures with the same fields in the same order."""

import sys
from collections.abc import Iterator
from importlib import import_module
from importlib.machinery import ModuleSpec
from importlib.util import module_from_spec
from pathlib import Path
from types import ModuleType
from typing import Any

# the files with records, and first the one that reads their fields
RECORD_FILES = ('axis/fields.py', 'axis/layout.py', 'axis/state_record.py', 'axis/rows.py',
                'solvers/exact/axis_figures.py')
_APART = 'package_of_the_hot_unit'


def record_words(package: Path) -> dict[str, Any]:
    """Return what stands in the template of the records: structures, fields, and how many numbers they hold."""
    fields, layout, state_record, rows, axis_figures = (_module(package, name) for name in RECORD_FILES)
    structures = _Structures(fields)
    for record in (layout.Segment, state_record.SinusoidRecord, state_record.SeriesScratch, rows.GivenSinusoid,
                   rows.EventRow, axis_figures.AxisFigures, axis_figures.KeptRound):
        structures.add(record)
    state = [structures.declared(field, public='public ') for field in fields.record_fields(state_record.State)]
    return {
        'STRUCTURES': '\n\n'.join(structures.texts.values()),
        'PARAMETER_FIELDS': ', '.join(layout.PARAMETER_FIELDS),
        'PARAMETER_SIZE': len(layout.PARAMETER_FIELDS),
        'SEGMENT_SIZE': len(layout.SEGMENT_FIELDS),
        'STATE_FIELDS': '\n    '.join(f'cdef {field}' for field in state),
        'STATE_SIZE': len(state_record.STATE_PLACES),
        'SERIES_ROWS': state_record.HIGHEST_ORDER + 1,
        'SINUSOID_SIZE': len(fields.names_of(state_record.SinusoidRecord)),
        'GIVEN_SINUSOID_SIZE': len(rows.GIVEN_SINUSOID_FIELDS),
        'EVENT_VALUES': _of('e', fields.names_of(rows.EventRow)),
        'SAMPLE_FIELDS': ', '.join(fields.names_of(rows.SampleRow)),
        'SAMPLE_SIZE': len(fields.names_of(rows.SampleRow)),
        'SAMPLE_VALUES': _of('self', fields.names_of(rows.SampleRow)),
        'ENERGY_FIELDS': ', '.join(fields.names_of(rows.EnergyRow)),
        'ENERGY_VALUES': _of('self', fields.names_of(rows.EnergyRow)),
        'FIGURES': len(axis_figures.FIGURE_NAMES),
        'ROUND_SIZE': axis_figures.ROUND_SIZE,
    }


class _Structures:
    """The structures in C, each behind those that it holds."""

    def __init__(self, fields: ModuleType) -> None:
        self._fields, self.texts = fields, dict[str, str]()

    def add(self, record: type[Any]) -> None:
        """Write a record, once."""
        if record.__name__ not in self.texts:
            lines = [self.declared(field) for field in self._fields.record_fields(record)]
            self.texts[record.__name__] = '\n    '.join([f'cdef struct {record.__name__}:', *lines]) + '\n'

    def declared(self, field: Any, public: str = '') -> str:
        """Return the declaration of a field; of plain numbers one that Python sees, where that is asked for."""
        if field.record:
            self.add(field.record)
        kind = field.record.__name__ if field.record else f'{public}double'
        return f'{kind} {field.name}' + (f'[{field.length}]' if field.length else '')


def _module(package: Path, name: str) -> ModuleType:
    """Import a file of the package, which needs nothing but its like and the standard library, without the package."""
    path = [_APART, *name.removesuffix('.py').split('/')]
    for depth in range(1, len(path)):
        spec = ModuleSpec('.'.join(path[:depth]), None, is_package=True)
        spec.submodule_search_locations = [str(package.joinpath(*path[1:depth]))]
        sys.modules.setdefault(spec.name, module_from_spec(spec))
    return import_module('.'.join(path))


def _of(whole: str, names: Iterator[str]) -> str:
    return ', '.join(f'{whole}.{name}' for name in names)
