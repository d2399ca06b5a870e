# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The rivals' machine code: numba compiles it when it is first called, and keeps it beside the source.

The switch STICKSLIP_COMPILED is not for it: a rival is never held back.
"""

from collections.abc import Callable
from typing import TypeVar

_Function = TypeVar('_Function', bound=Callable[..., object])

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
