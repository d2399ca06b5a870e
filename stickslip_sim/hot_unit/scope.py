# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""What the names of a file mean in the unit, and the types of the locals and expressions of a function."""

import ast
from collections.abc import Iterator

from .kinds import BOOL, COMPLEX, DOUBLE, LONG, Kind, Kinds, Record, TupleKind
from .sources import Constants, Source, Sources, UnitError

_ROUNDS = 4   # an assignment may need the type of one that stands below it
_QUESTIONS = 'math.isfinite', 'math.isinf', 'math.isnan'
_RANK = (COMPLEX, DOUBLE, LONG, BOOL)


class Scope:
    """The names of a file: functions of the unit with what they take and return, constants, rows of numbers, types."""

    def __init__(self, source: Source, sources: Sources, constants: Constants, kinds: Kinds) -> None:
        self.source, self.constants, self.kinds = source, constants.of(source.name), kinds
        self.types = kinds.of(source.name)
        self.origins = {name: (sources.of(file), original) for name, (file, original) in source.imports.items()}
        self.functions: dict[str, str] = {}       # their names in the unit
        self.parameters: dict[str, dict[str, Kind]] = {}
        self.results: dict[str, Kind] = {}
        for name in source.functions:
            self._add(name, source, name)
        for name, (origin, original) in self.origins.items():
            if original in origin.functions:
                self._add(name, origin, original)

    def unit_name(self, name: str) -> str:
        """Return the name in the unit of something that this file has or imports."""
        source, original = self.origins.get(name, (self.source, name))
        return source.unit_name(original)

    def _add(self, name: str, origin: Source, original: str) -> None:
        function, of = origin.functions[original], self.kinds.declared
        given = function.args
        if given.posonlyargs or given.kwonlyargs or given.vararg or given.kwarg or given.defaults:
            raise UnitError(origin.path, function,
                            f'{original} has more than plain arguments; write each one out, without defaults')
        self.functions[name] = origin.unit_name(original)
        self.parameters[name] = {argument.arg: of(argument.annotation, f'the argument {argument.arg} of {original}',
                                                  argument, origin) for argument in given.args}
        self.results[name] = of(function.returns, f'what {original} returns', function, origin)


class LocalTypes(ast.NodeVisitor):
    """What the names and expressions of a function are."""

    def __init__(self, function: ast.FunctionDef, scope: Scope) -> None:
        self._scope, self.arguments = scope, scope.parameters[function.name]
        self.locals, self.counters = dict[str, Kind](), set[str]()
        for turn in range(_ROUNDS):
            self._last_turn = turn == _ROUNDS - 1
            for node in ast.walk(function):
                if isinstance(node, ast.For):
                    self.counters.add(ast.unparse(node.target))
                for target, kind in self._assigned(node):
                    self._take(target, kind)
        for name in self.counters & {*self.arguments, *self.locals} - {'_'}:
            raise UnitError(scope.source.path, function, f'{function.name} has {name} as a counter and as more; give '
                            'the counter a name of its own')

    def kind(self, node: ast.expr) -> Kind | None:
        """Return the type of an expression, None where it is not known yet."""
        found: Kind | None = self.visit(node)
        return found

    def _take(self, target: ast.expr, kind: Kind | None) -> None:
        if isinstance(target, ast.Tuple):
            kinds = kind if isinstance(kind, TupleKind) and len(kind) == len(target.elts) else [None] * len(target.elts)
            for part, one in zip(target.elts, kinds, strict=True):
                self._take(part, one)
        elif isinstance(target, ast.Name) and target.id not in self.arguments and target.id != '_':
            kind = kind or (DOUBLE if self._last_turn else None)
            joined = _joined([self.locals.get(target.id), kind])
            if joined:
                self.locals[target.id] = joined._replace(within=False) if isinstance(joined, Record) else joined

    def _assigned(self, node: ast.AST) -> Iterator[tuple[ast.expr, Kind | None]]:
        """Yield what a statement assigns to, with its type."""
        if isinstance(node, ast.Assign):
            for target in node.targets:
                yield target, self.kind(node.value)
        elif isinstance(node, ast.AugAssign):
            yield node.target, self.kind(node.value)
        elif isinstance(node, ast.AnnAssign):
            yield node.target, self._scope.kinds.declared(node.annotation, ast.unparse(node.target), node,
                                                          self._scope.source)

    # one method for each sort of expression

    def visit_Tuple(self, node: ast.Tuple) -> Kind:
        """Return the types of its items."""
        return TupleKind(self.kind(item) or DOUBLE for item in node.elts)

    def visit_Compare(self, node: ast.Compare) -> Kind:
        """Return a truth."""
        return BOOL

    def visit_BoolOp(self, node: ast.BoolOp) -> Kind:
        """Return a truth."""
        return BOOL

    def visit_Constant(self, node: ast.Constant) -> Kind:
        """Return the type of a number."""
        return {bool: BOOL, int: LONG}.get(type(node.value), DOUBLE)

    def visit_Call(self, node: ast.Call) -> Kind | None:
        """Return what a function returns."""
        name = ast.unparse(node.func)
        if name in self._scope.results:
            return self._scope.results[name]
        if name in self._scope.types:
            return self._scope.types[name]
        if name in ('max', 'min', 'abs'):
            return _joined([self.kind(argument) for argument in node.args])
        return {'int': LONG, 'complex': COMPLEX, **dict.fromkeys(_QUESTIONS, BOOL)}.get(name, DOUBLE)

    def visit_Name(self, node: ast.Name) -> Kind | None:
        """Return what a name is."""
        known = self.arguments.get(node.id) or self.locals.get(node.id)
        if known or node.id in self.counters:
            return known or LONG
        return {int: LONG, float: DOUBLE}.get(type(self._scope.constants.get(node.id)))

    def visit_IfExp(self, node: ast.IfExp) -> Kind | None:
        """Return the type of both sides."""
        return _joined([self.kind(node.body), self.kind(node.orelse)])

    def visit_BinOp(self, node: ast.BinOp) -> Kind | None:
        """Return the type of both operands; a quotient is a float."""
        found = _joined([self.kind(node.left), self.kind(node.right)])
        return DOUBLE if isinstance(node.op, ast.Div) and found == LONG else LONG if found == BOOL else found

    def visit_UnaryOp(self, node: ast.UnaryOp) -> Kind | None:
        """Return the type of the operand, or a truth."""
        return BOOL if isinstance(node.op, ast.Not) else self.kind(node.operand)

    def visit_Attribute(self, node: ast.Attribute) -> Kind | None:
        """Return the type of a field."""
        whole = self.kind(node.value)
        if isinstance(whole, TupleKind) and node.attr in whole.names:
            return whole[whole.names.index(node.attr)]
        if isinstance(whole, Record):
            return self._scope.kinds.records[whole.name].get(node.attr)
        return DOUBLE

    def visit_Subscript(self, node: ast.Subscript) -> Kind | None:
        """Return the type of an item."""
        whole = self.kind(node.value)
        if isinstance(whole, TupleKind) and isinstance(node.slice, ast.Constant) and isinstance(node.slice.value, int):
            return whole[node.slice.value]
        if isinstance(whole, Record) and whole.name != DOUBLE:
            return Record(whole.name, within=True)
        return DOUBLE


def _joined(kinds: list[Kind | None]) -> Kind | None:
    """Return the type that holds values of all these; a tuple is joined with its like alone."""
    known = [kind for kind in kinds if kind]
    tuples = [kind for kind in known if isinstance(kind, TupleKind)]
    if tuples:
        named = next((kind for kind in tuples if kind.name), None)
        joined = TupleKind(_joined(list(items)) or DOUBLE for items in zip(*tuples, strict=False))
        return named or joined
    return next((kind for kind in _RANK if kind in known), known[0] if known else None)
