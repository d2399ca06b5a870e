# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The files of the hot path: those in its rooms with a function that is marked as compiled."""

import ast
import hashlib
from functools import cache, cached_property
from pathlib import Path

from .errors import UnitError

ROOMS = ('friction', 'linear', 'axis', 'solvers')
MARKS = {'compiled': 'cdef', 'inlined': 'cdef inline'}


class Source:
    """A file of the package, by its path in there."""

    def __init__(self, package: Path, name: str) -> None:
        self.package, self.name, self.path = package, name, package / name
        self.text = self.path.read_text(encoding='utf-8')

    @cached_property
    def tree(self) -> ast.Module:
        """The file, parsed."""
        return ast.parse(self.text, str(self.path))

    @property
    def prefix(self) -> str:
        """What the names of its functions begin with in the unit: its path in words."""
        return self.name.removesuffix('.py').replace('/', '_')

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
    """Return what a marked function is declared as in Cython, None of another one."""
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
