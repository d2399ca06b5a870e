# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""What the names of a file mean in the unit."""

import ast
from typing import Any

from .c_types import Kind, NamedKinds, declared
from .constants import Constants
from .errors import UnitError
from .sources import Source, Sources


class Scope:
    """The names of a file: functions of the unit and what they return, constants, rows of numbers, tuples."""

    def __init__(self, source: Source, sources: Sources, constants: Constants, kinds: NamedKinds) -> None:
        self.source, self.constants, self.kinds = source, constants.of(source.name), kinds.of(source.name)
        self.functions: dict[str, str] = {}       # their names in the unit
        self.results: dict[str, Kind] = {}
        self.tables = {name: unit_name(source, name) for name in rows_of_numbers(source, self.constants)}
        for name in source.functions:
            self._add(name, source, name, self.kinds)
        for name, (file, original) in source.imports.items():
            origin = sources.of(file)
            if original in origin.functions:
                self._add(name, origin, original, kinds.of(file))

    def arguments_of(self, function: ast.FunctionDef) -> dict[str, Kind]:
        """Return the arguments of a function with their types; raises UnitError."""
        given = function.args
        if given.posonlyargs or given.kwonlyargs or given.vararg or given.kwarg or given.defaults:
            raise UnitError(self.source.path, function,
                            f'{function.name} has more than plain arguments; write each one out, without defaults')
        return {argument.arg: declared(argument.annotation, f'the argument {argument.arg} of {function.name}', argument,
                                       self.source, self.kinds) for argument in given.args}

    def _add(self, name: str, origin: Source, original: str, kinds: dict[str, Kind]) -> None:
        function = origin.functions[original]
        self.functions[name] = unit_name(origin, original)
        self.results[name] = declared(function.returns, f'what {original} returns', function, origin, kinds)


def unit_name(source: Source, name: str) -> str:
    """Return the name in the unit of something in a file."""
    return f'{source.prefix}_{name}'


def rows_of_numbers(source: Source, constants: dict[str, Any]) -> dict[str, tuple[float, ...]]:
    """Return the constants that a file itself has and that are rows of floats."""
    return {name: value for name, value in constants.items()
            if name not in source.imports and isinstance(value, tuple) and value
            and all(isinstance(number, float) for number in value)}
