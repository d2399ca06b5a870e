# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The files of the hot path: those in its rooms with a function that is marked as compiled; and their constants."""

import ast
import hashlib
import math
from enum import IntEnum
from functools import cache, cached_property
from pathlib import Path
from typing import Any

ROOMS = ('friction', 'linear', 'axis', 'solvers')
MARKS = {'compiled': 'static', 'inlined': 'static inline'}
_BASICS = {'math': math, 'float': float, 'int': int, 'len': len, 'range': range, 'tuple': tuple}


class UnitError(Exception):
    """A source that cannot be compiled: one line that says where, what, and what to write instead."""

    def __init__(self, path: Path, node: ast.AST, message: str) -> None:
        super().__init__(f'{path}:{getattr(node, "lineno", 1)}: {message}')


class Source:
    """A file of the package, by its path in there."""

    def __init__(self, package: Path, name: str) -> None:
        self.package, self.name, self.path = package, name, package / name
        self.text = self.path.read_text(encoding='utf-8')

    @cached_property
    def tree(self) -> ast.Module:
        """The file, parsed."""
        return ast.parse(self.text, str(self.path))

    def unit_name(self, name: str) -> str:
        """Return the name in the unit of something in this file: begun with that of the file."""
        file = self.path.parent if self.path.stem == '__init__' else self.path
        return f'{file.stem}_{name.lstrip("_")}'

    @cached_property
    def functions(self) -> dict[str, ast.FunctionDef]:
        """Its marked functions."""
        return {node.name: node for node in self.tree.body if isinstance(node, ast.FunctionDef) and mark_of(node)}

    @cached_property
    def imports(self) -> dict[str, tuple[str, str]]:
        """The names that it takes from files of the package: (file, name there)."""
        found = {}
        for node in ast.walk(self.tree):
            if isinstance(node, ast.ImportFrom) and node.level:
                file = self._file_of(node)
                for alias in node.names:
                    found[alias.asname or alias.name] = (file, alias.name)
        return found

    def _file_of(self, node: ast.ImportFrom) -> str:
        """Return the file that an import is from: a module, or the __init__ of a room."""
        folder = self.path.parent
        for _ in range(node.level - 1):
            folder = folder.parent
        base = folder.joinpath(*(node.module or '').split('.'))
        for file in (base.with_suffix('.py'), base / '__init__.py'):
            if file.is_file():
                return file.relative_to(self.package).as_posix()
        raise UnitError(self.path, node, f'there is no file for the import from {"." * node.level}{node.module or ""}')


def mark_of(function: ast.FunctionDef) -> str | None:
    """Return what a marked function is declared as in C, None of another one."""
    for decorator in function.decorator_list:
        if isinstance(decorator, ast.Name) and decorator.id in MARKS:
            return MARKS[decorator.id]
    return None


class Sources:
    """The files of a package, each read once."""

    def __init__(self, package: Path) -> None:
        self._package = package
        self.of = cache(lambda name: Source(package, name))

    def hot(self) -> list[Source]:
        """Return those with marked functions, in the order of the rooms and then of their paths."""
        paths = (path for room in ROOMS for path in sorted((self._package / room).rglob('*.py')))
        sources = (self.of(path.relative_to(self._package).as_posix()) for path in paths)
        return [source for source in sources if source.functions]


def digest_of(package: Path, names: list[str]) -> str:
    """Return the digest of some files of the package; `core` computes the same when it loads the unit."""
    digest = hashlib.sha256()
    for name in names:
        digest.update((package / name).read_bytes())
    return digest.hexdigest()


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
