# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The node as others see it: parameters, topics, motion, commands, services.  One node for all of it.

It makes 200 steps a second: with the messages of a thousand a busy machine answers a question in half a minute.
"""

import math
import statistics
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

import pytest
from rcl_interfaces.srv import SetParameters
from rclpy.parameter import Parameter

from stickslip_sim.core.types import EventKind, Instant
from stickslip_sim.inputs import load_scene
from stickslip_sim.ros.node.parameters import promoted
from stickslip_sim.scene.schema import BY_NAME, PARAMETERS
from stickslip_sim.simulation.simulator import Simulator
from tests.support.busy_machine import judged_by_time
from tests.support.node_processes import NodeProcess, assert_clean, running
from tests.support.ros_nodes import Client, client, nanoseconds
from tests.support.waiting import wait_for

pytestmark = pytest.mark.ros

RATE = 200.0
SCENE = load_scene('paper_fig8', {'time.rate': RATE})
READ_ONLY = 'it cannot change while the node runs: start the node with another'

ParameterType = {'bool': 1, 'integer': 2, 'double': 3, 'string': 4, 'double_array': 8, 'string_array': 9}


@pytest.fixture(scope='module')
def process(tmp_path_factory: pytest.TempPathFactory) -> Iterator[NodeProcess]:
    with running(f'time.rate:={RATE}', folder=tmp_path_factory.mktemp('node'), afresh=True) as process:
        yield process
        assert_clean(*process.end())


@pytest.fixture(scope='module')
def connected(process: NodeProcess) -> Iterator[Client]:
    with client() as it:
        it.hear_friction()
        it.connect()
        yield it


@pytest.fixture
def axis(connected: Client) -> Client:
    """The client of an axis that begins anew."""
    connected.reset()
    return connected


class TestParameters:
    def test_all_of_the_schema_and_no_other(self, connected: Client) -> None:
        of_ros = {'use_sim_time', 'start_type_description_service'}
        of_the_node = {'thread_priority', 'lock_memory', 'cpu_affinity', 'require_real_time', 'meant'}
        assert set(connected.parameter_names()) - of_ros - of_the_node == {entry.name for entry in PARAMETERS}

    def test_descriptions(self, connected: Client) -> None:
        for entry, described in zip(PARAMETERS, connected.describe(*[entry.name for entry in PARAMETERS]), strict=True):
            assert described.name == entry.name
            assert described.type == ParameterType[entry.type]
            assert described.read_only is not entry.live
            assert entry.description in described.description
            assert entry.unit in described.description
            assert entry.allowed in described.additional_constraints
            if entry.type == 'double':
                assert [described.floating_point_range[0].from_value, described.floating_point_range[0].to_value] == [
                    entry.low, math.inf if entry.infinite else entry.high]

    def test_values_are_those_of_the_default_scene(self, connected: Client) -> None:
        """One without a value does not hide the others."""
        names = ['scene', 'axis.mass', 'friction.kinetic.velocities', 'drive.times', 'drive.velocity',
                 'initial.rest_time']
        scene, mass, velocities, absent, drive, rest = connected.values(*names)
        assert (scene.string_value, mass.double_value, drive.double_value) == ('paper_fig8', 350.0, 0.002)
        assert list(velocities.double_array_value) == [0.0, 0.035]
        assert (rest.double_value, absent.type) == (math.inf, 0)

    @pytest.mark.parametrize(('values', 'reported'), [
        ({'axis__mass': -1.0}, ['axis.mass = -1.0', '>= 1e-09 and <= 1e+12 kg']),
        ({'axis__mass': math.nan}, ['axis.mass = nan', '>= 1e-09']),
        ({'axis__mass': 'heavy'}, ["axis.mass = 'heavy'", 'a number']),
        ({'axis__normal_force': math.inf}, ['axis.normal_force = inf', '<= 1e+15 N']),
        ({'friction__kinetic__velocities': [0.02, 0.01]}, ['friction.kinetic.velocities']),
        ({'friction__kinetic__coefficients': [0.5, 0.05]}, ['friction.kinetic.coefficients[0] = 0.5', '0.12']),
        ({'axis__mass': 300.0, 'friction__static__limit': 0.01}, ['friction.static.limit']),
        ({'time__rate': 500.0}, ['time.rate = 500.0 is refused: must be 200.0, as at the start', READ_ONLY]),
        ({'drive__times': [0.0]}, ['drive.times', 'must be omitted, as at the start', READ_ONLY]),
        ({'record__enabled': True}, ['record.enabled = True is refused: must be false, as at the start', READ_ONLY]),
        ({'start_type_description_service': False}, ['must be true, as at the start', READ_ONLY]),
        ({'axis__weight': 1.0}, ['axis.weight']),
    ])
    def test_refused(self, connected: Client, values: dict[str, object], reported: list[str]) -> None:
        answer = connected.set_parameters(**values)
        assert not answer.successful
        assert '\n' not in answer.reason
        assert all(words in answer.reason for words in reported), answer.reason
        assert connected.values('axis.mass')[0].double_value == 350.0

    def test_what_param_load_sends_of_a_dump_changes_nothing(self, connected: Client) -> None:
        """It sends 'None' for what has no value, and 'inf' for .inf."""
        same = {'time__rate': RATE, 'time__mode': 'realtime', 'drive__times': 'None', 'initial__rest_time': 'inf',
                'friction__excess__exponent': 'None', 'command__velocity_limit': 'inf', 'axis__mass': 350.0,
                'start_type_description_service': True, 'meant': 'None'}
        for name, value in same.items():
            answer = connected.set_parameters(**{name: value})
            assert answer.successful, answer.reason

    @pytest.mark.parametrize(('name', 'sent', 'taken'), [
        ('axis.mass', '1e-06', 1e-6), ('axis.mass', '1e+17', 1e17), ('command.velocity_limit', 'inf', math.inf),
        ('drive.times', '[0.0, 1e-05]', [0.0, 1e-5]), ('drive.times', ['1e-05'], [1e-5]),
        ('drive.times', [0, 1], [0.0, 1.0]),
        ('axis.mass', '300', '300'), ('axis.mass', 'heavy', 'heavy'), ('drive.times', 'null', 'null'),
        ('drive.times', True, True), ('drive.times', 3, 3),
    ])
    def test_numbers_that_param_load_sends_as_texts(self, name: str, sent: Any, taken: object) -> None:
        value = promoted(Parameter(name, value=sent), BY_NAME[name]).value
        assert (list(value) if isinstance(taken, list) else value) == taken

    def test_a_change_acts_while_the_axis_moves(self, axis: Client) -> None:
        axis.next('friction_force', lambda message: message.force > 100.0)
        assert axis.set_parameters(axis__normal_force=7000).successful     # a whole number will do
        try:
            assert axis.values('axis.normal_force')[0].double_value == 7000.0
            now = axis.now()
            event = axis.next('mode_event', lambda event: event.kind == EventKind.BREAKAWAY and event.time > now)
            assert event.friction_force == pytest.approx(7000.0 * event.static_coefficient, rel=1e-9)
        finally:
            assert axis.set_parameters(axis__normal_force=3432.3275).successful

    def test_one_that_no_axis_has_is_asked_back(self, connected: Client) -> None:
        usual, unusual = ({'friction__kinetic__velocities': [0.0, top]} for top in (0.035, 35.0))
        name = 'friction.kinetic.velocities'
        answer = connected.set_parameters(**unusual)
        assert not answer.successful
        assert answer.reason.endswith(f"it was read as 35 m/s, and 5 mm/s is 0.005; if 35 m/s is intended, "
                                      f"add -p 'meant:=[{name}]'")
        assert 'did you mean friction.kinetic.velocities?' in connected.set_parameters(meant=[f'{name}s']).reason
        assert connected.set_parameters(**unusual, meant=[name]).successful
        assert connected.set_parameters(**usual).successful

    def test_two_that_fit_only_together_need_an_atomic_request(self, connected: Client) -> None:
        """As ROS defines its services, and as docs/scene.md says."""
        both = {'friction.kinetic.velocities': [0.0, 0.02, 0.035], 'friction.kinetic.coefficients': [0.12, 0.08, 0.05]}
        parameters = [Parameter(name, value=value).to_parameter_msg() for name, value in both.items()]
        results = connected.call(SetParameters, 'set_parameters', parameters=parameters).results
        assert [result.successful for result in results] == [False, False]
        assert all('friction.kinetic.coefficients' in result.reason for result in results), results
        assert connected.set_parameters(**{name.replace('.', '__'): value for name, value in both.items()}).successful
        assert [list(value.double_array_value) for value in connected.values(*both)] == [*both.values()]
        assert connected.set_parameters(friction__kinetic__velocities=[0.0, 0.035],
                                        friction__kinetic__coefficients=[0.12, 0.05]).successful


class TestTopics:
    @pytest.mark.parametrize(('name', 'kind', 'reliable', 'latched'), [
        ('/slider_state', 'stickslip_msgs/msg/SliderState', True, False),
        ('/friction_force', 'stickslip_msgs/msg/FrictionForce', True, False),
        ('/mode_event', 'stickslip_msgs/msg/ModeEvent', True, False),
        ('/timing', 'stickslip_msgs/msg/StepTiming', True, False),
        ('/run_info', 'stickslip_msgs/msg/RunInfo', True, True),
        ('/diagnostics', 'diagnostic_msgs/msg/DiagnosticArray', True, False),
    ])
    def test_published(self, connected: Client, name: str, kind: str, reliable: bool, latched: bool) -> None:
        (endpoint,) = connected.node.get_publishers_info_by_topic(name)
        assert (endpoint.node_name, endpoint.topic_type) == ('feed_axis', kind)
        assert (endpoint.qos_profile.reliability.name == 'RELIABLE') is reliable
        assert (endpoint.qos_profile.durability.name == 'TRANSIENT_LOCAL') is latched

    @pytest.mark.parametrize(('name', 'kind'), [
        ('/drive_velocity', 'stickslip_msgs/msg/DriveVelocity'),
        ('/external_force', 'stickslip_msgs/msg/ExternalForce')])
    def test_subscribed(self, connected: Client, name: str, kind: str) -> None:
        (endpoint,) = connected.node.get_subscriptions_info_by_topic(name)
        assert (endpoint.node_name, endpoint.topic_type) == ('feed_axis', kind)
        assert endpoint.qos_profile.reliability.name == 'BEST_EFFORT'

    def test_run_info_for_those_who_join_late(self, connected: Client) -> None:
        info = connected.latest('run_info')
        assert (info.scene, info.scene_hash, info.solver, info.rate) == (SCENE.name, SCENE.hash, 'exact', RATE)
        assert not [name for name, _ in connected.node.get_topic_names_and_types() if 'joint' in name]    # not wanted

    def test_one_state_a_step_at_the_rate(self, axis: Client) -> None:
        axis.next('slider_state', lambda state: state.step >= RATE)
        states = axis.states_of_run()
        start = nanoseconds(axis.latest('run_info').start_time)
        assert all(math.isclose(state.time, state.step / RATE, rel_tol=3e-16) for state in states)
        assert all(nanoseconds(state.header.stamp) - start == state.step * 5_000_000 for state in states)

    def test_simulation_time_follows_the_clock(self, axis: Client, process: NodeProcess) -> None:
        lags = []
        with judged_by_time(0.05, process.waits):
            for _ in range(20):
                state = axis.next('slider_state')
                lags.append(axis.node.get_clock().now().nanoseconds - nanoseconds(state.header.stamp))
            assert -1e6 < statistics.median(lags) < 50e6

    def test_timing(self, axis: Client, process: NodeProcess) -> None:
        with judged_by_time(0.05, process.waits):
            timing = axis.next('timing', lambda timing: timing.step > 1.5 * RATE)
            assert timing.real_time_factor == pytest.approx(1.0, abs=0.1)
            assert timing.steps == pytest.approx(RATE, abs=20)
            assert 0.0 <= timing.lateness_p50 < 0.005
        assert timing.period == 1 / RATE
        assert 0.0 < timing.cost_p50 <= timing.cost_p99 <= timing.cost_p999 <= timing.cost_max
        assert math.isnan(timing.command_age_p50)

    def test_diagnostics(self, axis: Client) -> None:
        message = axis.next('/diagnostics')
        assert [status.name for status in message.status] == [
            f'/feed_axis: {name}' for name in ('step loop', 'command', 'solver', 'recorder', 'neighbours')]
        assert {status.hardware_id for status in message.status} == {'/feed_axis'}
        status, values = axis.status('solver')
        assert (status.level, values['solver']) == (b'\0', 'exact')


class TestMotion:
    def test_events_are_those_of_the_offline_simulation(self, axis: Client) -> None:
        """With any steps and any clock, bit for bit."""
        axis.next('mode_event', lambda event: event.time > 2.0)
        start = nanoseconds(axis.latest('run_info').start_time)
        heard = [event for event in axis.heard['mode_event'] if nanoseconds(event.header.stamp) >= start]
        until = Instant(math.nextafter(heard[-1].time, math.inf), 0.0)    # a message has the time of its event rounded
        events = Simulator(SCENE.axis, SCENE.initial, SCENE.drive, SCENE.force).advance(until)
        expected = [event for event in events if event.kind != EventKind.KNOT]
        assert len(heard) > 8
        for event, message in zip(expected, heard, strict=True):
            assert (message.time, message.kind, message.mode, message.direction) == (
                event.time, event.kind, event.mode, event.direction)
            assert (message.position, message.velocity, message.drive_force, message.friction_force) == (
                event.position, event.velocity, event.drive_force, event.friction_force)
            assert message.step == math.ceil(event.time * RATE)

    def test_a_velocity_is_held(self, axis: Client) -> None:
        axis.send_velocity(0.005)
        first = axis.next('slider_state', lambda state: state.drive_velocity == 0.005)
        later = axis.next('slider_state', lambda state: state.step >= first.step + 40)
        assert later.drive_velocity == 0.005
        assert later.drive_position - first.drive_position == pytest.approx(0.005 * (later.time - first.time))
        timing = axis.next('timing', lambda timing: timing.command_age_p50 > 0.0)
        assert timing.command_age_p50 <= timing.command_age_max

    def test_bad_commands_are_refused(self, axis: Client) -> None:
        axis.send_velocity(0.004)
        axis.next('slider_state', lambda state: state.drive_velocity == 0.004)
        before, first = refusals(axis.status('command')[1]), len(axis.heard['slider_state'])
        for bad in (math.nan, math.inf, -math.inf, 1e3):
            axis.send_velocity(bad)
            axis.send_force(1e3 * bad)
        _, values = axis.status('command', lambda values: refusals(values) == [refused + 4 for refused in before],
                                b'\1')
        assert values['velocity last refusal'] == (
            'velocity = 1000.0 is refused: must be finite and within ±1.0 m/s; the previous command stays')
        axis.next('slider_state')
        assert {state.drive_velocity for state in axis.heard['slider_state'][first:]} == {0.004}


class TestServices:
    def test_pause_and_go_on(self, axis: Client) -> None:
        axis.next('slider_state', lambda state: state.step > 10)
        with paused(axis):
            last = axis.next('timing', lambda timing: timing.steps == 0).step
            wait_for(lambda: axis.latest('slider_state').step == last, 'the last state')
            status, _ = axis.status('step loop')
            assert 'paused' in status.message
            assert axis.latest('slider_state').step == last
        axis.next('slider_state', lambda state: state.step > last + 20)
        assert axis.states_of_run()    # as many as there were steps: none was made meanwhile, and none left out

    def test_reset_is_a_new_run(self, axis: Client) -> None:
        axis.send_velocity(0.005)
        axis.next('slider_state', lambda state: state.drive_velocity == 0.005 and state.step > 40)
        before = nanoseconds(axis.latest('run_info').start_time)
        with paused(axis):    # so that the first state is heard, however busy the machine
            state = axis.reset()
        assert (state.step, state.drive_velocity) == (0, 0.002)
        assert nanoseconds(axis.latest('run_info').start_time) > before
        axis.next('slider_state', lambda state: state.step > 20)
        assert {state.drive_velocity for state in axis.states_of_run()} == {0.002}


@contextmanager
def paused(axis: Client) -> Iterator[None]:
    """Let time stand still; it goes on for the other tests even after a failure."""
    assert axis.switch('set_paused', True).success
    try:
        yield
    finally:
        assert axis.switch('set_paused', False).success


def refusals(values: dict[str, str]) -> list[int]:
    """Return how many velocities and forces were refused."""
    return [int(values[f'{name} refused']) for name in ('velocity', 'force')]
