# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Numbers with a name: constants of a file, those that it imports, and members of enumerations."""

import ast
import math
from enum import IntEnum
from functools import cache
from typing import Any

from .sources import Source, Sources

_BASICS = {'math': math, 'float': float, 'int': int, 'len': len, 'range': range, 'tuple': tuple}


class Constants:
    """What the names in the files of a package stand for, read without running the package."""

    def __init__(self, sources: Sources) -> None:
        self._sources = sources
        self.of = cache(self._read)

    def _read(self, file: str) -> dict[str, Any]:
        """Return the constants of a file: numbers, tuples of them, text, and enumerations."""
        source = self._sources.of(file)
        found: dict[str, Any] = {}
        for node in source.tree.body:
            if isinstance(node, ast.ImportFrom) and node.level:
                found.update(self._imported(source, node))
            elif isinstance(node, ast.ClassDef) and any(ast.unparse(base) == 'IntEnum' for base in node.bases):
                found[node.name] = IntEnum(node.name, _values(node.body, {}))
            elif isinstance(node, ast.Assign | ast.AnnAssign):
                found.update(_values([node], found))
        return found

    def _imported(self, source: Source, node: ast.ImportFrom) -> dict[str, Any]:
        found = {}
        for alias in node.names:
            file, name = source.imports[alias.asname or alias.name]
            values = self.of(file)
            if name in values:
                found[alias.asname or alias.name] = values[name]
        return found


def _values(nodes: list[ast.stmt], known: dict[str, Any]) -> dict[str, Any]:
    """Return what assignments give names to, as far as that follows from numbers and other constants."""
    found: dict[str, Any] = {}
    for node in nodes:
        if not isinstance(node, ast.Assign | ast.AnnAssign) or node.value is None:
            continue
        try:
            value = eval(ast.unparse(node.value), {'__builtins__': {}}, {**_BASICS, **known, **found})
        except (NameError, TypeError, AttributeError, ValueError):   # not a constant
            continue
        for target in node.targets if isinstance(node, ast.Assign) else [node.target]:
            if isinstance(target, ast.Tuple):
                found.update({ast.unparse(name): one for name, one in zip(target.elts, value, strict=True)})
            else:
                found[ast.unparse(target)] = value
    return found
