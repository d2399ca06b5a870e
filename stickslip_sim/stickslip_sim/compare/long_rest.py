# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Statement: a long rest raises the first break-away to mu_s(inf) N."""

import math
from collections.abc import Sequence

from ..core.types import Event, EventKind, Mode
from ..runs import Run
from .statement import Finding, Statement, found, not_applicable

_EQUAL = 1e-3   # relative; the exact solver has rounding only, others their step


def _finding(run: Run, _: Sequence[object]) -> Finding:
    """Compare the first break-away of a run that begins after prolonged rest with those that follow."""
    axis = run.scene.axis
    break_aways = [event for event in run.events if _is_break_away(event)]
    if not break_aways:
        return not_applicable('no break-away')
    first, *later = break_aways
    law = axis.friction.along(first.friction_force).static
    if not math.isinf(first.rest_time):
        return not_applicable(f'the first break-away follows a rest of {first.rest_time:.4g} s, not a prolonged one')
    if law.coefficient(math.inf) == law.initial or axis.normal_force == 0.0:
        return not_applicable('static friction does not grow with the rest time')
    if run.scene.normal_load is not None:
        return not_applicable('the normal force varies, and the limit with it')
    limit, force = law.coefficient(math.inf) * axis.normal_force, abs(first.friction_force)
    next_force = max((abs(event.friction_force) for event in later), default=0.0)
    text = f'first break-away at {force:.6g} N, mu_s(inf) N = {limit:.6g} N'
    text += f'; the highest of {len(later)} later ones is {next_force:.6g} N' if later else ''
    is_raised = abs(force - limit) <= _EQUAL * limit and next_force <= (1.0 + _EQUAL) * force
    return found(is_raised, text, first_force=force, limit=limit, highest_later_force=next_force)


def _is_break_away(event: Event) -> bool:
    return event.kind == EventKind.BREAKAWAY and event.mode != Mode.STICK


LONG_REST = Statement('long rest', 'A long rest raises the first break-away to mu_s(inf) N.', _finding)
