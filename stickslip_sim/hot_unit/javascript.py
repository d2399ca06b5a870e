# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The same functions as one script of JavaScript, for a page: tuples and records are objects, long is a number.

It has the names of the C and none of its comments; the maths of a browser differ from those of C in the last bit.
"""

import ast
import re
from collections.abc import Mapping, Sequence

from .kinds import LONG, Kind, Record, TupleKind, c_name
from .printer import OF_MATH, Body
from .unit import Unit

# what a page has: the exact engine with its pieces of inputs and its figures, and static friction to be drawn
PAGE: dict[str, tuple[str, ...]] = {
    'friction/static.py': ('static_coefficient',),
    'solvers/exact/engine.py': ('start', 'advance', 'sample'),
    'solvers/exact/pieces.py': ('piece_at', 'enter_pieces'),
    'solvers/exact/many_axes.py': ('run_axis', 'book'),
}
_SPACES = re.compile(r' ?([-+]?=|[!=<>]=|[<>*/?:{}]|&&|\|\||[,;]) ')   # not around + and -: there are signs
_HEAD = '''"use strict";
const {asin, atan2, cos, exp, expm1, floor, log, log1p, pow, sin, sqrt, abs: fabs, abs: labs, trunc} = Math;
const INFINITY = Infinity, NAN = NaN, isfinite = Number.isFinite, isnan = Number.isNaN;
function isinf(a) { return a === INFINITY || a === -INFINITY; }
function copysign(a, b) { return b < 0 || 1 / b < 0 ? -fabs(a) : fabs(a); }
function fmod(a, b) { return a % b; }
function larger(a, b) { return b > a ? b : a; }
function smaller(a, b) { return b < a ? b : a; }
function complex_of(real, imag) { return {real, imag}; }
function sum_of(a, b) { return {real: a.real + b.real, imag: a.imag + b.imag}; }
function difference_of(a, b) { return {real: a.real - b.real, imag: a.imag - b.imag}; }
function product_of(a, b) { return {real: a.real * b.real - a.imag * b.imag, imag: a.real * b.imag + a.imag * b.real}; }
function rows(count, make) { return Array.from({length: count}, make); }
function clear(record) {
for (const [name, value] of Object.entries(record)) {
if (typeof value === "number") { record[name] = 0.0; }
else if (name !== "sinusoids" && name !== "scratch") { clear(value); }
}
}
function clear_state(s) { clear(s); }'''


class _Body(Body):
    """What JavaScript writes in another way than C."""

    counter = 'let'
    arrow = '.'

    def declared(self, kind: Kind) -> str:
        """Return the word that declares."""
        return 'const'

    def pointer_to(self, text: str) -> str:
        """Return a record, which is passed as it is."""
        return text

    def tuple_of(self, kind: TupleKind, items: Sequence[str]) -> str:
        """Return a tuple as an object."""
        return f'{{{", ".join(map("{}: {}".format, kind.fields, items))}}}'

    def cast(self, kind: str, node: ast.expr) -> str:
        """Return a whole number cut off, any other as it is; a truth counts."""
        return f'trunc({self.text(node)})' if kind == LONG else f'+{self.text(node, 13)}'


def script(unit: Unit, roots: Mapping[str, Sequence[str]] = PAGE) -> str:
    """Return the script of some functions, by file, and of all that they need; raises UnitError."""
    used = unit.reached(roots)
    lines = [_HEAD, *(_class(name, unit.kinds.records[name]) for name in unit.kinds.own)]
    for name, value in sorted(used.items()):
        if isinstance(value, tuple):
            lines.append(f'const {name} = [{", ".join(map(repr, value))}];')
        elif isinstance(value, int | float):
            lines.append(f'const {name} = {OF_MATH.get(repr(value), repr(value))};')
    for name, function, scope in unit.functions():
        if name in used:
            body = _Body(function, scope)
            inside = body.block(function.body[ast.get_docstring(function) is not None:], 0)
            own = ', '.join(map(c_name, sorted(body.types.locals)))
            lines += [f'function {name}({", ".join(map(c_name, scope.parameters[function.name]))}) {{',
                      *([f'let {own};'] if own else []), *(line.strip() for line in inside), '}']
    return _SPACES.sub(r'\1', '\n'.join(lines)) + '\n'


def _class(name: str, fields: Mapping[str, Kind]) -> str:
    """Return a record; its numbers begin as floats, which the engines of browsers then keep them as."""
    inside = ' '.join(f'this.{c_name(field)} = {_first(kind)};' for field, kind in fields.items())
    return f'class {name} {{ constructor() {{ {inside} }} }}'


def _first(kind: Kind) -> str:
    if not isinstance(kind, Record):
        return '0' if kind == LONG else '0.5'
    if not kind.within:
        return '[]'
    one = '0.5' if kind.name == 'double' else f'new {kind.name}()'
    return f'rows({kind.length}, () => {one})' if kind.length else one
