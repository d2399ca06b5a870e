# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""What the unit cannot be written from."""

import ast
from pathlib import Path


class UnitError(Exception):
    """A source that cannot be compiled: one line that says where, what, and what to write instead."""

    def __init__(self, path: Path, node: ast.AST, message: str) -> None:
        super().__init__(f'{path}:{getattr(node, "lineno", 1)}: {message}')
