# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Scenes for the reference: the paper's, the benchmark scenes A to D, and seeded random ones.

A scene is (name, parameters, duration).  Random numbers are rounded to four digits, so that a scene is the
same on every platform.
"""

from __future__ import annotations

import math
import random
from typing import Any, NamedTuple

from stickslip_sim.inputs import load_scene
from stickslip_sim.scene import scene_names
from tests.support.stored_objects import parameters_of

Parameters = dict[str, Any]
Segments = list[tuple[float, float, float]]


class Scene(NamedTuple):
    """Named input of one simulation."""

    name: str
    parameters: Parameters
    duration: float


# ---- the paper and the benchmarks -----------------------------------------------------------------


def paper(*, contact: str = 'rigid', dependence: bool = True, velocity: float = 0.002, tau: float = 0.2) -> Parameters:
    """Return the paper's data with N = m g."""
    model = {'model': 'rigid'} if contact == 'rigid' else {'model': 'compliant', 'stiffness': 5.0e6, 'damping': 15000.0}
    return {
        'axis': {
            'mass': 350.0,
            'drive_stiffness': 6.0e5,
            'drive_damping': 4000.0,
            'normal_force': 3432.3275,
        },
        'contact': model,
        'friction': {
            'static': {'law': 'exponential', 'initial': 0.12, 'limit': 0.24, 'time_constant': tau},
            'kinetic': {'velocities': [0.0, 0.035], 'coefficients': [0.12, 0.05]},
            'acceleration_dependence': dependence,
        },
        'drive': [(0.0, velocity, 0.0)],
        'force': [(0.0, 0.0, 0.0)],
        'initial': {'position': 0.0, 'velocity': 0.0, 'rest_time': math.inf},
    }


def scene_d(duration: float) -> Parameters:
    """Return scene D: 1 kHz zero-order-hold feed and force on the compliant axis."""
    parameters = paper(contact='compliant', tau=1.0)
    ticks = [k / 1000.0 for k in range(round(duration * 1000.0))]
    parameters['drive'] = [(t, 0.005 * (1.0 + 0.5 * math.sin(2.0 * math.pi * 3.0 * t)), 0.0) for t in ticks]
    parameters['force'] = [(t, 100.0 * math.sin(2.0 * math.pi * 20.0 * t), 0.0) for t in ticks]
    return parameters


def named_scenes() -> list[Scene]:
    """Return the paper scenes and scenes A to D."""
    return [
        Scene('paper_fig7', paper(), 60.0),
        Scene('paper_fig8', paper(contact='compliant'), 60.0),
        Scene('conventional_rigid', paper(dependence=False), 60.0),
        Scene('A', paper(velocity=0.001, tau=1.0), 60.0),
        Scene('B', paper(contact='compliant', velocity=0.001, tau=1.0), 60.0),
        Scene('C', paper(dependence=False, velocity=0.01, tau=1.0), 60.0),
        Scene('D', scene_d(5.0), 5.0),
    ]


# the first break-away of micro_feed is at 15 s; fast_feed settles, and later than 3 s its swing drowns in doubles
SHIPPED_DURATIONS = {'micro_feed': 40.0, 'fast_feed': 3.0, 'ball_screw': 1.0}


def shipped_scenes() -> list[Scene]:
    """Return every scene that the product ships, over ten seconds or a few events."""
    return [
        Scene(f'shipped_{name}', parameters_of(scene.axis, scene.initial, scene.drive, scene.force), duration)
        for name in sorted(scene_names())
        for duration in [SHIPPED_DURATIONS.get(name, 10.0)]
        for scene in [load_scene(name)]
    ]


# ---- random scenes ----------------------------------------------------------------------------------


def random_scenes(n: int, seed: int) -> list[Scene]:
    """Return n valid random scenes; scene i depends on (seed, i) alone."""
    return [_random_scene(f'random_{seed}_{i}', random.Random(f'{seed}/{i}'), i) for i in range(n)]


def _r(x: float) -> float:
    """Round to four significant digits."""
    return float(f'{x:.4g}')


def _random_scene(name: str, rng: random.Random, index: int) -> Scene:
    axis = _axis(rng)
    omega = math.sqrt(axis['drive_stiffness'] / axis['mass'])
    static = _static(rng, omega)
    drop = axis['normal_force'] * max(static['initial'] * 0.4, static.get('limit', 0.0) - static['initial'])
    slip_speed = drop / (axis['mass'] * omega)
    feed = _r(rng.choice((-1, 1)) * slip_speed * rng.choice((0.05, 0.1, 0.3, 0.7, 1.2)) * rng.uniform(0.7, 1.4))
    load = axis['normal_force'] * static['initial']
    cycle = 1.5 * load / (axis['drive_stiffness'] * abs(feed)) + 6.3 / omega
    duration = _r(rng.uniform(4.0, 7.0) * cycle)
    parameters = {
        'axis': axis,
        'contact': _contact(rng, axis, compliant=index % 2 == 1),
        'friction': _friction(rng, static, slip_speed, dependence=index % 4 < 2 or rng.random() < 0.3),
        'drive': _drive(rng, feed, duration),
        'force': _force(rng, load, duration),
        'initial': _initial(rng, static['law'], slip_speed, omega),
    }
    return Scene(name, parameters, duration)


def _axis(rng: random.Random) -> dict[str, float]:
    """Slow to fast, light to heavy, undamped to well damped."""
    mass = _r(rng.choice((0.05, 1.0, 20.0, 350.0, 4000.0)) * rng.uniform(0.5, 2.0))
    omega = rng.choice((5.0, 20.0, 60.0, 250.0)) * rng.uniform(0.6, 1.6)
    zeta = rng.choice((0.0, 0.0, 0.01, 0.05, 0.138, 0.3, 0.7))
    return {
        'mass': mass,
        'drive_stiffness': _r(mass * omega * omega),
        'drive_damping': _r(2.0 * zeta * mass * omega),
        'normal_force': _r(mass * rng.uniform(2.0, 40.0)),
    }


def _contact(rng: random.Random, axis: dict[str, float], compliant: bool) -> dict[str, Any]:
    if not compliant:
        return {'model': 'rigid'}
    stiffness = axis['drive_stiffness'] * rng.choice((0.7, 3.0, 8.3, 30.0, 200.0)) * rng.uniform(0.7, 1.4)
    zeta = rng.choice((0.0, 0.02, 0.1, 0.2, 0.5, 1.3))
    return {
        'model': 'compliant',
        'stiffness': _r(stiffness),
        'damping': _r(2.0 * zeta * math.sqrt(stiffness * axis['mass'])),
    }


def _static(rng: random.Random, omega: float) -> dict[str, Any]:
    law = rng.choice(('constant', 'exponential', 'exponential', 'kato', 'hyperbolic', 'logarithmic'))
    initial = _r(rng.uniform(0.08, 0.35))
    if law == 'constant':
        return {'law': law, 'initial': initial}
    rise = rng.uniform(1.02, 1.1) if law == 'logarithmic' else rng.uniform(1.1, 2.5)
    data: dict[str, Any] = {
        'law': law,
        'initial': initial,
        'limit': _r(initial * rise),
        'time_constant': _r(rng.choice((0.3, 2.0, 10.0)) * rng.uniform(0.5, 2.0) / omega),
    }
    if law == 'kato':
        data['exponent'] = rng.choice((0.4, 0.67, 1.0, 1.5))
    return data


def _friction(rng: random.Random, static: dict[str, Any], slip_speed: float, dependence: bool) -> dict[str, Any]:
    """A falling table of one to five breakpoints (some with a rise behind the minimum), and perhaps an excess."""
    start = static['initial'] * rng.choice((1.0, 1.0, 0.95, 0.7))
    count = rng.choice((1, 2, 2, 3, 5)) if not dependence else rng.choice((2, 2, 3, 5))
    speeds, values = [0.0], [_r(start) if start != static['initial'] else start]
    slip_speed *= rng.choice((1.0, 1.0, 3.0))
    for _k in range(1, count):
        speeds.append(_r(speeds[-1] + slip_speed * rng.uniform(0.15, 1.6) / math.sqrt(count)))
        values.append(_r(values[-1] * rng.uniform(0.45, 0.95)))
    if count >= 3 and rng.random() < 0.4:
        values[-1] = _r(values[-2] * rng.uniform(1.01, 1.04))
    friction: dict[str, Any] = {
        'static': static,
        'kinetic': {'velocities': speeds, 'coefficients': values},
        'acceleration_dependence': dependence,
    }
    if dependence and rng.random() < 0.5:
        friction['excess'] = _excess(rng, slip_speed)
    return friction


def _excess(rng: random.Random, slip_speed: float) -> dict[str, list[float]]:
    count = rng.choice((2, 3, 4))
    slip_speed *= rng.choice((1.0, 3.0))
    speeds, fractions = [0.0], [1.0]
    for k in range(1, count):
        speeds.append(_r(speeds[-1] + slip_speed * rng.uniform(0.3, 1.5) / (count - 1)))
        fractions.append(0.0 if k == count - 1 else _r(fractions[-1] * rng.uniform(0.3, 0.8)))
    return {'velocities': speeds, 'fractions': fractions}


def _drive(rng: random.Random, feed: float, duration: float) -> Segments:
    """Constant feed, reversal, stop and go, ramps without and with jumps."""
    kind = rng.choice(('constant', 'constant', 'reversal', 'stop', 'ramp', 'triangle'))
    middle, late = _r(duration * rng.uniform(0.35, 0.55)), _r(duration * rng.uniform(0.65, 0.8))
    if kind == 'reversal':
        return [(0.0, feed, 0.0), (middle, _r(-feed * rng.uniform(0.8, 2.0)), 0.0)]
    if kind == 'stop':
        return [(0.0, feed, 0.0), (middle, 0.0, 0.0), (late, _r(1.5 * feed), 0.0)]
    if kind == 'ramp':
        return [(0.0, 0.0, _r(2.0 * feed / duration)), (late, _r(0.7 * feed), 0.0)]
    if kind == 'triangle':
        slope = _r(4.0 * feed / duration)
        return [(0.0, 0.0, slope), (middle, slope * middle, -slope)]
    return [(0.0, feed, 0.0)]


def _force(rng: random.Random, load: float, duration: float) -> Segments:
    """None, constant, steps, ramps, a short blow."""
    kind = rng.choice(('none', 'constant', 'steps', 'ramp', 'blow'))
    size, sign = load * rng.uniform(0.1, 0.6), rng.choice((-1, 1))
    first, second = _r(duration * rng.uniform(0.2, 0.5)), _r(duration * rng.uniform(0.55, 0.85))
    if kind == 'constant':
        return [(0.0, _r(sign * size), 0.0)]
    if kind == 'steps':
        return [(0.0, 0.0, 0.0), (first, _r(sign * size), 0.0), (second, _r(-1.7 * sign * size), 0.0)]
    if kind == 'ramp':
        return [(0.0, _r(sign * size), _r(-2.0 * sign * size / duration)), (second, 0.0, 0.0)]
    if kind == 'blow':
        return [(0.0, 0.0, 0.0), (first, _r(6.0 * sign * load), 0.0), (_r(first * 1.01), 0.0, 0.0)]
    return [(0.0, 0.0, 0.0)]


def _initial(rng: random.Random, law: str, slip_speed: float, omega: float) -> dict[str, float]:
    finite = law == 'logarithmic' or rng.random() < 0.3
    return {
        'position': _r(rng.uniform(-1.0, 1.0)) if rng.random() < 0.2 else 0.0,
        'velocity': _r(rng.uniform(-1.5, 1.5) * slip_speed) if rng.random() < 0.2 else 0.0,
        'rest_time': _r(rng.uniform(0.0, 20.0) / omega) if finite else math.inf,
    }
