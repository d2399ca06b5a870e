# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""One switch between machine code and plain Python for the hot path.

An installed package brings its machine code along (`ahead` compiles it while it is built), and needs no compiler.  From
a source tree numba compiles at the first start, and keeps the code in a cache folder.  Module and folder are named by a
hash of all sources of the hot path, so that a change in any of them is never run with old code.

`STICKSLIP_COMPILED` chooses: `0` runs the same source as plain Python, with the same results; `jit` has numba compile,
which whoever calls the hot path from compiled code of their own needs.
"""

import functools
import hashlib
import importlib
import os
import pathlib
from collections.abc import Callable
from typing import Any, TypeVar

_Function = TypeVar('_Function', bound=Callable[..., object])
_HOT_PATH = ('core/jit.py', 'axis', 'friction/static.py', 'linear', 'solvers')
_RIVALS = ('bench/peers',)   # compiled too, never shipped as machine code
_PACKAGE = __package__.rpartition('.')[0]
_OPTIONS = {'cache': True, 'error_model': 'numpy', '_nrt': False}   # no array is made, so that none needs counting


@functools.cache
def source_digest(*others: str) -> str:
    """Return 16 digits that change with every source of the hot path, and of the other rooms that are named."""
    root = pathlib.Path(__file__).parent.parent
    digest = hashlib.sha256()
    for room in (*_HOT_PATH, *others):
        for path in sorted([root / room, *(root / room).rglob('*.py')]):
            if path.is_file():
                digest.update(path.read_bytes())
    return digest.hexdigest()[:16]


def _load_numba() -> Any:
    base = os.environ.get('XDG_CACHE_HOME') or os.path.join(os.path.expanduser('~'), '.cache')
    os.environ.setdefault('NUMBA_CACHE_DIR', os.path.join(base, 'stickslip', source_digest(*_RIVALS)))
    try:
        import numba
    except ImportError:
        return None
    return numba


def ahead_name(part: str) -> str:
    """Return the name of the extension module with a part of the machine code: `steps` or `batch`."""
    return f'_ahead_{part}_{source_digest()}'


def _load_ahead(part: str) -> Any:
    try:
        return importlib.import_module(f'{_PACKAGE}.{ahead_name(part)}')
    except ImportError:
        return None


_wish = os.environ.get('STICKSLIP_COMPILED', '1')
_ahead: Any = _load_ahead('steps') if _wish not in ('0', 'jit') else None
_ahead_batch: Any = _load_ahead('batch') if _ahead else None
_numba: Any = None if _wish == '0' or _ahead else _load_numba()
IS_COMPILED = _ahead is not None or _numba is not None


def compiled(function: _Function) -> _Function:
    """Compile a scalar function of the hot path, or leave it as it is."""
    return _numba.njit(**_OPTIONS)(function) if _numba else function


def inlined(function: _Function) -> _Function:
    """Compile a function into its callers: an array as an argument is seven numbers, a call of three costs 10 ns."""
    return _numba.njit(forceinline=True, **_OPTIONS)(function) if _numba else function


def compiled_without_lock(function: _Function) -> _Function:
    """Compile a function that works for long, while other threads may run Python; or leave it as it is."""
    return _numba.njit(nogil=True, **_OPTIONS)(function) if _numba else function


def entry(room: str, function: _Function) -> _Function:
    """Return the machine code of a function that Python calls: compiled ahead, or as `compiled` left it."""
    name = f'{room}_{function.__name__}'
    found: _Function = getattr(_ahead, name, None) or getattr(_ahead_batch, name, None) or function
    return found


def always_compiled(function: _Function) -> _Function:
    """Compile whatever the switch says: a rival of the benchmark is never held back by it."""
    numba = _numba or _load_numba()
    return numba.njit(**_OPTIONS)(function) if numba else function


def hot_path() -> str:
    """Return in words what the hot path runs as."""
    if _ahead:
        return 'compiled ahead'
    return f'numba {_numba.__version__}' if _numba else 'plain python'
