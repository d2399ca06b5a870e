# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The text of the unit: records, rows of numbers, functions, loops."""

from collections.abc import Iterator
from pathlib import Path
from string import Template
from typing import Any

from .c_types import NamedKinds
from .constants import Constants
from .functions import written
from .records import RECORD_FILES, record_words
from .scope import Scope, rows_of_numbers, unit_name
from .sources import Source, Sources, digest_of

# the functions that Python calls, by file
ENTRIES = {
    'solvers/exact/engine.py': ('start', 'advance', 'set_inputs', 'set_parameters', 'set_load', 'step', 'sample',
                                'energy'),
    'solvers/exact/soundness.py': ('is_sound',),
    'solvers/fixed_step/loop.py': ('start', 'advance', 'set_inputs', 'set_parameters', 'set_load', 'sample'),
}
_MANY_AXES = 'solvers/exact/many_axes.py'
_HERE = Path(__file__).parent


def write_unit(package: Path) -> str:
    """Return the Cython text of the hot path of a package; raises UnitError."""
    sources = Sources(package)
    constants, kinds = Constants(sources), NamedKinds(sources)
    hot = sources.hot()
    names = sorted({*RECORD_FILES, *(source.name for source in hot)})
    words = {**record_words(package), **constants.of(_MANY_AXES), 'SOURCES': repr(tuple(names)),
             'DIGEST': digest_of(package, names)}
    return '\n\n'.join([
        _filled('records.pyx.in', words),
        *(_row_of_numbers(unit_name(source, name), row) for source in hot
          for name, row in rows_of_numbers(source, constants.of(source.name)).items()),
        *(text for source in hot for text in _functions(source, Scope(source, sources, constants, kinds))),
        _filled('loops.pyx.in', words)])


def _functions(source: Source, scope: Scope) -> Iterator[str]:
    for name, function in source.functions.items():
        yield written(function, scope, is_entry=name in ENTRIES.get(source.name, ()))


def _row_of_numbers(name: str, values: tuple[float, ...]) -> str:
    """Return a constant row in C, which the compiler may compute with."""
    return (f'cdef extern from *:\n    """\n    static const double {name}[] = {{{", ".join(map(repr, values))}}};\n'
            f'    """\n    const double {name}[{len(values)}]\n')


def _filled(template: str, words: dict[str, Any]) -> str:
    return Template((_HERE / template).read_text(encoding='utf-8')).substitute(words)
