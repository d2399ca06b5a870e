# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Services: storms of calls, made-up and endless requests, runs that are recorded and reset; clear answers."""

import json
import math
import random
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
from stickslip_sim.check.limits import limits_of, outcomes_of
from stickslip_sim.check.remake import other_run, other_scene
from stickslip_sim.check.verification import verify
from stickslip_sim.core.errors import InputError
from stickslip_sim.inputs import load_scene
from stickslip_sim.recording import open_bag, read_run
from stickslip_sim.scene import scene_from_values
from stickslip_sim.simulation import Fault
from stickslip_sim.simulation.faults import RULES
from tests.support import standard_package
from tests.support.axis_here import AxisHere, axis_here
from tests.support.made_up_texts import NAMES
from tests.support.node_processes import recording_into
from tests.support.rigs import FIELDS, assert_same_states, made_again
from tests.support.ros_nodes import Asker, Client, live_axis
from tests.support.waiting import DEADLINE, wait_for

pytestmark = [pytest.mark.ros, pytest.mark.slow]

CALLS = 150
BILLION = 10**9
COUNTS: tuple[int, ...] = (0, -1, -BILLION, BILLION, 100_001, 1, 2, 7, 50)
SPEEDS = (math.nan, 0.002, -0.004, 0.01, math.inf, -math.inf, 1.5)
FORCES = (math.nan, 0.0, 100.0, -300.0, math.inf, 1e6)
MASSES = (350.0, 200.0, 500.0, -1.0, math.nan, 0.0)


class Storm:
    """Calls in any order, each with an answer that is known beforehand."""

    def __init__(self, axis: Asker, mode: str, seed: int) -> None:
        self.axis, self.stream = axis, random.Random(seed)
        self.is_stepped, self.is_paused, self.is_recording = mode == 'lockstep', False, False
        self.values = dict(load_scene('paper_fig8', {'time.mode': mode}).values)
        self.rig = scene_from_values(self.values).make_rig()     # in lock-step it is driven as the node is
        self.rig.make_step()

    def call(self) -> None:
        """Make one call."""
        self.stream.choices([self.step, self.inject, self.clear, self.reset, self.pause, self.record, self.parameter],
                          [6, 4, 1, 1, 2, 1, 2])[0]()

    def expect(self, answer: Any, success: bool, *reported: str) -> None:
        assert answer.success is success, answer
        assert answer.message
        assert '\n' not in answer.message
        for words in reported:
            assert words in answer.message

    def step(self) -> None:
        count, velocity, force = self.stream.choice(COUNTS), self.stream.choice(SPEEDS), self.stream.choice(FORCES)
        answer = self.axis.call(Step, 'step', steps=count, velocity=velocity, force=force)
        asks = count == 0 and math.isnan(velocity) and math.isnan(force)
        if not (asks or 1 <= count <= 100_000):
            self.expect(answer, False, f'steps = {count} is refused: must be 1 to 100000')
        elif not math.isnan(velocity) and not abs(velocity) <= 1.0:
            self.expect(answer, False, f'velocity = {velocity} is refused', 'NaN leaves the one in force')
        elif not math.isnan(force) and not abs(force) <= 1e5:
            self.expect(answer, False, f'force = {force} is refused')
        elif not (self.is_stepped or self.is_paused):
            self.expect(answer, False, 'refused while time runs by itself')
        else:
            self.expect(answer, True, f'{count} step')
            if self.is_stepped and not asks:
                self.follow(answer, count, velocity, force)

    def follow(self, answer: Any, count: int, velocity: float, force: float) -> None:
        """Make the same steps; the state and the events must be the same to the last bit."""
        results = [self.rig.make_step(*(None if math.isnan(value) else value for value in (velocity, force)))]
        results += [self.rig.make_step() for _ in range(count - 1)]
        assert answer.state.step == results[-1].step
        assert {name: getattr(answer.state, name) for name in FIELDS} == {
            name: getattr(results[-1].sample, name) for name in FIELDS}
        assert answer.friction.force == results[-1].sample.friction_force
        assert [(event.step, event.time, event.kind) for event in answer.events] == [
            (result.step, event.time, event.kind) for result in results for event in result.events
            if event.kind <= 5]

    def inject(self) -> None:
        kind = self.stream.choice([*RULES, 'clear', 'gremlin'])
        value = self.stream.choice([0.0, 0.5, 2.0, 200.0, math.nan, -1.0])
        asked = Fault(self.stream.choice(['', 'a', 'b', 'x\n', 'y' * 99]), kind, self.stream.choice([0.0, 0.004, -1.0]),
                      self.stream.choice([0.01, 0.05, math.inf, 0.0]), value)
        answer = self.axis.call(InjectFault, 'inject_fault', id=asked.id, kind=kind, start=asked.start,
                                duration=asked.duration, value=value)
        try:
            given = asked.id if kind == 'clear' else self.rig.inject(asked).id
            if kind == 'clear':
                self.rig.clear_fault(given)
        except InputError as error:
            self.expect_refusal(answer, error)
        else:
            self.expect(answer, True, given)
            assert answer.id == given

    def expect_refusal(self, answer: Any, error: InputError) -> None:
        self.expect(answer, False, f'{error.name} = ', 'is refused: must be ')
        assert answer.message == str(error)

    def clear(self) -> None:
        answer = self.axis.trigger('clear_faults')
        self.expect(answer, True)
        assert answer.message == 'cleared: ' + (', '.join(self.rig.clear_faults()) or 'there were none')

    def reset(self) -> None:
        answer = self.axis.trigger('reset')
        if self.is_recording and self.has_begun:
            self.expect(answer, False, 'refused while recording', '~/record')
            return
        self.expect(answer, True)
        self.rig.reset()
        self.rig.make_step()

    @property
    def has_begun(self) -> bool:
        """Whether a reset would undo anything."""
        return not self.is_stepped or self.rig.step > 0 or self.rig.has_orders

    def pause(self) -> None:
        wanted = self.stream.random() < 0.5
        answer = self.axis.switch('set_paused', wanted)
        if self.is_stepped:
            self.expect(answer, False, 'time.mode: lockstep', '~/step')
            return
        self.expect(answer, True, 'paused' if wanted else 'running', 'at simulation time')
        self.is_paused = wanted

    def record(self) -> None:
        wanted = self.stream.random() < 0.6
        answer = self.axis.switch('record', wanted)
        self.expect(answer, True, 'record')
        self.is_recording = wanted

    def parameter(self) -> None:
        mass = self.stream.choice(MASSES)
        answer = self.axis.set_parameters(axis__mass=mass)
        if not mass > 0.0:
            assert (answer.successful, 'axis.mass = ' in answer.reason) == (False, True)
            return
        assert answer.successful
        self.values['axis.mass'] = mass
        self.rig.change_axis(scene_from_values(self.values).axis)


class LiveStorm(Storm):
    """A storm over time that runs by itself, all of it in one bag; what the rig makes of it is looked up there."""

    def __init__(self, axis: Client, seed: int) -> None:
        super().__init__(axis, 'realtime', seed)
        self.client, self.is_recording = axis, True

    def call(self) -> None:
        super().call()
        self.client.send_velocity(self.stream.uniform(-0.005, 0.005))
        self.client.send_force(self.stream.choice([0.0, 150.0, math.nan]))

    def inject(self) -> None:
        kind, value = self.stream.choice([('friction_scale', 1.5), ('force_pulse', 200.0), ('drive_freeze', 0.0),
                                        ('command_delay', 0.01), ('command_loss', 0.5), ('encoder_dropout', 0.5)])
        is_good = self.stream.random() < 0.7
        answer = self.axis.call(InjectFault, 'inject_fault', kind=kind, start=self.stream.choice([0.0, 0.01]),
                                duration=self.stream.choice([0.01, 0.1]), value=value if is_good else -1e10)
        self.expect(answer, is_good, answer.id if is_good else 'value = -10000000000.0 is refused')

    def clear(self) -> None:
        self.expect(self.axis.trigger('clear_faults'), True, 'cleared: ')

    def record(self) -> None:
        self.expect(self.axis.switch('record', True), True, 'already recording into ')


class TestStorm:
    def test_in_lockstep_the_motion_is_that_of_the_orders(self, tmp_path: Path,
                                                          monkeypatch: pytest.MonkeyPatch) -> None:
        monkeypatch.chdir(tmp_path)
        with axis_here('time.mode:=lockstep') as axis:
            storm = Storm(axis, 'lockstep', 1)
            for _ in range(CALLS):
                storm.call()
            storm.follow(axis.step(300), 300, math.nan, math.nan)

    def test_in_real_time_the_bag_has_all_that_the_motion_depends_on(self, tmp_path: Path) -> None:
        with live_axis(*recording_into(tmp_path / 'run'), folder=tmp_path) as (_, axis):
            storm = LiveStorm(axis, 2)
            for _ in range(CALLS):
                storm.call()
        recorded = open_bag(tmp_path / 'run')
        assert recorded.counts['/rig_event'] > 10
        assert recorded.counts['/slider_state'] > 300
        assert_same_states(recorded, made_again(recorded, load_scene('paper_fig8')))


def test_a_recorded_run_that_has_not_begun_can_be_reset(tmp_path: Path) -> None:
    """As often as a client asks that is not sure of its answer; what was ordered before is not forgotten unseen."""
    folder = tmp_path / 'run'
    with axis_here('time.mode:=lockstep', *recording_into(folder)) as axis:
        for _ in range(2):
            answer = axis.trigger('reset')
            assert answer.success
            assert answer.message == 'simulation time and steps are at 0; the recording goes on'
        assert axis.call(InjectFault, 'inject_fault', kind='drive_freeze', duration=1.0).success
        assert not axis.trigger('reset').success
        axis.step(10, 0.01)
        assert 'refused while recording' in axis.trigger('reset').message
        assert axis.switch('record', False).success
        assert axis.trigger('reset').message == 'simulation time and steps begin anew at 0'
    steps = open_bag(folder).columns('/slider_state')['step']
    assert steps.tolist() == list(range(11))


def test_a_recording_that_begins_at_step_0_is_as_one_from_the_start(tmp_path: Path,
                                                                    capfd: pytest.CaptureFixture[str]) -> None:
    """The second run of a bench in lock-step: its states begin at 0 s as those of the first do."""
    folders = [tmp_path / name for name in ('first', 'second')]
    with axis_here('time.mode:=lockstep', *recording_into(folders[0])) as axis:
        for folder in folders:
            if folder is folders[1]:
                assert axis.trigger('reset').success
                assert axis.set_parameters(record__folder=str(folder)).successful
                assert axis.switch('record', True).success
            axis.step(10, 0.01)
            assert axis.switch('record', False).success
    log = capfd.readouterr().err
    for text in (*(f'recorded into {folder}' for folder in folders), 'simulation time and steps begin anew at 0'):
        assert f': {text}\n' in log
    limits = limits_of({'window': {'begin': 0.0, 'end': 0.01}, 'limits': {'peak_speed': {'max': 1.0}}})
    for folder in folders:
        run = read_run(folder)
        assert run.bag.columns('/slider_state')['step'].tolist() == list(range(11))
        assert run.bag.columns('/drive_velocity')['log_time'].tolist() == [0]
        assert all(outcome.passed for outcome in outcomes_of(limits, run))
        assert verify(run).difference is None
    changes = {'initial.position': 0.001, 'axis.mass': 300.0}    # of which the first cannot change in mid-run
    first, second = (other_run(run, other_scene(run, changes), changes) for run in map(read_run, folders))
    assert first.samples['position'].tolist() == second.samples['position'].tolist()
    assert first.samples['position'][0] == 0.001


@pytest.mark.parametrize('is_read', [False, True])
def test_a_fault_of_the_scene_that_does_nothing_is_warned_of(is_read: bool, capfd: pytest.CaptureFixture[str]) -> None:
    fault = ('ids:=[gap]', 'kinds:=[encoder_dropout]', 'starts:=[0.1]', 'durations:=[0.1]', 'values:=[0.5]')
    with axis_here('time.mode:=lockstep', *(f'faults.{text}' for text in fault), f'joint_interface.enabled:={is_read}'):
        pass
    assert ('encoder_dropout does nothing: no encoder is read' in capfd.readouterr().err) is not is_read


def test_what_was_cleared_is_reported_and_the_zeros_of_the_type() -> None:
    """`ros2 service call /feed_axis/step ... '{steps: 10}'` stops the drive, and says so."""
    with axis_here('time.mode:=lockstep', 'command.timeout:=0.05', 'command.on_timeout:=fault') as axis:
        def velocity_after(count: int, velocity: float = math.nan) -> Any:
            return axis.step(count, velocity).state.drive_velocity

        def clear() -> str:
            message: str = axis.trigger('clear_faults').message
            return message

        assert 'in place' not in axis.step(1).message
        assert axis.step(1, 0.0, 0.0).message.endswith(
            '; velocity = 0 in place of the input profile of the scene: NaN leaves it')
        assert 'in place' not in axis.step(1, 0.0, 0.0).message
        assert clear() == 'cleared: there were none'
        for fault in ('a', 'b'):
            assert axis.call(InjectFault, 'inject_fault', id=fault, kind='drive_freeze', duration=1.0).success
        assert clear() == 'cleared: a, b'
        assert velocity_after(1, 0.01) == 0.01
        assert velocity_after(100) == velocity_after(1, 0.01) == 0.0     # it takes none any more
        assert axis.call(InjectFault, 'inject_fault', id='c', kind='friction_scale', duration=1.0, value=1.5).success
        assert clear() == 'cleared: c, the command time-out (the drive takes commands again)'
        assert velocity_after(1, 0.01) == 0.01
        assert clear() == 'cleared: there were none'


# Requests that are made up or endless, answered at once, and those of the package simulation_interfaces.

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

    def test_without_the_package_it_says_how_to_get_it(self, monkeypatch: pytest.MonkeyPatch,
                                                       capfd: pytest.CaptureFixture[str]) -> None:
        monkeypatch.setitem(sys.modules, 'simulation_interfaces', None)
        with axis_here():
            pass
        assert capfd.readouterr().err.count('ros-$ROS_DISTRO-simulation-interfaces') == 1
