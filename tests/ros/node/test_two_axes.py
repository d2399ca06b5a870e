# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Two axes on one machine, as axes.launch.py starts them: what is said to one does not reach the other."""

from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from pathlib import Path
from typing import Any, NamedTuple

import pytest
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import JointState

from stickslip_sim.recording import open_bag
from tests.support.launch_files import launched
from tests.support.node_processes import NodeProcess, running
from tests.support.ros_nodes import Client, client
from tests.support.waiting import wait_for

pytestmark = pytest.mark.ros

AT_REST = 'drive.course:=constant drive.velocity:=0.0'


class Axis(NamedTuple):
    process: NodeProcess
    client: Client


@contextmanager
def two_axes(folder: Path, **arguments: str) -> Iterator[tuple[Axis, Axis]]:
    """Start both at once, in one folder, and wait for them."""
    with ExitStack() as stack:
        processes = [stack.enter_context(running(*started.words, folder=folder))
                     for started in launched('axes', parameters=AT_REST, **arguments).processes]
        x, y = (Axis(process, stack.enter_context(client(namespace)))
                for process, namespace in zip(processes, ('/x', '/y'), strict=True))
        for axis in (x, y):
            axis.client.connect()
        yield x, y


def test_joints_of_both_on_one_topic(tmp_path: Path) -> None:
    """With a prefix each, as one robot description and one robot_state_publisher need it, and no neighbour reported."""
    with two_axes(tmp_path, rate='200', joints='/joint_states') as axes:
        names: set[tuple[str, ...]] = set()
        axes[0].client.node.create_subscription(JointState, '/joint_states', lambda heard: names.add(tuple(heard.name)),
                                                10)
        both = {(f'{prefix}axis_slider', f'{prefix}axis_drive') for prefix in ('x_', 'y_')}
        wait_for(lambda: names == both, 'the joints of both')
        for axis in axes:
            assert status_of(axis, 'neighbours').message == 'nobody in the way'


def let_pass(axis: Axis, steps: int) -> None:
    step = axis.client.latest('slider_state').step
    axis.client.next('slider_state', lambda state: state.step > step + steps)


def status_of(axis: Axis, name: str) -> Any:
    """Return the next status of one of the axes; all say theirs on /diagnostics."""
    own = f'{axis.client.node.get_namespace()}/feed_axis'

    def found(message: Any) -> list[Any]:
        return [status for status in message.status if status.name == f'{own}: {name}']

    status, = found(axis.client.next('/diagnostics', lambda message: bool(found(message))))
    return status


def test_a_command_moves_one(tmp_path: Path) -> None:
    with two_axes(tmp_path, rate='200') as (x, y):
        x.client.send_velocity(0.004)
        x.client.next('slider_state', lambda state: state.position > 1e-4)
        let_pass(y, 100)
        assert {state.drive_velocity for state in y.client.heard['slider_state']} == {0.0}
        assert {state.position for state in y.client.heard['slider_state']} == {0.0}
        y.client.send_force(100.0)
        y.client.next('slider_state', lambda state: state.position > 0.0)
        assert x.client.latest('slider_state').drive_velocity == 0.004


def test_a_service_and_a_parameter_reach_one(tmp_path: Path) -> None:
    with two_axes(tmp_path, rate='200') as (x, y):
        answer = x.client.switch('set_paused', True)
        assert answer.success
        let_pass(y, 100)
        stands = x.client.latest('slider_state')
        assert answer.message == f'paused at simulation time {stands.step / 200:g} s'
        assert x.client.set_parameters(axis__normal_force=2000.0).successful
        assert [axis.client.values('axis.normal_force')[0].double_value for axis in (x, y)] == [2000.0, 3432.3275]


def test_each_records_what_is_its_own(tmp_path: Path) -> None:
    """They begin in the same second, in the same folder."""
    with two_axes(tmp_path, rate='200', record='true') as (x, y):
        x.client.send_velocity(0.004)
        x.client.next('slider_state', lambda state: state.drive_velocity == 0.004)
        let_pass(y, 20)
        for axis in (x, y):
            code, errors = axis.process.end()
            assert code == 0, errors
    folders = sorted((tmp_path / 'runs').iterdir())
    assert [folder.name[:14] for folder in folders] == ['x_positioning_', 'y_positioning_']
    commands = []
    for name, folder in zip('xy', folders):
        run = open_bag(folder)
        assert {topic.split('/')[1] for topic in run.topics} == {name, 'parameter_events'}
        commands.append(run.counts[f'/{name}/drive_velocity'])
    assert commands == [1, 0]


def test_each_has_its_clock(tmp_path: Path) -> None:
    with two_axes(tmp_path, rate='200', mode='free_run') as (x, y):
        times: list[int] = []
        x.client.node.create_subscription(Clock, '/y/clock', lambda clock: times.append(clock.clock.sec), 10)
        assert x.client.switch('set_paused', True).success
        wait_for(lambda: times and times[-1] > times[0], 'the clock of y while x is paused')
        assert [x.client.node.count_publishers(topic) for topic in ('/clock', '/x/clock', '/y/clock')] == [0, 1, 1]
        for axis in (x, y):
            assert status_of(axis, 'neighbours').message == 'nobody in the way'
