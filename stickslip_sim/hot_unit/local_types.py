# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The types of the locals of a function: Cython would take half of them for Python objects."""

import ast
from collections.abc import Iterator

from .c_types import BINT, COMPLEX, DOUBLE, LONG, Kind, TupleKind, declared
from .scope import Scope

_ROUNDS = 4   # an assignment may need the type of one that stands below it
_RANK = (COMPLEX, DOUBLE, LONG, BINT)
_COUNTS = frozenset({'count'})   # fields that are integers; all others are floats


class LocalTypes(ast.NodeVisitor):
    """What the names and expressions of a function are."""

    def __init__(self, function: ast.FunctionDef, scope: Scope) -> None:
        self._scope, self.arguments, self.locals = scope, scope.arguments_of(function), dict[str, Kind]()
        for turn in range(_ROUNDS):
            self._last_turn = turn == _ROUNDS - 1
            for node in ast.walk(function):
                for target, kind in self._assigned(node):
                    self._take(target, kind)

    def kind(self, node: ast.expr) -> Kind | None:
        """Return the type of an expression, None where it is not known yet."""
        found: Kind | None = self.visit(node)
        return found

    def generic_visit(self, node: ast.AST) -> None:
        """Return nothing of an expression that is none of those below."""

    def _take(self, target: ast.expr, kind: Kind | None) -> None:
        if isinstance(target, ast.Tuple):
            kinds = kind if isinstance(kind, TupleKind) and len(kind) == len(target.elts) else [None] * len(target.elts)
            for part, one in zip(target.elts, kinds, strict=True):
                self._take(part, one)
        elif isinstance(target, ast.Name) and target.id not in self.arguments:
            kind = kind or (DOUBLE if self._last_turn else None)
            joined = _joined([self.locals.get(target.id), kind])
            if joined:
                self.locals[target.id] = joined

    def _assigned(self, node: ast.AST) -> Iterator[tuple[ast.expr, Kind | None]]:
        """Yield what a statement assigns to, with its type."""
        if isinstance(node, ast.Assign):
            for target in node.targets:
                yield target, self.kind(node.value)
        elif isinstance(node, ast.AugAssign):
            yield node.target, self.kind(node.value)
        elif isinstance(node, ast.AnnAssign):
            source = self._scope.source
            yield node.target, declared(node.annotation, ast.unparse(node.target), node, source, self._scope.kinds)
        elif isinstance(node, ast.For):
            yield node.target, LONG

    # one method for each sort of expression

    def visit_Tuple(self, node: ast.Tuple) -> Kind:
        """Return the types of its items."""
        return TupleKind(self.kind(item) or DOUBLE for item in node.elts)

    def visit_Compare(self, node: ast.Compare) -> Kind:
        """Return a truth."""
        return BINT

    def visit_BoolOp(self, node: ast.BoolOp) -> Kind:
        """Return a truth."""
        return BINT

    def visit_Constant(self, node: ast.Constant) -> Kind:
        """Return the type of a number."""
        return {bool: BINT, int: LONG}.get(type(node.value), DOUBLE)

    def visit_Call(self, node: ast.Call) -> Kind | None:
        """Return what a function returns."""
        name = ast.unparse(node.func)
        if name in self._scope.results:
            return self._scope.results[name]
        if name in self._scope.kinds:
            return self._scope.kinds[name]
        if name in ('max', 'min'):
            return _joined([self.kind(argument) for argument in node.args])
        return {'int': LONG, 'complex': COMPLEX}.get(name, DOUBLE)

    def visit_Name(self, node: ast.Name) -> Kind | None:
        """Return what a name is."""
        known = self.arguments.get(node.id) or self.locals.get(node.id)
        value = self._scope.constants.get(node.id)
        return known or {int: LONG, float: DOUBLE}.get(type(value))

    def visit_IfExp(self, node: ast.IfExp) -> Kind | None:
        """Return the type of both sides."""
        return _joined([self.kind(node.body), self.kind(node.orelse)])

    def visit_BinOp(self, node: ast.BinOp) -> Kind | None:
        """Return the type of both operands; a quotient is a float."""
        found = _joined([self.kind(node.left), self.kind(node.right)])
        return DOUBLE if isinstance(node.op, ast.Div) and found == LONG else found

    def visit_UnaryOp(self, node: ast.UnaryOp) -> Kind | None:
        """Return the type of the operand, or a truth."""
        return BINT if isinstance(node.op, ast.Not) else self.kind(node.operand)

    def visit_Attribute(self, node: ast.Attribute) -> Kind:
        """Return the type of a field."""
        whole = self.kind(node.value)
        place = whole.of_name(node.attr) if isinstance(whole, TupleKind) else None
        if isinstance(whole, TupleKind) and place is not None:
            return whole[place]
        return LONG if node.attr in _COUNTS else DOUBLE

    def visit_Subscript(self, node: ast.Subscript) -> Kind:
        """Return the type of an item."""
        whole = self.kind(node.value)
        if isinstance(whole, TupleKind) and isinstance(node.slice, ast.Constant) and isinstance(node.slice.value, int):
            return whole[node.slice.value]
        return DOUBLE


def _joined(kinds: list[Kind | None]) -> Kind | None:
    """Return the type that holds values of all these; a tuple is joined with its like alone."""
    known = [kind for kind in kinds if kind]
    tuples = [kind for kind in known if isinstance(kind, TupleKind)]
    if tuples:
        joined = TupleKind(_joined(list(items)) or DOUBLE for items in zip(*tuples, strict=False))
        joined.names = tuples[0].names
        return joined
    return next((kind for kind in _RANK if kind in known), known[0] if known else None)
