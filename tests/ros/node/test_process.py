# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The node as a process: signals, scheduling, and its end."""

import os
import signal
import time
from pathlib import Path

import pytest

from stickslip_sim.core.errors import InputError, RecordingWarning
from stickslip_sim.core.types import EventKind
from stickslip_sim.inputs import load_scene
from stickslip_sim.recording import open_bag
from stickslip_sim.ros.node.parameters import cores_of
from stickslip_sim.scene.load import parse_scene
from tests.support.axis_here import axis_here
from tests.support.busy_machine import judged_by_time
from tests.support.node_processes import assert_clean, recording_into, running
from tests.support.rights import name_of, needs_fifo, policies, start_without_rights
from tests.support.ros_nodes import live_axis
from tests.support.waiting import wait_for

pytestmark = [pytest.mark.ros, pytest.mark.slow]


def test_a_smooth_law_changes_while_the_axis_moves() -> None:
    with axis_here('scene:=stribeck', 'time.mode:=lockstep') as axis:
        assert axis.values('friction.kinetic.tolerance')[0].double_value == 1e-4
        answer = axis.set_parameters(friction__kinetic__tolerance=1e-9)
        assert not answer.successful
        assert 'fits' in answer.reason
        assert not axis.set_parameters(friction__kinetic__law='exponential').successful
        axis.step(100)
        assert axis.set_parameters(friction__kinetic__initial=0.1, friction__kinetic__viscous=0.2).successful
        stop = next(event for event in axis.step(5000).events if event.kind == EventKind.STICK)
        assert stop.friction_force == pytest.approx(0.1 * 3432.3275, rel=1e-12)


def takes(number: int, pid: int) -> bool:
    """Return whether a process has a handler for a signal."""
    status = dict(line.split(':', 1) for line in Path(f'/proc/{pid}/status').read_text().splitlines())
    return bool(int(status['SigCgt'], 16) >> (number - 1) & 1)


class TestSignals:
    @pytest.mark.parametrize(('number', 'afresh'), [(signal.SIGINT, True), (signal.SIGTERM, False),
                                                    (signal.SIGHUP, False)])
    def test_the_bag_is_closed(self, tmp_path: Path, number: int, afresh: bool) -> None:
        folder = tmp_path / 'run'
        with live_axis(*recording_into(folder), afresh=afresh) as (process, axis):
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
        count = len(states['step'])
        assert list(states['step']) == list(states['sequence']) == list(range(count))
        assert list(states['log_time']) == [step * 1_000_000 for step in range(count)]
        (velocity,), (force,) = run.messages(['/drive_velocity']), run.messages(['/external_force'])
        assert (run.decode(velocity).velocity, run.decode(force).force) == (0.004, 50.0)
        assert list(states['drive_velocity'][velocity.sequence - 1:][:2]) == [0.002, 0.004]
        (change,) = (run.decode(message) for message in run.messages(['/parameter_events']))
        assert change.changed_parameters[0].name == 'axis.mass'
        assert run.receipt['timing']['steps'] == run.columns('/timing')['steps'].sum() == count
        assert run.receipt['commands']['velocity'] == {'received': 1, 'refused': 0}
        assert run.receipt['energy']['relative_residual'] <= 1e-13
        assert b'paper_fig8' in run.attachments['scene.yaml']

    @pytest.mark.parametrize(('number', 'delay'), [    # s: amid its imports, and after them
        (signal.SIGINT, 0.0), (signal.SIGINT, 0.6), (signal.SIGTERM, 0.3)])
    def test_while_it_starts(self, number: int, delay: float) -> None:
        with running(afresh=True) as process:
            wait_for(lambda: takes(signal.SIGTERM, process.pid), 'its handlers')    # Python itself takes but SIGINT
            time.sleep(delay)
            assert_clean(*process.end(number))

    def test_killed(self, tmp_path: Path) -> None:
        folder = tmp_path / 'run'
        with live_axis('time.rate:=200.0', *recording_into(folder)) as (process, axis), \
                judged_by_time(0.5, process.waits):
            axis.next('slider_state', lambda state: state.step > 500)
            process.kill()
            last = axis.latest('slider_state').step
            with pytest.warns(RecordingWarning, match='no end'):
                run = open_bag(folder)
            steps = run.columns('/slider_state')['step']
            assert last - 200 < steps[-1] <= last + 200
        assert not run.is_complete
        assert list(steps) == list(range(len(steps)))

    def test_stopped_for_a_while(self) -> None:
        with live_axis('time.rate:=200.0') as (process, axis), judged_by_time(0.5, process.waits):
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


class TestScheduling:
    @needs_fifo
    def test_the_steps_go_before_the_others_and_a_node_outlives_the_limit_on_it(self, tmp_path: Path) -> None:
        """SIGXCPU is what the kernel sends a process that used real-time CPU time for too long; it kills by default."""
        folder = tmp_path / 'run'
        wanted = ('thread_priority:=50', 'lock_memory:=true', 'cpu_affinity:=0', *recording_into(folder))
        with live_axis(*wanted, folder=tmp_path, afresh=True) as (process, axis):
            threads = policies(process.pid)
            steps, = (thread for thread, scheduled in threads.items() if scheduled == (os.SCHED_FIFO, 50))
            assert os.sched_getaffinity(steps) == {0}
            others = set(threads) - {steps}
            assert {threads[thread] for thread in others} == {(os.SCHED_FIFO, 49)}
            names = {name_of(process.pid, thread) for thread in others}
            assert any(name.startswith('dds.') for name in names)    # none of the middleware starves
            assert all(os.sched_getaffinity(thread) == os.sched_getaffinity(0) for thread in others)
            assert axis.status('step loop')[1]['scheduling'] == 'SCHED_FIFO 50, memory locked, core 0'
            process.send(signal.SIGXCPU)
            wait_for(lambda: all(policy == os.SCHED_OTHER for policy, _ in policies(process.pid).values()),
                     'threads without a priority')
            assert axis.status('step loop', lambda values: values['not granted'] != 'none')
        assert 'SCHED_FIFO is given up: the kernel sent SIGXCPU' in process.errors
        timing = open_bag(folder).receipt['timing']
        assert timing['scheduling'] == 'SCHED_FIFO lost, memory locked, core 0'
        assert 'scheduling: SCHED_FIFO lost, memory locked, core 0 (not all that is wanted)' in timing['verdict']

    def test_without_rights_the_node_says_what_is_missing_and_goes_on(self, tmp_path: Path) -> None:
        with live_axis('thread_priority:=50', 'lock_memory:=true', folder=tmp_path, prepare=start_without_rights,
                       afresh=True) as (process, axis):
            assert axis.status('step loop')[1]['scheduling'] == 'as any thread'
        missing = 'SCHED_FIFO 50 is not granted: RLIMIT_RTPRIO is 0, and CAP_SYS_NICE is missing'
        assert process.errors.count(missing) == 1
        assert process.errors.count('memory is not locked: RLIMIT_MEMLOCK is 1024 KiB') == 1

    def test_a_start_without_what_it_requires_is_refused(self, tmp_path: Path) -> None:
        with running('thread_priority:=50', 'require_real_time:=true', folder=tmp_path, prepare=start_without_rights,
                     afresh=True) as process:
            assert_refused(*process.wait(), 'require_real_time = True is refused: must be false, or all that is wanted'
                           ' granted; SCHED_FIFO 50 is not granted')

    def test_it_is_no_part_of_a_scene(self) -> None:
        scene = load_scene('paper_fig8')
        added = ''.join(f'    {line}\n' for line in (
            'thread_priority: 50', 'lock_memory: true', 'cpu_affinity: [0, 1]', 'require_real_time: false'))
        text = scene.text.replace('ros__parameters:\n', f'ros__parameters:\n{added}')
        assert parse_scene(text).hash == scene.hash

    @pytest.mark.parametrize(('value', 'cores'), [(-1, ()), (1, (1,)), ([1, 0, 1], (0, 1)), ((2,), (2,))])
    def test_cores_are_one_or_a_list(self, value: object, cores: tuple[int, ...]) -> None:
        assert cores_of(value) == cores

    @pytest.mark.parametrize('value', ['1', 1.0, True, [], [0, -1], [0.5], None, -2])
    def test_what_is_no_core_is_refused(self, value: object) -> None:
        with pytest.raises(InputError, match='cpu_affinity'):
            cores_of(value)


def assert_refused(code: int, errors: str, refusal: str) -> None:
    assert (code, len(errors.splitlines())) == (2, 1)
    assert errors.startswith(f'sim_node: {refusal}')
