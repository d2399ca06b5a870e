# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""What the annotations of the hot path mean in C."""

import ast
from functools import cache
from typing import Union

from .errors import UnitError
from .sources import Source, Sources

DOUBLE, LONG, BINT, COMPLEX = 'double', 'long', 'bint', 'double complex'
_PLAIN = {'float': DOUBLE, 'int': LONG, 'bool': BINT, 'complex': COMPLEX, 'None': 'void'}
_ROWS = {'EventRow': 'EventRow*', 'AxisFigures': 'AxisFigures*', 'KeptRounds': 'KeptRound*'}   # of a table: pointers
_OBJECTS = frozenset({'Parameters', 'State', 'Events', 'Sinusoids', 'SampleRow', 'EnergyRow'})

Kind = Union[str, 'TupleKind']   # a type in Cython, or the types of a tuple


class TupleKind(tuple[Kind, ...]):
    """The types of a tuple, and the names of its items if it has them: in C all are known by place."""

    names: tuple[str, ...] = ()

    def of_name(self, name: str) -> int | None:
        """Return the place of an item, None where there is no such name."""
        return self.names.index(name) if name in self.names else None


class UnknownTypeError(Exception):
    """An annotation that has no meaning in C."""


def text_of(kind: Kind) -> str:
    """Return a type as Cython writes it."""
    return f'({", ".join(map(text_of, kind))})' if isinstance(kind, TupleKind) else kind


def kind_of(annotation: ast.expr, named: dict[str, Kind]) -> Kind:
    """Return what an annotation means, where some names mean a tuple; raises UnknownTypeError."""
    if isinstance(annotation, ast.Subscript) and ast.unparse(annotation.value) == 'tuple':
        parts = annotation.slice.elts if isinstance(annotation.slice, ast.Tuple) else [annotation.slice]
        return TupleKind(kind_of(part, named) for part in parts)
    name = ast.unparse(annotation)
    known: dict[str, Kind] = {**{kind: kind for kind in _OBJECTS}, **_ROWS, **_PLAIN, **named}
    if name not in known:
        raise UnknownTypeError(name)
    return known[name]


class NamedKinds:
    """The names that files have for tuples: `Name = tuple[...]` and `class Name(NamedTuple)`."""

    def __init__(self, sources: Sources) -> None:
        self._sources = sources
        self.of = cache(self._read)

    def _read(self, file: str) -> dict[str, Kind]:
        """Return those that stand in a file or are imported there."""
        source = self._sources.of(file)
        found: dict[str, Kind] = {}
        for name, (origin, original) in source.imports.items():
            if original in self._own_names(origin):
                found[name] = self.of(origin)[original]
        for node in source.tree.body:
            name, kind = self._own(node, source, found)
            if name:
                found[name] = kind
        return found

    def _own_names(self, file: str) -> set[str]:
        return {_name_of(node) for node in self._sources.of(file).tree.body} - {''}

    @staticmethod
    def _own(node: ast.stmt, source: Source, found: dict[str, Kind]) -> tuple[str, Kind]:
        name = _name_of(node)
        try:
            if isinstance(node, ast.ClassDef) and name:
                fields = [field for field in node.body if isinstance(field, ast.AnnAssign)]
                kind = TupleKind(kind_of(field.annotation, found) for field in fields)
                kind.names = tuple(ast.unparse(field.target) for field in fields)
                return name, kind
            if isinstance(node, ast.Assign | ast.AnnAssign) and name and node.value is not None:
                return name, kind_of(node.value, found)
        except UnknownTypeError:   # a tuple for Python alone
            return '', ''
        return '', ''


def _name_of(node: ast.stmt) -> str:
    """Return the name that a statement gives to a tuple, '' if it does not."""
    if isinstance(node, ast.ClassDef) and 'NamedTuple' in map(ast.unparse, node.bases):
        return node.name
    if isinstance(node, ast.Assign | ast.AnnAssign) and isinstance(node.value, ast.Subscript):
        target = node.targets[0] if isinstance(node, ast.Assign) else node.target
        return ast.unparse(target) if ast.unparse(node.value.value) == 'tuple' else ''
    return ''


def declared(annotation: ast.expr | None, what: str, node: ast.AST, source: Source, named: dict[str, Kind]) -> Kind:
    """Return the kind of `what`, an argument or a result; raises UnitError where that is missing or unknown."""
    if annotation is None:
        raise UnitError(source.path, node, f'{what} has no type; annotate it')
    try:
        return kind_of(annotation, named)
    except UnknownTypeError as unknown:
        raise UnitError(source.path, annotation, f'{what} has the type {unknown}, which C does not have; take float, '
                        'int, bool, complex, a tuple of them or a record') from None
