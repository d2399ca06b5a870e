# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Input profiles: pieces follow each other to the last bit, and are what they say."""

import math
import random
from copy import deepcopy
from dataclasses import replace
from typing import Any

import pytest

from stickslip_sim.core import ranges
from stickslip_sim.core.errors import InputError
from stickslip_sim.core.input_profile import InputProfile, Sinusoid, constant, ramp, steps, table
from stickslip_sim.core.ranges import Range
from stickslip_sim.inputs import load_scene
from stickslip_sim.scene.schema import BY_NAME
from tests.conftest import Program
from tests.support.axes import COMPLIANT, paper_axis


def test_pieces_of_a_periodic_profile_follow_each_other_for_any_period() -> None:
    rng = random.Random(1)
    for _ in range(100):
        period = rng.uniform(1e-3, 3.0)
        profile = table('force', [0.0, 0.1 * period, 0.5 * period, 0.6 * period], [0.0, -1.0, -1.0, 0.0], period)
        time = 0.0
        for _ in range(1000):
            piece = profile.piece_at(time)
            assert piece.start == time < piece.end
            time = piece.end


def test_values() -> None:
    assert constant(3.0).value_at(1e9) == 3.0
    assert [ramp(1.0, 2.0, 3.0).value_at(t) for t in (0.0, 1.0, 3.0, 9.0)] == [1.0, 3.0, 7.0, 7.0]
    assert ramp(0.0, 1.0, math.inf).value_at(1e6) == 1e6
    assert [steps('drive', [0.0, 1.0], [5.0, -5.0]).value_at(t) for t in (0.0, 0.999, 1.0, 7.0)] == [5, 5, -5, -5]
    saw = table('drive', [0.0, 1.0], [0.0, 4.0], 2.0)
    assert [saw.value_at(t) for t in (0.0, 0.5, 1.0, 1.5, 2.0, 2.5, 3.75)] == [0, 2, 4, 2, 0, 2, 1]


@pytest.mark.parametrize(('times', 'values', 'period', 'word'), [
    ([], [], math.inf, 'as many'), ([0.0, 1.0], [1.0], math.inf, 'as many'), ([1.0], [1.0], math.inf, '0 s at'),
    ([0.0, 1.0, 1.0], [1.0] * 3, math.inf, 'increasing'), ([0.0, 1.0], [1.0] * 2, 1.0, 'below the period')])
def test_bad_times_are_refused(times: list[float], values: list[float], period: float, word: str) -> None:
    for make in (steps, table):
        with pytest.raises(InputError, match=word):
            make('drive', times, values, period)


@pytest.mark.parametrize(('sinusoid', 'word'), [
    (Sinusoid(math.nan, 1.0, 0.0), 'finite'), (Sinusoid(1.0, 0.0, 0.0), 'Hz'), (Sinusoid(1.0, 1e7, 0.0), 'Hz'),
    (Sinusoid(1.0, 1.0, math.inf), 'finite')])
def test_bad_sinusoids_are_refused(sinusoid: Sinusoid, word: str) -> None:
    with pytest.raises(InputError, match=word):
        InputProfile((0.0,), (0.0,), (0.0,), sinusoids=(sinusoid,))
    with pytest.raises(InputError, match='at most 100'):
        InputProfile((0.0,), (0.0,), (0.0,), sinusoids=(Sinusoid(1.0, 1.0, 0.0),) * 101)


def test_a_copy_of_what_holds_a_profile_holds_the_same_one() -> None:
    """What holds measured ones is copied for every fit."""
    profile = table('force', [0.0, 1.0], [2.0, 3.0])
    assert deepcopy({'force': profile})['force'] is profile


# A range: what has a meaning at all, which an axis is held to, and that a scene is held to the whole of it.

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


# What the hot path runs as, and what is said where that is not what was built.

LOAD = '''
import contextlib, io
with contextlib.redirect_stderr(io.StringIO()) as said:
    from stickslip_sim.core.hot_path import hot_path
    from stickslip_sim.solvers import exact, fixed_step
print(hot_path())
print(said.getvalue(), end='')
'''
MISSING = 'import sys; sys.modules["stickslip_sim._hot"] = None'
STALE = '''
import sys, types
sys.modules['stickslip_sim._hot'] = types.SimpleNamespace(SOURCES=('axis/layout.py',), DIGEST='that of another file')
'''
MOVED = STALE.replace('axis/layout.py', 'axis/moved_since.py')


@pytest.mark.parametrize(('before', 'why'), [
    (MISSING, 'the compiled hot path is missing ('), (STALE, 'the compiled hot path was built from other sources; '),
    (MOVED, 'the compiled hot path was built from other sources; ')])
def test_plain_python_in_its_place_is_reported_once_with_the_fix(before: str, why: str, in_a_process: Program) -> None:
    words, *lines = in_a_process(before + LOAD, compiled=True).splitlines()
    assert words == 'plain python'
    said, = lines
    assert said.startswith(f'stickslip: {why}')
    assert 'Build the package again' in said
    assert 'STICKSLIP_COMPILED=0' in said


@pytest.mark.parametrize('before', ['', STALE])
def test_plain_python_that_was_asked_for_is_not_reported(before: str, in_a_process: Program) -> None:
    assert in_a_process(before + LOAD, compiled=False) == 'plain python\n'
