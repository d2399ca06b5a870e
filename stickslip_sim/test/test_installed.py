# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""A few tests of the installed package, for `colcon test`: what is installed, the tool, and the node over real DDS.

The suite of the repository has the details.
"""

import csv
import os
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import partial
from pathlib import Path
from typing import Any

import pytest
import rclpy
from ament_index_python.packages import PackageNotFoundError, get_package_prefix
from rcl_interfaces.msg import Parameter, ParameterType, ParameterValue
from rcl_interfaces.srv import SetParameters
from rclpy.node import Node
from rclpy.qos import QoSProfile, ReliabilityPolicy

from stickslip_msgs.msg import DriveVelocity, ModeEvent, SliderState

# Only this machine, and a domain of its own unless one is set.
os.environ.setdefault('ROS_DOMAIN_ID', str(1 + os.getpid() % 100))
os.environ.setdefault('ROS_AUTOMATIC_DISCOVERY_RANGE', 'LOCALHOST')


@pytest.fixture(scope='session')
def prefix() -> Path:
    """Return where the package is installed."""
    try:
        return Path(get_package_prefix('stickslip_sim'))
    except PackageNotFoundError:
        pytest.exit('stickslip_sim is not installed, or setup.bash not sourced: colcon build, then colcon test', 1)


@pytest.fixture
def tool(prefix: Path, tmp_path: Path) -> Callable[..., subprocess.CompletedProcess[str]]:
    """Return a function that runs the tool in an empty folder, out of sight of the sources."""

    def run(*arguments: str | Path) -> subprocess.CompletedProcess[str]:
        return subprocess.run([prefix / 'lib/stickslip_sim/stickslip', *arguments], cwd=tmp_path, capture_output=True,
                              text=True, timeout=60, check=False)

    return run


def test_the_programs_are_where_ros2_run_looks(prefix: Path) -> None:
    programs = (prefix / 'lib/stickslip_sim').iterdir()
    assert {path.name for path in programs if os.access(path, os.X_OK)} == {
        'cascade_controller', 'compensating_controller', 'health', 'replay_node', 'sim_node', 'stickslip'}


def test_the_files_of_the_package(prefix: Path) -> None:
    share = prefix / 'share/stickslip_sim'
    assert (share / 'package.xml').is_file()
    assert (share / 'launch/sim.launch.py').is_file()
    assert (share / 'scenes/paper_fig8.yaml').is_file()


@pytest.mark.skipif(os.environ.get('STICKSLIP_COMPILED') == '0', reason='plain Python was asked for')
def test_the_hot_path_is_compiled(tmp_path: Path) -> None:
    program = 'from stickslip_sim.core.hot_path import hot_path; print(hot_path())'
    done = subprocess.run([sys.executable, '-c', program], cwd=tmp_path, capture_output=True, text=True, timeout=60,
                          check=True)
    assert (done.stdout, done.stderr) == ('compiled\n', '')


Tool = Callable[..., subprocess.CompletedProcess[str]]


def test_an_axis_at_rest_breaks_away_at_the_limit_of_static_friction(tool: Tool, tmp_path: Path) -> None:
    done = tool('simulate', 'paper_fig8', '--duration', '5', '--events', 'events.csv')
    assert done.returncode == 0, done.stderr
    with (tmp_path / 'events.csv').open() as file:
        events = list(csv.DictReader(file))
    assert float(events[0]['static_coefficient']) == 0.24
    assert [event['kind'] for event in events[:2]] == ['breakaway', 'coast']
    assert events[-1]['kind'] in {'stick', 'breakaway'}


def test_a_recorded_run_is_verified(tool: Tool) -> None:
    assert tool('simulate', 'paper_fig8', '--duration', '1', '--bag', 'run').returncode == 0
    assert tool('verify', 'run').stdout.startswith('identical, 1001 steps')


def test_a_scene_that_is_not_there_is_refused_in_one_line(tool: Tool) -> None:
    done = tool('simulate', 'paper_fig9', '--duration', '1')
    assert done.returncode == 2
    assert done.stderr.count('\n') == 1
    assert 'paper_fig8' in done.stderr


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
