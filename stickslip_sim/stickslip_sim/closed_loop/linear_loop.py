# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The linear loop of a controller and an axis that keeps its mode, sampled as the rig samples it.

The motion of a mode under a drive velocity that holds over a step is exact (a matrix exponential).  The delays of
commands and encoder, and the velocity that is taken from counts, are states too.
"""

import copy
import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import cached_property
from itertools import groupby, pairwise
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import expm
from scipy.optimize import brentq

from ..axis import CompliantContact
from ..controllers import Setpoint
from ..controllers.own_controller import Measurement, OwnController
from ..core.arrays import Numbers
from ..core.errors import InputError
from ..core.time_grid import Grid
from ..core.types import tuple_of
from ..scene import Scene
from ..simulation.faults import Faults

# What a controller does to small signals, found by asking it: a linear system from what it measures to its command.
#
# It is asked along a steady motion, with one thing measured 1e-7 m, 1e-6 m/s or 0.1 N off at one time; the difference
# of its answers is its impulse response.  A state-space system that has these is read off the Hankel matrix of the
# responses (Ho and Kalman 1966; Kung 1978), and is then compared with the controller on small random signals.

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


# The loop.

Complex = NDArray[np.complex128]
_POINTS = 1500           # of the frequencies
_LOWEST = 1e-5           # of the highest frequency
_DRIFTS = 1e-6           # beyond 1: a pole of an integrator, rounded
_SETTLED = 0.02          # of the step
_LONGEST = 20_000        # asks of a step response
_HALF_POWER = math.sqrt(0.5)
MOST_DELAY = 250         # steps, of a scene, and again of what may come on top: more takes minutes


class Plant(NamedTuple):
    """z⁺ = a z + b u, measured = c z; the first state is the slider's position.  `delay` in steps of the rig."""

    a: Numbers
    b: Numbers
    c: Numbers


def command_delay(scene: Scene) -> int:
    """Return by how many steps the faults of a scene delay a command from its start to its end."""
    lasting = [fault for fault in scene.rig.faults if fault.start == 0.0 and math.isinf(fault.duration)]
    faults = Faults(Grid(scene.time.rate), lasting)
    faults.enter(1)
    return faults.effect.command_delay


def check_delays(scene: Scene) -> None:
    """Raise InputError on delays that are too long for a linear loop."""
    late, told = command_delay(scene), scene.rig.encoder_delay_steps + scene.rig.encoder.velocity_steps
    if late + told > MOST_DELAY:
        raise InputError('delays', f'{late} steps of commands and {told} of the encoder',
                         f'at most {MOST_DELAY} steps together', 'make them shorter, or lower time.rate')


def plant_of(scene: Scene, speed: float | None, every: int, delay: int) -> Plant:
    """Return the axis in steady slip at a speed (m/s), or in stick (None), as a controller meets it."""
    step, encoder = 1.0 / scene.time.rate, scene.rig.encoder
    lag, over = (0, 0) if encoder.is_ideal else (scene.rig.encoder_delay_steps, encoder.velocity_steps)
    past = lag + over
    size = 4 + delay + 2 * past
    motion = expm(step * _rates(scene, speed))
    a, b = np.zeros((size, size)), np.zeros(size)
    a[:3, :3] = motion[:3, :3]
    if delay:
        a[:3, 4], a[3, 4], b[3 + delay] = motion[:3, 3], 1.0, 1.0
        a[4:3 + delay, 5:4 + delay] = np.eye(delay - 1)
    else:
        b[:4] = [*motion[:3, 3], 1.0]
    c = np.zeros((MEASURED, size))
    for k, (source, rate) in enumerate(((0, 1), (2, 3))):    # slider, drive
        first = 4 + delay + k * past
        places = [source, *range(first, first + past)]       # now, a step ago, ...
        a[places[1:], places[:-1]] = 1.0
        c[2 * k, places[lag]] = 1.0
        if over:
            c[2 * k + 1, [places[lag], places[past]]] = 1.0 / (over * step), -1.0 / (over * step)
        else:
            c[2 * k + 1, rate] = 1.0
    axis = scene.axis
    stiffness, damping = axis.drive_stiffness, axis.drive_damping * axis.feed_share
    c[4, :4] = -stiffness, -damping, stiffness, damping
    whole: Numbers = np.eye(size)
    held: Numbers = np.zeros(size)
    for _ in range(every):
        held, whole = held + whole @ b, whole @ a
    return Plant(whole, held[:, None], c)


def friction_slope(scene: Scene, speed: float) -> float:
    """Return by how much kinetic friction grows with the speed (m/s) of steady slip, N s/m; normally below 0."""
    kinetic = scene.axis.friction.along(speed).kinetic
    return scene.normal_force.value_at(0.0) * kinetic.slopes(abs(speed))[1]


def _rates(scene: Scene, speed: float | None) -> Numbers:
    """Return the rates of position, velocity, drive position and drive velocity."""
    axis, contact = scene.axis, scene.axis.contact
    stiffness, damping, mass = axis.drive_stiffness, axis.drive_damping, axis.mass
    rates = np.zeros((4, 4))
    rates[2, 3] = 1.0
    if speed is None and not isinstance(contact, CompliantContact):
        return rates
    held, rubbed = 0.0, 0.0
    if speed is not None:
        rubbed = friction_slope(scene, speed)
    elif isinstance(contact, CompliantContact):
        held, rubbed = contact.stiffness, contact.damping
    rates[0, 1] = 1.0
    rates[1] = np.array([-stiffness - held, -damping - rubbed, stiffness, damping * axis.feed_share]) / mass
    return rates


class Crossing(NamedTuple):
    """Where the open loop crosses the unit circle or the negative real axis: at a frequency, Hz."""

    frequency: float
    value: complex


@dataclass(frozen=True, eq=False)
class LinearLoop:
    """The loop about one mode: its plant with each command delay, and a controller asked every `period` s.

    `speed` is that of steady slip, m/s; None in stick.
    """

    scene: Scene
    speed: float | None
    every: int
    controller: LinearController

    @property
    def period(self) -> float:
        """Time from one ask to the next, s."""
        return self.every / self.scene.time.rate

    @cached_property
    def plant(self) -> Plant:
        """The axis with the delays of its scene."""
        return self._plant(0)

    def _plant(self, extra: int) -> Plant:
        return plant_of(self.scene, self.speed, self.every, command_delay(self.scene) + extra)

    def closed(self, gain: float = 1.0, extra: int = 0) -> Numbers:
        """Return the matrix of the closed loop from ask to ask, with another gain and `extra` steps of delay."""
        plant = self._plant(extra) if extra else self.plant
        own = self.controller.gain(gain)
        told = own.d[:, :MEASURED] @ plant.c
        whole: Numbers = np.block([[plant.a + plant.b @ told, plant.b @ own.c], [own.b[:, :MEASURED] @ plant.c, own.a]])
        return whole

    def is_stable(self, gain: float = 1.0, extra: int = 0) -> bool:
        """Whether all that it does dies out, or drifts as an integrator does."""
        return bool(np.abs(np.linalg.eigvals(self.closed(gain, extra))).max() < 1.0 + _DRIFTS)

    @cached_property
    def worst(self) -> tuple[float, float]:
        """Frequency (Hz) and rate of growth (1/s) of what grows fastest, or dies out slowest."""
        poles = np.linalg.eigvals(self.closed()).astype(complex)
        pole = np.log(poles[np.argmax(np.abs(poles))]) / self.period
        return abs(float(pole.imag)) / (2.0 * math.pi), float(pole.real)

    # Over the frequency

    @cached_property
    def frequencies(self) -> Numbers:
        """Frequencies up to half of those of the asks, Hz; denser where a resonance may be."""
        highest = 0.5 / self.period
        poles = np.concatenate([np.linalg.eigvals(matrix) for matrix in (self.plant.a, self.controller.a,
                                                                         self.closed())])
        own = np.abs(np.angle(poles)) / (2.0 * math.pi * self.period)
        near = np.outer(own[own > _LOWEST * highest], np.linspace(0.9, 1.1, 41)).ravel()
        found: Numbers = np.unique(np.append(near[near < highest], highest * np.geomspace(_LOWEST, 1.0, _POINTS)))
        return found

    def _responses(self, frequency: float) -> tuple[complex, complex]:
        """Return that of the slider's position (m) to the command (m/s), and that of the open loop."""
        z = np.exp(2j * math.pi * frequency * self.period)
        plant, own = self.plant, self.controller
        state = np.linalg.solve(z * np.eye(len(plant.a)) - plant.a, plant.b)
        inner = np.linalg.solve(z * np.eye(len(own.a)) - own.a, own.b[:, :MEASURED])
        back = (own.c @ inner + own.d[:, :MEASURED]) @ plant.c @ state
        return complex(state[0, 0]), -complex(back[0, 0])

    @cached_property
    def _response(self) -> Complex:
        return np.array([self._responses(frequency) for frequency in self.frequencies.tolist()])

    @property
    def slider(self) -> Complex:
        """The slider's position over the command at `frequencies`, m for each m/s."""
        return self._response[:, 0]

    @property
    def open(self) -> Complex:
        """The open loop L at `frequencies`, cut at the command: the loop closes as 1 + L."""
        return self._response[:, 1]

    def _crossings(self, level: NDArray[np.float64], of: str) -> Iterator[Crossing]:
        def here(log: float) -> float:
            value = self._responses(math.exp(log))[1]
            return math.log(abs(value)) if of == 'size' else value.imag
        for k in np.flatnonzero(level[:-1] * level[1:] < 0.0).tolist():
            frequency = math.exp(brentq(here, *np.log(self.frequencies[k:k + 2]).tolist(), xtol=1e-13))
            yield Crossing(frequency, self._responses(frequency)[1])

    @cached_property
    def gain_crossings(self) -> list[Crossing]:
        """Where |L| = 1."""
        return list(self._crossings(np.log(np.maximum(np.abs(self.open), 1e-300)), 'size'))

    @cached_property
    def phase_crossings(self) -> list[Crossing]:
        """Where L is real and negative, half the frequency of the asks among them."""
        last = Crossing(float(self.frequencies[-1]), complex(self.open[-1]))
        found = [*self._crossings(self.open.imag[:-1], 'phase'), last]
        return [one for one in found if one.value.real < 0.0]

    @cached_property
    def phase_margin(self) -> tuple[float, float]:
        """The least phase margin, degrees, and the frequency of its crossing, Hz; inf where |L| stays below 1."""
        margins = [(math.degrees(float(np.angle(-one.value))), one.frequency) for one in self.gain_crossings]
        return min(margins, key=lambda margin: abs(margin[0]), default=(math.inf, math.nan))

    @cached_property
    def stable_gains(self) -> tuple[float, float]:
        """The least and the largest factor on the commands with which the loop is stable, about 1 or next to it.

        (nan, nan) where no factor makes it stable.
        """
        borders = sorted(-1.0 / one.value.real for one in self.phase_crossings)
        edges = [0.0, *borders, math.inf]
        inner = [(low, high) for low, high in pairwise(edges) if high > low * (1.0 + 1e-9)]
        merged = [(stretch[0][0], stretch[-1][1]) for is_stable, stretches in groupby(
            inner, lambda ends: self.is_stable(_between(*ends))) if is_stable and (stretch := list(stretches))]
        return min(merged, key=lambda one: 0.0 if one[0] <= 1.0 <= one[1] else min(
            abs(math.log(edge)) for edge in one if 0.0 < edge < math.inf), default=(math.nan, math.nan))

    @cached_property
    def largest_delay(self) -> int | None:
        """The most steps of the rig by which commands may come later still; None: more than MOST_DELAY, or any.

        Of a loop that is not stable −1.
        """
        if not self.is_stable():
            return -1
        ways = [(math.degrees(float(np.angle(-one.value))) % 360.0) / (360.0 * one.frequency)
                for one in self.gain_crossings]
        if not ways or min(ways) * self.scene.time.rate > MOST_DELAY:
            return None
        found = int(min(ways) * self.scene.time.rate)
        while found and not self.is_stable(extra=found):
            found -= 1
        while found < MOST_DELAY and self.is_stable(extra=found + 1):
            found += 1
        return found

    # The step of the setpoint

    @cached_property
    def follows_setpoint(self) -> bool:
        """Whether the slider answers to the position of a setpoint."""
        return bool(self.controller.d[0, MEASURED] or self.controller.b[:, MEASURED].any()) and bool(self.slider.any())

    @cached_property
    def _entry(self) -> Numbers:
        own = self.controller
        return np.append(self.plant.b[:, 0] * own.d[0, MEASURED], own.b[:, MEASURED])

    @cached_property
    def step_response(self) -> tuple[Numbers, Numbers]:
        """Times (s) and slider's positions after the setpoint went from 0 to 1, for as long as poles die out."""
        matrix = self.closed()
        sizes = np.abs(np.linalg.eigvals(matrix))
        slowest = float(sizes[sizes < 1.0 - _DRIFTS].max(initial=0.5))
        count = min(max(round(-10.0 / math.log(slowest)), 100), _LONGEST)
        state: Numbers = np.zeros(len(matrix))
        positions: Numbers = np.zeros(count)
        for k in range(count):
            positions[k] = state[0]
            state = matrix @ state + self._entry
        return np.arange(count, dtype=np.float64) * self.period, positions

    @cached_property
    def overshoot_and_settling(self) -> tuple[float, float]:
        """Overshoot (a share of the step), and the time until 2 % are kept (s)."""
        times, positions = self.step_response
        final = positions[-1]
        outside = np.flatnonzero(np.abs(positions - final) > _SETTLED * abs(final))
        return max(float(positions.max() / final) - 1.0, 0.0), float(times[min(outside[-1] + 1, len(times) - 1)])

    @cached_property
    def bandwidth(self) -> float:
        """The frequency at which the slider follows the setpoint to −3 dB, Hz."""
        matrix = self.closed()

        def size(frequency: float) -> float:
            z = np.exp(2j * math.pi * frequency * self.period)
            return abs(complex(np.linalg.solve(z * np.eye(len(matrix)) - matrix, self._entry)[0]))
        frequencies: list[float] = self.frequencies.tolist()
        least = _HALF_POWER * size(frequencies[0])
        return next((frequency for frequency in frequencies if size(frequency) < least), math.inf)


def _between(low: float, high: float) -> float:
    """Return a gain between two borders."""
    if math.isinf(high):
        return 2.0 * low if low else 1.0
    return math.sqrt(low * high) if low else 0.5 * high
