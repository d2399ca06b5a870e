# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Who else is on the topics of a node, and whose clock it follows."""

import time
from itertools import count
from types import SimpleNamespace
from typing import Any, cast

import pytest
from builtin_interfaces.msg import Time
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import JointState

from stickslip_sim.bags import topics
from stickslip_sim.core.errors import InputError
from stickslip_sim.core.time_grid import NANOSECONDS
from stickslip_sim.ros.node.clock import ClockIn
from stickslip_sim.ros.node.graph_monitor import PublisherWatch
from tests.support.node_processes import running
from tests.support.ros2_control_client import THRESHOLD, Rule, always, hardware_interface, near_is_silent
from tests.support.ros_nodes import Client, client, nanoseconds
from tests.support.waiting import wait_for

pytestmark = [pytest.mark.ros, pytest.mark.slow]

SLOW = ('-p', 'time.rate:=200.0')    # who is there does not depend on it
MILLISECOND = NANOSECONDS // 1000
ON = (*SLOW, '-p', 'joint_interface.enabled:=true')


def trouble(axis: Client, text: str) -> Any:
    """Return the next status `neighbours` that has a text."""
    def find(message: Any) -> Any:
        return next(status for status in message.status if status.name.endswith(': neighbours'))
    return find(axis.next('/diagnostics', lambda message: text in find(message).message))


def no_trouble(axis: Client) -> None:
    assert trouble(axis, 'nobody in the way').level == b'\0'


class TestGraphMonitor:
    def test_controllers_come_and_go(self) -> None:
        with running(*ON) as process, client() as axis:
            axis.connect()
            axis.stop_commanding()
            with hardware_interface(always(0.003), name='first'):
                with hardware_interface(always(0.004), name='second'):
                    status = trouble(axis, '2 controllers at once')
                    assert status.level == b'\1'
                    assert '/drive_velocity, /joint_commands: /first, /second' in status.message
                no_trouble(axis)
                axis.next('slider_state', lambda state: state.drive_velocity == 0.003)
            assert 'velocity is gone, and its 0.003 stays in force' in trouble(axis, 'gone').message
            assert axis.latest('slider_state').drive_velocity == 0.003
            with hardware_interface(always(0.005), name='first'):
                axis.next('slider_state', lambda state: state.drive_velocity == 0.005)
                no_trouble(axis)
            trouble(axis, 'its 0.005 stays')
            assert axis.trigger('reset').success
            no_trouble(axis)
            _, errors = process.end()
        lines = [line.split(']: ')[1] for line in errors.splitlines() if 'velocity' in line and 'real-time' not in line]
        alone, gone = '/first alone commands the velocity', 'the controller of the velocity is gone, and its {} stays'
        assert [line.split(':')[0].split(' in force')[0] for line in lines[-5:]] == [
            '2 controllers at once on /drive_velocity, /joint_commands', alone, gone.format(0.003), alone,
            gone.format(0.005)]

    def test_what_a_time_out_has_ended_does_not_stay_in_force(self) -> None:
        """Nor does a force trouble anybody: no time-out ends it, and it is meant to act until the next."""
        with running(*SLOW, '-p', 'command.timeout:=0.05', '-p', 'command.on_timeout:=ramp_to_zero') as process, \
                client() as axis:
            axis.connect()
            axis.send_velocity(0.004)
            axis.send_force(300.0)
            axis.status('command', lambda values: values['timed out'] == '1' and values['force received'] == '1')
            axis.stop_commanding()
            looks = len(axis.heard['/diagnostics'])
            wait_for(lambda: not axis.node.count_publishers('drive_velocity'), 'nobody who commands')
            wait_for(lambda: len(axis.heard['/diagnostics']) > looks + 3, 'looks around')
            no_trouble(axis)
            _, errors = process.end()
        assert 'stays in force' not in errors
        assert 'velocity is gone, and the command time-out has struck' in errors
        assert 'nobody commands the force any more: the latest acts until the next' in errors

    def test_a_controller_bears_its_name_from_the_first_look_on(self) -> None:
        """ROS knows a publisher some 40 ms before it knows whose it is."""
        with client() as watcher:
            publishers = PublisherWatch(watcher.node, [topics.JOINT_COMMANDS], patience=60)

            def changed() -> bool:
                time.sleep(0.05)
                return publishers.have_changed()

            for _ in range(4):
                with hardware_interface(always(0.0), name='other'):
                    wait_for(changed, 'a controller')
                    assert publishers.nodes == ['/other']
                wait_for(changed, 'its end')
                assert publishers.nodes == []

    def test_a_stranger_on_a_topic_of_the_node(self) -> None:
        with running(*ON) as process, client() as axis:
            axis.connect()
            out = axis.node.create_publisher(JointState, 'joint_states', 10)
            assert '/client publishes on /joint_states too' in trouble(axis, 'joint_states').message
            axis.drop(out)
            no_trouble(axis)
            _, errors = process.end()
        assert errors.count('publishes on /joint_states too') == 1
        assert '/joint_states has one publisher again' in errors

    @pytest.mark.parametrize('rule', [Rule.ALL_POSITIONS, Rule.COMMANDED_POSITIONS])
    def test_one_that_never_sends_is_reported(self, rule: Rule) -> None:
        """They compare positions, and none is commanded: at position 0, or for ever, there is no difference."""
        with running(*ON, '-p', 'drive.velocity:=0.0') as process, client() as axis:
            axis.connect()
            with hardware_interface(always(0.003), near_is_silent(), rule) as hardware:
                status = trouble(axis, 'sends nothing')
                assert hardware.sent == 0
            assert THRESHOLD in status.message
            process.end()


class TestClock:
    @pytest.mark.parametrize('mode', ['lockstep', 'free_run'])
    def test_its_own_is_not_followed(self, mode: str) -> None:
        with running('-p', f'time.mode:={mode}', '-p', 'use_sim_time:=true') as process:
            code, errors = process.wait()
        assert code == 2
        assert errors.startswith('sim_node: use_sim_time = True is refused: must be false on this node')
        assert mode in errors
        assert len(errors.splitlines()) == 1

    def test_nor_later(self) -> None:
        with running('-p', 'time.mode:=lockstep') as process, client() as axis:
            axis.connect(is_moving=False)
            answer = axis.set_parameters(use_sim_time=True)
            assert (answer.successful, answer.reason.split(':')[0]) == (False, 'use_sim_time = True is refused')
            assert axis.set_parameters(use_sim_time=False).successful
            process.end()

    def test_that_of_another_is_warned_of_and_refused_where_nobody_has_one(self) -> None:
        with running() as process, client() as axis:
            axis.connect()
            answer = axis.set_parameters(use_sim_time=True)
            assert (answer.successful, 'no node publishes /clock' in answer.reason) == (False, True)
            out = axis.node.create_publisher(Clock, '/clock', 1)
            wait_for(lambda: axis.set_parameters(use_sim_time=True).successful, 'a /clock to follow')
            assert axis.set_parameters(use_sim_time=True).successful

            def is_of_clock(message: Any) -> bool:
                out.publish(Clock(clock=Time(sec=1000)))
                return bool(1000 <= message.header.stamp.sec < 1100)

            axis.next('timing', is_of_clock)
            assert not is_of_clock(axis.next('slider_state'))
            assert axis.trigger('reset').success
            axis.next('slider_state', is_of_clock)
            _, errors = process.end()
        assert errors.count('use_sim_time: true: the stamps of the motion follow from the next ~/reset on') == 1

    def test_stamps_start_from_the_first_of_another(self) -> None:
        with running('-p', 'use_sim_time:=true') as process, client() as axis:
            out = axis.node.create_publisher(Clock, '/clock', 1)
            wait_for(out.get_subscription_count, 'the node that waits')
            assert not axis.heard['slider_state']
            wait_for(lambda: out.publish(Clock(clock=Time(sec=1000))) or axis.heard['slider_state'], 'its first step')
            states = axis.heard['slider_state']
            starts = {nanoseconds(state.header.stamp) - state.step * MILLISECOND for state in states}
            # step 0 is 20 ms ahead, and ROS time went on while the node prepared it
            assert 1_000_020 * MILLISECOND < min(starts) < 1_001_000 * MILLISECOND
            _, errors = process.end()
        assert errors.count('waiting for the first /clock') == 1

    def test_it_does_not_wait_for_ever(self) -> None:
        """For ten seconds of its own clock; here each look takes four."""
        looks = count(0, 4 * NANOSECONDS)
        node = SimpleNamespace(get_clock=lambda: SimpleNamespace(now=lambda: SimpleNamespace(nanoseconds=0)),
                               get_logger=lambda: SimpleNamespace(info=lambda _: None))
        clock = ClockIn(cast(Any, node), lambda: next(looks))
        assert not clock.has_come()
        assert not clock.has_come()
        with pytest.raises(InputError, match=r'use_sim_time = True is refused: must be with a /clock within 10 s'):
            clock.has_come()

    def test_of_another_type(self) -> None:
        with running('-p', 'use_sim_time:=3') as process:
            code, errors = process.wait()
        assert code == 2
        assert "'use_sim_time' to '3'" in errors
        assert len(errors.splitlines()) == 1
