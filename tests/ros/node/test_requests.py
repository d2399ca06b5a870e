# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Requests to a node: made up and endless, answered at once; and those of the package simulation_interfaces."""

import math
import re
import sys
from collections.abc import Iterator, Mapping
from dataclasses import field, make_dataclass
from pathlib import Path
from types import MappingProxyType, SimpleNamespace
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
from tests.support.axis_here import AxisHere, axis_here
from tests.support.made_up_texts import NAMES
from tests.support.node_processes import recording_into
from tests.support.waiting import wait_for

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
def axis() -> Iterator[AxisHere]:
    """A node in lock-step; after all of this it makes a step and ends as if nothing had been."""
    with axis_here('time.mode:=lockstep') as it:
        yield it
        assert it.trigger('reset').success
        assert it.step(1)


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


class TestRequests:
    @FEW
    @given(steps=st.integers(-2**63, 3) | st.integers(100_001, 2**63 - 1), velocity=NUMBERS, force=NUMBERS)
    def test_steps(self, axis: AxisHere, steps: int, velocity: float, force: float) -> None:
        assert is_one_line(axis.call(Step, 'step', steps=steps, velocity=velocity, force=force).message)

    @FEW
    @given(id=WORDS, kind=KINDS, start=NUMBERS, duration=NUMBERS, value=NUMBERS)
    def test_faults(self, axis: AxisHere, **request: Any) -> None:
        assert is_one_line(axis.call(InjectFault, 'inject_fault', **request).message)

    @FEW
    @given(changes=st.dictionaries(NAMES | WORDS, VALUES, min_size=1, max_size=2))
    def test_parameters(self, axis: AxisHere, changes: dict[str, Any]) -> None:
        result = axis.set_parameters(**changes)
        assert result.successful or is_one_line(result.reason), result

    def test_endless_lists_are_answered_without_results_and_reported(
            self, axis: AxisHere, capfd: pytest.CaptureFixture[str]) -> None:
        for kind, name, request in ENDLESS:
            assert axis.call(kind, name, **request) == kind.Response(), name
        names = axis.parameter_names()    # as `ros2 param dump` asks
        assert len(axis.values(*names)) == len(names) > 1
        assert f'{MANY} parameters is refused: must be at most 1000' in capfd.readouterr().err


# What of the package simulation_interfaces (1.0 and later) the node needs; it is not among the wheels.

def message(constants: Mapping[str, int] = MappingProxyType({}), **fields: Any) -> Any:
    """Return a type of messages with constants, and fields by what makes their first value."""
    return make_dataclass('Message', [(name, Any, field(default_factory=make)) for name, make in fields.items()],
                          namespace=dict(constants), slots=True)


STOPPED, PLAYING, PAUSED, QUITTING = range(4)
OK, FAILED, UNSUPPORTED, ALREADY = 1, 4, 0, 101
RESULT = message({'RESULT_FEATURE_UNSUPPORTED': 0, 'RESULT_OK': 1, 'RESULT_OPERATION_FAILED': 4}, result=int,
                 error_message=str)
STATE = message({'STATE_STOPPED': 0, 'STATE_PLAYING': 1, 'STATE_PAUSED': 2, 'STATE_QUITTING': 3}, state=int)
FEATURES = message({'SIMULATION_RESET': 20, 'SIMULATION_STATE_GETTING': 24, 'SIMULATION_STATE_SETTING': 25,
                    'SIMULATION_STATE_PAUSE': 26, 'STEP_SIMULATION_SINGLE': 31, 'STEP_SIMULATION_MULTIPLE': 32},
                   features=list, custom_info=str)
SERVICES = {
    'GetSimulatorFeatures': (message(), message(features=FEATURES)),
    'ResetSimulation': (message({'SCOPE_DEFAULT': 0, 'SCOPE_TIME': 1, 'SCOPE_ALL': 255}, scope=int),
                        message(result=RESULT)),
    'StepSimulation': (message(steps=lambda: 1), message(result=RESULT)),
    'GetSimulationState': (message(), message(state=STATE, result=RESULT)),
    'SetSimulationState': (message(state=STATE), message({'ALREADY_IN_TARGET_STATE': 101}, result=RESULT)),
}
PACKAGE = SimpleNamespace(
    msg=SimpleNamespace(Result=RESULT, SimulationState=STATE, SimulatorFeatures=FEATURES),
    srv=SimpleNamespace(**{name: SimpleNamespace(Request=request, Response=response)
                           for name, (request, response) in SERVICES.items()}))


class TestStandardServices:
    @pytest.fixture(autouse=True)
    def _package(self, monkeypatch: pytest.MonkeyPatch) -> None:
        monkeypatch.setitem(sys.modules, 'simulation_interfaces', PACKAGE)

    @staticmethod
    def result(axis: AxisHere, kind: str, **request: Any) -> tuple[int, str]:
        """Return code and text of an answer of the service `KindSimulation` or `KindSimulationState`."""
        name = next(name for name in SERVICES if name.startswith(kind))
        service = re.sub('(?<=.)([A-Z])', r'_\1', name).lower()
        found = axis.call(getattr(PACKAGE.srv, name), service, **request).result
        return found.result, found.error_message

    def state(self, axis: AxisHere) -> int:
        answer = axis.call(PACKAGE.srv.GetSimulationState, 'get_simulation_state')
        assert answer.result.result == OK
        return int(answer.state.state)

    def set_state(self, axis: AxisHere, state: int) -> tuple[int, str]:
        return self.result(axis, 'Set', state=STATE(state))

    def test_while_time_runs_by_itself(self, capfd: pytest.CaptureFixture[str]) -> None:
        with axis_here('time.rate:=200.0') as axis:
            wait_for(lambda: axis.node.loop.step > 0, 'steps')
            assert self.state(axis) == PLAYING
            features = axis.call(PACKAGE.srv.GetSimulatorFeatures, 'get_simulator_features').features
            assert features.features == [20, 24, 25, 31, 32, 26]
            assert self.set_state(axis, PLAYING)[0] == ALREADY
            for state in (PAUSED, STOPPED):
                assert self.set_state(axis, state) == (OK, '')
                assert self.state(axis) == state
                assert self.set_state(axis, QUITTING)[0] == UNSUPPORTED
            assert self.result(axis, 'Step', steps=5) == (OK, '')
            assert axis.node.loop.step == 5
            code, text = self.result(axis, 'Reset', scope=1)
            assert (code, text[:20]) == (UNSUPPORTED, 'scope = 1 is refused')
            assert [self.set_state(axis, PLAYING), self.result(axis, 'Reset')] == [(OK, '')] * 2
        assert 'simulation_interfaces' not in capfd.readouterr().err

    def test_in_lock_step_and_while_recording(self, tmp_path: Path) -> None:
        with axis_here('time.mode:=lockstep', *recording_into(tmp_path / 'run')) as axis:
            assert self.state(axis) == PAUSED
            assert self.result(axis, 'Step') == (OK, '')
            for answer, reported in ((self.set_state(axis, PLAYING), 'time moves with ~/step only'),
                                     (self.result(axis, 'Step', steps=2**64 - 1), 'must be 1 to 100000'),
                                     (self.result(axis, 'Step', steps=0), 'must be 1 to 100000'),
                                     (self.set_state(axis, STOPPED), 'refused while recording')):
                assert answer[0] == FAILED
                assert reported in answer[1]
            assert axis.node.loop.step == 1

    def test_without_the_package_it_says_how_to_get_it(self, monkeypatch: pytest.MonkeyPatch,
                                                       capfd: pytest.CaptureFixture[str]) -> None:
        monkeypatch.setitem(sys.modules, 'simulation_interfaces', None)
        with axis_here():
            pass
        assert capfd.readouterr().err.count('ros-$ROS_DISTRO-simulation-interfaces') == 1
