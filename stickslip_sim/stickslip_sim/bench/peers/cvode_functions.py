# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The C functions of SUNDIALS that the rival calls, from the libraries that scikit-sundae brings along."""

import ctypes
import importlib.util
from pathlib import Path
from typing import Any

from ...core.errors import SolverError

_WORD, _REAL, _INT = ctypes.c_size_t, ctypes.c_double, ctypes.c_int   # a pointer is a word


def _library(name: str) -> ctypes.CDLL:
    """Load a library of the wheel; raises SolverError when the wheel is laid out in another way."""
    spec = importlib.util.find_spec('sksundae')
    assert spec is not None
    assert spec.origin is not None
    found = sorted((Path(spec.origin).parents[1] / 'scikit_sundae.libs').glob(f'lib{name}-*.so*'))
    if not found:
        raise SolverError(f'scikit-sundae has no library {name}: install the wheel of scikit-sundae 1.2')
    return ctypes.CDLL(str(found[0]), mode=ctypes.RTLD_GLOBAL)


class CvodeFunctions:
    """The C functions, with pointers as words, as compiled code can call them."""

    def __init__(self) -> None:
        core, vectors, cvode = (_library(f'sundials_{name}') for name in ('core', 'nvecserial', 'cvode'))

        def declare(library: ctypes.CDLL, name: str, result: Any, *arguments: Any) -> Any:
            function = getattr(library, name)
            function.restype, function.argtypes = result, list(arguments)
            return function

        self.context = declare(core, 'SUNContext_Create', _INT, _INT, _WORD)
        self.data = declare(core, 'N_VGetArrayPointer', _WORD, _WORD)
        self.destroy = declare(core, 'N_VDestroy', None, _WORD)
        self.free_context = declare(core, 'SUNContext_Free', _INT, _WORD)
        self.free_solver = declare(core, 'SUNNonlinSolFree', _INT, _WORD)
        self.vector = declare(vectors, 'N_VMake_Serial', _WORD, ctypes.c_int64, _WORD, _WORD)
        self.create = declare(cvode, 'CVodeCreate', _WORD, _INT, _WORD)
        self.init = declare(cvode, 'CVodeInit', _INT, _WORD, _WORD, _REAL, _WORD)
        self.reinit = declare(cvode, 'CVodeReInit', _INT, _WORD, _REAL, _WORD)
        self.tolerances = declare(cvode, 'CVodeSStolerances', _INT, _WORD, _REAL, _REAL)
        self.roots = declare(cvode, 'CVodeRootInit', _INT, _WORD, _INT, _WORD)
        self.directions = declare(cvode, 'CVodeSetRootDirection', _INT, _WORD, _WORD)
        self.no_warnings = declare(cvode, 'CVodeSetNoInactiveRootWarn', _INT, _WORD)
        self.user_data = declare(cvode, 'CVodeSetUserData', _INT, _WORD, _WORD)
        self.max_steps = declare(cvode, 'CVodeSetMaxNumSteps', _INT, _WORD, ctypes.c_long)
        self.max_step = declare(cvode, 'CVodeSetMaxStep', _INT, _WORD, _REAL)
        self.stop = declare(cvode, 'CVodeSetStopTime', _INT, _WORD, _REAL)
        self.fixed_point = declare(cvode, 'SUNNonlinSol_FixedPoint', _WORD, _WORD, _INT, _WORD)
        self.set_solver = declare(cvode, 'CVodeSetNonlinearSolver', _INT, _WORD, _WORD)
        self.advance = declare(cvode, 'CVode', _INT, _WORD, _REAL, _WORD, _WORD, _INT)
        self.root_info = declare(cvode, 'CVodeGetRootInfo', _INT, _WORD, _WORD)
        self.free = declare(cvode, 'CVodeFree', None, _WORD)
