# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""What annotations mean in C: numbers, tuples as structures by value, records as pointers to structures."""

import ast
from functools import cache
from itertools import groupby
from typing import NamedTuple, Union

from .sources import Constants, Source, Sources, UnitError

DOUBLE, LONG, BOOL, COMPLEX, VOID = 'double', 'long', 'bool', 'Complex', 'void'
_PLAIN = {'float': DOUBLE, 'int': LONG, 'bool': BOOL, 'complex': COMPLEX, 'None': VOID}
# the files with records, each behind those whose records it holds
RECORD_FILES = ('axis/layout.py', 'axis/state_record.py', 'axis/rows.py', 'solvers/exact/axis_figures.py',
                'solvers/exact/pieces.py')
# of C and JavaScript, which Python has as names
_WORDS = frozenset({'auto', 'case', 'char', 'const', 'default', 'delete', 'double', 'float', 'function', 'int', 'let',
                    'long', 'new', 'register', 'short', 'signed', 'static', 'switch', 'this', 'union', 'var', 'void',
                    'volatile'})

Kind = Union[str, 'TupleKind', 'Record']


class TupleKind(tuple[Kind, ...]):
    """The types of a tuple; with a name and names of its items where it is a NamedTuple."""

    name: str = ''
    names: tuple[str, ...] = ()

    @property
    def fields(self) -> tuple[str, ...]:
        """The names of the items in C."""
        return tuple(map(c_name, self.names)) or tuple(f'item{i}' for i in range(len(self)))


class Record(NamedTuple):
    """A pointer to a record, or to a number: to one, or to the first of many; or so many of them within a record."""

    name: str
    many: bool = False
    length: int = 0
    within: bool = False


class UnknownTypeError(Exception):
    """An annotation that has no meaning in C."""


def c_name(name: str) -> str:
    """Return a name that C takes."""
    return f'{name}_' if name in _WORDS else name


def text_of(kind: Kind) -> str:
    """Return a type as C writes it, a pointer with its star."""
    if isinstance(kind, Record):
        return f'{kind.name} *'
    if isinstance(kind, TupleKind):
        runs = ((text_of(one), len(list(group))) for one, group in groupby(kind))
        return kind.name or ''.join(f'{name[0].upper()}{name[1:]}{count if count > 1 else ""}' for name, count in runs)
    return kind


def declared_as(kind: Kind, name: str) -> str:
    """Return the declaration of a name."""
    if isinstance(kind, Record) and kind.within:
        return f'{kind.name} {c_name(name)}' + (f'[{kind.length}]' if kind.length else '')
    return f'{text_of(kind)}{"" if isinstance(kind, Record) else " "}{c_name(name)}'


class Kinds:
    """The names that files have for types, and the fields of all records."""

    def __init__(self, sources: Sources, constants: Constants) -> None:
        self._sources, self._constants = sources, constants
        self.records: dict[str, dict[str, Kind]] = {}
        self.of = cache(self._read)
        for file in RECORD_FILES:
            self.of(file)
        self.own = tuple(self.records)   # those of the unit

    def declared(self, annotation: ast.expr | None, what: str, node: ast.AST, source: Source) -> Kind:
        """Return the kind of `what`, an argument or a result; raises UnitError where that is missing or unknown."""
        if annotation is None:
            raise UnitError(source.path, node, f'{what} has no type; annotate it')
        try:
            return self._kind(annotation, self.of(source.name))
        except UnknownTypeError as unknown:
            raise UnitError(source.path, annotation, f'{what} has the type {unknown}, which C does not have; take '
                            'float, int, bool, complex, a tuple of them or a record') from None

    def _read(self, file: str) -> dict[str, Kind]:
        """Return those that stand in a file or are imported there."""
        source = self._sources.of(file)
        found: dict[str, Kind] = {}
        for name, (origin, original) in source.imports.items():
            if any(_name_of(node) == original for node in self._sources.of(origin).tree.body):
                found[name] = self.of(origin).get(original, VOID)
        for node in source.tree.body:
            if name := _name_of(node):
                try:
                    found[name] = self._own(name, node, found, file)
                except UnknownTypeError:   # a type for Python alone
                    continue
        return found

    def _own(self, name: str, node: ast.stmt, found: dict[str, Kind], file: str) -> Kind:
        if not isinstance(node, ast.ClassDef):
            assert isinstance(node, ast.Assign)
            return self._kind(node.value, found)
        fields = [field for field in node.body if isinstance(field, ast.AnnAssign)]
        if 'NamedTuple' in map(ast.unparse, node.bases):
            kind = TupleKind(self._kind(field.annotation, found) for field in fields)
            kind.name, kind.names = name, tuple(ast.unparse(field.target) for field in fields)
            return kind
        record = {ast.unparse(field.target): self._field(field.annotation, found, file) for field in fields}
        self.records[name] = record
        return Record(name)

    def _field(self, annotation: ast.expr, found: dict[str, Kind], file: str) -> Kind:
        """Return the kind of a field: a record, or so many of them, stand within; a list without a length elsewhere."""
        if isinstance(annotation, ast.Subscript) and ast.unparse(annotation.value) == 'Annotated':
            assert isinstance(annotation.slice, ast.Tuple)
            row = annotation.slice.elts[1]
            assert isinstance(row, ast.Call)
            length = eval(ast.unparse(row.args[0]), {}, self._constants.of(file))
            name = ast.unparse(row.args[1]) if len(row.args) > 1 else DOUBLE
            return Record(name, many=True, length=length, within=True)
        kind = self._kind(annotation, found)
        return kind._replace(within=True) if isinstance(kind, Record) and not kind.many else kind

    def _kind(self, annotation: ast.expr, named: dict[str, Kind]) -> Kind:
        """Return what an annotation means, where some names mean a type; raises UnknownTypeError."""
        if isinstance(annotation, ast.Subscript):
            what = ast.unparse(annotation.value)
            if what == 'tuple':
                parts = annotation.slice.elts if isinstance(annotation.slice, ast.Tuple) else [annotation.slice]
                return TupleKind(self._kind(part, named) for part in parts)
            if what == 'list':
                of = self._kind(annotation.slice, named)
                return Record(of.name if isinstance(of, Record) else text_of(of), many=True)
        known: dict[str, Kind] = {**_PLAIN, **named}
        name = ast.unparse(annotation)
        if known.get(name, VOID) == VOID and name != 'None':
            raise UnknownTypeError(name)
        return known[name]


def _name_of(node: ast.stmt) -> str:
    """Return the name that a statement gives to a tuple, a list or a record; '' if it does not."""
    if isinstance(node, ast.ClassDef):
        is_record = any('dataclass' in ast.unparse(one) for one in node.decorator_list)
        return node.name if is_record or 'NamedTuple' in map(ast.unparse, node.bases) else ''
    if isinstance(node, ast.Assign) and isinstance(node.value, ast.Subscript):
        return ast.unparse(node.targets[0]) if ast.unparse(node.value.value) in ('tuple', 'list') else ''
    return ''
