# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Statement: within a slip, friction over velocity has two values."""

from collections.abc import Sequence
from itertools import chain
from typing import NamedTuple

import numpy as np

from ..core.arrays import Numbers
from ..core.types import Event, EventKind, Mode
from ..runs import Run
from .drawn import complete_slips, within
from .run_part import RunPart
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


def _finding(run: Run, found_gaps: Sequence[list[_Gap]]) -> Finding:
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
                       'accelerates than while it decelerates.', _finding, branch_gaps)
