# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The records of `axis/layout.py` in C: structures with the same fields in the same order."""

import importlib.util
import sys
from collections.abc import Iterable
from pathlib import Path
from types import ModuleType
from typing import Any


def record_words(layout: Path) -> dict[str, Any]:
    """Return what stands in the template of the records: structures, fields, and how many numbers they hold."""
    of = _run(layout)
    nested = {field.record for field in of.STATE_FIELDS if field.record}
    structures = {of.Segment, of.SinusoidRecord, of.GivenSinusoid, of.EventRow, *nested}
    return {
        'STRUCTURES': '\n\n'.join(_structure(record.__name__, of.names_of(record))
                                  for record in sorted(structures, key=lambda record: record.__name__)),
        'PARAMETER_FIELDS': ', '.join(of.PARAMETER_FIELDS),
        'PARAMETER_SIZE': len(of.PARAMETER_FIELDS),
        'SEGMENT_SIZE': len(of.SEGMENT_FIELDS),
        'STATE_FIELDS': '\n    '.join(map(_state_field, of.STATE_FIELDS)),
        'STATE_SIZE': sum(field.size for field in of.STATE_FIELDS),
        'SINUSOID_SIZE': len(of.SINUSOID_FIELDS),
        'GIVEN_SINUSOID_SIZE': len(of.GIVEN_SINUSOID_FIELDS),
        'EVENT_VALUES': ', '.join(f'e.{name}' for name in of.EVENT_FIELDS),
        'SAMPLE_FIELDS': ', '.join(of.SAMPLE_FIELDS),
        'SAMPLE_VALUES': _of_self(of.SAMPLE_FIELDS),
        'ENERGY_FIELDS': ', '.join(of.ENERGY_FIELDS),
        'ENERGY_VALUES': _of_self(of.ENERGY_FIELDS),
    }


def _run(layout: Path) -> ModuleType:
    """Return the file as a module; it needs nothing but the standard library."""
    spec = importlib.util.spec_from_file_location('layout_of_the_hot_unit', layout)
    assert spec is not None
    assert spec.loader is not None
    module = sys.modules[spec.name] = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def _structure(name: str, fields: Iterable[str]) -> str:
    return f'cdef struct {name}:\n    double {", ".join(fields)}\n'


def _state_field(field: Any) -> str:
    kind = field.record.__name__ if field.record else 'public double'
    return f'cdef {kind} {field.name}' + (f'[{field.length}]' if field.length else '')


def _of_self(fields: Iterable[str]) -> str:
    return ', '.join(f'self.{name}' for name in fields)
