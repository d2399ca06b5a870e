# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Small runs to begin with: one of the tool, and one with everything that a node records."""

from collections.abc import Iterable
from pathlib import Path
from typing import Any

import numpy as np

from stickslip_sim.bags import topics
from stickslip_sim.bags.bag import BagWriter
from stickslip_sim.core.types import EventKind
from stickslip_sim.inputs import load_scene
from stickslip_sim.recording import MessageCodec, RunFacts, checkpoint_file, open_run, receipt_file, write_bag
from stickslip_sim.recording.messages import Packer, header, time_message
from stickslip_sim.runs import simulate
from stickslip_sim.scene import Scene, changed
from stickslip_sim.simulation import Fault, Rig, RigEvent

_STEPS = 12
_PLACES = {topic: place for place, topic in enumerate(topics.RECORDED)}
_CODEC = [topics.RIG_EVENT.type, topics.PARAMETER_EVENTS.type, topics.DRIVE_VELOCITY.type]
_SCENE = {'time.rate': 50.0, 'initial.rest_time': 0.0, 'drive.velocity': 0.02}


def files(folder: Path) -> list[bytes]:
    """Record both runs in a folder; return their files."""
    return [next(record(folder / name).glob('*.mcap')).read_bytes()
            for name, record in (('tool', _of_the_tool), ('node', _of_a_node))]


def _of_the_tool(folder: Path) -> Path:
    scene = load_scene('paper_fig8', _SCENE)
    run = simulate(scene, _STEPS / scene.time.rate, scene.time.step)
    write_bag(folder, RunFacts.of(scene, run.duration, scene.time.step), run.sample_rows(), run.events, run.receipt)
    return folder


def _of_a_node(folder: Path) -> Path:
    """Record from mid-run: a checkpoint, a command, a fault and a changed parameter, then steps."""
    scene = load_scene('paper_fig8', _SCENE)
    rig = scene.make_rig()
    for _ in range(_STEPS):
        rig.make_step()
    writer = open_run(folder, RunFacts.of(scene))
    writer.attach(checkpoint_file(rig.checkpoint()))
    tape = _Tape(writer)
    tape.order(rig, scene)
    for _ in range(_STEPS):
        tape.step(rig)
    writer.close(receipt_file({'timing': {'valid': True, 'verdict': 'kept'}, 'dropped_messages': 0}))
    return folder


class _Tape:
    """Writes what a node would."""

    def __init__(self, writer: BagWriter) -> None:
        self._writer = writer
        self._velocity: float | None = None    # of the next step, m/s
        self._codec = MessageCodec(_CODEC)
        self._packers = {topic: Packer(topic) for topic in (topics.SLIDER_STATE, topics.FRICTION_FORCE,
                                                            topics.MODE_EVENT)}

    def order(self, rig: Rig, scene: Scene) -> None:
        """Order one thing of every kind before the next step."""
        at, step = rig.time_ns, rig.step + 1
        self._velocity = 0.03
        self._encoded(topics.DRIVE_VELOCITY, {'header': header(at), 'velocity': self._velocity}, at, step)
        rig.change_axis(changed(scene, {'axis.mass': 300.0}).axis)
        self._encoded(topics.PARAMETER_EVENTS, _parameter_event(at, 'axis.mass', 300.0), at, step)
        rig.inject(Fault('dry', 'friction_scale', 0.04, 0.1, 1.5))

    def step(self, rig: Rig) -> None:
        """Make a step and write what came of it."""
        before = rig.time_ns
        result, self._velocity = rig.make_step(self._velocity), None
        self._rig_events(result.rig_events, before, result.step)
        for event in result.events:
            if event.kind == EventKind.KNOT:    # a node does not publish them
                continue
            at = event.instant.nanoseconds
            self._write(topics.MODE_EVENT, self._packers[topics.MODE_EVENT].pack(at, result.step, event), at,
                        result.step)
        for topic in (topics.SLIDER_STATE, topics.FRICTION_FORCE):
            at = result.sample.instant.nanoseconds
            self._write(topic, self._packers[topic].pack(at, result.step, result.sample), at, result.step)

    def _rig_events(self, rig_events: Iterable[RigEvent], at: int, step: int) -> None:
        for event in rig_events:
            fault = event.fault or Fault('', '', 0.0, 0.0, 0.0)
            self._encoded(topics.RIG_EVENT, {
                'header': header(at), 'step': step, 'time': at * 1e-9, 'kind': int(event.kind), 'id': event.id,
                'fault': fault.kind, 'start': fault.start, 'duration': fault.duration, 'value': event.value,
                'count': event.number, 'text': event.text}, at, step)

    def _encoded(self, topic: topics.Topic, fields: dict[str, Any], at: int, step: int) -> None:
        self._write(topic, self._codec.encode(topic.type, fields), at, step)

    def _write(self, topic: topics.Topic, data: bytes, at: int, step: int) -> None:
        self._writer.write(_PLACES[topic], data, at, at, step)


def _parameter_event(at: int, name: str, value: float) -> dict[str, Any]:
    empty = {f'{kind}_array_value': np.array([], dtype) for kind, dtype in (
        ('byte', np.uint8), ('bool', np.bool_), ('integer', np.int64), ('double', np.float64))}
    given = {'type': 3, 'bool_value': False, 'integer_value': 0, 'double_value': value, 'string_value': '',
             'string_array_value': [], **empty}
    return {'stamp': time_message(at), 'node': '/feed_axis', 'new_parameters': [], 'deleted_parameters': [],
            'changed_parameters': [{'name': name, 'value': given}]}
