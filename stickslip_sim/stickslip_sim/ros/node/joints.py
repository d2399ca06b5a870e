# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The axis as joints, for ros2_control's topic-based hardware interface: its states out, its commands in.

What that interface sends, and when it keeps silent, is in docs/ros2_control.md with the sources.
"""

import struct
from typing import NamedTuple

import numpy as np
from rclpy.node import Node
from sensor_msgs.msg import JointState

from ...bags.topics import JOINT_COMMANDS, JOINT_STATES
from ...core.errors import InputError
from ...core.time_grid import NANOSECONDS
from ...recording import MessageCodec
from ...recording.messages import header
from ...simulation import Measured, StepResult
from .endpoints import publisher
from .publishers import Publishers

_CDR = b'\0\1\0\0'              # before the message: CDR, little endian
_HEAD, _NUMBERS = '<4siI', '2dI4x2dI4x2d'    # stamp; and at the end three arrays, the length of the first before them


class JointNames(NamedTuple):
    """The joints of an axis, in the order of its messages, and the link that their positions refer to, the bed."""

    slider: str = 'axis_slider'
    drive: str = 'axis_drive'
    bed: str = 'bed'

    @classmethod
    def of(cls, prefix: str) -> 'JointNames':
        """Return them with a prefix."""
        return cls(*(prefix + name for name in cls()))

    @property
    def joints(self) -> tuple[str, str]:
        """The joints."""
        return self.slider, self.drive


class JointStates:
    """Publishes what the encoders say at the end of a step; nothing when that measurement was lost."""

    def __init__(self, node: Node, publishers: Publishers, names: JointNames, depth: int = 0) -> None:
        out = publisher(node, JOINT_STATES, depth)
        self._publish, self._is_heard = out.publish, out.get_subscription_count
        self._publishers = publishers
        self._pack = JointStatePacker(names).pack

    def take(self, result: StepResult) -> None:
        """Publish, stamped as the state of this step, if anybody hears it."""
        if result.measured is not None and self._is_heard():
            stamp_ns = self._publishers.start_ns + result.sample.instant.nanoseconds
            self._publish(self._pack(stamp_ns, result.measured, result.sample.drive_force))


class JointStatePacker:
    """Makes the bytes of joint_states, of which only the stamp and the numbers change.

    Its frame is the bed, as joint_state_broadcaster gives one: RViz draws the efforts of messages with a frame only.
    The effort of a joint is the force of its actuator: of the slider, which has none, 0.
    """

    def __init__(self, names: JointNames) -> None:
        pair = np.zeros(2)
        pattern = MessageCodec([JOINT_STATES.type]).encode(JOINT_STATES.type, {
            'header': header(0, names.bed), 'name': list(names.joints), 'position': pair, 'velocity': pair,
            'effort': pair})
        self._names = pattern[struct.calcsize(_HEAD):-struct.calcsize(f'<{_NUMBERS}')]
        self._struct = struct.Struct(f'{_HEAD}{len(self._names)}s{_NUMBERS}')

    def pack(self, stamp_ns: int, measured: Measured, drive_force: float) -> bytes:
        """Return the CDR bytes of the message with a stamp (ns) and the force in the drive (N)."""
        return self._struct.pack(
            _CDR, *divmod(stamp_ns, NANOSECONDS), self._names,
            measured.slider_position, measured.drive_position, 2,
            measured.slider_velocity, measured.drive_velocity, 2, 0.0, drive_force)


def commanded_velocity(message: JointState, names: JointNames) -> float:
    """Return the velocity for the drive, m/s, NaN where the sender has none yet.

    With fewer velocities than names the one is that of the drive, the only joint that takes a velocity.  Raises
    InputError on joints that are not of this axis, on arrays of other lengths, and on a message without a velocity.
    """
    given, velocities = list(message.name), message.velocity
    _check_names(given, names)
    if not velocities:
        others = [field for field in ('position', 'effort') if getattr(message, field)]
        raise _refusal('velocity', [], f'that of {names.drive}', f'{" and ".join(others) or "nothing"} came instead:'
                       f' give {names.drive} a velocity command interface')
    if len(velocities) not in (1, len(given)):
        raise _refusal('velocity', list(velocities), f'one for each of {", ".join(given)}, or that of {names.drive}'
                       ' alone', 'the arrays of a message go with its names')
    velocity: float = velocities[given.index(names.drive) if len(velocities) == len(given) else 0]
    return velocity


def disregarded(message: JointState, names: JointNames) -> str:
    """Return what a message asks for beside a velocity of the drive, which nothing here follows, or ''."""
    parts = [field for field in ('position', 'effort') if any(value == value for value in getattr(message, field))]
    if len(message.velocity) == 2 and abs(message.velocity[message.name.index(names.slider)]) > 0.0:
        parts.append(f'velocity of {names.slider}')
    return ' and '.join(parts)


def _check_names(given: list[str], names: JointNames) -> None:
    unknown = [name for name in given if name not in names.joints]
    if unknown:
        raise _refusal('name', unknown, f'of {", ".join(names.joints)}', 'name the joints of this axis only')
    if names.drive not in given or len(set(given)) < len(given):
        raise _refusal('name', given, f'{names.drive}, alone or with {names.slider}, each once',
                       f'command {names.drive}')


def _refusal(field: str, value: object, allowed: str, fix: str) -> InputError:
    return InputError(f'{JOINT_COMMANDS.name}.{field}', value, allowed, fix)
