"""/clock: simulation time as the time of the ROS graph, where no real clock moves it."""

from collections.abc import Sequence

from rcl_interfaces.msg import SetParametersResult
from rclpy.node import Node
from rclpy.parameter import Parameter
from rosgraph_msgs.msg import Clock

from ..errors import InputError
from ..pacing import Grid
from ..recording.topics import CLOCK
from ..rig import Product
from .conversion import set_stamp
from .topics import publisher

_FOLLOW = 'use_sim_time'


class ClockOut:
    """Publishes the time of a step once its state is out, `rate` times per second of simulation time.

    Raises InputError when the node itself goes by the time of the graph, and lets it not do so later.
    """

    def __init__(self, node: Node, grid: Grid, rate: float) -> None:
        _check_follows_none([node.get_parameter(_FOLLOW)])
        node.add_on_set_parameters_callback(_refuse_to_follow)
        self._publish = publisher(node, CLOCK).publish
        self._message = Clock()
        self._steps, self._ticks = grid, Grid(rate)
        self._next = 0

    def take(self, product: Product) -> None:
        """Publish, if a tick falls on the end of this step or into it."""
        if product.step == 0:
            self._next = 0
        now = self._steps.instant(product.step)
        if now >= self._ticks.instant(self._next):
            set_stamp(self._message.clock, now.nanoseconds)
            self._publish(self._message)
            while self._ticks.instant(self._next) <= now:
                self._next += 1


def _check_follows_none(parameters: Sequence[Parameter]) -> None:
    if any(parameter.name == _FOLLOW and parameter.value for parameter in parameters):
        raise InputError(_FOLLOW, True, 'false with time.mode lockstep or free_run',
                         'the node would wait for the /clock that it makes itself: set it on the other nodes')


def _refuse_to_follow(parameters: Sequence[Parameter]) -> SetParametersResult:
    try:
        _check_follows_none(parameters)
    except InputError as error:
        return SetParametersResult(successful=False, reason=str(error))
    return SetParametersResult(successful=True)
