# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""SUNDIALS CVODE with root finding, called as from C: no Python between two events.

The C libraries are those that scikit-sundae brings along; right-hand side and root functions are compiled to C
callbacks, and the loop from event to event is compiled too.  Reference: Hindmarsh et al., ACM TOMS 31 (2005) 363.
"""

import ctypes
import functools
import importlib.metadata
import importlib.util
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

from ...core.errors import SolverError
from ..problem import Outcome, Peer, Problem, Setting, tolerances
from .automaton import GUARDS, Q_F_RATE, SIZE, TIME, U, X, guards, missing, motion_of, rates
from .resets import end_of_piece, enter_piece, move, note, reset

_ADAMS, _NORMAL, _ROOT_RETURN = 1, 1, 2   # CV_ADAMS, CV_NORMAL, CV_ROOT_RETURN
_MAX_STEPS = 1_000_000
_Q = Q_F_RATE + 1                         # numbers of a motion
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


class _CvodeFunctions:
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


class _Code:
    """What has to be compiled once the libraries are there: two callbacks and the loop."""

    def __init__(self, c: _CvodeFunctions) -> None:
        self.right_side, self.root_function = _callbacks(c.data, _numbers())
        self.run = _run(_to_event(c))


def _numbers() -> Any:
    """Return compiled code that takes an address and a count for an array."""
    import numba
    from numba import carray, types
    from numba.extending import intrinsic

    @intrinsic
    def pointer(context: Any, address: Any) -> Any:
        def generate(backend: Any, builder: Any, signature: Any, arguments: Any) -> Any:
            return builder.inttoptr(arguments[0], backend.get_value_type(signature.return_type))
        return types.CPointer(types.float64)(types.uintp), generate

    @numba.njit
    def numbers(address: Any, count: Any) -> Any:
        return carray(pointer(address), (count,))

    return numbers


def _callbacks(data: Any, numbers: Any) -> tuple[Any, Any]:
    """Return the right side and the root functions, as CVODE calls them."""
    import numba
    from numba import types

    @numba.njit
    def known_of(user: Any) -> Any:
        sinusoids = int(numbers(user, 1)[0])
        known = numbers(user, 1 + _Q + sinusoids)
        return known[1:1 + _Q], known[1 + _Q:]

    callback = numba.cfunc(types.intc(types.float64, types.uintp, types.uintp, types.uintp))

    @callback
    def right_side(t: Any, y: Any, dy: Any, user: Any) -> Any:
        q, w = known_of(user)
        state, rate = numbers(data(y), 2), numbers(data(dy), 2)
        rate[0], rate[1] = rates(q, w, t, state[0], state[1])
        return 0

    @callback
    def root_function(t: Any, y: Any, out: Any, user: Any) -> Any:
        q, w = known_of(user)
        state, values = numbers(data(y), 2), numbers(out, 3)
        values[0], values[1], values[2] = guards(q, w, t, state[0], state[1])
        return 0

    return right_side, root_function


def _to_event(c: _CvodeFunctions) -> Any:
    """Return compiled code that lets CVODE integrate up to an event."""
    import numba

    reinit, stop, advance, root_info = c.reinit, c.stop, c.advance, c.root_info

    @numba.njit
    def to_event(memory: Any, vector: Any, p: Any, m: Any, w: Any, end: Any, y: Any, user: Any, at: Any,
                 found: Any) -> Any:
        """Integrate from the reset to the next event or to `end`; return the guard that fell, −1 or −2."""
        q, limit = motion_of(p, m), end - m[TIME]
        for i in range(_Q):
            user[1 + i] = q[i]
        y[0], y[1] = m[X], m[U]
        flag = reinit(memory, 0.0, vector)
        flag += stop(memory, limit)
        if flag != 0:
            return -2
        flag = advance(memory, limit, vector, at.ctypes.data, _NORMAL)
        if flag < 0:
            return -2
        move(p, m, w, at[0], y[0], y[1])
        if flag == _ROOT_RETURN:
            root_info(memory, found.ctypes.data)
            for i in range(GUARDS):
                if found[i] != 0:
                    return i
        m[TIME] = end
        return -1

    return to_event


def _run(to_event: Any) -> Any:
    """Return compiled code that goes from event to event, through the pieces of the inputs."""
    import numba

    @numba.njit
    def run(memory: Any, vector: Any, p: Any, begin: Any, pieces: Any, w: Any, duration: Any, m: Any, y: Any,
            user: Any, events: Any) -> Any:
        at, found, rows = np.zeros(1), np.zeros(GUARDS, np.int32), 0
        for k in range(len(pieces)):
            end = end_of_piece(pieces, k, duration)
            kind, direction = enter_piece(p, m, w, begin, pieces, k)
            rows = note(events, rows, m, kind, direction)
            while m[TIME] < end and rows >= 0:
                fallen = to_event(memory, vector, p, m, w, end, y, user, at, found)
                if fallen == -2:
                    return -2
                if fallen >= 0:
                    kind, direction = reset(p, m, w, fallen)
                    rows = note(events, rows, m, kind, direction)
            if rows < 0:
                return rows
        return rows

    return run


@functools.cache
def _loaded() -> tuple[_CvodeFunctions, _Code]:
    c = _CvodeFunctions()
    return c, _Code(c)


class _Solver:
    """One CVODE object, ready to be run as often as wanted."""

    def __init__(self, problem: Problem, tolerance: float) -> None:
        self._c, self._code = _loaded()
        self._problem, c = problem, self._c
        self._y, self._user = np.zeros(2), np.concatenate([[len(problem.sinusoids)], np.zeros(_Q), problem.sinusoids])
        self._m, self._events = np.zeros(SIZE), problem.event_rows()
        context = ctypes.c_size_t(0)
        c.context(0, ctypes.addressof(context))
        self._context = context
        self._vector = c.vector(2, self._y.ctypes.data, context)
        self._memory = c.create(_ADAMS, context)
        self._fixed_point = c.fixed_point(self._vector, 0, context)
        directions = np.full(GUARDS, -1, np.int32)
        memory = self._memory
        for flag in (c.init(memory, self._code.right_side.address, 0.0, self._vector),
                     c.tolerances(memory, tolerance, tolerance),
                     c.set_solver(memory, self._fixed_point), c.user_data(memory, self._user.ctypes.data),
                     c.roots(memory, GUARDS, self._code.root_function.address),
                     c.directions(memory, directions.ctypes.data), c.no_warnings(memory),
                     c.max_steps(memory, _MAX_STEPS),
                     c.max_step(memory, problem.longest_step if problem.longest_step < np.inf else 0.0)):
            if flag != 0:
                raise SolverError(f'CVODE refuses its settings (flag {flag})')

    def simulate(self) -> Outcome:
        """Run once."""
        problem = self._problem
        rows = self._code.run(self._memory, self._vector, problem.parameters, problem.start, problem.pieces,
                              problem.sinusoids, problem.duration, self._m, self._y, self._user, self._events)
        if rows < 0:
            raise SolverError('CVODE gave up' if rows == -2 else 'more events than the table holds')
        return Outcome(self._events[:rows].copy(), float(self._m[X]))

    def __del__(self) -> None:
        c = self._c
        for release, word in ((c.free, self._memory), (c.free_solver, self._fixed_point), (c.destroy, self._vector),
                              (c.free_context, self._context)):
            word = word if isinstance(word, ctypes.c_size_t) else ctypes.c_size_t(word)
            release(ctypes.addressof(word) if release in (c.free, c.free_context) else word)


def _prepare(problem: Problem, setting: Setting) -> Callable[[], Outcome]:
    return _Solver(problem, setting.value).simulate


def _version() -> str:
    return f'SUNDIALS of scikit-sundae {importlib.metadata.version("scikit-sundae")}'


PEER = Peer('CVODE (Adams), as from C', tolerances(1e-6, 1e-8, 1e-10, 1e-12),
            missing('sksundae', 'scikit-sundae'), _version, _prepare)
