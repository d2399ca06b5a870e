# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The node over real DDS: states, commands, parameters, health, and a recording that Ctrl-C closes."""

import os
import signal
import subprocess
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import partial
from pathlib import Path
from typing import Any

import pytest
import rclpy
from rcl_interfaces.msg import Parameter, ParameterType, ParameterValue
from rcl_interfaces.srv import SetParameters
from rclpy.node import Node
from rclpy.qos import QoSProfile, ReliabilityPolicy

from stickslip_msgs.msg import DriveVelocity, ModeEvent, SliderState

DEADLINE = 30.0    # s, of which a quiet machine needs one or two
NAMESPACE = f'/smoke_{os.getpid()}'    # also in a domain with other axes


@contextmanager
def running(prefix: Path, *parameters: str) -> Iterator[subprocess.Popen[bytes]]:
    """Run the node in real time; Ctrl-C ends it."""
    command = [str(prefix / 'lib/stickslip_sim/sim_node'), '--ros-args', '-r', f'__ns:={NAMESPACE}', *parameters]
    hear_interrupts = partial(signal.signal, signal.SIGINT, signal.SIG_DFL)    # as in a terminal
    with subprocess.Popen(command, preexec_fn=hear_interrupts) as process:
        try:
            yield process
            process.send_signal(signal.SIGINT)
            process.wait(DEADLINE)
        finally:
            process.kill()


@pytest.fixture
def axis(prefix: Path) -> Iterator[None]:
    """Run the node while a test looks at it."""
    with running(prefix):
        yield


@pytest.fixture
def client() -> Iterator[Node]:
    rclpy.init()
    node = rclpy.create_node('client', namespace=NAMESPACE)
    yield node
    node.destroy_node()
    rclpy.shutdown()


def heard(client: Node, kind: Any, topic: str, is_it: Callable[[Any], bool] = lambda _: True,
          meanwhile: Callable[[], object] = lambda: None) -> Any:
    """Return the first message of a topic that fulfils a condition; `meanwhile` is called ten times a second."""
    found: list[Any] = []
    client.create_subscription(kind, topic, lambda message: found.append(message) if is_it(message) else None, 10)
    client.create_timer(0.1, meanwhile)
    end = time.monotonic() + DEADLINE
    while not found:
        assert time.monotonic() < end, f'no such message on {topic} in {DEADLINE} s'
        rclpy.spin_once(client, timeout_sec=0.1)
    return found[0]


def command(client: Node, velocity: float) -> Callable[[], None]:
    """Return a function that commands the drive."""
    quality = QoSProfile(depth=1, reliability=ReliabilityPolicy.BEST_EFFORT)
    publisher = client.create_publisher(DriveVelocity, 'drive_velocity', quality)
    return lambda: publisher.publish(DriveVelocity(velocity=velocity))


@pytest.mark.usefixtures('axis')
def test_the_steps_go_on(client: Node) -> None:
    state = heard(client, SliderState, 'slider_state')
    assert heard(client, SliderState, 'slider_state', lambda later: later.step > state.step).time > state.time


@pytest.mark.usefixtures('axis')
def test_a_command_moves_the_drive_until_the_slider_breaks_away(client: Node) -> None:
    send = command(client, 0.005)
    heard(client, SliderState, 'slider_state', lambda state: state.drive_velocity == 0.005, send)
    assert heard(client, ModeEvent, 'mode_event', lambda event: event.kind == ModeEvent.KIND_BREAKAWAY).direction == 1


@pytest.mark.usefixtures('axis')
def test_parameters_are_taken_or_refused(client: Node) -> None:
    service = client.create_client(SetParameters, 'feed_axis/set_parameters')
    assert service.wait_for_service(DEADLINE)

    def is_taken(force: float) -> bool:
        value = ParameterValue(type=ParameterType.PARAMETER_DOUBLE, double_value=force)
        parameter = Parameter(name='axis.normal_force', value=value)
        for _ in range(round(DEADLINE)):    # an answer to a client that a server does not know yet is lost
            answer = service.call_async(SetParameters.Request(parameters=[parameter]))
            rclpy.spin_until_future_complete(client, answer, timeout_sec=1.0)
            if answer.done():
                break
        taken: bool = answer.result().results[0].successful
        return taken

    assert is_taken(2500.0)
    assert not is_taken(-1.0)


@pytest.mark.usefixtures('axis')
def test_the_axis_is_well(prefix: Path) -> None:
    done = subprocess.run([prefix / 'lib/stickslip_sim/health', '--ros-args', '-r', f'__ns:={NAMESPACE}'],
                          capture_output=True, text=True, timeout=DEADLINE, check=False)
    assert done.returncode == 0, done.stdout + done.stderr


def test_a_recording_is_closed_by_ctrl_c_and_can_be_run_again(client: Node, prefix: Path, tool: Callable[..., Any],
                                                              tmp_path: Path) -> None:
    run = tmp_path / 'run'
    with running(prefix, '-p', 'record.enabled:=true', '-p', f'record.folder:={run}') as process:
        heard(client, SliderState, 'slider_state', lambda state: state.drive_velocity == 0.005, command(client, 0.005))
    assert process.returncode == 0
    verified = tool('verify', run)
    assert verified.stdout.startswith('identical'), verified.stderr
