# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Statement: the initial displacements correspond to the stick balance condition."""

from collections.abc import Sequence

from ..axis import CompliantContact
from ..core.types import Mode
from ..runs import Run
from .look import look_at
from .run_part import APPLIED
from .statement import Finding, Statement, found, not_applicable

_EQUAL = 1e-9   # relative: rounding of the forces


def _finding(run: Run, _: Sequence[object]) -> Finding:
    """Compare the forces that displacements make at the start: of the drive spring, of the contact, and from outside.

    The drive damper is left out: a drive that sets off at a velocity has its force from the first instant on.
    """
    if run.begin != 0.0:
        return not_applicable(f'the recording begins at t = {run.begin:g} s, in mid-run')
    first = look_at(run).first
    if Mode(int(first['mode'])) != Mode.STICK:
        return not_applicable(f'the run begins in slip, at {first["velocity"]:.4g} m/s')
    axis = run.scene.axis
    spring = axis.drive_stiffness * (first['drive_position'] - first['position'])
    outside = first[APPLIED]
    held = first['friction_force'] if isinstance(axis.contact, CompliantContact) else spring + outside
    static = axis.friction.along(held).static
    limit = run.scene.normal_force.value_at(0.0) * static.coefficient(first['rest_time'])
    open_by = abs(spring + outside - held)
    text = f'drive spring {spring:.6g} N, outside {outside:.6g} N, contact {held:.6g} N of at most {limit:.6g} N'
    balanced = open_by <= _EQUAL * max(abs(spring), abs(outside), limit) and abs(held) <= (1.0 + _EQUAL) * limit
    return found(balanced, text, spring_force=spring, external_force=outside, contact_force=held, limit=limit)


START_BALANCE = Statement('start in balance', 'The initial displacements correspond to the stick balance condition.',
                          _finding)
