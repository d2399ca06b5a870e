# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""`stickslip call` beside a node: what it answers, refuses, or that nobody answers; and two axes on one machine."""

import os
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager
from functools import partial
from pathlib import Path
from threading import Event, Thread
from typing import Any, NamedTuple

import pytest
from rcl_interfaces.srv import GetParameters
from rclpy.node import Node
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import JointState

from stickslip_sim.recording import open_bag
from tests.support.launch_files import launched
from tests.support.node_processes import NodeProcess, assert_clean, running
from tests.support.ros_nodes import Client, bare_nodes, client
from tests.support.tool import Capture, answered, refused, tool
from tests.support.waiting import wait_for

pytestmark = pytest.mark.ros

AXIS = '/cell/feed_axis'
NO_PROFILES = {'FASTRTPS_DEFAULT_PROFILES_FILE': '', 'FASTDDS_DEFAULT_PROFILES_FILE': ''}    # as users start the tool


@pytest.fixture(scope='module')
def folder(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Path]:
    """Return where an axis runs."""
    folder = tmp_path_factory.mktemp('axis')
    with running('time.rate:=200.0', '-r', '__ns:=/cell', folder=folder):
        with client('/cell') as axis:
            axis.connect()
        yield folder


def refusal(capsys: Capture, *words: str) -> str:
    """Return the one line in which the node, or the tool, refuses a call."""
    return refused(capsys, 'call', *words, '--node', AXIS)


def said(capsys: Capture, *words: str) -> str:
    """Return the one line that the tool prints of an answer."""
    code, out, err = answered(capsys, 'call', *words, '--node', AXIS)
    assert (code, err) == (0, '')
    return out


def test_a_recording_and_a_new_run(folder: Path, capsys: Capture) -> None:
    assert said(capsys, 'record').startswith(f'recording into {folder}/runs/cell_paper_fig8_')
    assert 'refused while recording' in refusal(capsys, 'reset')
    begun = said(capsys, 'record', 'off').removeprefix('recorded into ').strip()
    assert open_bag(begun).is_complete
    assert said(capsys, 'record', 'off') == 'not recording\n'
    assert said(capsys, 'reset') == 'simulation time and steps begin anew at 0\n'


def test_steps_while_it_is_paused(folder: Path, capsys: Capture) -> None:
    assert 'refused while time runs by itself' in refusal(capsys, 'step')
    try:
        assert said(capsys, 'pause').startswith('paused at simulation time ')
        first, *events, state = said(capsys, 'step', '500', '--velocity', '-0.02', '--force', '10').splitlines()
        assert first.startswith('500 steps made')
        assert any('breakaway at ' in event for event in events)
        assert 'drive -20 mm/s' in state
        assert said(capsys, 'step').startswith('1 step made')
        assert 'drive -20 mm/s' in said(capsys, 'step')          # it goes on under what is in force
        assert 'steps = 0 is refused' in refusal(capsys, 'step', '0', '--velocity', '0.01')
        assert 'velocity = 5.0 is refused' in refusal(capsys, 'step', '--velocity', '5')
    finally:
        assert said(capsys, 'resume').startswith('running at simulation time ')


def test_faults(folder: Path, capsys: Capture) -> None:
    for words, answer in (
            ('friction_scale --value 1.5', 'friction_scale_1 (friction_scale 1.5) begins 0 s from now'),
            ('force_pulse --value -20 --start 60 --duration 2 --id a', 'a (force_pulse -20) begins 60 s from now'),
            ('drive_freeze --start 60 --id b', 'b (drive_freeze) begins 60 s from now'),
            ('encoder_dropout --value 0.5 --id c',
             'c (encoder_dropout 0.5) begins 0 s from now; encoder_dropout does nothing: no encoder is read; '
             'set joint_interface.enabled: true')):
        assert said(capsys, 'inject-fault', *words.split()) == f'{answer}\n'
    for fault in ('c', 'b'):
        assert said(capsys, 'clear-faults', fault) == f'{fault} cleared\n'
    assert said(capsys, 'clear-faults') == 'cleared: friction_scale_1, a\n'
    assert "kind = 'friction' is refused" in refusal(capsys, 'inject-fault', 'friction')
    assert refusal(capsys, 'inject-fault', 'friction_scale') == (    # 0 would be a friction that is gone
        'stickslip: --value is missing: must be given with friction_scale: a factor, >= 0 and <= 100; add --value X\n')
    assert 'force_pulse: within ±1e9 N' in refusal(capsys, 'inject-fault', 'force_pulse')


def test_parameters(folder: Path, capsys: Capture) -> None:
    assert said(capsys, 'set', 'axis.mass=300', 'command.max_velocity=0.5') == 'set: axis.mass, command.max_velocity\n'
    assert 'axis.mass = -1' in refusal(capsys, 'set', 'axis.mass=-1')
    assert 'solver.name' in refusal(capsys, 'set', 'axis.mass=350', 'solver.name=fixed_step')
    assert 'must be A.B=VALUE' in refusal(capsys, 'set', 'axis.mass')
    assert said(capsys, 'set', 'axis.mass=350', 'command.max_velocity=1') == 'set: axis.mass, command.max_velocity\n'


def test_nobody_answers(folder: Path, capsys: Capture) -> None:
    line = refused(capsys, 'call', 'reset', '--timeout', '3', code=1)
    assert line == (f'stickslip: no node /feed_axis offers reset (looked for 3 s); found {AXIS}: name it with'
                    ' --node\n')
    assert '--node' in refused(capsys, 'call', 'reset', '--node', 'a b')


class Double:
    """A second node of the name of the axis; it has not heard of a client that greets it first, or hears nobody."""

    def __init__(self, node: Any) -> None:
        self._service = node.create_service(GetParameters, 'feed_axis/get_parameters', lambda _, response: response)
        self._greetings = 0
        self.is_deaf = False

    def await_client(self) -> None:
        """Miss the first greeting of the next client."""
        self._greetings = 0

    def hear(self) -> None:
        """Answer what has come, but a first greeting."""
        with self._service.handle:
            request, header = self._service.handle.service_take_request(GetParameters.Request)
        if request is not None and not self.is_deaf:
            self._greetings += 1
            if self._greetings > 1:
                self._service.send_response(GetParameters.Response(), header)


@pytest.fixture
def double() -> Iterator[Double]:
    is_over = Event()

    def listen() -> None:
        while not is_over.wait(0.01):
            it.hear()

    kind = partial(Node, namespace='/cell', start_parameter_services=False, enable_rosout=False)
    with bare_nodes('feed_axis', kind=kind) as (node,):
        it = Double(node)
        thread = Thread(target=listen)
        thread.start()
        yield it
        is_over.set()
        thread.join()


def test_two_of_one_name(folder: Path, double: Double, capsys: Capture) -> None:
    """Each would do it, and one of the answers be reported.  A killed one is in the graph for a while.

    A call may have heard of one node only when it is made: so it greets both again, and so is the wait for both here.
    """
    def in_this_process() -> str:
        double.await_client()
        return refusal(capsys, 'step')

    def afresh() -> str:
        double.await_client()
        return tool('call', 'step', '--node', AXIS, **NO_PROFILES).stderr

    def of_two(call: Callable[[], str]) -> str:
        return line if 'two nodes' in (line := call()) else ''

    for call in (in_this_process, afresh):
        assert wait_for(partial(of_two, call), 'both').startswith(
            f"stickslip: --node = '{AXIS}' is refused: must be the name of one node; two nodes named {AXIS} answer")
    double.is_deaf = True    # as one that was killed
    assert 'refused while time runs by itself' in refusal(capsys, 'step')


def test_a_call_is_announced_often_unless_the_user_has_profiles(capsys: Capture, monkeypatch: pytest.MonkeyPatch
                                                                ) -> None:
    """Otherwise it would hear of a second node of one name seconds after the first."""
    used = []

    def init(**_: object) -> None:
        used.append([os.environ[name] for name in sorted(NO_PROFILES) if os.environ.get(name)])
        raise RuntimeError('that is all')

    monkeypatch.setattr('rclpy.init', init)
    for given in ('', '/home/me/mine.xml'):
        for name in NO_PROFILES:
            monkeypatch.setenv(name, given)
        assert 'that is all' in refused(capsys, 'call', 'step')
        assert [os.environ.get(name, '') for name in NO_PROFILES] == [given] * 2
    (ours, *_), theirs = used
    assert '<period><nanosec>100000000</nanosec></period>' in Path(ours).read_text()
    assert theirs == [given] * 2


def test_wrong_use(capsys: Capture) -> None:
    assert 'call record --help' in refused(capsys, 'call', 'record', 'perhaps')
    assert 'See stickslip call step --help' in refused(capsys, 'call', 'step', 'many')
    assert answered(capsys, 'call')[0] == 2


def test_without_a_workspace() -> None:
    done = tool('call', 'reset', AMENT_PREFIX_PATH='')
    assert (done.returncode, done.stdout) == (2, '')
    assert done.stderr == ("stickslip: AMENT_PREFIX_PATH = '' is refused: must be that of a ROS 2 workspace; source its"
                           ' setup.bash\n')


class Axis(NamedTuple):
    process: NodeProcess
    client: Client

    def let_pass(self, steps: int) -> None:
        step = self.client.latest('slider_state').step
        self.client.next('slider_state', lambda state: state.step > step + steps)

    @property
    def neighbours(self) -> str:
        """What it says next of its neighbours; both axes say theirs on /diagnostics."""
        name = f'{self.client.node.get_namespace()}/feed_axis: neighbours'

        def found(message: Any) -> list[str]:
            return [status.message for status in message.status if status.name == name]

        text, = found(self.client.next('/diagnostics', lambda message: bool(found(message))))
        return text


@contextmanager
def two_axes(folder: Path, **arguments: str) -> Iterator[tuple[Axis, Axis]]:
    """Start both at once, in one folder, as axes.launch.py does, and wait for them."""
    at_rest = 'drive.course:=constant drive.velocity:=0.0'
    with ExitStack() as stack:
        processes = [stack.enter_context(running(*started.words, folder=folder))
                     for started in launched('axes', parameters=at_rest, rate='200', **arguments).processes]
        x, y = (Axis(process, stack.enter_context(client(namespace)))
                for process, namespace in zip(processes, ('/x', '/y'), strict=True))
        for axis in (x, y):
            axis.client.connect()
        yield x, y


class TestTwoAxes:
    def test_what_is_said_to_one_does_not_reach_the_other(self, tmp_path: Path) -> None:
        """They begin in the same second, in the same folder; a prefix each, as one robot description needs it."""
        with two_axes(tmp_path, joints='/joint_states', record='true') as (x, y):
            names: set[tuple[str, ...]] = set()
            x.client.node.create_subscription(JointState, '/joint_states', lambda heard: names.add(tuple(heard.name)),
                                              10)
            both = {(f'{prefix}axis_slider', f'{prefix}axis_drive') for prefix in ('x_', 'y_')}
            wait_for(lambda: names == both, 'the joints of both')
            x.client.send_velocity(0.004)
            x.client.next('slider_state', lambda state: state.position > 1e-4)
            y.let_pass(100)
            assert {(state.drive_velocity, state.position) for state in y.client.heard['slider_state']} == {(0.0, 0.0)}
            y.client.send_force(100.0)
            y.client.next('slider_state', lambda state: state.position > 0.0)
            assert x.client.latest('slider_state').drive_velocity == 0.004
            assert x.client.set_parameters(axis__normal_force=2000.0).successful
            assert [axis.client.values('axis.normal_force')[0].double_value for axis in (x, y)] == [2000.0, 3432.3275]
            for axis in (x, y):
                assert axis.neighbours == 'nobody in the way'
                assert_clean(*axis.process.end())
        folders = sorted((tmp_path / 'runs').iterdir())
        assert [folder.name[:14] for folder in folders] == ['x_positioning_', 'y_positioning_']
        runs = {name: open_bag(folder) for name, folder in zip('xy', folders)}
        assert [{topic.split('/')[1] for topic in run.topics} for run in runs.values()] == [
            {name, 'parameter_events'} for name in runs]
        assert [run.counts[f'/{name}/drive_velocity'] for name, run in runs.items()] == [1, 0]

    def test_each_has_its_clock(self, tmp_path: Path) -> None:
        with two_axes(tmp_path, mode='free_run') as (x, y):
            times: list[int] = []
            x.client.node.create_subscription(Clock, '/y/clock', lambda clock: times.append(clock.clock.sec), 10)
            answer = x.client.switch('set_paused', True)
            assert answer.success
            wait_for(lambda: times and times[-1] > times[0], 'the clock of y while x is paused')
            assert answer.message == f'paused at simulation time {x.client.latest("slider_state").step / 200:g} s'
            assert [x.client.node.count_publishers(topic) for topic in ('/clock', '/x/clock', '/y/clock')] == [0, 1, 1]
            assert {axis.neighbours for axis in (x, y)} == {'nobody in the way'}
