# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Compile the hot path ahead of time, into extension modules that start in a millisecond and need no numba.

    python3 -m stickslip_sim.solvers.ahead FOLDER

FOLDER is that of a built or installed package; setup.py calls it for what it has just built.  numba's compiler for this
(pycc) is pinned with it, and is on its way out: without it, and without a linker, the package compiles at its first
start.
"""

import os
import sys
import warnings
from pathlib import Path
from typing import Any

_ARRAY, _TABLE = 'f8[::1]', 'f8[:,::1]'
_AT = f'{_ARRAY}, {_ARRAY}, f8, f8'
_START = f'i8({_ARRAY}, {_ARRAY}, f8, f8, f8, f8, f8, f8, f8, {_ARRAY}, {_TABLE}, i8'
_STEPS = {
    'advance': f'Tuple((i8, i8))({_AT}, {_TABLE}, i8)',
    'set_inputs': f'i8({_AT}, f8, f8, f8, f8, {_ARRAY}, {_TABLE}, i8)',
    'set_parameters': f'i8({_ARRAY}, {_AT}, {_TABLE}, i8)',
    'sample': f'void({_AT}, {_ARRAY})',
}
_EXACT = {**_STEPS, 'start': f'{_START})', 'energy': f'void({_AT}, {_ARRAY})'}
_FIXED = {**_STEPS, 'start': f'{_START}, f8, f8, f8)'}
_BATCH = {'run_axes': f'void({_TABLE}, {_TABLE}, {_TABLE}, f8, i8, i8, {_ARRAY}, {_TABLE}, {_ARRAY}, {_TABLE})'}


def compile_ahead(folder: str) -> None:
    """Write the extension modules for the sources in use into a package folder; old ones are removed."""
    from ..core.jit import ahead_name
    from .exact import many_axes, engine, judge

    judged: Any = judge.is_sound
    from .fixed_step import loop

    for old in Path(folder).glob('_ahead_*'):
        old.unlink()
    steps = _module(ahead_name('steps'), folder)
    for name, signature in _EXACT.items():
        steps.export(f'exact_{name}', signature)(getattr(engine, name).py_func)
    steps.export('exact_is_sound', f'b1({_AT})')(judged.py_func)
    for name, signature in _FIXED.items():
        steps.export(f'fixed_step_{name}', signature)(getattr(loop, name).py_func)
    steps.compile()
    batch = _module(ahead_name('batch'), folder)
    for name, signature in _BATCH.items():
        batch.export(f'exact_{name}', signature)(getattr(many_axes, name).py_func)
    with _without_lock():
        batch.compile()


def _module(name: str, folder: str) -> Any:
    with warnings.catch_warnings():
        warnings.simplefilter('ignore')   # that pycc is on its way out
        from numba.pycc import CC
    module = CC(name)
    module.output_dir = folder
    return module


class _without_lock:  # noqa: N801
    """Have pycc compile functions that let other Python threads run; it has no option for that."""

    def __enter__(self) -> None:
        from numba.pycc import compiler

        self._flags = compiler.Flags

        def unlocked() -> Any:
            flags = self._flags()
            flags.release_gil = True
            return flags

        compiler.Flags = unlocked

    def __exit__(self, *error: object) -> None:
        from numba.pycc import compiler

        compiler.Flags = self._flags


if __name__ == '__main__':
    if os.environ.get('STICKSLIP_COMPILED') != 'jit':
        sys.exit('set STICKSLIP_COMPILED=jit: what is compiled ahead comes from numba')
    compile_ahead(sys.argv[1])
