# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The standard services of simulators: those of the package simulation_interfaces, where it is installed."""

import json
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from tests.support import standard_package
from tests.support.node_processes import recording_into, running
from tests.support.ros_nodes import client
from tests.support.waiting import wait_for

pytestmark = pytest.mark.ros

OK, FAILED, UNSUPPORTED = 1, 4, 0
STOPPED, PLAYING, PAUSED, QUITTING = range(4)
ALREADY = 101
Ask = Callable[..., list[Any]]


@pytest.fixture
def ask(pytestconfig: pytest.Config, monkeypatch: pytest.MonkeyPatch) -> Ask:
    """Let nodes find the package, built once and kept; return what calls services, each as 'NAME FIELDS'."""
    folder = pytestconfig.cache.mkdir('simulation_interfaces')
    for name, value in standard_package.environment(Path(folder)).items():
        monkeypatch.setenv(name, value)

    def call(*services: str) -> list[Any]:
        done = subprocess.run([sys.executable, '-m', 'tests.support.standard_client', *services], capture_output=True,
                              text=True, check=False)
        assert done.returncode == 0, done.stderr
        answers: list[Any] = json.loads(done.stdout)
        return answers

    return call


def set_state(state: int) -> str:
    return f'set_simulation_state {{"state": {{"state": {state}}}}}'


@pytest.mark.slow    # the first time; then the package is there
def test_while_time_runs_by_itself(ask: Ask) -> None:
    with running(afresh=True) as process, client() as axis:
        axis.connect()
        features, *states, steps, scope = ask(
            'get_simulator_features', 'get_simulation_state', set_state(PLAYING), set_state(PAUSED),
            'get_simulation_state', set_state(QUITTING), set_state(STOPPED), 'get_simulation_state',
            'step_simulation {"steps": 5}', 'reset_simulation {"scope": 1}')
        wait_for(lambda: axis.latest('slider_state').step == 5, 'the steps')
        assert ask('get_simulation_state', set_state(PLAYING), 'reset_simulation')[1:] == [
            {'result': {'result': OK, 'error_message': ''}}] * 2
        _, errors = process.end()
    assert features['features']['features'] == [20, 24, 25, 31, 32, 26]
    assert [answer['result']['result'] for answer in states] == [OK, ALREADY, OK, OK, UNSUPPORTED, OK, OK]
    assert [answer['state']['state'] for answer in states if 'state' in answer] == [PLAYING, PAUSED, STOPPED]
    assert steps['result']['result'] == OK
    assert scope['result']['result'] == UNSUPPORTED
    assert scope['result']['error_message'].startswith('scope = 1 is refused')
    assert 'simulation_interfaces' not in errors


def test_in_lock_step(ask: Ask) -> None:
    with running('-p', 'time.mode:=lockstep', afresh=True) as process, client() as axis:
        axis.connect(is_moving=False)
        state, playing, steps, too_many, none = ask(
            'get_simulation_state', set_state(PLAYING), 'step_simulation',
            'step_simulation {"steps": 18446744073709551615}', 'step_simulation {"steps": 0}')
        wait_for(lambda: axis.latest('slider_state').step == 1, 'the step')
        process.end()
    assert state['state']['state'] == PAUSED
    assert playing['result']['result'] == FAILED
    assert 'time moves with ~/step only' in playing['result']['error_message']
    assert steps['result'] == {'result': OK, 'error_message': ''}
    assert [answer['result']['result'] for answer in (too_many, none)] == [FAILED, FAILED]
    assert 'must be 1 to 100000' in too_many['result']['error_message']


def test_nothing_is_stopped_while_recording(ask: Ask, tmp_path: Path) -> None:
    with running(*recording_into(tmp_path / 'run'), afresh=True) as process, client() as axis:
        axis.connect()
        stop, state = ask(set_state(STOPPED), 'get_simulation_state')
        process.end()
    assert stop['result']['result'] == FAILED
    assert 'refused while recording' in stop['result']['error_message']
    assert state['state']['state'] == PLAYING


def test_without_the_package_it_says_how_to_get_it() -> None:
    with running() as process, client() as axis:
        axis.connect()
        _, errors = process.end()
    assert errors.count('ros-$ROS_DISTRO-simulation-interfaces') == 1
