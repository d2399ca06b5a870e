# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""MuJoCo: a slider on a joint, with spring, damper and friction as a force that is set in each step.

Its own friction cannot be used: it has no static limit that grows with rest time, and creeps in stick.  Inputs and
events are looked at once a step, by compiled code: an event that falls within a step is acted on at its end.
"""

import importlib.metadata
import math
from collections.abc import Callable

import numpy as np

from ...axis.layout import MASS
from ...core.errors import SolverError
from ..problem import Outcome, Peer, Problem, Setting, time_steps
from .automaton import (
    DIRECTION,
    F,
    F_RATE,
    Q_MASS,
    SIZE,
    TIME,
    U,
    V,
    V_RATE,
    X,
    always_compiled,
    guard_scales,
    guards,
    missing,
    motion_of,
    rates,
)
from .resets import KNOT, classify, enter_piece, move, note, reset

_MODEL = """
<mujoco>
  <option timestep="{step!r}" gravity="0 0 0" integrator="Euler">
    <flag contact="disable" constraint="disable"/>
  </option>
  <worldbody>
    <body>
      <joint name="axis" type="slide" axis="1 0 0"/>
      <geom type="box" size="0.1 0.1 0.1" mass="{mass!r}"/>
    </body>
  </worldbody>
</mujoco>
"""


@always_compiled
def _look(q, w, t, x, u):
    """Return the force that accelerates the slider at τ = t, and the guard that has fallen there, or −1."""
    _, rate = rates(q, w, t, x, u)
    values, scales = guards(q, w, t, x, u), guard_scales(q)
    for guard in (2, 1, 0):
        if values[guard] < -scales[guard]:
            return q[Q_MASS] * rate, guard
    return q[Q_MASS] * rate, -1


@always_compiled
def _next_piece(pieces, piece):
    """Return when the inputs go over to their next piece; a step that ends within rounding of it counts as there."""
    return pieces[piece + 1, 0] * (1.0 - 1e-14) if piece + 1 < len(pieces) else math.inf


@always_compiled
def _act(p, m, w, pieces, piece, fallen, time, x, u, events, rows):
    """Act at the end of a step, `time`, on a fallen guard (−1: none) and on inputs that go over to their next piece.

    Return the rows in use and the piece; the state from there on stands in `m`.
    """
    move(p, m, w, time - m[TIME], x, u)
    m[TIME] = time
    if fallen >= 0:
        kind, direction = reset(p, m, w, fallen)
        if kind == KNOT:
            m[U] = u   # it is passed, not stopped at
        rows = note(events, rows, m, kind, direction)
    while rows >= 0 and _next_piece(pieces, piece) <= time:
        piece += 1
        late = time - pieces[piece, 0]
        m[V], m[V_RATE] = pieces[piece, 1] + pieces[piece, 2] * late, pieces[piece, 2]
        m[F], m[F_RATE] = pieces[piece, 3] + pieces[piece, 4] * late, pieces[piece, 4]
        was = m[DIRECTION]
        kind = classify(p, m, w)
        rows = note(events, rows, m, kind, m[DIRECTION] if m[DIRECTION] != 0.0 else was)
    return rows, piece


class _Run:

    def __init__(self, problem: Problem, step: float) -> None:
        import mujoco

        self._problem, self._step = problem, step
        self._model = mujoco.MjModel.from_xml_string(_MODEL.format(step=step, mass=float(problem.parameters[MASS])))
        self._data = mujoco.MjData(self._model)
        self._advance, self._clear = mujoco.mj_step, mujoco.mj_resetData
        self._m, self._events = np.zeros(SIZE), problem.event_rows()

    def simulate(self) -> Outcome:
        """Run once."""
        model, data, problem, m, h = self._model, self._data, self._problem, self._m, self._step
        p, w, pieces, events = problem.parameters, problem.sinusoids, problem.pieces, self._events
        self._clear(model, data)
        kind, direction = enter_piece(p, m, w, problem.start, pieces, 0)
        rows, piece = note(events, 0, m, kind, direction), 0
        data.qpos[0], data.qvel[0] = m[X], m[U]
        q = np.array(motion_of(p, m))
        pull, _ = _look(q, w, 0.0, m[X], m[U])
        since, due = 0.0, _next_piece(pieces, piece)
        position, velocity, force = data.qpos, data.qvel, data.qfrc_applied
        for k in range(round(problem.duration / h)):
            force[0] = pull
            self._advance(model, data)
            time = (k + 1) * h
            pull, fallen = _look(q, w, time - since, position[0], velocity[0])
            if fallen >= 0 or due <= time:
                rows, piece = _act(p, m, w, pieces, piece, fallen, time, position[0], velocity[0], events, rows)
                since, due = time, _next_piece(pieces, piece)
                position[0], velocity[0] = m[X], m[U]
                q = np.array(motion_of(p, m))
                pull, _ = _look(q, w, 0.0, m[X], m[U])
                if rows < 0:
                    raise SolverError('more events than the table holds')
        return Outcome(events[:rows].copy(), float(position[0]))


def _prepare(problem: Problem, setting: Setting) -> Callable[[], Outcome]:
    return _Run(problem, setting.value).simulate


def _version() -> str:
    return f'MuJoCo {importlib.metadata.version("mujoco")}'


PEER = Peer('MuJoCo', time_steps(1e-3, 1e-4), missing('mujoco', 'mujoco'), _version, _prepare)
