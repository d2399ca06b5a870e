# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Recorded runs made again by a rig: from the commands, parameters and faults in the bag, by their steps."""

from collections import defaultdict
from typing import Any

import numpy as np

from stickslip_sim.recording import Bag
from stickslip_sim.scene import Scene, scene_from_values
from stickslip_sim.simulation import Fault, RigEventKind, StepResult
from tests.support.rigs import Order, Script, force, run, velocity

FIELDS = ('time', 'position', 'velocity', 'acceleration', 'drive_position', 'drive_velocity', 'drive_force',
          'rest_time', 'mode', 'direction')


def orders_of(recorded: Bag, scene: Scene) -> Script:
    """Return the orders of a bag, by the step before which they came."""
    orders: dict[int, list[Order]] = defaultdict(list)
    values = dict(scene.values)
    for message in recorded.messages(['/drive_velocity', '/external_force', '/parameter_events', '/rig_event']):
        content = recorded.decode(message)
        if message.topic == '/parameter_events':
            values |= {changed.name: changed.value.double_value for changed in content.changed_parameters}
            orders[message.sequence].append(_change(scene_from_values(values)))
        elif message.topic == '/rig_event':
            orders[message.sequence] += _of_event(content)
        else:
            orders[message.sequence].append(_command(content))
    return orders


def made_again(recorded: Bag, scene: Scene) -> list[StepResult]:
    """Return what a rig makes of the orders of a bag, over as many steps."""
    return run(scene.make_rig(), recorded.counts['/slider_state'], orders_of(recorded, scene))


def assert_same_states(recorded: Bag, results: list[StepResult]) -> None:
    """Compare the states of a bag with those of a rig, bit by bit."""
    states = recorded.columns('/slider_state')
    assert list(states['step']) == [result.step for result in results]
    for name in FIELDS:
        ours = np.array([getattr(result.sample, name) for result in results])
        np.testing.assert_array_equal(states[name], ours, err_msg=name)


def rig_events_in(recorded: Bag, *kinds: RigEventKind) -> list[Any]:
    """Return the rig events of some kinds in a bag."""
    return [event for event in map(recorded.decode, recorded.messages(['/rig_event'])) if event.kind in kinds]


def _command(message: Any) -> Order:
    if hasattr(message, 'velocity'):
        return velocity(message.velocity)
    return force(message.force)


def _change(scene: Scene) -> Order:
    return lambda rig: rig.change_axis(scene.axis)


def _of_event(event: Any) -> list[Order]:
    if event.kind == RigEventKind.FAULT_INJECTED:
        return [lambda rig: rig.inject(Fault(event.id, event.fault, event.start, event.duration, event.value))]
    if event.kind == RigEventKind.FAULT_CLEARED:
        return [lambda rig: rig.clear_fault(event.id)]
    if event.kind == RigEventKind.COMMAND_TIMEOUT:
        return [lambda rig: rig.time_out(event.value)]
    return []
