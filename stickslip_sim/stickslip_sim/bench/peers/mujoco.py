# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""MuJoCo: a slider on a joint, with spring, damper and friction as a force that is set in each step.

Its own friction cannot be used: it has no static limit that grows with rest time, and creeps in stick.
"""

import importlib.metadata
import importlib.util
from collections.abc import Callable

import numpy as np

from ...axis.layout import MASS
from ...core.errors import SolverError
from ..problem import Outcome, Problem
from .always_compiled import NUMBA_MISSING
from .automaton import SIZE, U, X, motion_of
from .grid import act, begin, look, next_piece
from .peer import Peer, Setting, time_steps

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
_UNIT = 1.0   # of mass: the force is wanted, not the acceleration
_MISSING = NUMBA_MISSING if importlib.util.find_spec('mujoco') else 'pip install mujoco'


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
        rows, piece = begin(p, m, w, problem.start, pieces, events), 0
        data.qpos[0], data.qvel[0] = m[X], m[U]
        q = np.array(motion_of(p, m))
        pull, _ = look(q, w, _UNIT, 0.0, m[X], m[U])
        since, due = 0.0, next_piece(pieces, piece)
        position, velocity, force = data.qpos, data.qvel, data.qfrc_applied
        for k in range(round(problem.duration / h)):
            force[0] = pull
            self._advance(model, data)
            time = (k + 1) * h
            pull, fallen = look(q, w, _UNIT, time - since, position[0], velocity[0])
            if fallen >= 0 or due <= time:
                rows, piece = act(p, m, w, pieces, piece, fallen, time, position[0], velocity[0], events, rows)
                since, due = time, next_piece(pieces, piece)
                position[0], velocity[0] = m[X], m[U]
                q = np.array(motion_of(p, m))
                pull, _ = look(q, w, _UNIT, 0.0, m[X], m[U])
                if rows < 0:
                    raise SolverError('more events than the table holds')
        return Outcome(events[:rows].copy(), float(position[0]))


def _prepare(problem: Problem, setting: Setting) -> Callable[[], Outcome]:
    return _Run(problem, setting.value).simulate


def _version() -> str:
    return f'MuJoCo {importlib.metadata.version("mujoco")}'


PEER = Peer('MuJoCo', time_steps(1e-3, 1e-4), _MISSING, _version, _prepare)
