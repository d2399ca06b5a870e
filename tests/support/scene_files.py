# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Scene files for tests, and what refuses them."""

import pathlib
from typing import Any

import pytest

from stickslip_sim.core.errors import InputError

HEAD = '/**:\n  ros__parameters:\n'
NAME = '    scene: unnamed\n'


def write(folder: pathlib.Path, body: str, head: str | None = None) -> str:
    """Write a scene file, with the name that a scene without one bears unless it has a head; return its path."""
    if head is None:
        head = HEAD + ('' if 'scene:' in body else NAME)
    path = folder / 'scene.yaml'
    path.write_text(head + body, encoding='utf-8')
    return str(path)


def refusal(function: Any, *arguments: Any) -> InputError:
    """Return the error of a call that must be refused in one line."""
    with pytest.raises(InputError) as caught:
        function(*arguments)
    assert '\n' not in str(caught.value)
    return caught.value
