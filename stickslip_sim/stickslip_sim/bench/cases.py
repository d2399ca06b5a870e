# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The cases of the race: A to D, which span the motions of an axis, and every shipped scene."""

import math

from ..axis import Axis, CompliantContact, Friction, InitialState, RigidContact
from ..core.errors import InputError
from ..core.input_profile import InputProfile, constant
from ..friction import KineticTable, StaticLaw, StaticLawKind
from ..friction.kinetic import default_excess
from ..inputs import load_scene
from ..scene import scene_names
from .problem import Problem

LETTERS = ('A', 'B', 'C', 'D')
_DURATION = 60.0          # s, of A, B and C
_CHAOTIC_DURATION = 5.0   # s, of D: errors grow tenfold every 2 s, so that a longer comparison says nothing
_SCENE_DURATION = 10.0    # s
_LONG_SCENES = {'micro_feed': 60.0}   # s: it breaks away for the first time after 15 s
_TICK = 1000.0            # Hz, of the commands of D


def case_names() -> list[str]:
    """Return the names of all cases."""
    return [*LETTERS, *scene_names()]


def make_case(name: str, duration: float | None = None) -> Problem:
    """Return a case, for its own duration or another (s); raises InputError on an unknown name."""
    if name in LETTERS:
        return _letter(name, duration)
    if name not in scene_names():
        raise InputError('--scenes', name, 'one of ' + ', '.join(case_names()), 'see `stickslip scenes`')
    scene = load_scene(name)
    return Problem(name, scene.summary, scene.axis, scene.initial, scene.drive, scene.force,
                   duration or _LONG_SCENES.get(name, _SCENE_DURATION))


def _letter(name: str, duration: float | None) -> Problem:
    """Return A to D: the paper's axis from prolonged rest, with a rest-time constant of 1 s."""
    rigid, compliant = RigidContact(), CompliantContact(5e6, 15000.0)
    duration = duration or (_CHAOTIC_DURATION if name == 'D' else _DURATION)
    if name == 'A':
        return _constant('A', 'rigid contact, 1 mm/s', _axis(rigid), 0.001, duration)
    if name == 'B':
        return _constant('B', 'compliant contact, 1 mm/s', _axis(compliant), 0.001, duration)
    if name == 'C':
        return _constant('C', 'conventional characteristics, rigid, 10 mm/s', _axis(rigid, branches=False), 0.01,
                         duration)
    starts = tuple(k / _TICK for k in range(round(duration * _TICK)))
    drive = InputProfile(starts, tuple(0.005 * (1.0 + 0.5 * math.sin(2.0 * math.pi * 3.0 * t)) for t in starts),
                   (0.0,) * len(starts))
    force = InputProfile(starts, tuple(100.0 * math.sin(2.0 * math.pi * 20.0 * t) for t in starts),
                         (0.0,) * len(starts))
    return Problem('D', 'compliant contact, new feed and force 1000 times a second', _axis(compliant), InitialState(),
                   drive, force, duration)


def _constant(name: str, summary: str, axis: Axis, feed: float, duration: float) -> Problem:
    return Problem(name, summary, axis, InitialState(), constant(feed), constant(0.0), duration)


def _axis(contact: RigidContact | CompliantContact, *, branches: bool = True) -> Axis:
    kinetic = KineticTable((0.0, 0.035), (0.12, 0.05))
    static = StaticLaw(StaticLawKind.EXPONENTIAL, 0.12, 0.24, 1.0)
    return Axis(350.0, 6e5, 4000.0, 3432.3275, contact,
                Friction(static, kinetic, default_excess(kinetic) if branches else None))
