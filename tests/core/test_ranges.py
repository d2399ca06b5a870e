# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""A range: what has a meaning at all, which an axis is held to, and that a scene is held to the whole of it."""

import math
from dataclasses import replace
from typing import Any

import pytest

from stickslip_sim.core import ranges
from stickslip_sim.core.errors import InputError
from stickslip_sim.core.ranges import Range
from stickslip_sim.inputs import load_scene
from stickslip_sim.scene.schema import BY_NAME
from tests.support.axes import COMPLIANT, paper_axis


@pytest.mark.parametrize(('within', 'good', 'bad', 'allowed'), [
    (Range(1e-9, 1.0), (1e-300, 1e300), (0.0, -1.0), 'finite and > 0 kg'),
    (Range(0.0, 1.0), (0.0, -0.0, 1e300), (-1e-300,), 'finite and >= 0 kg'),
    (Range(-1.0, 1.0), (0.0, -1e300, 1e300), (), 'finite kg'),
])
def test_meaning(within: Range, good: tuple[float, ...], bad: tuple[float, ...], allowed: str) -> None:
    for value in good:
        within.check_meaning('mass', value, 'kg', 'weigh it')
    for value in (*bad, math.nan, math.inf, -math.inf):
        with pytest.raises(InputError, match=f'mass = {value} is refused: must be {allowed}; weigh it'):
            within.check_meaning('mass', value, 'kg', 'weigh it')


@pytest.mark.parametrize(('name', 'field', 'within'), [
    ('axis.mass', 'mass', ranges.MASS), ('axis.drive_stiffness', 'drive_stiffness', ranges.STIFFNESS),
    ('axis.drive_damping', 'drive_damping', ranges.DAMPING), ('axis.normal_force', 'normal_force', ranges.NORMAL_FORCE),
])
def test_an_axis_may_be_what_no_scene_may(name: str, field: str, within: Range) -> None:
    assert (BY_NAME[name].low, BY_NAME[name].high) == within
    beyond = 2.0 * within.high
    changes: dict[str, Any] = {field: beyond}
    assert getattr(replace(paper_axis(COMPLIANT), **changes), field) == beyond
    with pytest.raises(InputError, match=name):
        load_scene('paper_fig8', {name: beyond})
