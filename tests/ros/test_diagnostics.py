# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Who else is on the topics of a node, whose clock it follows, and how it is."""

import signal
import subprocess
import time
from itertools import count
from pathlib import Path
from types import SimpleNamespace
from typing import Any, cast

import pytest
from builtin_interfaces.msg import Time
from diagnostic_msgs.msg import DiagnosticStatus
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import JointState

from stickslip_sim.bags import topics
from stickslip_sim.core.errors import InputError, StickslipError
from stickslip_sim.core.time_grid import NANOSECONDS
from stickslip_sim.ros.health_node import health_of
from stickslip_sim.ros.node.clock import ClockIn
from stickslip_sim.ros.node.graph_monitor import PublisherWatch
from tests.support.axis_here import axis_here
from tests.support.node_processes import (
    ended_at_once,
    executable,
    recording_into,
    ros_args,
    running,
    with_small_files,
)
from tests.support.ros2_control_client import THRESHOLD, Rule, always, hardware_interface, near_is_silent
from tests.support.ros_nodes import Client, client, live_axis, nanoseconds
from tests.support.waiting import wait_for

pytestmark = [pytest.mark.ros, pytest.mark.slow]

SLOW = ('time.rate:=200.0',)    # who is there, and how it is, does not depend on it
MILLISECOND = NANOSECONDS // 1000
ON = (*SLOW, 'joint_interface.enabled:=true')


def trouble(axis: Client, text: str) -> Any:
    """Return the next status `neighbours` that has a text."""
    def find(message: Any) -> Any:
        return next(status for status in message.status if status.name.endswith(': neighbours'))
    return find(axis.next('/diagnostics', lambda message: text in find(message).message))


def no_trouble(axis: Client) -> None:
    assert trouble(axis, 'nobody in the way').level == b'\0'


class TestGraphMonitor:
    def test_controllers_come_and_go(self) -> None:
        with live_axis(*ON) as (process, axis):
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
            out = axis.node.create_publisher(JointState, 'joint_states', 10)    # a stranger on a topic of the node
            assert '/client publishes on /joint_states too' in trouble(axis, 'joint_states').message
            axis.drop(out)
            no_trouble(axis)
        said = [line.split(']: ')[1] for line in process.errors.splitlines() if ']: ' in line]
        of_velocity = [line for line in said if 'velocity' in line and 'real-time' not in line]
        alone, gone = '/first alone commands the velocity', 'the controller of the velocity is gone, and its {} stays'
        assert [line.split(':')[0].split(' in force')[0] for line in of_velocity[-5:]] == [
            '2 controllers at once on /drive_velocity, /joint_commands', alone, gone.format(0.003), alone,
            gone.format(0.005)]
        assert process.errors.count('publishes on /joint_states too') == 1
        assert '/joint_states has one publisher again' in process.errors

    def test_what_a_time_out_has_ended_does_not_stay_in_force(self) -> None:
        """Nor does a force trouble anybody: no time-out ends it, and it is meant to act until the next."""
        wanted = ('command.timeout:=0.05', 'command.on_timeout:=ramp_to_zero')
        with live_axis(*SLOW, *wanted) as (process, axis):
            axis.send_velocity(0.004)
            axis.send_force(300.0)
            axis.status('command', lambda values: values['timed out'] == '1' and values['force received'] == '1')
            axis.stop_commanding()
            looks = len(axis.heard['/diagnostics'])
            wait_for(lambda: not axis.node.count_publishers('drive_velocity'), 'nobody who commands')
            wait_for(lambda: len(axis.heard['/diagnostics']) > looks + 3, 'looks around')
            no_trouble(axis)
        assert 'stays in force' not in process.errors
        assert 'velocity is gone, and the command time-out has struck' in process.errors
        assert 'nobody commands the force any more: the latest acts until the next' in process.errors

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

    def test_one_that_never_sends_is_reported(self) -> None:
        """They compare positions, and none is commanded: at position 0, or for ever, there is no difference."""
        with live_axis(*ON, 'drive.velocity:=0.0') as (_, axis):
            for rule in (Rule.ALL_POSITIONS, Rule.COMMANDED_POSITIONS):
                with hardware_interface(always(0.003), near_is_silent(), rule) as hardware:
                    status = trouble(axis, 'sends nothing')
                    assert hardware.sent == 0
                assert THRESHOLD in status.message
                no_trouble(axis)


class TestClock:
    def test_its_own_is_not_followed_later(self) -> None:
        with axis_here('time.mode:=lockstep') as axis:
            answer = axis.set_parameters(use_sim_time=True)
            assert (answer.successful, answer.reason.split(':')[0]) == (False, 'use_sim_time = True is refused')
            assert axis.set_parameters(use_sim_time=False).successful

    def test_that_of_another_is_warned_of_and_refused_where_nobody_has_one(self) -> None:
        with live_axis() as (process, axis):
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
        assert process.errors.count('use_sim_time: true: the stamps of the motion follow from the next ~/reset on') == 1

    def test_stamps_start_from_the_first_of_another(self) -> None:
        with running('use_sim_time:=true') as process, client() as axis:
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


class TestHealth:
    def test_one_that_runs_is_well_one_of_another_namespace_is_not_meant_and_one_that_hangs_says_nothing(self) -> None:
        there = ('-r', '__ns:=/press')
        with live_axis(*SLOW, namespace='/press') as (process, _):
            done = subprocess.run([executable('health'), *ros_args(*there, 'patience:=20.0')], capture_output=True,
                                  text=True, timeout=60, check=False)
            elsewhere = ended_at_once('health', 'patience:=3.0')
            process.send(signal.SIGSTOP)
            hanging = ended_at_once('health', *there, 'patience:=1.5')
            process.send(signal.SIGCONT)
        assert (done.returncode, done.stderr) == (0, '')
        assert done.stdout.startswith('/press/feed_axis is well')
        assert (elsewhere[0], 'in this namespace' in elsewhere[1]) == (1, True)
        assert hanging[0] == 1
        assert hanging[1].startswith('health: /press/feed_axis published nothing on /diagnostics within 1.5 s')

    def test_one_whose_recording_failed_is_not_well(self, tmp_path: Path) -> None:
        with running(*recording_into(tmp_path / 'run'), prepare=with_small_files):
            with client() as axis:
                axis.status('recorder', lambda values: int(values['dropped']) > 0)
            code, errors = ended_at_once('health', 'patience:=20.0')
        assert code == 1
        assert errors.startswith('health: /feed_axis is not well: recorder: ')
        assert len(errors.splitlines()) == 1

    def test_a_verdict_is_by_the_worst(self) -> None:
        fine, slow, full = (DiagnosticStatus(name=name, level=level, message=f'{name} reported')
                            for name, level in (('loop', b'\0'), ('command', b'\1'), ('recorder', b'\2')))
        assert health_of('/a', [fine]) == '/a is well: loop: loop reported'
        assert health_of('/a', [fine, slow]) == '/a is well, with warnings: command: command reported'
        with pytest.raises(StickslipError, match=r'not well: recorder: recorder reported$'):
            health_of('/a', [slow, full, fine])
