# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The rivals' machine code: numba compiles it when it is first called, and keeps it beside these sources.

The switch STICKSLIP_COMPILED is not for it: a rival is never held back.
"""

import hashlib
import os
from collections.abc import Callable
from pathlib import Path
from typing import TypeVar

from ...axis import layout
from ...friction import static

_Function = TypeVar('_Function', bound=Callable[..., object])


def _digest() -> str:
    """Return a mark of these sources, and of those whose numbers they hold.

    numba itself looks at the file of a function alone, and would go on with the places of a table laid out anew.
    """
    files = [*sorted(Path(__file__).parent.glob('*.py')), Path(layout.__file__), Path(static.__file__)]
    return hashlib.sha256(b''.join(file.read_bytes() for file in files)).hexdigest()[:16]


os.environ['NUMBA_CACHE_DIR'] = str(Path(__file__).parent / '__pycache__' / _digest())
try:
    import numba
    NUMBA_MISSING = None
except ImportError:
    NUMBA_MISSING = 'pip install numba'


def always_compiled(function: _Function) -> _Function:
    """Compile a function; without numba it stays as it is, and its contestant does not race."""
    if NUMBA_MISSING is not None:
        return function
    found: _Function = numba.njit(cache=True, error_model='numpy', _nrt=False)(function)
    return found
