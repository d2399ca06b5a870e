# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Made-up requests and commands to a real node: each is answered or refused in one line, and the node goes on."""

import math
from collections.abc import Iterator
from typing import Any

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from tests.support.made_up_texts import NAMES
from tests.support.node_processes import running
from tests.support.ros_nodes import Client, client

from stickslip_msgs.srv import InjectFault, Step  # isort: skip

pytestmark = pytest.mark.ros

FEW = settings(max_examples=60,
               suppress_health_check=list(HealthCheck))
NUMBERS = st.floats() | st.sampled_from((0.0, -0.0, 1e-320, 1e308, math.inf, -math.inf, math.nan))
WORDS = st.sampled_from(('', 'clear', 'dry', '\x1b[2J', 'a\nb', 'x' * 10_000)) | st.text(
    st.characters(exclude_categories=['Cs'], exclude_characters='\0'), max_size=9)
KINDS = st.sampled_from(('friction_scale', 'force_pulse', 'encoder_freeze', 'encoder_step', 'encoder_dropout',
                         'command_loss', 'command_delay', 'drive_freeze', 'clear')) | WORDS
VALUES = (st.booleans() | st.integers(-2**63, 2**63 - 1) | NUMBERS | WORDS | st.binary(min_size=1, max_size=9).map(
    lambda data: [bytes([byte]) for byte in data]) | st.lists(NUMBERS, min_size=1, max_size=4) | st.lists(
        WORDS, min_size=1, max_size=3) | st.lists(st.booleans(), min_size=1, max_size=3) | st.just([1.0] * 1_000_000))


@pytest.fixture(scope='module')
def axis() -> Iterator[Client]:
    """A node in lock-step; after all of this it makes a step and ends as if nothing had been."""
    with running('-p', 'scene:=paper_fig8', '-p', 'time.mode:=lockstep') as process, client() as it:
        it.connect(is_moving=False)
        yield it
        assert it.trigger('reset').success
        assert it.call(Step, 'step', steps=1, velocity=math.nan, force=math.nan).success
        code, errors = process.end()
        assert code == 0
        assert 'Traceback' not in errors, errors


@FEW
@given(steps=st.integers(-2**63, 3) | st.integers(100_001, 2**63 - 1), velocity=NUMBERS, force=NUMBERS)
def test_steps(axis: Client, steps: int, velocity: float, force: float) -> None:
    is_answered(axis.call(Step, 'step', steps=steps, velocity=velocity, force=force))


@FEW
@given(id=WORDS, kind=KINDS, start=NUMBERS, duration=NUMBERS, value=NUMBERS)
def test_faults(axis: Client, **request: Any) -> None:
    is_answered(axis.call(InjectFault, 'inject_fault', **request))


@FEW
@given(changes=st.dictionaries(NAMES | WORDS, VALUES, min_size=1, max_size=2))
def test_parameters(axis: Client, changes: dict[str, Any]) -> None:
    result = axis.set_parameters(**changes)
    assert result.successful or one_line(result.reason), result


def is_answered(response: Any) -> None:
    assert one_line(response.message), response


def one_line(text: str) -> bool:
    return 0 < len(text) <= 3000 and text.isprintable()
