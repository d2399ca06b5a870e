# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The friction characteristics of an axis as curves, and where a run broke away (Fig. 6)."""

import math
from contextlib import suppress

import numpy as np

from ..axis import Friction
from ..core.arrays import Numbers
from ..core.errors import InputError
from ..core.types import Event
from ..figures.slips import breaks_away
from ..friction import StaticLaw
from ..plots.characteristics import Characteristics, Curve
from ..runs import Run
from ..scene import Scene, changed
from ..scene.load import unscaled
from ..scene.schema import BACKWARD
from .look import look_at

_BEYOND = 1.25   # of the limit velocity, and of the longest rest: how far the axes go
_POINTS = 400
_TIME_CONSTANTS = 5.0


def characteristics_of(run: Run) -> list[Characteristics]:
    """Return what there is to draw of the friction of a run: forwards, and backwards where that differs."""
    breaks = [event for event in run.events if breaks_away(event)]
    sides = [(friction, breaks) for friction in run.scene.axis.friction.sides]
    if len(sides) > 1:
        sides = [(friction, [event for event in breaks if event.direction == direction])
                 for (friction, _), direction in zip(sides, (1, -1))]
    longest = max(_longest(friction.static, breaks) for friction, breaks in sides)
    return [_of_side(run, friction, breaks, longest) for friction, breaks in sides]


def _of_side(run: Run, friction: Friction, breaks: list[Event], longest: float) -> Characteristics:
    speeds = _speeds(run, friction)
    kinetic = np.array([friction.kinetic.coefficient(speed) for speed in speeds])
    finite = [event for event in breaks if math.isfinite(event.rest_time)]
    marks = np.array([(event.rest_time, event.static_coefficient) for event in finite]).reshape(-1, 2)
    rests = np.linspace(0.0, longest, _POINTS, dtype=np.float64)
    static = np.array([friction.static.coefficient(rest) for rest in rests.tolist()])
    return Characteristics(
        Curve(speeds, kinetic), _accelerating(friction, speeds, kinetic, breaks), Curve(rests, static),
        friction.static.coefficient(math.inf) if friction.static.bounded else None,
        Curve(marks[:, 0], marks[:, 1]), len(finite) < len(breaks))


def _speeds(run: Run, friction: Friction) -> Numbers:
    """Return speeds that show all of the tables, breakpoints among them."""
    breakpoints = {*friction.kinetic.velocities, *(friction.excess.velocities if friction.excess else ())}
    end = _BEYOND * (friction.kinetic.limit_velocity or max(map(abs, look_at(run).ranges['velocity'])) or 1.0)
    return np.array(sorted({*np.linspace(0.0, end, _POINTS).tolist(), *(w for w in breakpoints if w < end)}))


def _accelerating(friction: Friction, speeds: Numbers, kinetic: Numbers, breaks: list[Event]) -> dict[str, Curve]:
    """Return the accelerating branch of the first and of the last break-away: mu_k + E psi."""
    if friction.excess is None or not breaks:
        return {}
    psi = np.array([friction.excess.fraction(speed) for speed in speeds])
    branches = {}
    for label, event in {'first slip': breaks[0], 'last slip': breaks[-1]}.items():
        speed = abs(event.velocity)
        share = friction.excess.fraction(speed)
        if share > 0.0:
            excess = (event.static_coefficient - friction.kinetic.coefficient(speed)) / share
            branches[label] = Curve(speeds, kinetic + max(excess, 0.0) * psi)
    return branches


def _longest(law: StaticLaw, events: list[Event]) -> float:
    constants = _TIME_CONSTANTS * law.time_constant
    return max([constants, *(_BEYOND * event.rest_time for event in events if math.isfinite(event.rest_time))])


# An axis with the conventional characteristics (Fig. 3), beside its own (Fig. 4 of the paper).

_KINETIC = 'friction.kinetic'


def scene_as_run(run: Run) -> Scene | None:
    """Return the scene with the inputs of the run; None for a recorded run whose inputs were not constant."""
    if not run.is_recorded:
        return run.scene
    inputs = look_at(run).steady
    if inputs is None or run.is_changed:
        return None
    return changed(run.scene, {'drive.course': 'constant', 'drive.velocity': inputs.velocity,
                                   'force.course': 'constant', 'force.constant': inputs.force})


def characteristics_beside(scene: Scene) -> dict[str, Scene]:
    """Return the scene with constant, with falling, and with acceleration-dependent kinetic friction, by these names.

    What the scene cannot have is left out: one without a falling branch has no limit velocity for the others.
    """
    conventional = {'friction.acceleration_dependence': False}
    friction = unscaled(scene).axis.friction
    kinetic, back = friction.kinetic, friction.along(-1.0).kinetic
    constant: dict[str, object] = {
        f'{_KINETIC}.law': 'table', f'{_KINETIC}.velocities': (0.0,),
        f'{_KINETIC}.coefficients': (kinetic.coefficients[0],), f'{_KINETIC}.end_slope': 0.0}
    if friction.backward is not None:
        constant |= dict.fromkeys(name for name in scene.values if name.startswith(f'{_KINETIC}.{BACKWARD}.'))
        constant[f'{_KINETIC}.{BACKWARD}.coefficients'] = (back.coefficients[0],)
    found = {'constant kinetic friction': changed(scene, {**conventional, **constant})}
    if len(set(kinetic.coefficients)) > 1:
        found['falling kinetic friction'] = changed(scene, conventional)
    with suppress(InputError):
        found['acceleration-dependent friction'] = changed(scene, {'friction.acceleration_dependence': True})
    return found
