# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Friction as the planned faults of a scene scale it, checked before the run."""

import math

from ..axis import Axis
from ..core.errors import InputError
from ..core.time_grid import Grid
from ..rig.changed_friction import with_friction_scaled
from ..rig.faults import Faults
from ..rig.settings import RigSettings
from .solver import SolverSettings


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
