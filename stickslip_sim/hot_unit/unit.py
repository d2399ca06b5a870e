# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The text of the unit in C: types, constants, functions; and its wrapper for Python, in Cython."""

import ast
import zlib
from collections.abc import Iterable, Iterator, Mapping, Sequence
from itertools import groupby
from pathlib import Path
from string import Template
from typing import NamedTuple

from .kinds import RECORD_FILES, Kind, Kinds, Record, TupleKind, c_name, declared_as, text_of
from .printer import OF_MATH, head_of, printed
from .scope import Scope
from .sources import Constants, Source, Sources, UnitError, digest_of

# the functions that Python calls by themselves, by file, and those that loops in the wrapper call
ENTRIES: dict[str, tuple[str, ...]] = {
    'solvers/exact/engine.py': ('start', 'advance', 'set_inputs', 'set_parameters', 'set_load', 'step', 'sample',
                                'energy'),
    'solvers/exact/soundness.py': ('is_sound',),
    'solvers/fixed_step/loop.py': ('start', 'advance', 'set_inputs', 'set_parameters', 'set_load', 'sample'),
}
LOOPS: dict[str, tuple[str, ...]] = {
    'solvers/exact/pieces.py': ('enter_pieces', 'take_samples'),
    'solvers/exact/many_axes.py': ('run_axis', 'step_axis'),
}
# and those that a program in C has (stickslip_sim/plain_c); the wrapper carries their text
EXPORTED: dict[str, tuple[str, ...]] = {
    'solvers/exact/engine.py': ('start', 'advance', 'set_inputs', 'set_parameters', 'set_load', 'sample', 'energy'),
    'solvers/exact/soundness.py': ('is_sound',),
    'solvers/exact/pieces.py': ('piece_at', 'enter_pieces'),
}
_HEAD = '''/* Copyright 2026 The stickslip authors
   SPDX-License-Identifier: Apache-2.0

   The hot path of stickslip, written by hot_unit from the files named below: change those, not this.
   Compile it without contraction of a product and a sum (-ffp-contract=off) and without fast math. */

#include <math.h>
#include <stdbool.h>
#include <string.h>

#ifdef __clang__
#pragma STDC FP_CONTRACT OFF
#endif
'''
_BASICS = '''
typedef struct { double real, imag; } Complex;

static inline double larger(double a, double b) { return b > a ? b : a; }   /* as Python does, also with NaN */

static inline double smaller(double a, double b) { return b < a ? b : a; }

static inline Complex complex_of(double real, double imag) { return (Complex){real, imag}; }

static inline Complex sum_of(Complex a, Complex b) { return (Complex){a.real + b.real, a.imag + b.imag}; }

static inline Complex difference_of(Complex a, Complex b) { return (Complex){a.real - b.real, a.imag - b.imag}; }

static inline Complex product_of(Complex a, Complex b)
{
    return (Complex){a.real * b.real - a.imag * b.imag, a.real * b.imag + a.imag * b.real};
}
'''
_CLEAR = '''
/* Set all numbers but those of the sinusoids to 0. */
static void clear_state(State *s)
{
    *s = (State){.sinusoids = s->sinusoids, .scratch = s->scratch};
}
'''


class _Printed(NamedTuple):
    """A function of the unit."""

    source: Source
    head: str
    text: str
    uses: dict[str, object]
    tuples: list[TupleKind]


class Unit:
    """The hot path of a package; raises UnitError."""

    def __init__(self, package: Path) -> None:
        self._sources = sources = Sources(package)
        self._hot = sources.hot()
        self._constants = constants = Constants(sources)
        self.kinds = Kinds(sources, constants)
        self._scopes = {source.name: Scope(source, sources, constants, self.kinds) for source in self._hot}
        self.names = sorted({*RECORD_FILES, *(source.name for source in self._hot)})
        self.digest = digest_of(package, self.names)
        self._printed: dict[str, _Printed] = {}
        for key, function, scope in self.functions():
            if key in self._printed:
                raise UnitError(scope.source.path, function, f'{key} is there twice; rename one')
            self._printed[key] = _Printed(scope.source, head_of(function, scope), *printed(function, scope))

    def text(self, roots: Mapping[str, Sequence[str]]) -> str:
        """Return the C of some functions, by file, and of all that they need."""
        used = self.reached(roots)
        functions = {name: one for name, one in self._printed.items() if name in used}
        parts = [_HEAD, _BASICS, *self._structures(functions.values()), _CLEAR, *self._values(used), '',
                 *(f'{one.head};' for one in functions.values())]
        for file, group in groupby(functions.values(), lambda one: one.source):
            parts.append(f'\n/* {file.name}: {(ast.get_docstring(file.tree) or "").partition(chr(10))[0]} */')
            parts += [f'\n{one.text}' for one in group]
        return '\n'.join(parts) + '\n'

    def fmu(self, package: Path) -> dict[str, str]:
        """Return the header of the engine in C, without the notes for its readers, and the two sources of an FMU."""
        header, axis, fmu = (
            (package / name).read_text(encoding='utf-8')
            for name in ('plain_c/stickslip_axis.h', 'plain_c/stickslip_axis.c', 'fmu/stickslip_fmu.c'))
        words = dict.fromkeys(('VERSION', 'SEGMENT_SIZE', 'SEGMENTS', 'MODES', 'KINDS'), '')
        records = self.kinds.records
        words |= {name: ''.join(f'double {c_name(field)};' for field in fields) for name, fields in records.items()}
        words['PARAMETERS'] = ''.join(f'AXIS_{field.upper()},' for field, kind in records['Parameters'].items()
                                      if isinstance(kind, str))
        return {'stickslip_axis.h': Template(header).substitute(words),
                'stickslip_axis.c': self.text(EXPORTED) + axis, 'stickslip_fmu.c': fmu}

    def wrapper(self, include: str, script: str) -> str:
        """Return the Cython of the entries and of the classes that they work on, around the C of a file.

        It carries the script of a page, too.
        """
        words = {**self._record_words(), 'SOURCES': repr(tuple(self.names)), 'DIGEST': self.digest, 'FILE': include,
                 'ENGINE': repr(zlib.compress(self.text(EXPORTED).encode(), 9)),
                 'SCRIPT': repr(zlib.compress(script.encode(), 9)),
                 'DECLARED': '\n    '.join(self._declared()), 'ENTRIES': '\n\n'.join(self._entries())}
        return Template((Path(__file__).parent / 'wrapper.pyx.in').read_text(encoding='utf-8')).substitute(words)

    def functions(self) -> Iterator[tuple[str, ast.FunctionDef, Scope]]:
        """Yield all functions, with their names in the unit and what names mean in their files."""
        for source in self._hot:
            for name, function in source.functions.items():
                yield source.unit_name(name), function, self._scopes[source.name]

    def reached(self, roots: Mapping[str, Sequence[str]]) -> dict[str, object]:
        """Return the names that functions, by file, use, and those that these use, with the values of constants."""
        found, left = dict[str, object](), dict[str, object].fromkeys(
            self._sources.of(file).unit_name(one) for file, names in roots.items() for one in names)
        while left:
            name, value = left.popitem()
            found[name] = value
            if name in self._printed:
                left |= {other: of for other, of in self._printed[name].uses.items() if other not in found}
        return found

    def _structures(self, functions: Iterable[_Printed]) -> Iterator[str]:
        for name, fields in self.kinds.records.items():
            if name in self.kinds.own:
                yield _structure(name, [declared_as(kind, field) for field, kind in fields.items()])
        for name, kind in {text_of(kind): kind for one in functions for kind in one.tuples}.items():
            yield _structure(name, [declared_as(one, field) for field, one in zip(kind.fields, kind, strict=True)])

    @staticmethod
    def _values(uses: Mapping[str, object]) -> Iterator[str]:
        """Yield the constants that are used."""
        yield ''
        for name, value in sorted(uses.items()):
            if isinstance(value, tuple):
                yield f'static const double {name}[] = {{{", ".join(map(repr, value))}}};'
            elif isinstance(value, int | float):
                text = OF_MATH.get(repr(value), repr(value))
                yield f'#define {name} {text}' if value >= 0 else f'#define {name} ({text})'

    # for Python

    def _record_words(self) -> dict[str, object]:
        """Return for each record its fields that are numbers, as those of an object, too, and how many."""
        words = dict[str, object]()
        for name, of in self.kinds.records.items():
            fields = [field for field, kind in of.items() if isinstance(kind, str)]
            words |= {f'{name}_fields': ', '.join(fields), f'{name}_size': len(fields),
                      f'{name}_values': ', '.join(f'self.{field}' for field in fields)}
        state = self.kinds.records['State']
        return {**words, 'STATE_RECORDS': '\n    '.join(
            f'cdef {declared_as(kind._replace(name=f"C{kind.name}"), field)}' for field, kind in state.items()
            if isinstance(kind, Record)),
            'STATE_SIZE': sum(map(self._size, state.values())),
            'SERIES_ROWS': self._constants.of('axis/state_record.py')['HIGHEST_ORDER'] + 1,
            'EVENT_VALUES': ', '.join(f'e[{i}]' for i in range(len(self.kinds.records['EventRow'])))}

    def _size(self, kind: Kind) -> int:
        """Return how many numbers a field holds; one whose length is not known holds none."""
        if not isinstance(kind, Record):
            return 1
        one = 1 if kind.name == 'double' else sum(map(self._size, self.kinds.records[kind.name].values()))
        return one * (kind.length or 1) if kind.within else 0

    def _declared(self) -> Iterator[str]:
        """Yield the structures and functions that the wrapper uses; its classes have the names of some structures."""
        for name in self.kinds.own:
            yield f'ctypedef struct C{name} "{name}":\n        pass'
        results = [self._result(file, name) for file, names in (ENTRIES | LOOPS).items() for name in names]
        for name, kind in {text_of(kind): kind for kind in results if isinstance(kind, TupleKind)}.items():
            yield f'ctypedef struct {name}:'
            yield from (f'    {text_of(one).replace("bool", "bint")} {field}'
                        for field, one in zip(kind.fields, kind, strict=True))
        for file, names in (ENTRIES | LOOPS).items():
            for name in names:
                parameters = self._scopes[file].parameters[name].items()
                inside = self._sources.of(file).unit_name(name)
                yield (f'{_in_cython(self._result(file, name))} c_{inside} "{inside}"('
                       f'{", ".join(f"{_in_cython(kind)} {one}" for one, kind in parameters)}) nogil')

    def _entries(self) -> Iterator[str]:
        for file, names in ENTRIES.items():
            for name in names:
                inside, result = self._sources.of(file).unit_name(name), self._result(file, name)
                given = self._scopes[file].parameters[name]
                arguments = ', '.join(f'{kind.name if isinstance(kind, Record) else text_of(kind)} {one}'
                                      for one, kind in given.items())
                passed = ', '.join(f'{one}.c()' if isinstance(kind, Record) else one for one, kind in given.items())
                call = f'c_{inside}({passed})'
                if isinstance(result, TupleKind):
                    returned = ', '.join(f'got.{field}' for field in result.fields)
                    call = f'cdef {text_of(result)} got = {call}\n    return {returned}'
                elif result != 'void':
                    call = f'return {call}'
                yield f'def {inside}({arguments}):\n    {call}'

    def _result(self, file: str, name: str) -> Kind:
        return self._scopes[file].results[name]


def _structure(name: str, lines: Sequence[str]) -> str:
    return '\n'.join(['', 'typedef struct {', *(f'    {line};' for line in lines), f'}} {name};'])


def _in_cython(kind: Kind) -> str:
    if isinstance(kind, Record):
        return 'double*' if kind.name == 'double' else f'C{kind.name}*'
    return text_of(kind).replace('bool', 'bint')
