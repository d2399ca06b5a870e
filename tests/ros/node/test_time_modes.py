# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The modes of time: the same profile in real time, in lock-step, free and offline, with stalls thrown in; /clock."""

import itertools
import math
import select
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from rclpy.node import Node
from rclpy.parameter import Parameter
from rclpy.qos import QoSProfile
from rosgraph_msgs.msg import Clock

from stickslip_msgs.msg import SliderState
from stickslip_sim.core.errors import InputError
from stickslip_sim.inputs import load_scene
from stickslip_sim.recording import Bag, open_bag, read_run
from stickslip_sim.runs import simulate_events
from stickslip_sim.scene import Scene
from tests.support.axis_here import axis_here
from tests.support.busy_machine import judged_by_time
from tests.support.node_processes import NodeProcess, recording_into
from tests.support.rigs import FIELDS, assert_same_states, made_again
from tests.support.ros_nodes import Client, live_axis, nanoseconds
from tests.support.tool import restore_interrupt
from tests.support.waiting import DEADLINE, wait_for

pytestmark = [pytest.mark.ros, pytest.mark.slow]

STALL = 0.2          # s
STANDSTILL = 1.5     # s
MS = 1_000_000
RICH: dict[str, Any] = {
    'seed': 77, 'command.acceleration_limit': 0.2, 'joint_interface.enabled': True, 'encoder.resolution': 1e-6,
    'faults.ids': ['dry', 'knock', 'noisy'], 'faults.kinds': ['friction_scale', 'force_pulse', 'command_loss'],
    'faults.starts': [0.2, 0.5, 0.1], 'faults.durations': [0.4, 0.05, math.inf], 'faults.values': [1.4, 500.0, 0.3],
}


@contextmanager
def node_of(scene: Scene, folder: Path, name: str, mode: str) -> Iterator[tuple[NodeProcess, Client]]:
    """Run a node on a scene in a mode of time, recording into folder/name."""
    file = folder / f'{name}.yaml'
    file.write_text(scene.text)
    free = ['time.factor:=.inf'] if mode == 'free_run' else []
    with live_axis('--params-file', str(file), f'time.mode:={mode}', *free, *recording_into(folder / name)) as running:
        yield running


@contextmanager
def stalls(process: NodeProcess) -> Iterator[None]:
    """Stop the process for a while, again and again."""
    is_over = threading.Event()

    def stall() -> None:
        while not is_over.wait(2 * STALL):
            process.send(signal.SIGSTOP)
            time.sleep(STALL)
            process.send(signal.SIGCONT)

    thread = threading.Thread(target=stall)
    thread.start()
    try:
        yield
    finally:
        is_over.set()
        thread.join()


def wait_for_steps(axis: Client, count: int) -> None:
    step = axis.latest('slider_state').step + count
    axis.next('slider_state', lambda state: state.step > step)


def repeat_in_lockstep(axis: Client, recorded: Bag) -> None:
    """Give the commands of a bag with ~/step, before the steps that they came before."""
    commands: dict[int, dict[str, float]] = {}
    for message in recorded.messages(['/drive_velocity', '/external_force']):
        content = recorded.decode(message)
        name = 'velocity' if hasattr(content, 'velocity') else 'force'
        commands.setdefault(message.sequence, {})[name] = getattr(content, name)
    begins = [1, *sorted(set(commands) - {0, 1}), recorded.counts['/slider_state']]
    for begin, end in itertools.pairwise(begins):
        axis.step(end - begin, **commands.get(begin, {}))


class TestTheSameRun:
    def test_in_real_time_in_lockstep_and_offline(self, tmp_path: Path) -> None:
        scene = load_scene('paper_fig8', RICH)
        with node_of(scene, tmp_path, 'live', 'realtime') as (process, axis), stalls(process):
            assert axis.node.count_publishers('/clock') == 0
            for k in range(40):
                axis.send_velocity(0.004 * math.sin(0.3 * k))
                if k % 7 == 0:
                    axis.send_force(30.0 * math.cos(k))
                wait_for_steps(axis, 25)
        live = open_bag(tmp_path / 'live')
        assert live.counts['/drive_velocity'] > 15
        assert live.receipt['commands']['lost'] > 1
        assert live.receipt['timing']['overruns'] > 100
        with node_of(scene, tmp_path, 'stepped', 'lockstep') as (process, axis), stalls(process):
            repeat_in_lockstep(axis, live)
        stepped = open_bag(tmp_path / 'stepped')
        assert_same_columns(live, stepped)
        assert_same_states(live, made_again(live, scene))
        assert stepped.receipt['commands']['lost'] == live.receipt['commands']['lost']
        late = {name: [mark for mark in read_run(tmp_path / name).marks if mark.label.startswith('late ≤ ')]
                for name in ('live', 'stepped')}
        assert late['live']
        assert all(mark.is_of_host for mark in late['live'])
        assert sum(mark.number for mark in late['live']) > 0    # a step may be late by less than a period
        assert not late['stepped']

    def test_the_receipt_is_that_of_the_offline_run_however_long(self, tmp_path: Path) -> None:
        """A second time, after a reset, for 13 minutes and 4 000 events; the events of the first do not count."""
        scene = load_scene('paper_fig8', {'time.rate': 1.0})
        (tmp_path / 'long.yaml').write_text(scene.text)
        words = ('--params-file', tmp_path / 'long.yaml', 'time.mode:=lockstep', 'record.each_reset:=true')
        with axis_here(*words, *recording_into(tmp_path / 'run')) as axis:
            axis.step(50)
            assert axis.trigger('reset').success
            for _ in range(2):
                axis.step(400)
        results, offline = (receipt['results'] for receipt in (
            open_bag(tmp_path / 'run_2').receipt, simulate_events(scene, 800.0).receipt))
        for each in (results, offline):
            del each['root_iterations']    # they depend on where the steps end
        assert sum(results['events'].values()) > 4_000
        assert results == offline

    def test_free_with_commands_that_come_when_they_come(self, tmp_path: Path) -> None:
        scene = load_scene('paper_fig8', RICH)
        with node_of(scene, tmp_path, 'free', 'free_run') as (process, axis), stalls(process):
            for k in range(40):
                axis.send_velocity(0.004 * math.sin(0.3 * k))
                wait_for_steps(axis, 50)
        free = open_bag(tmp_path / 'free')
        assert free.counts['/drive_velocity'] > 3
        assert free.receipt['dropped_messages'] == 0
        assert_same_states(free, made_again(free, scene))


def assert_same_columns(one: Bag, other: Bag) -> None:
    for topic, names in (('/slider_state', (*FIELDS, 'step', 'sequence', 'log_time')),
                         ('/friction_force', ('step', 'force', 'coefficient', 'contact_deflection')),
                         ('/mode_event', ('step', 'time', 'kind', 'position', 'friction_force', 'rest_time'))):
        first, second = one.columns(topic), other.columns(topic)
        for name in names:
            np.testing.assert_array_equal(first[name], second[name], err_msg=f'{topic} {name}')


@pytest.fixture(scope='class')
def node_with_a_clock() -> Iterator[Client]:
    """The client of a lock-step node with 300 ticks a second for 1000 steps; it hears them too."""
    with live_axis('time.mode:=lockstep', 'clock.rate:=300.0') as (_, axis):
        heard = axis.heard['/clock'] = []
        states: list[Any] = []    # heard as the ticks are, so that they come in one order

        def tick(message: Any) -> None:
            heard.append((nanoseconds(message.clock), nanoseconds(states[-1].header.stamp) if states else -1))

        axis.node.create_subscription(SliderState, 'slider_state', states.append, QoSProfile(depth=5000))
        axis.node.create_subscription(Clock, '/clock', tick, QoSProfile(depth=100))
        wait_for(lambda: axis.trigger('reset').success and heard, 'a tick')
        yield axis


@pytest.fixture
def clocked(node_with_a_clock: Client) -> Client:
    """That client at the start of a run, of which it heard."""
    heard = node_with_a_clock.heard['/clock']
    heard.clear()
    assert node_with_a_clock.trigger('reset').success
    wait_for(lambda: heard and heard[-1][0] == 0, 'the start')
    del heard[:-1]    # ticks of the run before that were still on their way
    return node_with_a_clock


class TestClock:
    def test_after_the_state_of_its_step_at_its_own_rate(self, clocked: Client) -> None:
        heard = clocked.heard['/clock']
        for _ in range(22):
            clocked.step(1)
        wait_for(lambda: heard[-1][0] == 20 * MS, 'the last tick')
        assert [time for time, _ in heard] == [math.ceil(k * 10 / 3) * MS for k in range(7)]
        assert all(state >= time for time, state in heard)

    def test_others_follow_it(self, clocked: Client) -> None:
        follower = Node('follower', context=clocked.node.context,
                        parameter_overrides=[Parameter('use_sim_time', value=True)])
        clocked.add(follower)
        try:
            def follows() -> bool:
                clocked.step(10)   # more of them: the axis may not have found the follower yet
                now: int = follower.get_clock().now().nanoseconds
                return now > 0 and now == clocked.heard['/clock'][-1][0]

            wait_for(follows, 'the time of the follower')
        finally:
            clocked.remove(follower)


LISTENER = """
import rclpy
from rclpy.node import Node
from stickslip_msgs.msg import SliderState

rclpy.init()
node, steps = Node('listener'), []
node.create_subscription(SliderState, 'slider_state', lambda state: steps.append(state.step), 10_000)
while not node.count_publishers('slider_state'):
    rclpy.spin_once(node, timeout_sec=0.1)
while not steps:                            # the matching of both takes a moment more
    rclpy.spin_once(node, timeout_sec=0.1)
print(steps[-1], flush=True)
while steps[-1] < steps[0] + 1500:
    rclpy.spin_once(node, timeout_sec=0.1)
print(steps == list(range(steps[0], steps[-1] + 1)))
"""


def test_no_state_of_a_long_request_is_lost_for_a_slow_listener() -> None:
    """The listener stands still while the steps are made."""
    with live_axis('time.mode:=lockstep') as (_, axis):
        listener = subprocess.Popen([sys.executable, '-c', LISTENER], stdout=subprocess.PIPE, text=True,
                                    preexec_fn=restore_interrupt)
        said = listener.stdout
        assert said is not None

        def is_listening() -> bool:
            axis.step(1)
            return bool(select.select([said], [], [], 0.05)[0])

        wait_for(is_listening, 'the listener')
        listener.send_signal(signal.SIGSTOP)
        try:
            axis.step(1500)
        finally:
            listener.send_signal(signal.SIGCONT)
        first, complete = listener.communicate(timeout=DEADLINE)[0].split()
        assert int(first) > 0
        assert complete == 'True'


class TestStamps:
    def test_stay_with_the_time_of_the_graph_after_a_pause_and_a_standstill(self) -> None:
        def is_of_now(state: Any) -> bool:
            return time.time_ns() - nanoseconds(state.header.stamp) < 1e9 * STANDSTILL / 2

        with live_axis('time.rate:=200.0') as (process, axis):
            axis.next('slider_state', is_of_now)
            assert axis.switch('set_paused', True).success
            time.sleep(STANDSTILL)
            assert axis.switch('set_paused', False).success
            axis.next('slider_state', is_of_now)
            process.send(signal.SIGSTOP)
            time.sleep(STANDSTILL)
            process.send(signal.SIGCONT)
            axis.next('slider_state', is_of_now)
            stamps = [nanoseconds(state.header.stamp) for state in axis.heard['slider_state']]
            assert stamps == sorted(stamps)

    def test_are_simulation_time_with_a_factor_and_it_is_said_once(self) -> None:
        with live_axis('time.factor:=4.0', 'time.rate:=200.0') as (process, axis):
            timing = axis.next('timing', lambda timing: timing.step > 1600)
            state = axis.next('slider_state', lambda state: state.step > timing.step)
            apart = nanoseconds(state.header.stamp) - nanoseconds(timing.header.stamp)
            assert abs(apart - (state.step - timing.step) * 5 * MS) < 1500 * MS    # 6 s with the time of the graph
        assert process.errors.count('stamps are simulation time') == 1


class TestFreeRun:
    def test_goes_at_its_factor(self) -> None:
        with live_axis('time.mode:=free_run', 'time.factor:=2.0', 'time.rate:=200.0') as (process, axis):
            with judged_by_time(0.05, process.waits):
                timing = axis.next('timing', lambda timing: timing.real_time_factor == pytest.approx(2.0, rel=0.05))
            assert not timing.valid
            _, values = axis.status('step loop')
            assert values['verdict'].startswith('not in real time (time.mode free_run)')
            assert axis.latest('slider_state').header.stamp.sec < 1000


@pytest.mark.parametrize(('given', 'reported'), [
    ({'time.mode': 'lockstep', 'time.factor': math.inf}, 'only time.mode: free_run'),
    ({'time.mode': 'realtime', 'time.factor': math.inf}, 'only time.mode: free_run'),
    ({'time.mode': 'lockstep', 'clock.rate': 1001.0}, 'at most time.rate'),
    ({'clock.rate': 100.0}, 'clock.rate'), ({'time.mode': 'fast'}, 'time.mode'),
])
def test_times_that_do_not_fit_are_refused(given: dict[str, object], reported: str) -> None:
    with pytest.raises(InputError, match=reported):
        load_scene('paper_fig8', given)
