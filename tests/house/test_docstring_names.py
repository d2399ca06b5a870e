# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""A name in backticks in a docstring is one of the package: of something in its code, or of what its texts name.

So a docstring does not go on to name what has another name by now.  Examples that are no names stand in quotes.
"""

import ast
import builtins
import re
from collections import defaultdict
from functools import cache
from itertools import pairwise
from pathlib import Path
from typing import NamedTuple

import stickslip_sim
from stickslip_sim.scene.schema import BY_NAME

PACKAGE = Path(stickslip_sim.__file__).parent
IN_BACKTICKS = re.compile(r'`([A-Za-z_]\w*(?:\.[A-Za-z_]\w*)*)(?:\(\))?`')
DOCUMENTED = ast.Module | ast.ClassDef | ast.FunctionDef
NAMING = {'id', 'attr', 'arg', 'name', 'asname', 'module'}   # fields of nodes


class Source(NamedTuple):
    """A module: its docstrings, the texts in its code, and what has a name there or stands in a text."""

    docstrings: list[str]
    texts: list[str]
    names: set[str]


def source(path: Path) -> Source:
    nodes = [*ast.walk(ast.parse(path.read_text(encoding='utf-8')))]
    docs = [node.body[0].value for node in nodes if isinstance(node, DOCUMENTED) and node.body
            and isinstance(node.body[0], ast.Expr) and isinstance(node.body[0].value, ast.Constant)]
    of_docs = {*map(id, docs)}
    texts = [node.value for node in nodes
             if isinstance(node, ast.Constant) and isinstance(node.value, str) and id(node) not in of_docs]
    names = {word for text in texts for word in re.findall(r'\w+', text)}
    for node in nodes:
        for field in NAMING.intersection(node._fields):
            names.update((getattr(node, field) or '').split('.'))
    return Source([str(one.value) for one in docs], texts, names)


@cache
def sources() -> dict[Path, Source]:
    return {path.relative_to(PACKAGE): source(path) for path in PACKAGE.rglob('*.py')}


@cache
def known() -> tuple[dict[str, set[str]], set[str], str]:
    """Return the names in each module or room by its name, all of them, and all texts."""
    inside: defaultdict[str, set[str]] = defaultdict(set)
    for path, module in sources().items():
        own = path.parent.name if path.stem == '__init__' else path.stem
        inside[own] |= module.names
        places = [PACKAGE.name, *path.parent.parts, path.stem]
        for room, part in pairwise(places):
            inside[room].add(part)
    every = set().union(*inside.values(), inside, dir(builtins))
    return inside, every, '\n'.join(text for module in sources().values() for text in module.texts)


def is_known(name: str) -> bool:
    """Return whether there is such a name; capitals in one with dots, SECTION.file, stand for others."""
    inside, every, written = known()
    if '.' not in name:
        return name in every
    if name in written or name in BY_NAME:
        return True
    parts = [part for part in name.split('.') if not part.isupper()]
    return {*parts} <= every and all(room not in inside or part in inside[room] for room, part in pairwise(parts))


def test_names_in_backticks_exist() -> None:
    named = [(str(path), name) for path, module in sources().items() for text in module.docstrings
             for name in IN_BACKTICKS.findall(text)]
    assert len(named) > 1000
    assert [one for one in named if not is_known(one[1])] == []


def test_a_name_that_is_gone_is_found() -> None:
    assert not is_known('simulate_evnts')
    assert not is_known('runs.simulate_evnts')
    assert not is_known('solvers.exact.sweep')
    assert all(map(is_known, ('simulate_events', 'runs.batch.run_batch', 'SECTION.file', 'drive.velocity', 'str')))
