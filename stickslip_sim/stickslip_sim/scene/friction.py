# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The friction of a scene, from complete values: forwards, and backwards where that differs."""

import math
from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import Any

from ..axis import Axis, Friction
from ..core.errors import InputError
from ..core.time_grid import Grid
from ..friction import (
    ExcessTable,
    KineticTable,
    SmoothExcess,
    SmoothKinetic,
    StaticLaw,
    StaticLawKind,
    excess_table,
    kinetic_table,
    smooth,
)
from ..friction.kinetic import default_excess
from ..simulation.faults import Faults
from ..simulation.plant import with_friction_scaled
from ..simulation.rig import RigSettings
from .friction_schema import BACKWARD, backward_name, forward_name
from .model import SolverSettings
from .schema import BY_NAME
from .values import section_of

_SECTIONS = ('friction.static.', 'friction.kinetic.', 'friction.excess.')
_INSIDE = f'.{BACKWARD}.'

_KINETIC: dict[str, Callable[..., SmoothKinetic]] = {
    'stribeck': smooth.stribeck, 'exponential': smooth.exponential, 'hyperbolic': smooth.hyperbolic,
}
_EXCESS: dict[str, Callable[..., SmoothExcess]] = {'cosine': smooth.cosine, 'power': smooth.power}


def friction_of(values: Mapping[str, Any]) -> Friction:
    """Return the friction of complete values; raises InputError."""
    forwards = {name: value for name, value in values.items() if _INSIDE not in name}
    changes = {forward_name(name): value for name, value in values.items() if _INSIDE in name}
    friction = _one_way(forwards)
    back = friction if not changes else _backwards(forwards | changes)
    return friction if back == friction else replace(friction, backward=back)


def _backwards(values: Mapping[str, Any]) -> Friction:
    """Return the friction of motion along −x; an InputError names the parameter of that."""
    try:
        return _one_way(values)
    except InputError as error:
        name, allowed = backward_name(error.name.partition('[')[0]), error.allowed
        for section in _SECTIONS:
            allowed = allowed.replace(section, f'{section}{BACKWARD}.')
        raise InputError(name if name in BY_NAME else error.name, error.value, allowed,
                         f'{error.fix}; backwards, what is left out is as forwards') from None


def _one_way(values: Mapping[str, Any]) -> Friction:
    static = section_of(values, 'friction.static')
    law = StaticLawKind[static.pop('law').upper()]
    static.setdefault('limit', static['initial'])
    kinetic = _kinetic(section_of(values, 'friction.kinetic'))
    return Friction(StaticLaw(law, **static), kinetic, _excess(values, kinetic))


def _kinetic(given: dict[str, Any]) -> KineticTable:
    law = given.pop('law')
    if law == 'table':
        return KineticTable(**given)
    tolerance = given.pop('tolerance')
    return kinetic_table(_KINETIC[law](**given), tolerance)


def _excess(values: Mapping[str, Any], kinetic: KineticTable) -> ExcessTable | None:
    if not values['friction.acceleration_dependence']:
        return None
    excess = section_of(values, 'friction.excess')
    law = excess.pop('law')
    if law != 'table':
        tolerance = excess.pop('tolerance')
        if 'limit_velocity' not in excess:
            excess['limit_velocity'] = default_excess(kinetic).velocities[-1]
        return excess_table(_EXCESS[law](**excess), tolerance)
    if len(excess) == 1:
        (given,) = excess
        raise InputError(f'friction.excess.{given}', excess[given], 'given with both velocities and fractions',
                         'add the other, or leave both out')
    return ExcessTable(**excess) if excess else default_excess(kinetic)


# Friction as the planned faults of a scene scale it, checked before the run.

def check_scaled_friction(axis: Axis, solver: SolverSettings, rig: RigSettings, rate: float) -> None:
    """Raise InputError when the solver cannot follow the axis at some time; `rate` in steps a second."""
    plan = Faults(Grid(rate), rig.faults)
    while plan.next_change < math.inf:
        plan.enter(int(plan.next_change))
        scale = math.prod(plan.values('friction_scale'))
        try:
            solver.check(with_friction_scaled(axis, scale))
        except InputError as error:
            raise InputError(f'with friction times {scale:g} by faults: {error.name}', error.value, error.allowed,
                             error.fix) from None
