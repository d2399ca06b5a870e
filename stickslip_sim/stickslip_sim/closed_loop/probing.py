# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""What a controller does to small signals, found by asking it: a linear system from what it measures to its command.

It is asked along a steady motion, with one thing measured 1e-7 m, 1e-6 m/s or 0.1 N off at one time; the difference of
its answers is its impulse response.  A state-space system that has these is read off the Hankel matrix of the responses
(Ho and Kalman 1966; Kung 1978), and is then compared with the controller on small random signals.
"""

import copy
import math
from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np

from ..controllers import Setpoint
from ..controllers.own_controller import Measurement, OwnController
from ..core.arrays import Numbers
from ..core.types import tuple_of

_AMPLITUDES = np.array([1e-7, 1e-6, 1e-7, 1e-6, 0.1, 1e-7, 1e-6])   # of _INPUTS
_INPUTS = 'slider_position', 'slider_velocity', 'drive_position', 'drive_velocity', 'drive_force', 'setpoint', 'speed'
_HALF = 150          # rows of the Hankel matrix: as many asks of memory are found
_BEFORE = 16         # asks before the disturbance: it may have to begin
_LEAST = 1e-9        # of the largest singular value: what is smaller is rounding
_NEAR = 1e-3         # of the answers: a smooth law bends so much
MEASURED = 5         # of the inputs; then come position and velocity of the setpoint


class NotLinearError(Exception):
    """Why no linear system answers as the controller does."""


class LinearController(NamedTuple):
    """ξ⁺ = a ξ + b y, command = c ξ + d y; y is what it measures, then position and velocity of the setpoint."""

    a: Numbers
    b: Numbers
    c: Numbers
    d: Numbers

    def gain(self, factor: float) -> 'LinearController':
        """Return the controller whose commands are so many times as large."""
        return self._replace(c=factor * self.c, d=factor * self.d)

    @property
    def integrates(self) -> bool:
        """Whether a constant error makes its command grow."""
        return bool((np.abs(np.linalg.eigvals(self.a) - 1.0) < 1e-6).any())


def linear_controller(controller: Callable[[float, Measurement], Any], times: Numbers, base: Numbers
                      ) -> LinearController:
    """Return what a controller does about a steady motion: `base` has a row of inputs for each of the times.

    Raises NotLinearError; ControllerError when it answers what is no command.
    """
    ask = _Asking(controller, times, base)
    nominal = ask()
    if ask() != nominal:
        raise NotLinearError('it answers otherwise when it is asked the same again: give it a reset(), without chance')
    count = 2 * _HALF
    responses = np.empty((count, len(_INPUTS)))
    for k, amplitude in enumerate(_AMPLITUDES):
        off = np.zeros_like(base)
        off[_BEFORE, k] = amplitude
        responses[:, k] = (np.array(ask(off)) - nominal)[_BEFORE:_BEFORE + count]
    if not responses[:, :MEASURED].any():
        raise NotLinearError('its answers do not depend on what it measures: constant, at a limit, or below a '
                             'threshold')
    found = _realised(responses)
    off = _AMPLITUDES * np.random.RandomState(1).uniform(-1.0, 1.0, base.shape)
    off[:_BEFORE] = 0.0
    answers, expected = np.array(ask(off)) - nominal, _answers(found, off)
    difference = float(np.abs(answers - expected).max() / np.abs(expected).max())
    if not difference < _NEAR:
        raise NotLinearError(f'it is not linear: its answers are {100.0 * difference:.3g} % from those of a linear '
                             f'system (a threshold, a limit, or a memory of more than {_HALF} asks)')
    return found


def probe_length() -> int:
    """Return how often it is asked in a row."""
    return _BEFORE + 4 * _HALF


class _Asking:
    """Asks fresh copies of a controller along a motion."""

    def __init__(self, controller: Callable[[float, Measurement], Any], times: Numbers, base: Numbers) -> None:
        self._controller, self._times, self._base = controller, times.tolist(), base

    def __call__(self, off: Numbers | float = 0.0) -> list[float]:
        """Return its commands, m/s, to measurements that are off the motion."""
        own = OwnController(_copied(self._controller), (math.inf, math.inf))
        own.reset()
        answers: list[float] = []
        latest = 0.0
        for step, (time, row) in enumerate(zip(self._times, (self._base + off).tolist())):
            measured = tuple_of(Measurement, (*row[:MEASURED], False, tuple_of(Setpoint, row[MEASURED:])))
            try:
                answer = own.ask(time, measured)
            except Exception as error:
                own.failed(error, step, time)
            velocity, force = own.command(answer, step, time)
            if force:
                raise NotLinearError('it orders a force: only velocities of the drive are probed')
            latest = latest if velocity is None else velocity
            answers.append(latest)
        return answers


def _copied(controller: Any) -> Any:
    try:
        return copy.deepcopy(controller)
    except Exception:    # it holds a file, a lock, ...: then its reset() has to do
        return controller


def _realised(responses: Numbers) -> LinearController:
    """Return the smallest balanced system with these impulse responses to inputs of _AMPLITUDES."""
    later = responses[1:]
    blocks = np.lib.stride_tricks.sliding_window_view(later, _HALF, axis=0)[:_HALF]      # row, input, column
    now, then = (blocks[:, :, k:_HALF - 1 + k].reshape(len(blocks), -1) for k in (0, 1))
    u, sizes, v = np.linalg.svd(now, full_matrices=False)
    order = int(np.count_nonzero(sizes > _LEAST * max(float(sizes[0]), float(np.abs(responses).max()))))
    root = np.sqrt(sizes[:order])
    u, v = u[:, :order], v[:order]
    first = root[:, None] * v[:, ::_HALF - 1]      # the first column of each input
    return LinearController((u.T @ then @ v.T) / np.outer(root, root), first / _AMPLITUDES, u[:1] * root,
                            responses[:1] / _AMPLITUDES)


def _answers(system: LinearController, inputs: Numbers) -> Numbers:
    state, answers = np.zeros(len(system.a)), np.empty(len(inputs))
    for k, row in enumerate(inputs):
        answers[k] = (system.c @ state + system.d @ row)[0]
        state = system.a @ state + system.b @ row
    return answers
