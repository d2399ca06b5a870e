# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The scheduling of a real node: what runs at which priority, what is said of it, and what is refused."""

import os
import signal
from pathlib import Path

import pytest

from stickslip_sim.core.errors import InputError
from stickslip_sim.inputs import load_scene
from stickslip_sim.recording import open_bag
from stickslip_sim.scene.load import parse_scene
from tests.support.forked_programs import ended_at_once
from tests.support.node_processes import recording_into, running
from tests.support.rights import name_of, needs_fifo, policies, start_without_rights
from tests.support.ros_nodes import client
from tests.support.waiting import wait_for

pytestmark = pytest.mark.ros
_WANTED = ('-p', 'thread_priority:=50', '-p', 'lock_memory:=true', '-p', 'cpu_affinity:=0')


@needs_fifo
def test_the_steps_go_before_the_others_and_a_node_outlives_the_limit_on_it(tmp_path: Path) -> None:
    """SIGXCPU is what the kernel sends a process that has used real-time CPU time for too long; it kills by default."""
    folder = tmp_path / 'run'
    with running(*_WANTED, *recording_into(folder), folder=tmp_path, afresh=True) as process:
        with client() as axis:
            axis.connect()
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
        code, errors = process.end()
    assert code == 0
    assert 'SCHED_FIFO is given up: the kernel sent SIGXCPU' in errors
    timing = open_bag(folder).receipt['timing']
    assert timing['scheduling'] == 'SCHED_FIFO lost, memory locked, core 0'
    assert 'scheduling: SCHED_FIFO lost, memory locked, core 0 (not all that is wanted)' in timing['verdict']


def test_without_rights_the_node_says_what_is_missing_and_goes_on(tmp_path: Path) -> None:
    with running('-p', 'thread_priority:=50', '-p', 'lock_memory:=true', folder=tmp_path,
                 prepare=start_without_rights, afresh=True) as process:
        with client() as axis:
            axis.connect()
            assert axis.status('step loop')[1]['scheduling'] == 'as any thread'
        code, errors = process.end()
    assert code == 0
    assert errors.count('SCHED_FIFO 50 is not granted: RLIMIT_RTPRIO is 0, and CAP_SYS_NICE is missing') == 1
    assert errors.count('memory is not locked: RLIMIT_MEMLOCK is 1024 KiB') == 1


def test_a_start_without_what_it_requires_is_refused(tmp_path: Path) -> None:
    with running('-p', 'thread_priority:=50', '-p', 'require_real_time:=true', folder=tmp_path,
                 prepare=start_without_rights, afresh=True) as process:
        refused_in_one_line(*process.wait(), 'require_real_time = True is refused: must be false, or all that is wanted'
                            ' granted; SCHED_FIFO 50 is not granted')


@pytest.mark.parametrize(('arguments', 'refusal'), [
    (['thread_priority:=100'], 'thread_priority = 100 is refused: must be a whole number, >= 0 and <= 99'),
    (['thread_priority:=50', 'time.mode:=lockstep'],
     'thread_priority = 50 is refused: must be 0 with time.mode: lockstep'),
])
def test_refused_starts(arguments: list[str], refusal: str) -> None:
    given = [word for argument in arguments for word in ('-p', argument)]
    refused_in_one_line(*ended_at_once('sim_node', '--ros-args', *given), refusal)


def refused_in_one_line(code: int, errors: str, refusal: str) -> None:
    assert (code, len(errors.splitlines())) == (2, 1)
    assert errors.startswith(f'sim_node: {refusal}')


def test_scheduling_is_no_part_of_a_scene() -> None:
    scene = load_scene('paper_fig8')
    added = '    thread_priority: 50\n    lock_memory: true\n    cpu_affinity: [0, 1]\n    require_real_time: false\n'
    assert parse_scene(scene.text.replace('ros__parameters:\n', f'ros__parameters:\n{added}')).hash == scene.hash


@pytest.mark.parametrize(('value', 'cores'), [(-1, ()), (1, (1,)), ([1, 0, 1], (0, 1)), ((2,), (2,))])
def test_cores_are_one_or_a_list(value: object, cores: tuple[int, ...]) -> None:
    from stickslip_sim.ros.node.listed_parameters import cores_of
    assert cores_of(value) == cores


@pytest.mark.parametrize('value', ['1', 1.0, True, [], [0, -1], [0.5], None, -2])
def test_what_is_no_core_is_refused(value: object) -> None:
    from stickslip_sim.ros.node.listed_parameters import cores_of
    with pytest.raises(InputError, match='cpu_affinity'):
        cores_of(value)
