# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Axes of every kind through sensors of every kind: what a right model must hold on.

Unlike the feeds of `axes`, theirs are not chosen to excite the axis: a constant feed, a few steps, there and back,
a ramp, a sine, or a motor that drives the slider without a spring.  What a run does not show must be called so.
"""

import math

import numpy as np
from numpy.random import Generator

from stickslip_sim.core.types import EventKind
from stickslip_sim.runs import simulate_events
from stickslip_sim.scene import scene_from_values

from .axes import (
    CONTACTS,
    KINETIC_LAWS,
    STATIC_LAWS,
    SyntheticAxis,
    Values,
    any_free_of,
    between,
    even_ratios,
    machine_values,
    start_of,
)
from .measuring import Sensors

FEEDS = 'constant', 'steps', 'there and back', 'ramp', 'sine', 'motor'
SLIPS = 5, 60                    # break-aways, at least and at most
VARIED_FREE = 2, 7               # parameters, at least and at most
SENSORS = 'without noise', 'Gaussian noise', 'encoders that count'
_DURATIONS = 4.0, 12.0           # s
_RATES = 500.0, 1000.0, 2000.0   # Hz
_PERIODS = 0.2, 1.0              # s, of stick-slip
_NOISES = 3e-5, 1e-2             # of a slip: standard deviation, or step of the encoder
_FORCE_NOISES = 0.002, 0.03      # of the root mean square
_HAVE_FORCE, _HAVE_BACK = 0.7, 0.3   # shares of the axes with a sensor of force, and with friction backwards
_BACK = 0.8, 1.25                # friction backwards over that forwards
_MOTOR = 1.3, 3.0                # its amplitude over static friction


def varied_axes(number: int, seed: int = 0) -> list[SyntheticAxis]:
    """Return the first axes of a seed; feeds, and sensors without noise, with it and that count, come in turn."""
    return [_axis(np.random.default_rng([seed, k]), k) for k in range(number)]


def kind_of(k: int) -> str:
    """Return which of `SENSORS` the k-th axis has."""
    return SENSORS[k // len(FEEDS) % len(SENSORS)]


def _axis(rng: Generator, k: int) -> SyntheticAxis:
    feed = FEEDS[k % len(FEEDS)]
    while True:
        values, duration, slip = _machine(rng, feed)
        truth = scene_from_values(values)
        events = simulate_events(truth, duration).events
        if SLIPS[0] <= sum(event.kind is EventKind.BREAKAWAY for event in events) <= SLIPS[1]:
            break
    free = any_free_of(rng, truth, *VARIED_FREE)
    sensors = _sensors(rng, kind_of(k), slip, feed == 'motor')
    start = start_of(rng, truth, free)
    if feed == 'motor':
        start = scene_from_values({name: value for name, value in start.values.items()
                                   if not name.startswith('force.')})
    return SyntheticAxis(f'{feed} {k}', truth, start, free, int(rng.integers(2**31)), duration, sensors)


def _machine(rng: Generator, feed: str) -> tuple[Values, float, float]:
    """Return the values of a scene, how long it is measured (s), and about how far it slips (m)."""
    values = machine_values(rng, CONTACTS[rng.integers(2)], STATIC_LAWS[rng.integers(len(STATIC_LAWS))],
                            KINETIC_LAWS[rng.integers(len(KINETIC_LAWS))])
    values = {name: value for name, value in values.items() if not name.startswith('drive.')}
    duration = between(rng, *_DURATIONS)
    slip = _slip(values)
    if rng.random() < _HAVE_BACK and feed in ('there and back', 'sine', 'motor'):
        values |= _backward(rng, values)
    if feed == 'motor':
        return values | _motor(rng, values, duration), duration, slip
    return values | _feed(rng, feed, slip / even_ratios(rng, *_PERIODS), duration), duration, slip


def _number(values: Values, name: str) -> float:
    return float(str(values[name]))


def _highest(values: Values) -> float:
    return max(_number(values, name) for name in ('friction.static.initial', 'friction.static.limit')
               if name in values)


def _slip(values: Values) -> float:
    coefficients = values.get('friction.kinetic.coefficients')
    low = coefficients[-1] if isinstance(coefficients, tuple) else _number(values, 'friction.kinetic.limit')
    return 2.0 * _number(values, 'axis.normal_force') * (_highest(values) - low) / _number(values,
                                                                                           'axis.drive_stiffness')


def _feed(rng: Generator, feed: str, velocity: float, duration: float) -> Values:
    kind = {'constant': 'constant', 'ramp': 'ramp', 'sine': 'sine'}.get(feed, 'steps')
    found: Values = {'drive.course': kind}
    if kind == 'steps':
        parts = int(rng.integers(2, 6))
        ways = [(-1.0)**k if feed == 'there and back' else 1.0 for k in range(parts)]
        return found | {'drive.times': tuple(duration * k / parts for k in range(parts)),
                        'drive.velocities': tuple(velocity * way * between(rng, 0.5, 2.0) for way in ways)}
    if kind == 'ramp':
        return found | {'drive.velocity': velocity, 'drive.acceleration': velocity * between(rng, 0.5, 4.0) / duration,
                        'drive.duration': duration * between(rng, 0.5, 1.0)}
    if kind == 'sine':
        return found | {'drive.velocity': 0.0, 'drive.amplitude': velocity * between(rng, 1.0, 3.0),
                        'drive.frequency': between(rng, 1.0, 4.0) / duration, 'drive.phase': 0.0}
    return found | {'drive.velocity': velocity}


def _motor(rng: Generator, values: Values, duration: float) -> Values:
    """Return what drives the slider without a spring: a force of two sinusoids beyond static friction."""
    amplitude = _highest(values) * _number(values, 'axis.normal_force') * between(rng, *_MOTOR)
    frequency = between(rng, 4.0, 10.0) / duration
    return {'axis.drive_stiffness': 0.0, 'axis.drive_damping': 0.0, 'drive.course': 'constant', 'drive.velocity': 0.0,
            'force.course': 'sine', 'force.constant': 0.0, 'force.amplitude': amplitude, 'force.frequency': frequency,
            'force.phase': 0.0, 'force.amplitudes': (amplitude * between(rng, 0.1, 0.4),),
            'force.frequencies': (frequency * math.pi,)}


def _backward(rng: Generator, values: Values) -> Values:
    """Return friction backwards: all of it by one factor."""
    factor, found = between(rng, *_BACK), Values()
    for name in ('static.initial', 'static.limit', 'kinetic.initial', 'kinetic.limit', 'kinetic.coefficients'):
        section, _, own = name.partition('.')
        value = values.get(f'friction.{name}')
        if value is not None:
            found[f'friction.{section}.backward.{own}'] = (
                tuple(factor * one for one in value) if isinstance(value, tuple) else factor * float(str(value)))
    return found


def _sensors(rng: Generator, kind: str, slip: float, is_motor: bool) -> Sensors:
    has_noise, counts = kind != SENSORS[0], kind == SENSORS[2]
    size = slip * even_ratios(rng, *_NOISES) if has_noise else 0.0
    force = even_ratios(rng, *_FORCE_NOISES) if has_noise else 0.0
    return Sensors(float(rng.choice(_RATES)), size if counts else 0.0, force, 0.0 if counts else size,
                   is_motor or rng.random() < _HAVE_FORCE)
