"""Where commands come in: what arrives goes into the slots of the step loop, and what is refused is told."""

from collections.abc import Callable

from rclpy.node import Node
from sensor_msgs.msg import JointState

from ..commands import CommandSlot
from ..errors import InputError
from ..recording import topics as names
from .joints import DRIVE, commanded_velocity, disregarded
from .topics import command_subscription, subscription

_QUIET = 1_000_000_000   # ns between two warnings of refused commands of a kind


class Inlet:
    """Listens to the topics of commands; `now` is the steady clock of the step loop, ns."""

    def __init__(self, node: Node, velocity: CommandSlot, force: CommandSlot, now: Callable[[], int],
                 with_joints: bool) -> None:
        self._log, self._now = node.get_logger(), now
        self._velocity = velocity
        self._quiet_until: dict[str, int] = {}   # by kind of command
        command_subscription(node, names.DRIVE_VELOCITY, lambda value: self._take(velocity, value))
        command_subscription(node, names.EXTERNAL_FORCE, lambda value: self._take(force, value))
        if with_joints:
            subscription(node, names.JOINT_COMMANDS, self._take_joints)

    def _take(self, slot: CommandSlot, value: float) -> None:
        self._tell(slot, slot.offer(value, self._now()))

    def _take_joints(self, message: JointState) -> None:
        try:
            velocity = commanded_velocity(message)
        except InputError as error:
            self._tell(self._velocity, self._velocity.refuse(str(error)))
            return
        self._take(self._velocity, velocity)
        if other := disregarded(message):
            self._log.warning(f'joint_commands: {other} is disregarded; the velocity of {DRIVE} counts', once=True)

    def _tell(self, slot: CommandSlot, refusal: str) -> None:
        now = self._now()
        if refusal and now >= self._quiet_until.get(slot.name, now):
            self._quiet_until[slot.name] = now + _QUIET
            self._log.warning(refusal)
