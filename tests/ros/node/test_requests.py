# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Requests to a node: made up and endless, answered at once; and those of the package simulation_interfaces."""

import json
import math
import subprocess
import sys
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from rcl_interfaces.msg import Parameter, ParameterType, ParameterValue
from rcl_interfaces.srv import (
    DescribeParameters,
    GetParameters,
    GetParameterTypes,
    ListParameters,
    SetParameters,
    SetParametersAtomically,
)

from stickslip_msgs.srv import InjectFault, Step
from tests.support import standard_package
from tests.support.made_up_texts import NAMES
from tests.support.node_processes import assert_clean, recording_into, running
from tests.support.ros_nodes import Client, client, live_axis
from tests.support.waiting import DEADLINE, wait_for

pytestmark = [pytest.mark.ros, pytest.mark.slow]

FEW = settings(max_examples=40, suppress_health_check=list(HealthCheck))
NUMBERS = st.floats() | st.sampled_from((0.0, -0.0, 1e-320, 1e308, math.inf, -math.inf, math.nan))
WORDS = st.sampled_from(('', 'clear', 'dry', '\x1b[2J', 'a\nb', 'x' * 10_000)) | st.text(
    st.characters(exclude_categories=['Cs'], exclude_characters='\0'), max_size=9)
KINDS = st.sampled_from(('friction_scale', 'force_pulse', 'encoder_freeze', 'encoder_step', 'encoder_dropout',
                         'command_loss', 'command_delay', 'drive_freeze', 'clear')) | WORDS
VALUES = (st.booleans() | st.integers(-2**63, 2**63 - 1) | NUMBERS | WORDS | st.binary(min_size=1, max_size=9).map(
    lambda data: [bytes([byte]) for byte in data]) | st.lists(NUMBERS, min_size=1, max_size=4) | st.lists(
        WORDS, min_size=1, max_size=3) | st.lists(st.booleans(), min_size=1, max_size=3) | st.just([1.0] * 1_000_000))


def is_one_line(text: str) -> bool:
    return 0 < len(text) <= 3000 and text.isprintable()


@pytest.fixture(scope='class')
def axis() -> Iterator[Client]:
    """A node in lock-step; after all of this it makes a step and ends as if nothing had been."""
    with live_axis('time.mode:=lockstep') as (_, it):
        yield it
        assert it.trigger('reset').success
        assert it.call(Step, 'step', steps=1, velocity=math.nan, force=math.nan).success


class TestMadeUp:
    @FEW
    @given(steps=st.integers(-2**63, 3) | st.integers(100_001, 2**63 - 1), velocity=NUMBERS, force=NUMBERS)
    def test_steps(self, axis: Client, steps: int, velocity: float, force: float) -> None:
        assert is_one_line(axis.call(Step, 'step', steps=steps, velocity=velocity, force=force).message)

    @FEW
    @given(id=WORDS, kind=KINDS, start=NUMBERS, duration=NUMBERS, value=NUMBERS)
    def test_faults(self, axis: Client, **request: Any) -> None:
        assert is_one_line(axis.call(InjectFault, 'inject_fault', **request).message)

    @FEW
    @given(changes=st.dictionaries(NAMES | WORDS, VALUES, min_size=1, max_size=2))
    def test_parameters(self, axis: Client, changes: dict[str, Any]) -> None:
        result = axis.set_parameters(**changes)
        assert result.successful or is_one_line(result.reason), result


MANY = 5_000    # seconds of work
MASS = Parameter(name='axis.mass', value=ParameterValue(type=ParameterType.PARAMETER_DOUBLE, double_value=351.0))
ENDLESS: list[tuple[Any, str, dict[str, Any]]] = [
    (SetParameters, 'set_parameters', {'parameters': [MASS] * MANY}),
    (SetParametersAtomically, 'set_parameters_atomically', {'parameters': [MASS] * MANY}),
    (GetParameters, 'get_parameters', {'names': ['axis.mass'] * MANY}),
    (GetParameterTypes, 'get_parameter_types', {'names': ['axis.mass'] * MANY}),
    (DescribeParameters, 'describe_parameters', {'names': ['axis.mass'] * MANY}),
    (ListParameters, 'list_parameters', {'prefixes': ['axis'] * MANY}),
]


@pytest.mark.parametrize(('program', 'node'), [('sim_node', 'feed_axis'), ('cascade_controller', 'cascade_controller')])
def test_endless_lists_are_answered_without_results_and_reported(program: str, node: str) -> None:
    with client() as asker, running(program=program) as process:
        for kind, name, request in ENDLESS:
            assert asker.call(kind, name, node, **request) == kind.Response(), name
        names = asker.call(ListParameters, 'list_parameters', node).result.names    # as `ros2 param dump` asks
        assert len(asker.call(GetParameters, 'get_parameters', node, names=names).values) == len(names) > 1
        assert_clean(*process.end())
    assert f'{MANY} parameters is refused: must be at most 1000' in process.errors


OK, FAILED, UNSUPPORTED, ALREADY = 1, 4, 0, 101
STOPPED, PLAYING, PAUSED, QUITTING = range(4)
Ask = Callable[..., list[Any]]


def set_state(state: int) -> str:
    return f'set_simulation_state {{"state": {{"state": {state}}}}}'


class TestStandardServices:
    @pytest.fixture
    def ask(self, pytestconfig: pytest.Config, monkeypatch: pytest.MonkeyPatch) -> Ask:
        """Let nodes find the package, built once and kept; return what calls services, each as 'NAME FIELDS'."""
        folder = pytestconfig.cache.mkdir('simulation_interfaces')
        for name, value in standard_package.environment(Path(folder)).items():
            monkeypatch.setenv(name, value)

        def call(*services: str) -> list[Any]:
            done = subprocess.run([sys.executable, '-m', 'tests.support.standard_package', *services],
                                  capture_output=True, text=True, timeout=DEADLINE, check=False)
            assert done.returncode == 0, done.stderr
            answers: list[Any] = json.loads(done.stdout)
            return answers

        return call

    def test_while_time_runs_by_itself(self, ask: Ask) -> None:
        with live_axis('time.rate:=200.0', afresh=True) as (process, axis):
            features, *states, steps, scope = ask(
                'get_simulator_features', 'get_simulation_state', set_state(PLAYING), set_state(PAUSED),
                'get_simulation_state', set_state(QUITTING), set_state(STOPPED), 'get_simulation_state',
                'step_simulation {"steps": 5}', 'reset_simulation {"scope": 1}')
            wait_for(lambda: axis.latest('slider_state').step == 5, 'the steps')
            assert ask('get_simulation_state', set_state(PLAYING), 'reset_simulation')[1:] == [
                {'result': {'result': OK, 'error_message': ''}}] * 2
        assert features['features']['features'] == [20, 24, 25, 31, 32, 26]
        assert [answer['result']['result'] for answer in states] == [OK, ALREADY, OK, OK, UNSUPPORTED, OK, OK]
        assert [answer['state']['state'] for answer in states if 'state' in answer] == [PLAYING, PAUSED, STOPPED]
        assert steps['result']['result'] == OK
        assert scope['result']['result'] == UNSUPPORTED
        assert scope['result']['error_message'].startswith('scope = 1 is refused')
        assert 'simulation_interfaces' not in process.errors

    def test_in_lock_step_and_while_recording(self, ask: Ask, tmp_path: Path) -> None:
        with live_axis('time.mode:=lockstep', *recording_into(tmp_path / 'run'), afresh=True) as (_, axis):
            state, playing, steps, too_many, none, stop = ask(
                'get_simulation_state', set_state(PLAYING), 'step_simulation',
                'step_simulation {"steps": 18446744073709551615}', 'step_simulation {"steps": 0}', set_state(STOPPED))
            wait_for(lambda: axis.latest('slider_state').step == 1, 'the step')
        assert state['state']['state'] == PAUSED
        assert steps['result'] == {'result': OK, 'error_message': ''}
        for answer, reported in ((playing, 'time moves with ~/step only'), (too_many, 'must be 1 to 100000'),
                                 (none, 'must be 1 to 100000'), (stop, 'refused while recording')):
            assert answer['result']['result'] == FAILED
            assert reported in answer['result']['error_message']

    def test_without_the_package_it_says_how_to_get_it(self) -> None:
        with live_axis() as (process, _):
            pass
        assert process.errors.count('ros-$ROS_DISTRO-simulation-interfaces') == 1
