# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""What the hot path runs as, and what is said where that is not what was built."""

import pytest

from tests.conftest import Program

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


@pytest.mark.parametrize('before', ['', MISSING, STALE, MOVED])
def test_plain_python_that_was_asked_for_is_not_reported(before: str, in_a_process: Program) -> None:
    assert in_a_process(before + LOAD, compiled=False) == 'plain python\n'
