# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Folders of studies that somebody has edited, and the words that describe a study on a command line."""

import json
import os
from collections.abc import Callable, Sequence
from contextlib import redirect_stderr, redirect_stdout
from io import StringIO
from pathlib import Path
from typing import Any, NamedTuple
from unittest import mock

from hypothesis import strategies as st
from hypothesis.strategies import DrawFn, SearchStrategy

from stickslip_sim.cli.main import run
from stickslip_sim.study.folder import PARTIAL, POINTS_TABLE, SIDECAR
from tests.support import made_up_texts

_SCENE = 'paper_fig7'
_GRID = ('--over', 'drive.velocity=0.001:0.01:3', '--over', 'friction.static.limit=0.2:0.3:2', '--duration', '2')
_DRAWN = ('--samples', '16', '--duration', '2')
_DISTRIBUTIONS = ('seed: 0\nparameters:\n  axis.normal_force: {distribution: uniform, low: 3000.0, high: 3800.0}\n'
                  '  friction.static.limit: {distribution: normal, mean: 0.24, standard_deviation: 0.02,'
                  ' between: [0.18, 0.3]}\n')
_ODD: SearchStrategy[Any] = (
    st.none() | st.booleans() | st.sampled_from((0, -1, 1, 10**30, 10**400, 0.5, 1e400, -0.0, '', [], {}, [[]]))
    | st.floats() | st.text(max_size=20) | made_up_texts.NAMES)
_CELLS = st.sampled_from(('', 'inf', '-1', 'stick-slip', '2', '7', '1e308')) | made_up_texts.WORDS


class Edited(NamedTuple):
    """The files of a folder by name, and what resumes its study."""

    files: dict[str, str]
    command: Sequence[str]


def folders(where: Path) -> SearchStrategy[Edited]:
    """Run a grid and a sample of distributions in a folder; return what may become of their folders."""
    known = where / 'known.yaml'
    known.write_text(_DISTRIBUTIONS)
    commands = (['sweep', _SCENE, *_GRID], ['uncertainty', _SCENE, '--with', str(known), *_DRAWN])
    made = [_made(where / command[0], command) for command in commands]
    return _edited(made)


DISTRIBUTIONS = made_up_texts.changed([_DISTRIBUTIONS]) | made_up_texts.ANYTHING
_ENDS = st.sampled_from(('0.001', '0.1', '1', '-1', '0', '1e400', 'nan', '1e-320', ' 2', '')) | made_up_texts.WORDS
_RANGES = st.builds('{}:{}'.format, _ENDS, _ENDS)
_ELEMENTS = st.sampled_from(('', '', '[1]', '[0]', '[99]', '[-1]', '[1_0]', '[' + '9' * 50 + ']', '[]', '[\u0661]'))
VARIATIONS = st.builds('{}{}{}{}{}'.format, made_up_texts.NAMES | st.text(max_size=9), _ELEMENTS,
                       st.sampled_from(('=', '=', '=', ' = ', '')), _RANGES,
                       st.sampled_from(('', ':3', ':2:log', ':1', ':x', ':1e3', ':log', ':3:log:log', ':' + '9' * 60)))
OPTIONS = st.tuples(VARIATIONS, _RANGES, st.builds('{},{}'.format, _ENDS, _ENDS) | made_up_texts.WORDS,
                    made_up_texts.WORDS)


def _made(folder: Path, command: Sequence[str]) -> Edited:
    call_tool(*command, '--out', str(folder))
    files = {name: (folder / name).read_text() for name in (SIDECAR, POINTS_TABLE)}
    return Edited(files, command)


@st.composite
def _edited(draw: DrawFn, made: Sequence[Edited]) -> Edited:
    """Return a folder whose description or table was changed; some are incomplete."""
    files, command = draw(st.sampled_from(made))
    files = dict(files)
    changed = draw(st.sampled_from((SIDECAR, SIDECAR, POINTS_TABLE)))
    files[changed] = draw((_changed_json if changed == SIDECAR else _changed_table)(files[changed]))
    if draw(st.integers(0, 3)) == 0:
        files[PARTIAL] = files.pop(POINTS_TABLE)
    return Edited(files, command)


@st.composite
def _changed_json(draw: DrawFn, text: str) -> str:
    """Return JSON with other values in some places, or changed as any text."""
    if draw(st.integers(0, 3)) == 0:
        return draw(made_up_texts.changed([text]))
    tree = json.loads(text)
    for _ in range(draw(st.integers(1, 3))):
        _change_a_value(draw, tree)
    return json.dumps(tree)


@st.composite
def _changed_table(draw: DrawFn, text: str) -> str:
    """Return CSV with other words in some cells, or changed as any text."""
    if draw(st.integers(0, 3)) == 0:
        return draw(made_up_texts.changed([text]))
    rows = [line.split(',') for line in text.splitlines()]
    for _ in range(draw(st.integers(1, 3))):
        row = draw(st.sampled_from(rows))
        row[draw(st.integers(0, len(row) - 1))] = draw(_CELLS)
    return '\n'.join(map(','.join, rows)) + '\n'


def _change_a_value(draw: DrawFn, tree: dict[str, Any]) -> None:
    """Go down the tree at random; there replace, remove or double what is found."""
    node: Any = tree
    while True:
        keys = list(node) if isinstance(node, dict) else list(range(len(node)))
        if not keys:
            return
        key = draw(st.sampled_from(keys))
        if isinstance(node[key], (dict, list)) and draw(st.integers(0, 3)):
            node = node[key]
            continue
        draw(st.sampled_from(_CHANGES))(draw, node, key)
        return


def _replace(draw: DrawFn, node: Any, key: Any) -> None:
    node[key] = draw(_ODD)


def _remove(draw: DrawFn, node: Any, key: Any) -> None:
    del node[key]


def _double(draw: DrawFn, node: Any, key: Any) -> None:
    if isinstance(node, list):
        node.append(node[key])


_CHANGES: list[Callable[[DrawFn, Any, Any], None]] = [_replace, _replace, _remove, _double]


def call_tool(*arguments: str) -> None:
    """Call the tool, which does what it is asked to or refuses in one line; what it would call internal is raised."""
    said = StringIO()
    with mock.patch.dict(os.environ, STICKSLIP_DEBUG='1'), redirect_stdout(StringIO()), redirect_stderr(said):
        code = run(arguments)
    assert code == 0 or said.getvalue().count('\n') == 1, (code, said.getvalue())
