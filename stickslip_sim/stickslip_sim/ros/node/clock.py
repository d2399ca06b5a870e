# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""/clock: simulation time as the time of the ROS graph, where no real clock moves it; or the time of another node."""

from collections.abc import Callable

from rclpy.node import Node
from rosgraph_msgs.msg import Clock

from ...bags.topics import CLOCK
from ...core.errors import InputError
from ...core.time_grid import NANOSECONDS, Grid
from ...scene.model import TimeSettings
from ...simulation import StepResult
from .endpoints import publisher, set_stamp

_PATIENCE = 10 * NANOSECONDS


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


class ClockIn:
    """The /clock of another node with `use_sim_time`; `now` is the steady clock, ns."""

    def __init__(self, node: Node, now: Callable[[], int]) -> None:
        self._node, self._now = node, now
        self._last = 0    # moment to wait until
        self._heard = 0   # moment at which the time of the node was found to have come

    @property
    def age(self) -> int:
        """How old the time of the node is before the executor hears the next /clock, ns; 0 without `use_sim_time`."""
        return self._now() - self._heard if self._heard else 0

    def has_come(self) -> bool:
        """Return whether the node has a time; raises InputError after ten seconds without."""
        clock = self._node.get_clock()
        if clock.now().nanoseconds > 0:
            self._heard = self._now() if clock.ros_time_is_active else 0
            return True
        if not self._last:
            self._last = self._now() + _PATIENCE
            self._node.get_logger().info('use_sim_time: waiting for the first /clock')
        if self._now() > self._last:
            raise InputError('use_sim_time', True, f'with a /clock within {_PATIENCE / NANOSECONDS:g} s',
                             'start what publishes it, or set use_sim_time to false')
        return False


def check_sim_time(time: TimeSettings, wanted: object, now: object = None, has_clock: bool = True) -> str:
    """Return what to warn of with this `use_sim_time`, given at the start or in place of that of `now`.

    Raises InputError where there is no clock to follow.
    """
    if wanted and time.makes_clock:
        raise InputError('use_sim_time', wanted, f'false on this node with time.mode: {time.mode}',
                         'it publishes /clock itself: set use_sim_time on the nodes that should follow')
    if wanted and not has_clock:
        raise InputError('use_sim_time', wanted, 'false while no node publishes /clock', 'start that node first')
    if wanted == bool(now):
        return ''
    if now is not None:
        return f'use_sim_time: {str(wanted).lower()}: the stamps of the motion follow from the next ~/reset on'
    return 'use_sim_time with time.mode: realtime: stamps start from the /clock of another node, then keep real time'
