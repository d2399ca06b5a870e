"""One switch between machine code (numba) and plain Python for the hot path.

`STICKSLIP_COMPILED=0`, or no numba, runs the same source as plain Python with the same results.
Compiled code is kept in a cache folder whose name is a hash of all sources of the hot path, so that a change in any
file, not only in the one numba looks at, compiles anew, and a second start compiles nothing.
"""

import hashlib
import os
import pathlib
from collections.abc import Callable
from typing import Any, TypeVar

_Function = TypeVar('_Function', bound=Callable[..., object])
_ROOMS = ('compiled.py', 'friction', 'axis', 'linear', 'solvers', 'bench/peers')


def _cache_folder() -> pathlib.Path:
    root = pathlib.Path(__file__).parent
    digest = hashlib.sha256()
    for room in _ROOMS:
        for path in sorted([root / room, *(root / room).rglob('*.py')]):
            if path.is_file():
                digest.update(path.read_bytes())
    base = os.environ.get('XDG_CACHE_HOME') or os.path.join(os.path.expanduser('~'), '.cache')
    return pathlib.Path(base) / 'stickslip' / digest.hexdigest()[:16]


def _load_numba() -> Any:
    os.environ.setdefault('NUMBA_CACHE_DIR', str(_cache_folder()))
    try:
        import numba
    except ImportError:
        return None
    return numba


def _is_switched_off() -> bool:
    return os.environ.get('STICKSLIP_COMPILED', '1') == '0'


_numba: Any = None if _is_switched_off() else _load_numba()
IS_COMPILED = _numba is not None
_OPTIONS = {'cache': True, 'error_model': 'numpy', '_nrt': False}   # no array is made, so that none needs counting


def compiled(function: _Function) -> _Function:
    """Compile a scalar function of the hot path, or leave it as it is."""
    return _numba.njit(**_OPTIONS)(function) if IS_COMPILED else function


def compiled_without_lock(function: _Function) -> _Function:
    """Compile a function that works for long, while other threads may run Python; or leave it as it is."""
    return _numba.njit(nogil=True, **_OPTIONS)(function) if IS_COMPILED else function


def always_compiled(function: _Function) -> _Function:
    """Compile whatever the switch says: a rival of the benchmark is never held back by it."""
    numba = _numba or _load_numba()
    return function if numba is None else numba.njit(**_OPTIONS)(function)
