"""scipy's solve_ivp with events: what most people reach for.  Right-hand side and guards are compiled."""

from collections.abc import Callable
from typing import Any

import numpy as np

from ...compiled import always_compiled
from ...errors import SolverError
from ..problem import Outcome, Problem
from .automaton import DIRECTION, F, F_RATE, GUARDS, SIZE, TIME, U, V, V_RATE, X, guards, motion_of, rates
from .peer import Peer, Setting, tolerances
from .resets import classify, move, reset, start

try:
    import scipy
    from scipy.integrate import solve_ivp
    _MISSING = None
except ImportError:
    _MISSING = 'pip install scipy'

_FINEST = 100 * np.finfo(float).eps   # scipy's own floor of the relative tolerance


@always_compiled
def _vector(q, w, t, y):
    dx, du = rates(q, w, t, y[0], y[1])
    return np.array([dx, du])


@always_compiled
def _guard(q, w, t, y, which):
    return guards(q, w, t, y[0], y[1])[which]


@always_compiled
def _motion(p, m):
    return np.array(motion_of(p, m))


class _Guard:
    """A guard as solve_ivp wants it: it ends the integration where it falls through zero."""

    terminal = True
    direction = -1.0

    def __init__(self, q: Any, w: Any, which: float) -> None:
        self._q, self._w, self._which = q, w, which

    def __call__(self, t: float, y: Any) -> Any:
        return _guard(self._q, self._w, t, y, self._which)


class _Run:
    """One run: the automaton, and the rows of its events."""

    def __init__(self, problem: Problem, method: str, tolerance: float) -> None:
        self.problem = problem
        self.rows: list[tuple[float, ...]] = []
        self._options: dict[str, Any] = {'method': method, 'rtol': max(tolerance, _FINEST), 'atol': tolerance,
                                         'max_step': problem.longest_step}
        self._m = np.zeros(SIZE)

    def simulate(self) -> Outcome:
        """Go through all pieces of the inputs."""
        problem, m = self.problem, self._m
        p, w = problem.parameters, problem.waves
        ends = [*problem.pieces[1:, 0].tolist(), problem.duration]
        for k, ((_, *values), end) in enumerate(zip(problem.pieces, ends)):
            before = m[DIRECTION]
            if k == 0:
                kind = start(p, m, w, *problem.start, *values)
            else:
                m[V], m[V_RATE], m[F], m[F_RATE] = values
                kind = classify(p, m, w)
            if kind >= 0.0:
                self._note(kind, m[DIRECTION] or before)
            while m[TIME] < end:
                self._to_event(p, m, w, end)
        return Outcome(np.array(self.rows).reshape(-1, 5), float(m[X]))

    def _to_event(self, p: Any, m: Any, w: Any, end: float) -> None:
        q = _motion(p, m)
        limit = end - m[TIME]
        done = solve_ivp(lambda t, y: _vector(q, w, t, y), (0.0, limit), (m[X], m[U]),
                         events=[_Guard(q, w, i) for i in range(GUARDS)], **self._options)
        if not done.success:
            raise SolverError(f'solve_ivp: {done.message}')
        x, u = done.y[:, -1]
        move(p, m, w, done.t[-1], x, u)
        fallen = [i for i, times in enumerate(done.t_events) if len(times)]
        if not fallen:
            m[TIME] = end
            return
        kind, direction = reset(p, m, w, fallen[0])
        self._note(kind, direction)

    def _note(self, kind: float, direction: float) -> None:
        m = self._m
        self.rows.append((m[TIME], kind, direction, m[X], m[U]))
        if len(self.rows) > len(self.problem.event_rows()):
            raise SolverError('more events than the table holds')


def _prepare(method: str) -> Callable[[Problem, Setting], Callable[[], Outcome]]:

    def prepare(problem: Problem, setting: Setting) -> Callable[[], Outcome]:
        return lambda: _Run(problem, method, setting.value).simulate()

    return prepare


def _version() -> str:
    return f'scipy {scipy.__version__}'


PEERS = tuple(Peer(f'scipy {method}', settings, _MISSING, _version, _prepare(method)) for method, settings in (
    ('DOP853', tolerances(1e-4, 1e-6, 1e-8, 1e-10, 1e-12)), ('LSODA', tolerances(1e-6, 1e-9, 1e-12)),
    ('Radau', tolerances(1e-6, 1e-9))))
