# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Feeds by what their runs would say of parameters: the one that narrows them most is proposed."""

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import accumulate
from typing import NamedTuple

import numpy as np

from ..core.arrays import Numbers
from ..core.errors import InputError, SolverError
from ..core.types import Progress
from ..inputs.scene_files import SceneOrName, scene_of
from ..report.html import Shown
from ..report.model import Part
from ..report.quantity import quantity
from ..scene import Scene, changed, scene_from_values
from ..study.variation import number_at
from .information import SHARE_MOVED, Sensors, Slopes, covariance_after, run_slopes
from .moved_number import moved_number

# The feeds that an experiment is chosen from: input profiles of the drive, of a few kinds, at a few speeds.

AS_IT_IS = 'as it is'
_SPEEDS, _FEW = 7, 3     # of constant feeds; of the other kinds
_LEVELS = 5              # of steps
_PAUSES = 6              # of a start-stop feed, the last one 32 times as long as the first
_REVERSALS = 4
_PERIODS = 2, 8          # of a sine in a run


class Feed(NamedTuple):
    """A feed: its `kind`, a `name` for people, and the parameters of `drive` that make it."""

    kind: str
    name: str
    drive: dict[str, object]

    def scene(self, scene: Scene) -> Scene:
        """Return a scene with this feed in place of its own."""
        if self.kind == AS_IT_IS:
            return scene
        kept = {name: value for name, value in scene.values.items() if not name.startswith('drive.')}
        return scene_from_values({**kept, 'scene': f'{scene.name}_experiment',
                                  **{f'drive.{name}': value for name, value in self.drive.items()}})


def speeds_of(text: str) -> tuple[float, float]:
    """Return the ends of LOW:HIGH; raises InputError."""
    low, _, high = text.partition(':')
    try:
        return float(low), float(high)
    except ValueError:
        raise InputError('--speeds', text, 'LOW:HIGH, two numbers in m/s', 'for example 1e-4:1e-2') from None


def default_speeds(scene: Scene) -> tuple[float, float]:
    """Return the speeds between which feeds are proposed, m/s: a tenth to ten times the scene's highest one.

    Raises InputError where its drive rests.
    """
    speed = max(map(abs, scene.drive.values))
    if speed == 0.0:
        raise InputError('--speeds', None, 'given for a scene whose drive rests', 'add --speeds LOW:HIGH, in m/s')
    return 0.1 * speed, 10.0 * speed


def feeds(speeds: tuple[float, float], duration: float) -> list[Feed]:
    """Return the feeds of a run of `duration` s, between the lowest and the highest of `speeds`, m/s."""
    low, high = speeds
    few = [float(speed) for speed in np.geomspace(low, high, _FEW)]
    return [Feed(AS_IT_IS, 'the feed of the scene', {}), *_constant(low, high), *_ramps(few, duration),
            *_steps(low, high, duration), *(_start_stop(speed, duration) for speed in few),
            *(_to_and_fro(speed, duration) for speed in few),
            *(feed for speed in few for feed in _sines(speed, duration))]


def _constant(low: float, high: float) -> Iterator[Feed]:
    for speed in map(float, np.geomspace(low, high, _SPEEDS)):
        yield Feed('constant', f'constant, {_shown(speed)}', {'course': 'constant', 'velocity': speed})


def _ramps(speeds: list[float], duration: float) -> Iterator[Feed]:
    for speed in speeds:
        yield Feed('ramp', f'ramp from 0 to {_shown(speed)}',
                   {'course': 'ramp', 'velocity': 0.0, 'acceleration': speed / duration, 'duration': duration})


def _steps(low: float, high: float, duration: float) -> Iterator[Feed]:
    levels = tuple(map(float, np.geomspace(low, high, _LEVELS)))
    times = tuple(duration * k / _LEVELS for k in range(_LEVELS))
    for word, speeds in (('up', levels), ('down', levels[::-1])):
        yield Feed('steps', f'{_LEVELS} steps {word}, {_shown(speeds[0])} to {_shown(speeds[-1])}',
                   {'course': 'steps', 'times': times, 'velocities': speeds})


def _start_stop(speed: float, duration: float) -> Feed:
    """Half of the run moves, in equal parts; the pauses between them grow twofold, to see static friction grow."""
    pauses = [2.0 ** k for k in range(_PAUSES)]
    move, scale = 0.5 * duration / (_PAUSES + 1), 0.5 * duration / math.fsum(pauses)
    spans = [span for pause in pauses for span in (move, scale * pause)]
    velocities = (speed, 0.0) * _PAUSES + (speed,)
    return Feed('start-stop', f'start and stop, {_shown(speed)}, growing pauses',
                {'course': 'steps', 'times': (0.0, *accumulate(spans)), 'velocities': velocities})


def _to_and_fro(speed: float, duration: float) -> Feed:
    half = 0.5 * duration / _REVERSALS
    return Feed('to and fro', f'to and fro, {_shown(speed)}',
                {'course': 'steps', 'times': (0.0, half), 'velocities': (speed, -speed), 'period': 2.0 * half})


def _sines(speed: float, duration: float) -> Iterator[Feed]:
    for periods in _PERIODS:
        sine = {'course': 'sine', 'amplitude': speed, 'frequency': periods / duration}
        name = f'{_shown(speed)}, {quantity(periods / duration, "Hz", 3)}'
        yield Feed('sine', f'sine, {name}', {**sine, 'velocity': 0.0})
        yield Feed('sine on a feed', f'sine on as much feed, {name}', {**sine, 'velocity': speed})


def _shown(speed: float) -> str:
    return quantity(speed, 'm/s', 3)


_MOST_PARAMETERS = 20
_MOST_SAMPLES = 1_000_000
D_OPTIMAL, A_OPTIMAL = 'D', 'A'
CRITERIA = {D_OPTIMAL: 'volume that is left to the parameters (D-optimal)',
            A_OPTIMAL: 'mean square of the deviations (A-optimal)'}


@dataclass(frozen=True)
class Wishes:
    """What an experiment is to be: the parameters that it is for, its duration (s), speeds (m/s), and bounds.

    `known` is the deviation of each parameter before, a share, and `scatter` that from slip to slip.  `travel` (m) is
    the most that the drive may go, from its one end to the other.
    """

    parameters: tuple[str, ...]
    duration: float
    speeds: tuple[float, float]
    sensors: Sensors
    known: float
    scatter: float
    travel: float
    criterion: str


@dataclass(frozen=True)
class Experiment:
    """A feed and its run: its derivatives, the covariance (k, k) of the logarithms after it, and the drive's way, m.

    `score` is the deviation that the criterion stands for, a share: the lower the better.
    """

    feed: Feed
    slopes: Slopes
    covariance: Numbers
    travel: float
    score: float

    @property
    def deviations(self) -> Numbers:
        """The deviation (k,) of each parameter after the run, a share."""
        return np.sqrt(np.diag(self.covariance))


@dataclass(frozen=True, repr=False)
class Design(Shown):
    """The experiments of a scene, the best first, and the feeds that were left out, with the reason."""

    scene: Scene
    wishes: Wishes
    experiments: tuple[Experiment, ...]
    left_out: tuple[tuple[Feed, str], ...]

    def _shown(self) -> Iterator[Part]:
        from .report import design_report

        yield f'Design for {", ".join(self.wishes.parameters)} of {self.scene.name}: best is {self.best.feed.name}'
        yield from design_report(self)

    @property
    def best(self) -> Experiment:
        """The experiment that narrows the parameters most."""
        return self.experiments[0]

    @property
    def best_of_kinds(self) -> list[Experiment]:
        """The best experiment of each kind of feed, the best first."""
        kinds: dict[str, Experiment] = {}
        for one in self.experiments:
            kinds.setdefault(one.feed.kind, one)
        return list(kinds.values())


def design(scene: SceneOrName, parameters: Sequence[str], *, duration: float = 10.0,
           speeds: tuple[float, float] | None = None, travel: float = math.inf, rate: float = 1000.0,
           resolution: float = 1e-6, noise: float = 0.0, force_noise: float | None = None, known: float = 0.3,
           scatter: float = 0.01, criterion: str = D_OPTIMAL, progress: Progress = None) -> Design:
    """Return the feeds whose runs would narrow parameters of a scene, the best first.

    They are between `speeds` (m/s; None: a tenth to ten times the scene's), and take a `duration` (s) and at most a
    `travel` (m).  The position is read `rate` times a second (Hz), with a `resolution` and a `noise` (m), the drive
    force with a `force_noise` (N), or not at all.  `known` is the deviation of each parameter before, a share, and
    `scatter` that from slip to slip.  Raises InputError.
    """
    if isinstance(parameters, str):
        raise InputError('parameters', parameters, 'a list of names', f'give [{parameters!r}]')
    if criterion not in (A_OPTIMAL, D_OPTIMAL):
        raise InputError('criterion', criterion, f'{D_OPTIMAL} or {A_OPTIMAL}', 'D is the volume, A the variances')
    loaded = scene_of(scene)
    return designed(loaded, Wishes(tuple(parameters), duration, speeds or default_speeds(loaded), Sensors(
        rate, resolution, noise, force_noise), known, scatter, travel, criterion), progress)


def designed(scene: Scene, wishes: Wishes, progress: Progress = None) -> Design:
    """Return the experiments that a scene allows, by what they would say; raises InputError."""
    exact = changed(scene, {'solver.name': 'exact'})
    _check(exact, wishes)
    times = np.arange(1, round(wishes.duration * wishes.sensors.rate) + 1) / wishes.sensors.rate
    found: list[Experiment] = []
    left_out: list[tuple[Feed, str]] = []
    candidates = feeds(wishes.speeds, wishes.duration)
    for count, feed in enumerate(candidates, 1):
        try:
            one = _experiment(feed, exact, wishes, times)
        except (InputError, SolverError) as error:
            left_out.append((feed, str(error)))
        else:
            if one.travel <= wishes.travel:
                found.append(one)
            else:
                left_out.append((feed, f'its drive goes {one.travel:.3g} m'))
        if progress:
            progress(count / len(candidates))
    if not found:
        reasons = '; '.join(sorted({reason for _, reason in left_out}))
        raise InputError('--travel', wishes.travel, f'such that a feed is left ({reasons})', 'allow more')
    return Design(scene, wishes, tuple(sorted(found, key=lambda one: one.score)), tuple(left_out))


def _experiment(feed: Feed, scene: Scene, wishes: Wishes, times: Numbers) -> Experiment:
    moved = feed.scene(scene)
    deviations = wishes.sensors.deviations
    slopes = run_slopes(moved, list(wishes.parameters), times, list(deviations))
    covariance = covariance_after(slopes, deviations, wishes.known, wishes.scatter)
    way = np.append(0.0, slopes.samples['drive_position'] - moved.initial.position)
    return Experiment(feed, slopes, covariance, float(np.ptp(way)), _score(covariance, wishes.criterion))


def _score(covariance: Numbers, criterion: str) -> float:
    count = len(covariance)
    if criterion == A_OPTIMAL:
        return math.sqrt(float(np.trace(covariance)) / count)
    return math.exp(0.5 * float(np.linalg.slogdet(covariance)[1]) / count)


def _check(scene: Scene, wishes: Wishes) -> None:
    """Raise InputError unless the wishes have a meaning."""
    names, sensors = wishes.parameters, wishes.sensors
    if not 1 <= len(names) <= _MOST_PARAMETERS or len(set(names)) < len(names):
        raise InputError('--for', ','.join(names), f'1 to {_MOST_PARAMETERS} parameters, each once',
                         'for example friction.static.time_constant,friction.static.limit')
    for name in names:
        _check_parameter(scene, name)
    (low, high), noise = wishes.speeds, 1.0 if sensors.force_noise is None else sensors.force_noise
    for option, value, good, allowed in (
            ('--duration', wishes.duration, 0.0 < wishes.duration <= 1e5, '> 0 and <= 1e5 s'),
            ('--rate', sensors.rate, 0.0 < sensors.rate <= 1e6, '> 0 and <= 1e6 Hz'),
            ('--speeds', f'{low:g}:{high:g}', 0.0 < low < high <= 1e6, 'LOW:HIGH with 0 < LOW < HIGH, in m/s'),
            ('--resolution', sensors.resolution, 0.0 <= sensors.resolution < math.inf, 'finite and >= 0 m'),
            ('--noise', sensors.noise, 0.0 <= sensors.noise < math.inf, 'finite and >= 0 m'),
            ('--force-noise', sensors.force_noise, 0.0 < noise < math.inf, 'finite and > 0 N'),
            ('--known', wishes.known, 0.0 < wishes.known <= 10.0, '> 0 and <= 10, a share of each parameter'),
            ('--scatter', wishes.scatter, 0.0 <= wishes.scatter <= 1.0, 'from 0 to 1, a share of each parameter'),
            ('--travel', wishes.travel, wishes.travel > 0.0, '> 0 m')):
        if not good:
            raise InputError(option, value, allowed, 'give a value in this range')
    if sensors.deviations['position'] == 0.0:
        raise InputError('--resolution', 0.0, '> 0 m where --noise is 0', 'readings are never exact: give one of them')
    if not 1 <= round(wishes.duration * sensors.rate) <= _MOST_SAMPLES:
        raise InputError('--rate', sensors.rate, f'such that there are 1 to {_MOST_SAMPLES} readings in '
                         f'{wishes.duration:g} s', 'measure less often, or for a shorter time')


def _check_parameter(scene: Scene, name: str) -> None:
    if name.startswith('drive.'):
        raise InputError('--for', name, 'no parameter of the drive', 'the feed is the proposal')
    moved_number(scene, name, SHARE_MOVED)
    if number_at(scene.values, name) == 0.0:
        raise InputError('--for', name, 'a number other than 0: its prior knowledge is relative', 'give it with --set')
