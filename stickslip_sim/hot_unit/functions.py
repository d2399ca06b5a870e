# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""A function of the hot path as Cython takes it: names of the unit, constants as numbers, all types declared."""

import ast
import math
from collections.abc import Callable
from typing import NoReturn, TypeVar

from .c_types import TupleKind, text_of
from .errors import UnitError
from .local_types import LocalTypes
from .scope import Scope
from .sources import mark_of

_C_FUNCTIONS = frozenset({'asin', 'atan2', 'copysign', 'cos', 'exp', 'expm1', 'floor', 'isnan', 'log', 'log1p', 'sin',
                          'sqrt'})
_OF_MATH = {'inf': ast.Name('INFINITY'), 'nan': ast.Name('NAN'), 'pi': ast.Constant(math.pi)}
_BUILT_IN = frozenset({'abs', 'clear_state', 'max', 'min', 'range'})
_CASTS = {'int': 'long', 'float': 'double'}
_UNUSED = '_'   # one loop's counter, another line's spare item
_Node = TypeVar('_Node', bound=ast.AST)


def written(function: ast.FunctionDef, scope: Scope, *, is_entry: bool) -> str:
    """Return the Cython text of a function; Python may call it when it is an entry.  Raises UnitError."""
    types = LocalTypes(function, scope)
    statements = _Body(function, scope, types).statements()
    head = (f'{"cpdef" if is_entry else mark_of(function)} {text_of(scope.results[function.name])} '
            f'{scope.functions[function.name]}')
    arguments = ', '.join(f'{text_of(kind)} {name}' for name, kind in types.arguments.items())
    lines = [f'cdef {text_of(kind)} {name}' for name, kind in sorted(types.locals.items())]
    for statement in statements:
        lines += ast.unparse(ast.fix_missing_locations(statement)).split('\n')
    return '\n    '.join([f'{head}({arguments}) noexcept nogil:', *lines]) + '\n'


class _Body(ast.NodeTransformer):
    """The statements of a function, rewritten where Cython would take a Python object or does not know a name."""

    def __init__(self, function: ast.FunctionDef, scope: Scope, types: LocalTypes) -> None:
        self._function, self._scope, self._types = function, scope, types
        self._own = {*types.arguments, *types.locals}

    def statements(self) -> list[ast.stmt]:
        """Return them, without the docstring."""
        has_docstring = ast.get_docstring(self._function) is not None
        return [self.visit(statement) for statement in self._function.body[has_docstring:]]

    # names

    def visit_Name(self, node: ast.Name) -> ast.expr:
        """Return what a name means in the unit."""
        name, scope = node.id, self._scope
        if name in self._own or name in _BUILT_IN:
            return node
        if name in scope.functions:
            return ast.Name(scope.functions[name])
        if name in scope.tables:
            return ast.Name(scope.tables[name])
        if isinstance(scope.constants.get(name), int | float):
            return ast.Constant(scope.constants[name])
        self._refuse(node, f'{name}, which is neither a number nor a marked function')

    def visit_Attribute(self, node: ast.Attribute) -> ast.expr:
        """Return a field: of a tuple by its place, of `math` what C has for it."""
        if isinstance(node.value, ast.Name) and node.value.id == 'math':
            if node.attr in _OF_MATH:
                return _OF_MATH[node.attr]
            if node.attr in _C_FUNCTIONS:
                return ast.Name(node.attr)
            self._refuse(node, f'math.{node.attr}, which the unit does not take from C')
        whole = self._types.kind(node.value)
        place = whole.of_name(node.attr) if isinstance(whole, TupleKind) else None
        self.generic_visit(node)
        return node if place is None else ast.Subscript(node.value, ast.Constant(place), node.ctx)

    def visit_Call(self, node: ast.Call) -> ast.expr:
        """Return a call; conversions are casts, and a tuple with names is a tuple."""
        name = ast.unparse(node.func)
        arguments = [self.visit(argument) for argument in node.args]
        kind = self._scope.kinds.get(name)
        if isinstance(kind, TupleKind):
            given = {word.arg: self.visit(word.value) for word in node.keywords}
            return ast.Tuple([*arguments, *(given[field] for field in kind.names[len(arguments):])], ast.Load())
        if node.keywords:
            self._refuse(node, f'{name} with names of arguments; give them in order')
        if name in _CASTS:
            return ast.Call(ast.Name('cast'), [ast.Name(_CASTS[name]), *arguments], [])
        return ast.Call(ast.Name('complex_of') if name == 'complex' else self.visit(node.func), arguments, [])

    def visit_For(self, node: ast.For) -> ast.stmt:
        """Return a loop over a range, whose counter is an integer."""
        if isinstance(node.target, ast.Name) and node.target.id == _UNUSED:
            node.target = ast.Name('counter_')
            self._types.locals['counter_'] = 'long'
            self._own.add('counter_')
        return self._inside(node)

    # one tuple or another: Cython would make an object of it

    def visit_Return(self, node: ast.Return) -> ast.stmt:
        """Return one of two tuples by two returns."""
        is_tuple = isinstance(self._scope.results[self._function.name], TupleKind)
        if isinstance(node.value, ast.IfExp) and is_tuple:
            return self._either(node.value, lambda value: self.visit_Return(ast.Return(value)))
        return self._inside(node)

    def visit_Assign(self, node: ast.Assign) -> ast.stmt:
        """Return the assignment of one of two tuples as two."""
        if isinstance(node.value, ast.IfExp) and isinstance(node.targets[0], ast.Tuple):
            return self._either(node.value, lambda value: self.visit_Assign(ast.Assign(list(node.targets), value)))
        return self._inside(node)

    def visit_AnnAssign(self, node: ast.AnnAssign) -> ast.stmt:
        """Return an assignment whose type is declared above."""
        if node.value is None:
            return ast.Pass()
        return self.visit_Assign(ast.Assign([node.target], node.value))

    def _either(self, choice: ast.IfExp, statement: Callable[[ast.expr], ast.stmt]) -> ast.If:
        return ast.If(self.visit(choice.test), [statement(choice.body)], [statement(choice.orelse)])

    def _inside(self, node: _Node) -> _Node:
        self.generic_visit(node)
        return node

    def _refuse(self, node: ast.AST, what: str) -> NoReturn:
        raise UnitError(self._scope.source.path, node, f'{self._function.name} uses {what}')
