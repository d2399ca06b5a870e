# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The axis as joints, for ros2_control's topic-based hardware interface: its states out, its commands in.

What that interface sends, and when it keeps silent, is in docs/ros2_control.md with the sources.
"""

import struct

import numpy as np
from rclpy.node import Node
from sensor_msgs.msg import JointState

from ...core.errors import InputError
from ...core.time_grid import NANOSECONDS
from ...recording import MessageCodec
from ...recording.messages import header
from ...recording.topics import JOINT_COMMANDS, JOINT_STATES
from ...rig import Measured, StepResult
from .endpoints import publisher
from .publishers import Publishers

SLIDER, DRIVE = 'axis_slider', 'axis_drive'
JOINTS = (SLIDER, DRIVE)
_CDR = b'\0\1\0\0'              # before the message: CDR, little endian
_HEAD, _NUMBERS = '<4siI', '2dI4x2dI4x2d'    # stamp; and at the end three arrays, the length of the first before them


class JointStates:
    """Publishes what the encoders say at the end of a step; nothing when that measurement was lost."""

    def __init__(self, node: Node, publishers: Publishers, depth: int = 0) -> None:
        out = publisher(node, JOINT_STATES, depth)
        self._publish, self._is_heard = out.publish, out.get_subscription_count
        self._publishers = publishers
        self._pack = JointStatePacker().pack

    def take(self, result: StepResult) -> None:
        """Publish, stamped as the state of this step, if anybody hears it."""
        if result.measured is not None and self._is_heard():
            stamp_ns = self._publishers.start_ns + result.sample.instant.nanoseconds
            self._publish(self._pack(stamp_ns, result.measured, result.sample.drive_force))


class JointStatePacker:
    """Makes the bytes of joint_states, of which only the stamp and the numbers change.

    The effort of a joint is the force of its actuator: of the slider, which has none, 0.
    """

    def __init__(self) -> None:
        pair = np.zeros(len(JOINTS))
        pattern = MessageCodec([JOINT_STATES.type]).encode(JOINT_STATES.type, {
            'header': header(0), 'name': list(JOINTS), 'position': pair, 'velocity': pair, 'effort': pair})
        self._names = pattern[struct.calcsize(_HEAD):-struct.calcsize(f'<{_NUMBERS}')]
        self._struct = struct.Struct(f'{_HEAD}{len(self._names)}s{_NUMBERS}')

    def pack(self, stamp_ns: int, measured: Measured, drive_force: float) -> bytes:
        """Return the CDR bytes of the message with a stamp (ns) and the force in the drive (N)."""
        return self._struct.pack(
            _CDR, *divmod(stamp_ns, NANOSECONDS), self._names,
            measured.slider_position, measured.drive_position, len(JOINTS),
            measured.slider_velocity, measured.drive_velocity, len(JOINTS), 0.0, drive_force)


def commanded_velocity(message: JointState) -> float:
    """Return the velocity for the drive, m/s, NaN where the sender has none yet.

    With fewer velocities than names the one is that of the drive, the only joint that takes a velocity.  Raises
    InputError on joints that are not of this axis, on arrays of other lengths, and on a message without a velocity.
    """
    names, velocities = list(message.name), message.velocity
    _check_names(names)
    if not velocities:
        given = [field for field in ('position', 'effort') if getattr(message, field)]
        raise _refusal('velocity', [], f'that of {DRIVE}', f'{" and ".join(given) or "nothing"} came instead: give '
                       f'{DRIVE} a velocity command interface')
    if len(velocities) not in (1, len(names)):
        raise _refusal('velocity', list(velocities), f'one for each of {", ".join(names)}, or that of {DRIVE} alone',
                       'the arrays of a message go with its names')
    velocity: float = velocities[names.index(DRIVE) if len(velocities) == len(names) else 0]
    return velocity


def disregarded(message: JointState) -> str:
    """Return what a message asks for beside a velocity of the drive, which nothing here follows, or ''."""
    parts = [field for field in ('position', 'effort') if any(value == value for value in getattr(message, field))]
    if len(message.velocity) == len(JOINTS) and abs(message.velocity[message.name.index(SLIDER)]) > 0.0:
        parts.append(f'velocity of {SLIDER}')
    return ' and '.join(parts)


def _check_names(names: list[str]) -> None:
    unknown = [name for name in names if name not in JOINTS]
    if unknown:
        raise _refusal('name', unknown, f'of {", ".join(JOINTS)}', 'name the joints of this axis only')
    if DRIVE not in names or len(set(names)) < len(names):
        raise _refusal('name', names, f'{DRIVE}, alone or with {SLIDER}, each once', f'command {DRIVE}')


def _refusal(field: str, value: object, allowed: str, fix: str) -> InputError:
    return InputError(f'{JOINT_COMMANDS.name}.{field}', value, allowed, fix)
