# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""/clock: simulation time as the time of the ROS graph, where no real clock moves it."""

from rclpy.node import Node
from rosgraph_msgs.msg import Clock

from ...core.errors import InputError
from ...core.time_grid import Grid
from ...recording.topics import CLOCK
from ...rig import StepResult
from ...scene.model import TimeSettings
from .conversion import set_stamp
from .endpoints import publisher


class ClockOut:
    """Publishes the time of a step once its state is out, `rate` times per second of simulation time."""

    def __init__(self, node: Node, grid: Grid, rate: float) -> None:
        self._publish = publisher(node, CLOCK).publish
        self._message = Clock()
        self._steps, self._ticks = grid, Grid(rate)
        self._next = 0

    def take(self, result: StepResult) -> None:
        """Publish, if a tick falls on the end of this step or into it."""
        if result.step == 0:
            self._next = 0
        now = self._steps.instant(result.step)
        if now >= self._ticks.instant(self._next):
            set_stamp(self._message.clock, now.nanoseconds)
            self._publish(self._message)
            while self._ticks.instant(self._next) <= now:
                self._next += 1


def check_sim_time(time: TimeSettings, wanted: object) -> str:
    """Return what to warn of with this `use_sim_time`; raises InputError where the node would follow its own clock."""
    if not wanted:
        return ''
    if time.makes_clock:
        raise InputError('use_sim_time', wanted, f'false on this node with time.mode: {time.mode}',
                         'it publishes /clock itself: set use_sim_time on the nodes that should follow')
    return 'use_sim_time with time.mode: realtime: stamps start from the /clock of another node, then keep real time'
