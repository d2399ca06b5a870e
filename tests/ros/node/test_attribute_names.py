# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Nodes of ours neither set nor read what is private to rclpy's Node: it would break far from where it is done."""

import ast
from pathlib import Path

import pytest

import stickslip_sim

node = pytest.importorskip('rclpy.node')
ROOM = Path(stickslip_sim.__file__).parent / 'ros'


def attributes(tree: ast.AST) -> set[str]:
    """Return what is set or read of `self` or a parent class, and the names of the methods."""
    return {part.attr for part in ast.walk(tree) if isinstance(part, ast.Attribute)
            and ast.unparse(part.value) in ('self', 'super()')} | {
        part.name for part in ast.walk(tree) if isinstance(part, ast.FunctionDef)}


def nodes() -> list[ast.ClassDef]:
    """Return our classes whose base has Node in its name."""
    trees = [ast.parse(file.read_text(encoding='utf-8')) for file in sorted(ROOM.rglob('*.py'))]
    return [part for tree in trees for part in ast.walk(tree) if isinstance(part, ast.ClassDef)
            and any('Node' in ast.unparse(base) for base in part.bases)]


@pytest.mark.parametrize('ours', nodes(), ids=lambda ours: ours.name)
def test_nothing_private_to_rclpy_is_touched(ours: ast.ClassDef) -> None:
    theirs = attributes(ast.parse(Path(node.__file__).read_text(encoding='utf-8')))
    private = {name for name in theirs if name.startswith('_') and not name.startswith('__')}
    assert '_publishers' in private
    assert attributes(ours) & private == set()
