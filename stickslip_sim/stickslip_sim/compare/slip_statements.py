# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Statement: within a slip, friction over velocity has two values."""

import math
from collections.abc import Sequence
from itertools import chain
from typing import NamedTuple

import numpy as np

from ..axis import CompliantContact
from ..core.arrays import Numbers
from ..core.types import Event, EventKind, Mode
from ..figures.slips import breaks_away, complete_slips
from ..runs import Run
from .look import look_at
from .run_part import APPLIED, RunPart, within
from .statement import Finding, Statement, found, not_applicable

_GAP = 0.01   # of the lower value: less is one value


class _Gap(NamedTuple):
    """The friction at one speed of a slip, on both branches."""

    speed: float   # m/s
    upper: float   # N, accelerating
    lower: float   # N, decelerating


def branch_gaps(part: RunPart) -> list[_Gap]:
    """Compare both branches of each slip half-way between the speeds of its break-away and its peak."""
    if part.scene.axis.friction.excess is None:
        return []
    return [gap for slip in complete_slips(part.events) if _is_raised(part, *slip) and (gap := _gap(part, *slip))]


def _two_values_finding(run: Run, found_gaps: Sequence[list[_Gap]]) -> Finding:
    """Return what comes of the gaps between the branches."""
    if run.scene.axis.friction.excess is None:
        return not_applicable('without acceleration dependence friction has one value at each velocity')
    if run.scene.normal_load is not None:
        return not_applicable('the normal force varies, and friction with it')
    gaps = list(chain(*found_gaps))
    if not gaps:
        return not_applicable('no complete slip with a break-away above kinetic friction')
    least = min(gap.upper / gap.lower - 1.0 if gap.lower > 0.0 else np.inf for gap in gaps)
    last = gaps[-1]
    text = (f'{len(gaps)} slips, the upper value at least {100.0 * least:.3g} % above the lower; in the last one, at '
            f'{last.speed * 1e3:.4g} mm/s, {last.upper:.4g} N accelerating and {last.lower:.4g} N decelerating')
    return found(least > _GAP, text, slips=len(gaps), least_gap_ratio=least, speed=last.speed,
                 accelerating_force=last.upper, decelerating_force=last.lower)


def _is_raised(part: RunPart, begin: Event, _: Event) -> bool:
    """Whether static friction at the break-away is above kinetic friction, so that there is a second branch."""
    kinetic = part.scene.axis.friction.along(begin.direction).kinetic.coefficient(abs(begin.velocity))
    return begin.kind == EventKind.BREAKAWAY and begin.static_coefficient > (1.0 + _GAP) * kinetic


def _gap(part: RunPart, begin: Event, end: Event) -> _Gap | None:
    """Return the friction of both branches at one speed, None when a branch has no two points."""
    columns = within(part, begin.time, end.time)
    speed, force = np.abs(columns['velocity']), np.abs(columns['friction_force'])
    branches = [columns['mode'] == mode for mode in (Mode.ACCELERATING, Mode.DECELERATING)]
    if min(branch.sum() for branch in branches) < 2:
        return None
    middle = 0.5 * (abs(begin.velocity) + max(speed[branch].max() for branch in branches))
    upper, lower = (float(np.interp(middle, *_rising(speed[branch], force[branch]))) for branch in branches)
    return _Gap(float(middle), upper, lower)


def _rising(speed: Numbers, force: Numbers) -> tuple[Numbers, Numbers]:
    order = np.argsort(speed, kind='stable')
    return speed[order], force[order]


TWO_VALUES = Statement('two-valued friction',
                       'Within a slip the friction force over velocity has two values: more while the slider '
                       'accelerates than while it decelerates.', _two_values_finding, branch_gaps)


# Statement: the initial displacements correspond to the stick balance condition.

_ROUNDING = 1e-9   # relative: rounding of the forces


def _start_balance_finding(run: Run, _: Sequence[object]) -> Finding:
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
    balanced = open_by <= _ROUNDING * max(abs(spring), abs(outside), limit) and abs(held) <= (1.0 + _ROUNDING) * limit
    return found(balanced, text, spring_force=spring, external_force=outside, contact_force=held, limit=limit)


START_BALANCE = Statement('start in balance', 'The initial displacements correspond to the stick balance condition.',
                          _start_balance_finding)


# Statement: a long rest raises the first break-away to mu_s(inf) N.

_EQUAL = 1e-3   # relative; the exact solver has rounding only, others their step


def _long_rest_finding(run: Run, _: Sequence[object]) -> Finding:
    """Compare the first break-away of a run that begins after prolonged rest with those that follow."""
    axis = run.scene.axis
    break_aways = [event for event in run.events if breaks_away(event)]
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


LONG_REST = Statement('long rest', 'A long rest raises the first break-away to mu_s(inf) N.', _long_rest_finding)
