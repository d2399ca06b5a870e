# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Recordings of a real node, run again without ROS: with all that was ordered while it ran."""

import itertools
import math
import signal
from pathlib import Path

import pytest

from stickslip_sim.check.remake import checkpoint_of, doubts_about
from stickslip_sim.check.verification import Verdict, verify
from stickslip_sim.cli.main import run as tool
from stickslip_sim.core.errors import RecordingWarning
from stickslip_sim.recording import open_bag, read_run
from stickslip_sim.simulation import RigEventKind
from tests.support.rewritten_bags import rewritten
from tests.support.ros_nodes import Client, live_axis
from tests.support.waiting import wait_for

pytestmark = [pytest.mark.ros, pytest.mark.slow]

from stickslip_msgs.srv import InjectFault, Step  # noqa: E402

SETTINGS = ('command.timeout:=0.4', 'command.on_timeout:=fault', 'command.acceleration_limit:=1.0',
            'force.course:=sine', 'force.amplitude:=200.0', 'force.frequency:=7.0')


def stir(axis: Client) -> None:
    """Order something of every kind, some of it while the axis pauses."""
    inject(axis, 'dry', 'friction_scale', 0.05, 1.5)
    inject(axis, 'lost', 'command_loss', 0.0, 0.5)
    inject(axis, 'late', 'command_delay', 0.0, 0.03)
    inject(axis, 'knock', 'force_pulse', 0.1, 300.0, 0.05)
    for k in range(60):
        axis.send_velocity(0.002 + 1e-4 * k)
        axis.send_force(-10.0 * k)
        axis.next('slider_state')
    assert axis.set_parameters(axis__normal_force=4000.0, friction__static__limit=0.4).successful
    assert axis.switch('set_paused', True).success
    assert axis.call(InjectFault, 'inject_fault', id='dry', kind='clear').success
    assert axis.set_parameters(axis__mass=300.0).successful
    assert axis.switch('set_paused', False).success
    axis.next('slider_state', lambda state: state.drive_velocity == 0.0)    # the time-out
    axis.send_velocity(0.02)                                                # not taken
    assert axis.trigger('clear_faults').success
    keep_going(axis)
    drive_on(axis)
    inject(axis, '', 'drive_freeze', 0.02, 0.0, 0.1)
    inject(axis, 'wet', 'friction_scale', 0.3, 0.5, 0.5)                    # planned when the recording ends


def keep_going(axis: Client) -> None:
    """Command the drive, again and again, until the slider has let go and stuck: a command lasts for 0.4 s."""
    events = len(axis.heard['mode_event'])

    def has_moved() -> bool:
        if axis.latest('slider_state').drive_velocity == 0.0:    # a busy machine let it time out
            assert axis.trigger('clear_faults').success
        axis.send_velocity(0.006)
        return len(axis.heard['mode_event']) > events + 2

    wait_for(has_moved, 'events')


def drive_on(axis: Client) -> None:
    """Command the drive until it is heard to follow; each time another velocity, so that the last command counts."""
    velocities = itertools.count(100)

    def follows() -> bool:
        velocity = next(velocities) * 1e-4
        axis.send_velocity(velocity)
        state = axis.next('slider_state', lambda state: state.drive_velocity in (velocity, 0.0))
        if state.drive_velocity == velocity:
            return True
        assert axis.trigger('clear_faults').success    # a busy machine let it time out
        return False

    wait_for(follows, 'the velocity')


def inject(axis: Client, name: str, kind: str, start: float, value: float, duration: float = math.inf) -> None:
    answer = axis.call(InjectFault, 'inject_fault', id=name, kind=kind, start=start, duration=duration, value=value)
    assert answer.success, answer.message


def is_identical(verdict: Verdict) -> bool:
    return verdict.difference is None and verdict.missing == 0 and verdict.steps > 100 and verdict.events > 2


def test_from_the_start_then_in_mid_run_then_killed(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Three recordings of one node, each run again by itself."""
    with live_axis(*SETTINGS, 'record.enabled:=true', folder=tmp_path, namespace='/cell') as (process, axis):
        whole = Path(axis.latest('run_info').bag_path)
        stir(axis)
        assert axis.switch('record', False).success
        middle = begun(axis)
        begin = axis.next('slider_state').step
        axis.next('slider_state', lambda state: state.step > begin + 500)    # the fault that was planned has begun
        assert axis.trigger('clear_faults').success
        stir(axis)
        assert axis.switch('record', False).success
        last = begun(axis)
        written = axis.next('slider_state').step
        axis.send_force(5000.0)
        axis.next('slider_state', lambda state: state.step > written + 500)
        axis.send_force(-5000.0)
        axis.next('slider_state', lambda state: state.step > written + 1500)
        process.send(signal.SIGKILL)
        process.wait()
    first = verify(read_run(whole))
    assert is_identical(first), first
    assert {RigEventKind.COMMAND_TIMEOUT, RigEventKind.FAULT_CLEARED, RigEventKind.COMMAND_LOST} <= kinds(whole)
    recording = read_run(middle)
    checkpoint = checkpoint_of(recording)
    assert checkpoint is not None
    assert checkpoint['step'] >= first.steps - 1
    assert is_identical(verify(recording)), verify(recording)
    with pytest.warns(RecordingWarning, match='has no end'):
        killed = read_run(last)
    assert doubts_about(killed) == ('the recording has no end: cut off, or still being written',)
    assert is_identical(verify(killed)), verify(killed)
    every_order_counts(whole, tmp_path)
    what_if(whole, middle, capsys)


def every_order_counts(bag: Path, tmp_path: Path) -> None:
    """Leave out a single order of each kind: the run comes out different."""
    run = open_bag(bag)
    for topic in ('/cell/drive_velocity', '/cell/external_force', '/cell/rig_event', '/parameter_events'):
        last = [message.sequence for message in run.messages([topic]) if '/rig_event' not in topic
                or run.decode(message).kind == RigEventKind.COMMAND_TIMEOUT][-1]
        difference = verify(read_run(without(bag, topic, last, tmp_path))).difference
        assert difference is not None, topic
        assert difference.step >= last


def without(bag: Path, topic: str, step: int, tmp_path: Path) -> Path:
    """Return a copy of a bag without what was recorded on a topic before a step."""
    return rewritten(bag, tmp_path / topic.replace('/', '_'), message=lambda name, number, data: (
        None if (name, number) == (topic, step) else data))


def what_if(whole: Path, middle: Path, capsys: pytest.CaptureFixture[str]) -> None:
    for bag, change, code, reported in (
            (whole, 'initial.rest_time=0.5', 0, 'motion '), (whole, 'contact.model=rigid', 0, 'motion '),
            (middle, 'axis.mass=100.0', 0, 'motion '), (whole, 'time.rate=500.0', 2, 'its commands are counted'),
            (middle, 'initial.rest_time=0.5', 2, 'this recording begins in mid-run')):
        capsys.readouterr()
        assert tool(['verify', str(bag), '--set', change]) == code
        assert reported in ''.join(capsys.readouterr())


def begun(axis: Client) -> Path:
    """Begin a recording; return its folder."""
    answer = axis.switch('record', True)
    assert answer.success
    return Path(answer.message.removeprefix('recording into '))


def kinds(folder: Path) -> set[int]:
    run = open_bag(folder)
    return {int(kind) for kind in run.columns('rig_event')['kind']}


def test_in_lock_step_with_what_happened_in_the_same_gap(tmp_path: Path) -> None:
    """Between two steps: faults, parameters, the start of the recording, and more of both."""
    with live_axis('time.mode:=lockstep', 'scene:=paper_fig7', folder=tmp_path) as (_, axis):
        assert axis.call(Step, 'step', steps=1200, velocity=0.004, force=math.nan).success
        inject(axis, 'dry', 'friction_scale', 0.0, 1.7)
        inject(axis, 'lost', 'command_loss', 0.0, 0.5)
        assert axis.set_parameters(axis__normal_force=3000.0).successful
        folder = begun(axis)
        assert axis.call(InjectFault, 'inject_fault', id='dry', kind='clear').success
        assert axis.set_parameters(axis__normal_force=100.0).successful
        inject(axis, 'knock', 'force_pulse', 0.01, -700.0, 0.2)
        for k in range(40):
            assert axis.call(Step, 'step', steps=13, velocity=0.001 * k, force=7.0 * k).success
        assert axis.switch('record', False).success
    assert is_identical(verify(read_run(folder))), verify(read_run(folder))


def test_a_new_run_with_other_parameters(tmp_path: Path) -> None:
    """Changed while it pauses at its start, before and after the recording begins."""
    with live_axis('time.mode:=free_run', 'time.factor:=3.0', folder=tmp_path) as (_, axis):
        assert axis.switch('set_paused', True).success
        assert axis.trigger('reset').success
        assert axis.set_parameters(axis__normal_force=3000.0, friction__static__limit=0.45).successful
        inject(axis, 'knock', 'force_pulse', 0.0, -900.0, 0.2)
        folder = begun(axis)
        assert axis.set_parameters(axis__mass=200.0).successful
        assert axis.switch('set_paused', False).success
        axis.next('slider_state', lambda state: state.time > 3.0)
        assert axis.switch('record', False).success
    recording = read_run(folder)
    checkpoint = checkpoint_of(recording)
    assert checkpoint is not None
    assert checkpoint['step'] == 0
    assert is_identical(verify(recording)), verify(recording)
