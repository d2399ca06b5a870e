# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Runs of the node in real time in which everything happens that a bag can hold."""

from collections.abc import Iterator
from contextlib import contextmanager
from functools import partial
from pathlib import Path

from tests.support.node_processes import recording_into
from tests.support.ros_nodes import Client, live_axis
from tests.support.waiting import wait_for

from stickslip_msgs.srv import InjectFault  # isort: skip


@contextmanager
def eventful_run(folder: Path, *arguments: str) -> Iterator[Client]:
    """Record commands, faults, changed parameters and transitions; let the caller look before the bag is closed."""
    with live_axis(*recording_into(folder), *arguments) as (_, axis):
        for velocity in (0.004, -0.003, 0.002):
            axis.send_velocity(velocity)
            wait_for(partial(_follows, axis, velocity), 'the command in force')
        assert axis.call(InjectFault, 'inject_fault', id='dry', kind='friction_scale', start=0.05, duration=9.0,
                         value=1.5).success
        assert axis.call(InjectFault, 'inject_fault', kind='force_pulse', start=0.2, duration=0.1, value=500.0).success
        axis.send_force(300.0)
        assert axis.set_parameters(axis__mass=300.0).successful
        pulse_is_over = axis.now() + 0.3
        axis.next('mode_event')
        axis.next('slider_state', lambda state: state.time > pulse_is_over)
        assert axis.call(InjectFault, 'inject_fault', id='dry', kind='clear').success
        assert axis.trigger('clear_faults').success
        axis.send_force(0.0)
        axis.next('timing')
        yield axis


def _follows(axis: Client, velocity: float) -> bool:
    return bool(axis.latest('slider_state').drive_velocity == velocity)
