# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""A controller in process and the same one on a real node in lock-step: the same states, events, commands and bag."""

import json
from collections.abc import Mapping
from pathlib import Path
from types import MappingProxyType
from typing import Any, NamedTuple

import pytest

import stickslip_sim as stickslip
from stickslip_sim.bags import topics
from stickslip_sim.bags.topics import Topic
from stickslip_sim.check.verification import verify
from stickslip_sim.recording import RecordedRun, read_run
from tests.support.own_controllers import Cascade
from tests.support.repository import ROOT

pytestmark = [pytest.mark.ros, pytest.mark.slow]

from tests.support.node_processes import ended_at_once  # noqa: E402
from tests.support.ros_nodes import live_axis  # noqa: E402

Changes = Mapping[str, Any]
DURATION = 0.4   # s
COMPARED = topics.SLIDER_STATE, topics.FRICTION_FORCE, topics.MODE_EVENT, topics.DRIVE_VELOCITY, topics.EXTERNAL_FORCE


class Case(NamedTuple):
    """A node with changes to a scene; what is changed while it runs, if anything, before it is driven once more."""

    scene: str
    changes: Changes
    live: Changes = MappingProxyType({})
    rate: float = 1000.0    # Hz, at which the controller is asked
    pushes: bool = False    # commands a force


def faults(*given: tuple[str, float, float, float]) -> Changes:
    kinds, starts, durations, values = zip(*given)
    return {'faults.ids': [f'f{k}' for k in range(len(kinds))], 'faults.kinds': list(kinds),
            'faults.starts': list(starts), 'faults.durations': list(durations), 'faults.values': list(values)}


CASES = {
    'counted': Case('paper_fig7', {
        'encoder.resolution': 1e-6, 'encoder.delay': 0.003, 'encoder.noise': 2e-7, 'encoder.velocity_steps': 4,
        **faults(('encoder_dropout', 0.0, 0.2, 0.3), ('encoder_freeze', 0.1, 0.02, 0.0),
                 ('encoder_step', 0.2, 0.1, 1e-5))}, {'axis.drive_stiffness': 9e5}),
    'channel': Case('paper_fig8', {
        'command.velocity_limit': 0.03, 'command.acceleration_limit': 2.0,
        **faults(('command_loss', 0.05, 0.2, 0.4), ('command_delay', 0.15, 0.1, 0.004))}, {'friction.scale': 1.3}),
    'watched': Case('micro_feed', {
        'command.timeout': 0.005, 'command.on_timeout': 'ramp_to_zero', 'encoder.resolution': 1e-8,
        **faults(('command_loss', 0.1, 0.2, 0.5), ('drive_freeze', 0.3, 0.03, 0.0))}, rate=250.0),
    'pushed': Case('paper_fig8', {
        'time.rate': 2000.0, 'solver.name': 'fixed_step', 'solver.method': 'rk4', 'solver.step': 1e-4,
        'encoder.delay': 0.002, **faults(('encoder_dropout', 0.1, 0.3, 1.0), ('friction_scale', 0.1, 0.1, 0.6),
                                         ('force_pulse', 0.15, 0.1, -300.0))},
        rate=500.0, pushes=True),
}


def recorded(run: RecordedRun, topic: Topic, is_decoded: bool = False) -> list[tuple[int, int, Any]]:
    """Return the messages of a topic with their steps and times: as bytes, or their fields (ROS pads some of them)."""
    return [(message.sequence, message.log_time, str(run.bag.decode(message)) if is_decoded else message.data)
            for message in run.bag.messages([run.bag.name_of(topic)])]


def drive(case: Case, setpoint: Path) -> None:
    """Let `controller_node` drive the axis from a reset on."""
    own = ROOT / 'tests/support/own_controllers.py'
    options = ('--controller', f'{own}:Cascade', '--gain', f'pushes={case.pushes}', '--rate', f'{case.rate:g}',
               f'--setpoint={setpoint}', f'--duration={DURATION}')
    code, errors = ended_at_once('controller_node', options=options)
    assert code == 0, errors
    assert f'connected to /feed_axis: {case.scene}, ' in errors
    assert errors.splitlines()[-1].endswith(f't = {DURATION:g} s')


@pytest.mark.parametrize('name', CASES)
def test_is_the_run_of_a_node_in_lock_step_to_the_last_bit(name: str, tmp_path: Path) -> None:
    """And so is a second one with other parameters, in the bag that its reset begins."""
    case = CASES[name]
    runs: dict[str, Changes] = {'run': {}, 'run_2': case.live} if case.live else {'run': {}}
    setpoint = tmp_path / 'move.csv'
    setpoint.write_text('time,position [mm]\n0,0\n0.3,1.3\n0.5,1.3\n')
    changes = {**case.changes, 'record.folder': str(tmp_path / 'run'), 'record.each_reset': True}
    words = [f'{key}:={json.dumps(value)}' for key, value in changes.items()]
    with live_axis(f'scene:={case.scene}', 'time.mode:=lockstep', 'joint_interface.enabled:=true', *words,
                   folder=tmp_path) as (_, axis):
        drive(case, setpoint)
        if case.live:
            assert axis.set_parameters(**{key.replace('.', '__'): value for key, value in case.live.items()}).successful
            drive(case, setpoint)
    for run, live in runs.items():
        scene = stickslip.load_scene(case.scene, {**changes, **live})
        own = stickslip.close_loop(Cascade(case.pushes), scene, DURATION, case.rate, setpoint)
        own.save(tmp_path / f'own_{run}')
        mine, theirs = read_run(tmp_path / f'own_{run}'), read_run(tmp_path / run)
        assert theirs.scene == mine.scene == own.scene
        for topic in COMPARED:
            assert recorded(mine, topic) == recorded(theirs, topic), topic.name
        assert recorded(mine, topics.RIG_EVENT, True) == recorded(theirs, topics.RIG_EVENT, True)
        assert [(mark.label, round(mark.begin, 9), mark.number) for mark in own.marks] == [
            (mark.label, round(mark.begin, 9), mark.number) for mark in theirs.marks]
        again = verify(mine)
        assert (again.difference, again.steps) == (None, len(own.samples['time']))
