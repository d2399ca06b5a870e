# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Scenes for the reference: the paper's, the benchmark scenes A to D, the shipped ones, and random ones, as stored."""

from __future__ import annotations

import math
from typing import Any, NamedTuple

from stickslip_sim.inputs import load_scene
from stickslip_sim.scene import scene_names
from tests.support.stored_objects import parameters_of
from tests.support.stored_runs import stored

Parameters = dict[str, Any]


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
        'axis': {'mass': 350.0, 'drive_stiffness': 6.0e5, 'drive_damping': 4000.0, 'normal_force': 3432.3275},
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


def random_scenes() -> list[Scene]:
    """Return scenes that were drawn once, with every law, contact and input: the stored runs have their data."""
    return [Scene(name, run['parameters'], run['duration']) for name, run in stored().items()
            if name.startswith('random')]
