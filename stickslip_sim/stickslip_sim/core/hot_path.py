# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""One switch between machine code and plain Python for the hot path.

The hot path is plain Python.  While the package is built, all of it is compiled as one extension module, `_hot`, in
which every function that is marked here sees every other one (docs/solvers.md).  `STICKSLIP_COMPILED=0` runs the same
source as it stands, with the same results.
"""

import hashlib
import importlib
import os
import sys
from collections.abc import Callable
from pathlib import Path
from types import ModuleType
from typing import TypeVar

_PACKAGE = __package__.rpartition('.')[0]
_Function = TypeVar('_Function', bound=Callable[..., object])


def compiled(function: _Function) -> _Function:
    """Mark a function of the hot path; it may be called from anywhere in it."""
    return function


def inlined(function: _Function) -> _Function:
    """Mark a function of the hot path that is compiled into its few callers: a call would cost more than its work."""
    return function


def entry(function: _Function) -> _Function:
    """Return the machine code of a function of the hot path that Python calls; where there is none, the function."""
    if UNIT is None:
        return function
    found: _Function = getattr(UNIT, f'{function.__module__.rpartition(".")[2]}_{function.__name__}')
    return found


def hot_path() -> str:
    """Return in words what the hot path runs as."""
    return 'plain python' if UNIT is None else 'compiled'


def _load() -> ModuleType | None:
    """Return the unit, None for plain Python: in silence where that was asked for, else with a line that says why."""
    if os.environ.get('STICKSLIP_COMPILED') == '0':
        return None
    try:
        unit = importlib.import_module(f'{_PACKAGE}._hot')
    except ImportError as error:
        _say(f'the compiled hot path is missing ({error})')
        return None
    if not _is_built_from(unit.SOURCES, unit.DIGEST):
        _say('the compiled hot path was built from other sources')
        return None
    return unit


def _is_built_from(names: tuple[str, ...], wanted: str) -> bool:
    """Whether files of this package, all still there, have this digest, as the build takes it."""
    digest, package = hashlib.sha256(), Path(__file__).parents[1]
    try:
        for name in names:
            digest.update((package / name).read_bytes())
    except FileNotFoundError:
        return False
    return digest.hexdigest() == wanted


def _say(what: str) -> None:
    sys.stderr.write(f'stickslip: {what}; plain Python runs instead, hundreds of times slower.  Build the package '
                     'again (pip install, colcon build or make build), or set STICKSLIP_COMPILED=0 to mean it\n')


UNIT = _load()
