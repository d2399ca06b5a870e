# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Solvers under a normal force that varies with time.

Between its jumps a normal force that is constant leaves every mode a linear equation with constant coefficients.  One
that varies smoothly makes those of a slip vary, where mu_k has a slope: its motion is a power series
(`axis.slip_series`).
"""

from ..axis import Axis
from ..core.errors import InputError
from ..core.input_profile import InputProfile
from ..friction.static import StaticLawKind
from . import Solver


def under_load(solver: Solver, axis: Axis, normal_force: InputProfile) -> Solver:
    """Return what solves an axis under a normal force, N; raises InputError where it has no meaning or no solution."""
    normal_force.check('normal_load')
    least, _ = normal_force.bounds()
    if least < 0.0:
        raise InputError('axis.normal_force + normal_load', least, '>= 0 N at all times',
                         'a slideway cannot pull: raise axis.normal_force, or reduce the load (sinusoids count with '
                         'their full amplitude)')
    if not normal_force.is_stepwise:
        if solver.with_normal_force is None:
            raise InputError('normal_load', 'a load that varies smoothly',
                             f'constant or steps with solver.name: {solver.name}',
                             'use normal_load.course: steps, or solver.name: exact')
        if solver.name == 'exact' and not exact_follows(axis, normal_force):
            raise InputError('friction.static.law', 'kato', 'another law under a normal load that varies smoothly',
                             'its growth is singular at rest time 0 (docs/model.md): use law: exponential, '
                             'normal_load.course: steps, or solver.name: adaptive')
    return solver if solver.with_normal_force is None else solver.with_normal_force(normal_force)


def exact_follows(axis: Axis, normal_force: InputProfile) -> bool:
    """Whether the exact solver takes an axis under a normal force: one that varies smoothly not with Kato's law."""
    return normal_force.is_stepwise or all(side.static.kind != StaticLawKind.KATO for side in axis.friction.sides)
