# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""A controller against many variants of one scene: each point of a study is a closed loop, checked against limits."""

import copy
import hashlib
import json
import math
from collections.abc import Iterator, Mapping
from dataclasses import asdict, dataclass, field, fields
from enum import IntEnum
from functools import cached_property
from pathlib import Path
from typing import Any, ClassVar, NamedTuple

import numpy as np

from ..check.limits import LimitOutcome, Limits, check_fit, load_limits, outcomes_of
from ..check.observed_run import KnownCommands
from ..controllers.own_controller import OwnController, made_controller, named_controller
from ..core.arrays import Numbers
from ..core.errors import ControllerError, InputError, SolverError
from ..core.time_grid import Instants
from ..figures.control import errors_to
from ..scene import Scene, scene_from_values
from ..scene.parameter import Parameter
from ..scene.values import overridden
from ..study.sample import EvenGrid, Sobol
from ..study.study import check_variations, versions_of_a_study
from ..study.variation import GAIN, MOTION_SECTIONS, changes_at, parameter_of
from .loop import ClosedLoopRun, own_controller, run_loop, steps_between, steps_of

SECTIONS = (*MOTION_SECTIONS, 'encoder', 'command', 'faults', GAIN)
FOLDER_FORM = 'stickslip closed loops 1'
_OF_SETPOINT = 'largest_error', 'rms_error'   # m
_PLAIN_CHUNK = 4                              # points: a fraction of a second
_DELAY = 'encoder.delay'


class Outcome(IntEnum):
    """What a point came to; only one that PASSED counts as passed."""

    PASSED = 0
    MISSED = 1        # a limit
    CONTROLLER = 2    # raised, or answered what is no command
    SOLVER = 3        # gave up
    REFUSED = 4       # no scene, no controller, or nothing to check has these values


WORDS = {Outcome.PASSED: 'passed', Outcome.MISSED: 'limits missed', Outcome.CONTROLLER: 'controller failed',
         Outcome.SOLVER: 'solver gave up', Outcome.REFUSED: 'refused'}


class Attempt(NamedTuple):
    """The run of a point as far as it went, what each limit came to, and why it failed where it did.

    Of one among many without limits there are the `positions` at its steps alone, m.
    """

    outcome: Outcome
    run: ClosedLoopRun | None = None
    limits: tuple[LimitOutcome, ...] = ()
    reason: str = ''
    positions: Numbers | None = None


def loop_parameter(name: str) -> tuple[Parameter, int | None]:
    """Return the parameter of a scene, or the argument of a controller, that a name stands for; raises InputError."""
    return parameter_of(name, SECTIONS)


@dataclass(frozen=True, eq=False)
class LoopStudy:
    """The measured scene of the effective `values`, varied as `sample` says, with a controller in the loop.

    `controller` is FILE.py:NAME, or the thing itself; names that begin with `gain.` are its arguments, beside those
    that are `fixed`.  `setpoint` has a row a step.  A `vectorized` controller is asked for many points in one call.
    Raises InputError unless every combination of the ends of the variations is a scene and a controller.
    """

    values: Mapping[str, object]
    sample: EvenGrid | Sobol
    controller: Any
    duration: float
    rate: float | None = None
    setpoint: Numbers | None = None
    limits_file: str | None = None
    fixed: Mapping[str, object] = field(default_factory=dict)
    vectorized: bool = False
    form: ClassVar[str] = FOLDER_FORM
    largest: ClassVar[float] = math.inf
    words: ClassVar[Mapping[float, str]] = {float(outcome): word for outcome, word in WORDS.items()}

    def __post_init__(self) -> None:
        twice = sorted({f'{GAIN}.{name}' for name in self.fixed} & set(self.names))
        if twice:
            raise InputError('--gain', twice[0].partition('.')[2], 'a value or a range, once', 'drop one of the two')
        last, _ = len(self.times.seconds) - 1, self.every    # raise on a duration and a rate
        check_variations(self.sample.variations, self._checked)
        if self.limits is not None:
            check_fit(self.limits, 0.0, last * float(self.scene.time.step), False, KnownCommands(0.0))
        for name in self.limit_names:
            if name in ('outcome', 'until', *_OF_SETPOINT, *self.names) or set(name) & set(',"\r\n'):
                raise InputError('limit', name, 'a name that can head a column of a table, and no other one has',
                                 'give it another name, and its kind as check')

    def _checked(self, point: Numbers) -> Scene:
        scene = self.scene_at(point)
        self.controller_at(point, scene)
        if self.vectorized:
            from .lanes import check_lanes

            check_lanes(scene)
        return scene

    @property
    def names(self) -> tuple[str, ...]:
        """What varies."""
        return tuple(one.name for one in self.sample.variations)

    @property
    def count(self) -> int:
        """How many points there are."""
        return self.sample.count

    @property
    def limit_names(self) -> tuple[str, ...]:
        """The limits in their order."""
        return tuple(limit.name for limit in self.limits.limits) if self.limits else ()

    @property
    def figure_names(self) -> tuple[str, ...]:
        """The outcome, up to when it ran (s), the errors to the setpoint (m), and what each limit came to."""
        return ('outcome', 'until', *(() if self.setpoint is None else _OF_SETPOINT), *self.limit_names)

    @cached_property
    def scene(self) -> Scene:
        """The scene that is varied."""
        return scene_from_values(self.values)

    @cached_property
    def times(self) -> Instants:
        """The times of the steps."""
        return steps_of(self.scene, self.duration)

    @cached_property
    def every(self) -> int:
        """How many steps there are from one answer of the controller to the next."""
        return steps_between(self.rate, self.scene.time.rate)

    @cached_property
    def limits(self) -> Limits | None:
        """The limits that the runs are checked against."""
        return None if self.limits_file is None else load_limits(self.limits_file)

    @cached_property
    def _found(self) -> Any:
        return named_controller(self.controller) if isinstance(self.controller, str) else self.controller

    def __getstate__(self) -> dict[str, Any]:
        """Return what it was made of: the rest is read again in another process."""
        return {one.name: getattr(self, one.name) for one in fields(self)}

    @property
    def chunk(self) -> int:
        """How many points to work on between two looks at the clock."""
        if self.vectorized:
            from .lanes import most_lanes

            return most_lanes(self)
        return _PLAIN_CHUNK

    def points(self, first: int, last: int) -> Numbers:
        """Return the points from `first` on, up to `last`: a row each; a delay is whole steps."""
        points = self.sample.points(first, last)
        if _DELAY in self.names:
            column, rate = self.names.index(_DELAY), self.scene.time.rate
            points[:, column] = np.round(points[:, column] * rate) / rate
        return points

    def scene_at(self, point: Numbers) -> Scene:
        """Return the scene of a point; raises InputError."""
        chosen = [i for i, name in enumerate(self.names) if not name.startswith(f'{GAIN}.')]
        changes = changes_at(self.values, [self.names[i] for i in chosen], point[chosen])
        return scene_from_values(overridden(self.values, changes))

    def controller_at(self, point: Numbers, scene: Scene) -> OwnController:
        """Return the controller of a point, made anew; raises InputError."""
        gains = self.gains_of(point.tolist())
        return own_controller(self.made({**self.fixed, **gains}), scene)

    def gains_of(self, numbers: list[Any]) -> dict[str, Any]:
        """Return the arguments of the controller among what stands for the `names`."""
        return {name.partition('.')[2]: number for name, number in zip(self.names, numbers)
                if name.startswith(f'{GAIN}.')}

    def made(self, gains: Mapping[str, object], is_alone: bool = True) -> Any:
        """Return a controller with arguments: of a class or a function made with them, of anything else a copy.

        One on arrays that `is_alone` is asked for a single axis.
        """
        found = self._found
        made = made_controller(found, gains) if isinstance(found, type) or gains else copy.deepcopy(found)
        if self.vectorized and is_alone:
            from .lanes import OneLane

            return OneLane(made)
        return made

    def attempt(self, point: Numbers) -> Attempt:
        """Return what comes of a point."""
        try:
            scene = self.scene_at(point)
            own = self.controller_at(point, scene)
            run = run_loop(own, scene, self.every, self.times, self.setpoint)
        except ControllerError as error:
            return Attempt(Outcome.CONTROLLER, error.run, reason=str(error))
        except SolverError as error:
            return Attempt(Outcome.SOLVER, reason=str(error))
        except InputError as error:
            return Attempt(Outcome.REFUSED, reason=str(error))
        return self.judged(run)

    def judged(self, run: ClosedLoopRun | None, positions: Numbers | None = None) -> Attempt:
        """Return what comes of a run that was made to its end; without limits its positions will do."""
        if self.limits is None or run is None:
            return Attempt(Outcome.PASSED, run, positions=positions)
        try:
            found = tuple(outcomes_of(self.limits, run))
        except InputError as error:
            return Attempt(Outcome.REFUSED, run, reason=str(error))
        return Attempt(Outcome.PASSED if all(one.passed for one in found) else Outcome.MISSED, run, found)

    def rows(self, first: int, last: int) -> Numbers:
        """Return the points from `first` on, up to `last`, with their figures: a row each."""
        points = self.points(first, last)
        return np.array([[*point.tolist(), *self._figures(attempt)]
                         for point, attempt in zip(points, self._attempts(points))])

    def _attempts(self, points: Numbers) -> Iterator[Attempt]:
        if self.vectorized:
            from .lanes import attempts

            return attempts(self, points)
        return map(self.attempt, points)

    def _figures(self, attempt: Attempt) -> list[float]:
        found = {one.name: one.value for one in attempt.limits}
        positions = attempt.positions if attempt.run is None else attempt.run.samples['position']
        last = 0 if positions is None else len(positions) - 1
        figures = [float(attempt.outcome), float(self.times.seconds[last] + self.times.fractions[last])]
        if self.setpoint is not None:
            figures += ([math.nan, math.nan] if positions is None else
                        errors_to(self.setpoint[:len(positions), 0], positions))
        return figures + [math.nan if (value := found.get(name)) is None else float(value)
                          for name in self.limit_names]

    def described(self, command: str = '') -> dict[str, Any]:
        """Return all that it is as JSON values, with the `command`."""
        sample, drawn = self.sample, None
        if isinstance(sample, Sobol):
            drawn = {'points': sample.count, 'seed': sample.seed, 'correlations': sample.correlations}
        return _as_json({
            'form': self.form, 'command': command, 'scene': self.scene.name, 'scene_hash': self.scene.hash,
            'points': self.count, 'duration': self.duration, 'rate': self.rate,
            'over': [{**asdict(one), 'unit': one.unit} for one in sample.variations],
            'sobol': drawn,
            'controller': self.controller if isinstance(self.controller, str) else repr_of(self.controller),
            'controller_digest': _digest_of(self.controller), 'arguments': dict(self.fixed),
            'vectorized': self.vectorized,
            'setpoint_digest': '' if self.setpoint is None else _digest(self.setpoint.tobytes()),
            'limits_digest': '' if self.limits_file is None else _digest(Path(self.limits_file).read_bytes()),
            'versions': versions_of_a_study(), 'scene_text': self.scene.text,
        })


def repr_of(controller: object) -> str:
    """Return the name of a controller, without the place in memory."""
    return str(getattr(controller, '__qualname__', type(controller).__qualname__))


def _as_json(values: dict[str, Any]) -> dict[str, Any]:
    """Return values as they come back from a JSON file."""
    return dict(json.loads(json.dumps(values, default=repr)))


def _digest(content: bytes) -> str:
    return hashlib.sha256(content).hexdigest()


def _digest_of(controller: object) -> str:
    """Return the digest of the file that a controller is from; empty where there is none."""
    if isinstance(controller, str):
        return _digest(Path(controller.rpartition(':')[0]).read_bytes())
    return ''
