# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The node as a process: commands and parameters on the way, signals, and its end."""

import signal
import time
from pathlib import Path

import pytest

from stickslip_sim.core.errors import RecordingWarning
from stickslip_sim.core.types import EventKind
from stickslip_sim.recording import open_bag
from tests.support.busy_machine import judged_by_time
from tests.support.node_processes import assert_clean, recording_into, running
from tests.support.ros_nodes import client
from tests.support.waiting import wait_for

from rcl_interfaces.srv import SetParameters, SetParametersAtomically  # isort: skip  # after ros_nodes, which skips
from rclpy.parameter import Parameter  # isort: skip

pytestmark = [pytest.mark.ros, pytest.mark.slow]


def test_refused_commands_of_one_kind_do_not_hush_up_the_other() -> None:
    with running() as process, client() as axis:
        axis.connect()
        axis.send_velocity(5.0)
        axis.send_force(1e9)
        axis.status('command', lambda values: values['velocity refused'] == values['force refused'] == '1')
        _, errors = process.end()
    assert 'velocity = 5.0 is refused' in errors
    assert 'force = 1000000000.0 is refused' in errors


def test_a_smooth_law_changes_while_the_axis_moves() -> None:
    with running('-p', 'scene:=stribeck') as process, client() as axis:
        axis.connect()
        assert axis.values('friction.kinetic.tolerance')[0].double_value == 1e-4
        answer = axis.set_parameters(friction__kinetic__tolerance=1e-9)
        assert not answer.successful
        assert 'fits' in answer.reason
        assert not axis.set_parameters(friction__kinetic__law='exponential').successful
        assert axis.set_parameters(friction__kinetic__initial=0.1, friction__kinetic__viscous=0.2).successful
        now = axis.now()
        stop = axis.next('mode_event', lambda event: event.kind == EventKind.STICK and event.time > now)
        assert stop.friction_force == pytest.approx(0.1 * 3432.3275, rel=1e-12)
        assert_clean(*process.end())


def test_only_an_atomic_request_changes_parameters_together() -> None:
    """As ROS defines its services, and as docs/scene.md says."""
    table = {'friction.kinetic.velocities': [0.0, 0.01, 0.03], 'friction.kinetic.coefficients': [0.12, 0.1, 0.05]}
    parameters = [Parameter(name, value=value).to_parameter_msg() for name, value in table.items()]
    with running() as process, client() as axis:
        axis.connect()
        results = axis.call(SetParameters, 'set_parameters', parameters=parameters).results
        assert [result.successful for result in results] == [False, False]
        assert all('friction.kinetic.coefficients' in result.reason for result in results), results
        answer = axis.call(SetParametersAtomically, 'set_parameters_atomically', parameters=parameters).result
        assert answer.successful, answer.reason
        assert [list(value.double_array_value) for value in axis.values(*table)] == [*table.values()]
        assert_clean(*process.end())


def takes(number: int, pid: int) -> bool:
    """Return whether a process has a handler for a signal."""
    status = dict(line.split(':', 1) for line in Path(f'/proc/{pid}/status').read_text().splitlines())
    return bool(int(status['SigCgt'], 16) >> (number - 1) & 1)


class TestSignals:
    @pytest.mark.parametrize('number', [signal.SIGINT, signal.SIGTERM, signal.SIGHUP])
    def test_the_bag_is_closed(self, tmp_path: Path, number: int) -> None:
        folder = tmp_path / 'run'
        with running(*recording_into(folder), afresh=True) as process, client() as axis:
            axis.connect()
            axis.send_velocity(0.004)
            axis.next('slider_state', lambda state: state.drive_velocity == 0.004)
            axis.send_force(50.0)
            assert axis.set_parameters(axis__mass=300.0).successful
            axis.next('timing')
            process.send(number)
            process.send(number)      # impatient
            assert_clean(*process.wait())
        run = open_bag(folder)
        assert run.is_complete
        states = run.columns('/slider_state')
        assert list(states['step']) == list(range(len(states['step'])))
        assert list(states['sequence']) == list(states['step'])
        assert list(states['log_time']) == [step * 1_000_000 for step in states['step']]
        (velocity,), (force,) = run.messages(['/drive_velocity']), run.messages(['/external_force'])
        assert run.decode(velocity).velocity == 0.004
        assert run.decode(force).force == 50.0
        before, after = (states['drive_velocity'][velocity.sequence + i] for i in (-1, 0))
        assert (before, after) == (0.002, 0.004)
        (change,) = (run.decode(message) for message in run.messages(['/parameter_events']))
        assert change.changed_parameters[0].name == 'axis.mass'
        assert run.receipt['timing']['steps'] == len(states['step'])
        assert run.columns('/timing')['steps'].sum() == len(states['step'])
        assert run.receipt['commands']['velocity'] == {'received': 1, 'refused': 0}
        assert run.receipt['energy']['relative_residual'] <= 1e-13
        assert b'paper_fig8' in run.attachments['scene.yaml']

    @pytest.mark.parametrize('delay', [0.0, 0.3, 0.6])    # s: amid its imports, and after them
    @pytest.mark.parametrize('number', [signal.SIGINT, signal.SIGTERM, signal.SIGHUP])
    def test_while_it_starts(self, number: int, delay: float) -> None:
        with running(afresh=True) as process:
            wait_for(lambda: takes(signal.SIGTERM, process.pid), 'its handlers')    # Python itself takes but SIGINT
            time.sleep(delay)
            assert_clean(*process.end(number))

    def test_killed(self, tmp_path: Path) -> None:
        folder = tmp_path / 'run'
        with running(*recording_into(folder)) as process, client() as axis, judged_by_time(0.5, process.waits):
            axis.connect()
            axis.next('slider_state', lambda state: state.step > 2500)
            process.kill()
            last = axis.latest('slider_state').step
            with pytest.warns(RecordingWarning, match='no end'):
                run = open_bag(folder)
            steps = run.columns('/slider_state')['step']
            assert last - 1000 < steps[-1] <= last + 1000
        assert not run.is_complete
        assert list(steps) == list(range(len(steps)))

    def test_stopped_for_a_while(self) -> None:
        with running() as process, client() as axis, judged_by_time(0.5, process.waits):
            axis.connect()
            reports = len(axis.heard['timing'])
            process.send(signal.SIGSTOP)
            time.sleep(1.0)
            process.send(signal.SIGCONT)
            axis.next('timing', lambda timing: timing.lateness_max > 0.5)
            # a stop at the end of a second is reported by that second's report, the late step by the next one's
            wait_for(lambda: any(timing.real_time_factor < 0.95 for timing in axis.heard['timing'][reports:]),
                     'a report of the lost time')
            _, values = axis.status('step loop')
            assert values['times skipped'] == '1'
            assert axis.states_of_run()    # with none left out
