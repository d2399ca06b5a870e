# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""A function of the hot path in C: the names of its source, the first line of its docstring, all types declared."""

import ast
import math
from collections.abc import Iterator, Sequence
from itertools import count
from typing import Any, NoReturn

from .kinds import BOOL, COMPLEX, DOUBLE, LONG, VOID, Kind, Record, TupleKind, c_name, declared_as, text_of
from .scope import LocalTypes, Scope
from .sources import UnitError, mark_of

OF_MATH = {'inf': 'INFINITY', 'nan': 'NAN', 'pi': repr(math.pi)}
_C_FUNCTIONS = frozenset({'asin', 'atan2', 'copysign', 'cos', 'exp', 'expm1', 'floor', 'isfinite', 'isinf', 'isnan',
                          'log', 'log1p', 'sin', 'sqrt'})
_OPERATORS = {ast.Add: ('+', 10), ast.Sub: ('-', 10), ast.Mult: ('*', 11), ast.Div: ('/', 11)}
_COMPARISONS = {ast.Lt: '<', ast.LtE: '<=', ast.Gt: '>', ast.GtE: '>=', ast.Eq: '==', ast.NotEq: '!='}
_ON_COMPLEX = {ast.Add: 'sum_of', ast.Sub: 'difference_of', ast.Mult: 'product_of'}
_CHOICE, _AND, _COMPARED, _UNARY, _POSTFIX = 1, 3, 8, 12, 13   # how tight operators bind
_LINE = 112


def head_of(function: ast.FunctionDef, scope: Scope) -> str:
    """Return what a function is declared as."""
    arguments = ', '.join(declared_as(kind, name) for name, kind in scope.parameters[function.name].items())
    result = declared_as(scope.results[function.name], scope.functions[function.name])
    return '\n'.join(_broken(f'{mark_of(function)} {result}({arguments or "void"})'))


def printed(function: ast.FunctionDef, scope: Scope) -> tuple[str, dict[str, Any], list[TupleKind]]:
    """Return a function in C, the names that it uses (values of constants, too) and its tuples; raises UnitError."""
    body = Body(function, scope)
    lines = list(body.block(function.body[ast.get_docstring(function) is not None:], 1))
    docstring = (ast.get_docstring(function) or '').partition('\n')[0]
    locals_: dict[str, list[str]] = {}
    for name, kind in sorted(body.types.locals.items()):
        locals_.setdefault(text_of(kind), []).append(('*' if isinstance(kind, Record) else '') + c_name(name))
    text = '\n'.join([*([f'/* {docstring} */'] if docstring else []), head_of(function, scope), '{',
                      *(f'    {kind.removesuffix("*").strip()} {", ".join(names)};' for kind, names in locals_.items()),
                      *(f'    (void)({c_name(name)});' for name in body.types.arguments if name not in body.used),
                      *lines, '}'])
    return text, body.names, [kind for kind in (*body.types.locals.values(), *body.types.arguments.values(),
                                                scope.results[function.name], *body.tuples)
                              if isinstance(kind, TupleKind)]


class Body(ast.NodeVisitor):
    """Statements as lines, expressions as text that is in parentheses where something binds tighter outside of it.

    What another language writes in another way stands in methods without an underscore.
    """

    counter = LONG   # what a counter is declared as
    arrow = '->'     # from a record to its field

    def __init__(self, function: ast.FunctionDef, scope: Scope) -> None:
        self._function, self._scope, self.types = function, scope, LocalTypes(function, scope)
        self._own = {*self.types.arguments, *self.types.locals, *self.types.counters}
        self.names, self.used, self.tuples = dict[str, Any](), set[str](), list[TupleKind]()
        self._numbers = count(1)

    # statements

    def block(self, statements: Sequence[ast.stmt], depth: int) -> Iterator[str]:
        """Yield the lines of statements."""
        for statement in statements:
            for line in self._lines(statement, depth):
                yield from _broken('    ' * depth + line) if not line.startswith('    ') else [line]

    def _lines(self, node: ast.stmt, depth: int) -> Iterator[str]:
        if isinstance(node, ast.Return):
            result = self._scope.results[self._function.name]
            yield 'return;' if node.value is None else f'return {self._as(node.value, result)};'
        elif isinstance(node, ast.Assign | ast.AnnAssign):
            targets = list(node.targets) if isinstance(node, ast.Assign) else [node.target]
            if node.value is not None:
                yield from self._assigned(targets, node.value)
        elif isinstance(node, ast.AugAssign):
            yield self._augmented(node)
        elif isinstance(node, ast.If):
            yield from self._if(node, depth, 'if')
        elif isinstance(node, ast.While | ast.For) and not node.orelse:
            yield f'{self._loop(node)} {{'
            yield from self.block(node.body, depth + 1)
            yield '}'
        elif isinstance(node, ast.Expr) and isinstance(node.value, ast.Call):
            yield f'{self.text(node.value)};'
        elif isinstance(node, ast.Break | ast.Continue):
            yield 'break;' if isinstance(node, ast.Break) else 'continue;'
        elif not isinstance(node, ast.Pass):
            self._refuse(node, f'{ast.unparse(node).partition(chr(10))[0]!r}, a statement which the unit does not have')

    def _if(self, node: ast.If, depth: int, word: str) -> Iterator[str]:
        yield f'{word} ({self.text(node.test)}) {{'
        yield from self.block(node.body, depth + 1)
        if len(node.orelse) == 1 and isinstance(node.orelse[0], ast.If):
            yield from self._if(node.orelse[0], depth, '} else if')
            return
        if node.orelse:
            yield '} else {'
            yield from self.block(node.orelse, depth + 1)
        yield '}'

    def _loop(self, node: ast.While | ast.For) -> str:
        if isinstance(node, ast.While):
            return f'while ({self.text(node.test)})'
        call = node.iter
        if not (isinstance(call, ast.Call) and ast.unparse(call.func) == 'range' and len(call.args) < 3):
            self._refuse(node, f'a loop over {ast.unparse(call)}; loop over range(count) or range(first, end)')
        begin = self._as(call.args[0], LONG) if len(call.args) == 2 else '0'
        end, counter = self._as(call.args[-1], LONG), ast.unparse(node.target)
        counter = f'turn{next(self._numbers)}' if counter == '_' else c_name(counter)
        if isinstance(call.args[-1], ast.Constant | ast.Name):
            return f'for ({self.counter} {counter} = {begin}; {counter} < {end}; {counter}++)'
        return (f'for ({self.counter} {counter} = {begin}, {counter}_end = {end}; {counter} < {counter}_end; '
                f'{counter}++)')

    def _assigned(self, targets: Sequence[ast.expr], value: ast.expr) -> Iterator[str]:
        if not isinstance(targets[0], ast.Tuple):
            to = self.types.kind(targets[0]) or DOUBLE
            yield ' = '.join([*map(self.text, targets), self._as(value, to)]) + ';'
            return
        parts = targets[0].elts
        if isinstance(value, ast.Tuple) and not self._exchanges(parts, value.elts):
            for part, one in zip(parts, value.elts, strict=True):
                if ast.unparse(part) != '_':
                    yield from self._assigned([part], one)
            return
        kind = self.types.kind(value)
        if not isinstance(kind, TupleKind):
            self._refuse(value, f'{ast.unparse(value)} as a tuple, which it is not')
        place = self.text(value)
        if not isinstance(value, ast.Name):
            place = f'got{next(self._numbers)}'
            self.tuples.append(kind)
            yield f'{self.declared(kind)} {place} = {self._as(value, kind)};'
        for part, field in zip(parts, kind.fields, strict=True):
            if ast.unparse(part) != '_':
                yield f'{self.text(part)} = {place}.{field};'

    def _exchanges(self, targets: list[ast.expr], values: list[ast.expr]) -> bool:
        """Whether something that stands on the right is set on the left before."""
        for i, target in enumerate(targets):
            name = ast.unparse(target)
            for value in values[i + 1:]:
                inside = list(ast.walk(value))
                if any(isinstance(one, ast.Name | ast.Attribute) and ast.unparse(one) == name for one in inside) or (
                        not isinstance(target, ast.Name) and any(isinstance(one, ast.Call) and any(
                            isinstance(self.types.kind(given), Record) for given in one.args) for one in inside)):
                    return True
        return False

    def _augmented(self, node: ast.AugAssign) -> str:
        kind, target = self.types.kind(node.target), self.text(node.target)
        if kind == COMPLEX:
            if type(node.op) not in _ON_COMPLEX:
                self._refuse(node, f'{ast.unparse(node)!r}; complex numbers are added, subtracted and multiplied')
            return f'{target} = {_ON_COMPLEX[type(node.op)]}({target}, {self._as(node.value, COMPLEX)});'
        if type(node.op) not in _OPERATORS or (isinstance(node.op, ast.Div) and kind != DOUBLE):
            self._refuse(node, f'{ast.unparse(node)!r}, an operator which the unit does not have')
        return f'{target} {_OPERATORS[type(node.op)][0]}= {self.text(node.value)};'

    # expressions

    def text(self, node: ast.expr, level: int = 0) -> str:
        """Return an expression, in parentheses unless it binds at least so tight."""
        found = self.visit(node)
        if found is None:
            self._refuse(node, f'{ast.unparse(node)}, an expression which the unit does not have')
        text, own = found
        return text if own >= level else f'({text})'

    def _as(self, node: ast.expr, kind: Kind) -> str:
        """Return an expression as a value of a type."""
        if isinstance(node, ast.IfExp) and (isinstance(kind, TupleKind) or kind == COMPLEX):
            return f'{self.text(node.test, _CHOICE + 1)} ? {self._as(node.body, kind)} : {self._as(node.orelse, kind)}'
        if isinstance(kind, TupleKind):
            if isinstance(node, ast.Tuple):
                return self._made(kind, node.elts)
            if text_of(self.types.kind(node) or VOID) != text_of(kind):
                self._refuse(node, f'{ast.unparse(node)}, which is no {text_of(kind)}')
        own = self.types.kind(node)
        if kind == COMPLEX and own != COMPLEX:
            return f'complex_of({self.text(node)}, 0.0)'
        if isinstance(own, Record) and own.within and not own.many:
            return self.pointer_to(self.text(node, _UNARY))
        return self.text(node)

    def declared(self, kind: Kind) -> str:
        """Return the type with which a tuple is declared."""
        return text_of(kind)

    def pointer_to(self, text: str) -> str:
        """Return where a record is."""
        return f'&{text}'

    def tuple_of(self, kind: TupleKind, items: Sequence[str]) -> str:
        """Return a tuple of these."""
        return f'({text_of(kind)}){{{", ".join(items)}}}'

    def cast(self, kind: str, node: ast.expr) -> str:
        """Return a number as one of another type."""
        return f'({kind}){self.text(node, _UNARY)}'

    def _made(self, kind: TupleKind, items: Sequence[ast.expr]) -> str:
        self.tuples.append(kind)
        return self.tuple_of(kind, [self._as(item, one) for item, one in zip(items, kind, strict=True)])

    def visit_Constant(self, node: ast.Constant) -> tuple[str, int]:
        """Return a number."""
        if not isinstance(node.value, bool | int | float):
            self._refuse(node, f'{node.value!r}, which is no number')
        return (repr(node.value).lower() if isinstance(node.value, bool) else repr(node.value)), _POSTFIX

    def visit_Name(self, node: ast.Name) -> tuple[str, int]:
        """Return what a name means in the unit."""
        name, scope = node.id, self._scope
        if name in self._own:
            self.used.add(name)
            return c_name(name), _POSTFIX
        if name == 'clear_state':
            return name, _POSTFIX
        if name in scope.functions or isinstance(scope.constants.get(name), int | float | tuple):
            self.names[scope.unit_name(name)] = None if name in scope.functions else scope.constants[name]
            return scope.unit_name(name), _POSTFIX
        self._refuse(node, f'{name}, which is neither a number nor a marked function')

    def visit_Attribute(self, node: ast.Attribute) -> tuple[str, int]:
        """Return a field, or what C has for one of `math`."""
        if isinstance(node.value, ast.Name) and node.value.id == 'math':
            if node.attr in OF_MATH or node.attr in _C_FUNCTIONS:
                return OF_MATH.get(node.attr, node.attr), _POSTFIX
            self._refuse(node, f'math.{node.attr}, which the unit does not take from C')
        is_pointer = isinstance(node.value, ast.Name) and isinstance(self.types.kind(node.value), Record)
        return f'{self.text(node.value, _POSTFIX)}{self.arrow if is_pointer else "."}{c_name(node.attr)}', _POSTFIX

    def visit_Subscript(self, node: ast.Subscript) -> tuple[str, int]:
        """Return an item of a row, or of a tuple."""
        whole, text = self.types.kind(node.value), self.text(node.value, _POSTFIX)
        if isinstance(whole, TupleKind):
            return f'{text}.{whole.fields[ast.literal_eval(node.slice)]}', _POSTFIX
        return f'{text}[{self.text(node.slice)}]', _POSTFIX

    def visit_Tuple(self, node: ast.Tuple) -> tuple[str, int]:
        """Return a tuple."""
        kind = self.types.kind(node)
        assert isinstance(kind, TupleKind)
        return self._made(kind, node.elts), _POSTFIX

    def visit_Call(self, node: ast.Call) -> tuple[str, int]:
        """Return a call; conversions are casts, and a tuple with names is a structure."""
        name, scope, given = ast.unparse(node.func), self._scope, node.args
        kind = scope.types.get(name)
        if isinstance(kind, TupleKind):
            words = {word.arg: word.value for word in node.keywords}
            return self._made(kind, [*given, *(words[field] for field in kind.names[len(given):])]), _POSTFIX
        if node.keywords:
            self._refuse(node, f'{name} with names of arguments; give them in order')
        if name in ('int', 'float'):
            return self.cast(LONG if name == 'int' else DOUBLE, given[0]), _UNARY
        if name in ('max', 'min'):
            if self.types.kind(node) != DOUBLE:
                self._refuse(node, f'{name} of integers, which the unit does not have')
            function, text = ('larger', 'smaller')[name == 'min'], self.text(given[0])
            for other in given[1:]:
                text = f'{function}({text}, {self.text(other)})'
            return text, _POSTFIX
        if name in ('abs', 'complex'):
            function = {'complex': 'complex_of', 'abs': 'fabs' if self.types.kind(given[0]) == DOUBLE else 'labs'}[name]
            return f'{function}({", ".join(map(self.text, given))})', _POSTFIX
        function = self.text(node.func)
        kinds = scope.parameters[name].values() if name in scope.parameters else [DOUBLE] * len(given)
        return f'{function}({", ".join(self._as(*pair) for pair in zip(given, kinds, strict=True))})', _POSTFIX

    def visit_BinOp(self, node: ast.BinOp) -> tuple[str, int]:
        """Return a sum, a product, a power."""
        sides = self.types.kind(node.left), self.types.kind(node.right)
        if COMPLEX in sides and type(node.op) in _ON_COMPLEX:
            return (f'{_ON_COMPLEX[type(node.op)]}({self._as(node.left, COMPLEX)}, {self._as(node.right, COMPLEX)})',
                    _POSTFIX)
        if isinstance(node.op, ast.Pow | ast.Mod) and DOUBLE in sides:
            function = 'pow' if isinstance(node.op, ast.Pow) else 'fmod'   # of numbers that are not negative
            return f'{function}({self.text(node.left)}, {self.text(node.right)})', _POSTFIX
        if COMPLEX in sides or type(node.op) not in _OPERATORS:
            self._refuse(node, f'{ast.unparse(node)}, an operator which the unit does not have')
        operator, level = _OPERATORS[type(node.op)]
        left = self.text(node.left, level)
        if operator == '/' and DOUBLE not in sides:
            left = self.cast(DOUBLE, node.left)
        return f'{left} {operator} {self.text(node.right, level + 1)}', level

    def visit_UnaryOp(self, node: ast.UnaryOp) -> tuple[str, int]:
        """Return a number with the other sign, or the other truth."""
        if self.types.kind(node.operand) == COMPLEX:
            self._refuse(node, f'{ast.unparse(node)}; complex numbers are added, subtracted and multiplied')
        sign = '!' if isinstance(node.op, ast.Not) else '-'
        return f'{sign}{self.text(node.operand, _POSTFIX)}', _UNARY

    def visit_Compare(self, node: ast.Compare) -> tuple[str, int]:
        """Return a comparison; one between two others is looked at twice."""
        sides = [node.left, *node.comparators]
        if any(isinstance(part, ast.Call) for side in sides[1:-1] for part in ast.walk(side)):
            self._refuse(node, f'{ast.unparse(node)}, a call between two comparisons; give its result a name')
        if isinstance(node.ops[0], ast.In) and isinstance(sides[1], ast.Tuple):
            left = self.text(sides[0], _COMPARED + 1)
            return ' || '.join(f'{left} == {self.text(one, _COMPARED + 1)}' for one in sides[1].elts), _AND
        if any(type(operator) not in _COMPARISONS for operator in node.ops):
            self._refuse(node, f'{ast.unparse(node)}, a comparison which the unit does not have')
        parts = [f'{self.text(left, _COMPARED + 1)} {_COMPARISONS[type(operator)]} {self.text(right, _COMPARED + 1)}'
                 for left, operator, right in zip(sides, node.ops, sides[1:], strict=False)]
        return ' && '.join(parts), (_AND if len(parts) > 1 else _COMPARED)

    def visit_BoolOp(self, node: ast.BoolOp) -> tuple[str, int]:
        """Return both truths, or either."""
        if any(self.types.kind(value) != BOOL for value in node.values):
            self._refuse(node, f'{ast.unparse(node)}, which is of more than truths; compare each')
        operator = ' && ' if isinstance(node.op, ast.And) else ' || '
        return operator.join(self.text(value, _COMPARED) for value in node.values), _AND

    def visit_IfExp(self, node: ast.IfExp) -> tuple[str, int]:
        """Return one of two."""
        kind = self.types.kind(node) or DOUBLE
        if isinstance(kind, TupleKind) or kind == COMPLEX:
            return self._as(node, kind), _CHOICE
        return (f'{self.text(node.test, _CHOICE + 1)} ? {self.text(node.body, _CHOICE + 1)} : '
                f'{self.text(node.orelse, _CHOICE + 1)}'), _CHOICE

    def _refuse(self, node: ast.AST, what: str) -> NoReturn:
        raise UnitError(self._scope.source.path, node, f'{self._function.name} uses {what}')


def _broken(line: str) -> Iterator[str]:
    """Yield a line in parts that are not too long, broken behind a comma or before an operator."""
    rest = '    ' + ' ' * (len(line) - len(line.lstrip()))
    while len(line) > _LINE:
        at = max(line.rfind(', ', len(rest) + 1, _LINE) + 1, *(
            line.rfind(f' {operator} ', len(rest) + 1, _LINE) for operator in ('+', '-', '*', '&&', '||', '?', ':')))
        if at <= 0:
            break
        yield line[:at]
        line = rest + line[at + 1:]
    yield line
