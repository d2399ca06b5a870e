# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The feeds that an experiment is chosen from: input profiles of the drive, of a few kinds, at a few speeds."""

import math
from collections.abc import Iterator
from itertools import accumulate
from typing import NamedTuple

import numpy as np

from ..core.errors import InputError
from ..report.quantity import quantity
from ..scene import Scene, scene_from_values

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
