# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""A scene: everything that decides a run, checked and ready for the simulator."""

import hashlib
import math
from collections.abc import Mapping
from dataclasses import asdict, dataclass, field
from fractions import Fraction
from functools import cached_property
from html import escape
from typing import Any, NamedTuple

from ..axis import Axis, InitialState
from ..core.errors import InputError
from ..core.input_profile import InputProfile, constant
from ..core.time_grid import Grid
from ..report.html import folded
from ..simulation.drive import DriveLimits
from ..simulation.encoder import EncoderSettings
from ..simulation.faults import Fault, Faults
from ..simulation.rig import Rig, RigSettings
from ..simulation.simulator import Simulator
from ..simulation.solved_axis import SolverOf
from ..solvers import Solver, adaptive, exact, fixed_step
from .values import scene_text

# How the motion is computed, and the solver that these settings make.

_METHODS = {'exact': (), 'fixed_step': tuple(fixed_step.METHODS), 'adaptive': adaptive.METHODS}
_DEFAULT_METHODS = {'fixed_step': 'euler', 'adaptive': 'DOP853'}


@dataclass(frozen=True, slots=True)
class SolverSettings:
    """`name` of the solver; settings that it does not have are None: `method`, `step` (s), `rtol`, `atol` (m, m/s).

    Raises InputError when the method is not one of this solver.
    """

    name: str
    method: str | None = None
    step: float | None = None
    rtol: float | None = None
    atol: float | None = None

    def __post_init__(self) -> None:
        methods = _METHODS[self.name]
        if self.method is not None and self.method not in methods:
            raise InputError('solver.method', self.method, f'one of {", ".join(methods)} with solver.name: {self.name}',
                             'the other methods belong to another solver')

    @property
    def settings(self) -> dict[str, Any]:
        """The settings beside the name."""
        return {key: value for key, value in asdict(self).items() if key != 'name' and value is not None}

    def check(self, axis: Axis) -> None:
        """Raise InputError when steps of this length cannot follow an axis."""
        if self.name == 'fixed_step':
            fixed_step.check_step(axis, **self.settings)

    def make(self, axis: Axis) -> Solver:
        """Return the solver, for the smooth law of an axis's kinetic friction if it can take one and there is one.

        Raises InputError as `check` does.
        """
        self.check(axis)
        if self.name == 'fixed_step':
            return fixed_step.solver(**self.settings)
        if self.name == 'adaptive':
            ahead, back = (axis.friction.along(direction).kinetic.law for direction in (1.0, -1.0))
            return adaptive.solver(**self.settings, kinetic=ahead, backward=back)
        return exact.SOLVER


def method_of(values: Mapping[str, object]) -> str | None:
    """Return the method that is meant when none is given: the usual one of this solver."""
    return _DEFAULT_METHODS.get(str(values['solver.name']))


@dataclass(frozen=True, slots=True)
class TimeSettings:
    """How simulation time goes: `rate` in steps per second of it, `factor` in simulation time per real time.

    `clock_rate` is that of /clock, Hz.
    """

    mode: str
    rate: float
    factor: float
    clock_rate: float

    @property
    def makes_clock(self) -> bool:
        """Whether simulation time is the time of the ROS graph."""
        return self.mode != 'realtime'

    @property
    def is_wall_time(self) -> bool:
        """Whether simulation time goes as the time of the ROS graph does."""
        return self.mode == 'realtime' and self.factor == 1.0

    @property
    def is_paced(self) -> bool:
        """Whether a step waits until it is due."""
        return self.mode != 'lockstep' and self.factor != math.inf

    @property
    def step(self) -> Fraction:
        """Simulation time of a step, s, exactly."""
        return 1 / Fraction(repr(self.rate))


@dataclass(frozen=True, slots=True)
class CommandSettings:
    """Commands beyond `max_velocity` (m/s) or `max_force` (N), either way, are refused; `timeout` in s, 0: off."""

    max_velocity: float
    max_force: float
    timeout: float


@dataclass(frozen=True, slots=True)
class TimingSettings:
    """The limits of a real-time valid run: `max_lateness` and `max_latency` in s, `max_overruns` a share."""

    max_lateness: float
    max_overruns: float
    max_latency: float


@dataclass(frozen=True, slots=True)
class RecordSettings:
    """Whether the node records from its start, and into which folder (empty: it chooses one).

    It goes on in another file at `max_size` bytes, or after `max_duration` s.  Its log times are simulation time, or
    those of the wall clock (`log_time`: simulation or wall).  With `each_reset` every reset begins a bag.
    """

    enabled: bool
    folder: str
    max_size: int | None = None
    max_duration: float | None = None
    log_time: str = 'simulation'
    each_reset: bool = False


class ProfileSource(NamedTuple):
    """The file that the points of a profile were read from: where it is as stated, its column, and the unit there."""

    file: str
    column: str
    unit: str


@dataclass(frozen=True, repr=False)
class Scene:
    """One scene; `values` are all of its parameters by dotted name.

    `summary` is one line for people and no part of the scene, nor are the `sources` of profiles from files, by section.
    """

    name: str
    summary: str = field(compare=False)
    axis: Axis
    initial: InitialState
    drive: InputProfile   # m/s
    force: InputProfile   # N
    solver: SolverSettings
    time: TimeSettings
    command: CommandSettings
    timing: TimingSettings
    rig: RigSettings
    record: RecordSettings
    joint_prefix: str     # of the names of joints and frames
    seed: int
    values: dict[str, object] = field(hash=False)
    sources: Mapping[str, ProfileSource] = field(default_factory=dict, compare=False)
    normal_load: InputProfile | None = None   # N, on top of the normal force of the axis

    def __repr__(self) -> str:
        return f'<Scene {self.name}: {self.summary or self.hash[:12]}>'

    def _repr_html_(self) -> str:
        return folded(repr(self)[1:-1], f'<pre>{escape(self.text)}</pre>')

    @cached_property
    def text(self) -> str:
        """The scene as a parameter file."""
        return scene_text(self.values)

    @cached_property
    def hash(self) -> str:
        """The sha256 of the text in hexadecimal."""
        return hashlib.sha256(self.text.encode()).hexdigest()

    def make_rig(self) -> Rig:
        """Return the axis and its rig at the start."""
        return Rig(self.axis, self.initial, self.drive, self.force, self.solver.make, Grid(self.time.rate), self.rig,
                   self.normal_load)

    def make_simulator(self, solver: Solver | SolverOf | None = None, accounting: bool = False) -> Simulator:
        """Return the axis alone at the start, with the solver of the scene or another."""
        return Simulator(self.axis, self.initial, self.drive, self.force, solver or self.solver.make, accounting,
                         self.normal_load)

    @property
    def inputs(self) -> tuple[InputProfile, ...]:
        """The input profiles of the drive and the force, and that of the normal load where there is one."""
        return (self.drive, self.force) if self.normal_load is None else (self.drive, self.force, self.normal_load)

    @property
    def normal_force(self) -> InputProfile:
        """The normal force on the slideway over time, N, as long as no parameter changes."""
        return (self.normal_load or constant(0.0)).plus(self.axis.normal_force)


# The settings of the rig around the axis and of time in a scene, checked together.

_FAULT_LISTS = 'ids', 'kinds', 'starts', 'durations', 'values'
_FINEST = 1e-15    # m, of an encoder: the counts of any position are numbers then


def time_settings(values: Mapping[str, Any]) -> TimeSettings:
    """Return how time goes; raises InputError."""
    mode, rate, factor = values['time.mode'], values['time.rate'], values['time.factor']
    if factor == math.inf and mode != 'free_run':
        raise InputError('time.factor', factor, 'finite', 'only time.mode: free_run goes as fast as it can')
    clock_rate = values.get('clock.rate', rate)
    if clock_rate > rate:
        raise InputError('clock.rate', clock_rate, f'at most time.rate ({rate:g} Hz)',
                         'time moves with the steps: raise time.rate, or leave it out for a message with every step')
    return TimeSettings(mode, rate, factor, clock_rate)


def rig_settings(values: Mapping[str, Any]) -> RigSettings:
    """Return the rig; raises InputError."""
    encoder = EncoderSettings(*(values[f'encoder.{name}'] for name in EncoderSettings.__dataclass_fields__))
    if 0.0 < encoder.resolution < _FINEST:
        raise InputError('encoder.resolution', encoder.resolution, f'0, or at least {_FINEST:g} m', '0 does not round')
    grid = Grid(values['time.rate'])
    _check_timeout(values['command.timeout'], grid)
    return RigSettings(
        seed=values['seed'],
        measures=values['joint_interface.enabled'],
        encoder=encoder,
        encoder_delay_steps=_whole_steps('encoder.delay', encoder.delay, grid),
        limits=DriveLimits(values['command.velocity_limit'], values['command.acceleration_limit']),
        on_timeout=values['command.on_timeout'],
        timeout_deceleration=values.get('command.timeout_deceleration', math.inf),
        faults=_faults(values, grid))


def _check_timeout(timeout: float, grid: Grid) -> None:
    if 0.0 < timeout < 1.0 / grid.rate:
        raise InputError('command.timeout', timeout, f'0, or at least a step ({1.0 / grid.rate:g} s)',
                         'commands are taken once a step: make it longer, or raise time.rate')


def _whole_steps(name: str, seconds: float, grid: Grid) -> int:
    count = grid.steps(seconds)
    if grid.instant(count).seconds != seconds:
        raise InputError(name, seconds, f'whole steps of {1.0 / grid.rate:g} s',
                         'choose a multiple, or another time.rate')
    return count


def _faults(values: Mapping[str, Any], grid: Grid) -> tuple[Fault, ...]:
    given = {name: values[f'faults.{name}'] for name in _FAULT_LISTS if f'faults.{name}' in values}
    if not given:
        return ()
    given.setdefault('values', (0.0,) * len(given.get('ids', ())))
    for name in _FAULT_LISTS:
        if name not in given or len(given[name]) != len(given.get('ids', ())):
            raise InputError(f'faults.{name}', list(given.get(name, ())), 'as many as there are faults.ids',
                             'give ids, kinds, starts and durations, one of each for every fault')
    faults = tuple(map(Fault, *(given[name] for name in _FAULT_LISTS)))
    plan = Faults(grid, ())
    for fault in faults:
        try:
            plan.inject(fault, 1)
        except InputError as error:
            raise InputError(f'faults ({fault.id}): {error.name}', error.value, error.allowed, error.fix) from None
    return faults
