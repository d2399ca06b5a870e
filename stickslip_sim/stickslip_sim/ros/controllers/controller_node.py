# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The node of an example controller: measurements in on `joint_states`, drive velocities out on `joint_commands`.

It acts on each measurement, and the stamp of that is its time.  So it goes with the bench in real time, in lock-step
and as fast as possible alike, with `use_sim_time` or without.
"""

import math
import time
from collections.abc import Sequence
from typing import Any

from rclpy.clock import Clock, ClockType
from sensor_msgs.msg import JointState
from std_srvs.srv import Trigger

from ...controllers import MoveProgress
from ...core.errors import InputError
from ...core.time_grid import NANOSECONDS
from ...recording.topics import JOINT_COMMANDS, JOINT_STATES
from ...rig import Measured
from ...scene.schema import JOINT_PREFIX
from ..node.endpoints import publisher, subscription
from ..node.joints import JointNames
from ..node.listed_parameters import ListedNode
from ..process.given_parameters import GivenParameters
from ..services.answers import answer
from .controller_parameters import COMMON, COMPENSATION, following, model_of

_REPORT_PERIOD = 1.0   # s
_STOPS, _STOP_PAUSE = 5, 0.02    # s between them


class ControllerNode(ListedNode):
    """Follows its moves with the drive of the bench; raises InputError when its parameters are wrong."""

    def __init__(self, name: str, compensates: bool, given: GivenParameters) -> None:
        super().__init__(name, (*COMMON, *(COMPENSATION if compensates else ())), given)
        self._model = model_of(self.values)     # once: what its file says later is for the next start
        self._following = following(self.values, self._model)
        self._progress: MoveProgress | None = None
        self._heard = self._refused = self._limited = 0    # measurements and commands since the last report
        self._refusal = ''
        self._is_deaf = False
        self._joints = JointNames.of(str(self.values[JOINT_PREFIX.name] or ''))
        self._command = JointState(name=[self._joints.drive], velocity=[0.0])
        self._commands_out = publisher(self, JOINT_COMMANDS)
        subscription(self, JOINT_STATES, self._hear)
        self.create_service(Trigger, '~/restart', self._restart)
        self.create_timer(_REPORT_PERIOD, self._report, clock=Clock(clock_type=ClockType.STEADY_TIME))

    def begin(self) -> None:
        """Say what it is about to do."""
        moves = self._following.moves
        self.get_logger().info(f'moves of {moves.travel:g} m at {moves.peak:g} m/s, with the first {JOINT_STATES.name}')

    def end(self) -> None:
        """Let the drive stop, if it was moved; said several times, for best effort may lose what is said last."""
        if self._progress is not None:
            for _ in range(_STOPS):
                self._send(0.0)
                time.sleep(_STOP_PAUSE)

    def values_changed(self) -> None:
        """Go on with other gains."""
        self._following = following(self.values, self._model)

    def _hear(self, message: JointState) -> None:
        self._heard += 1
        try:
            measured = measurement(message, self._joints)
        except InputError as error:
            self._refused += 1
            self._refusal = str(error)
            return
        stamp = message.header.stamp
        its = self._following.answer(self._progress, stamp.sec * NANOSECONDS + stamp.nanosec, measured)
        if its.is_new:
            self.get_logger().info(f'the moves begin at {measured.slider_position:g} m')
        self._progress = its.progress
        self._limited += its.command.is_limited
        self._command.header.stamp = stamp
        self._send(its.command.velocity)

    def _send(self, velocity: float) -> None:
        self._command.velocity[0] = velocity
        self._commands_out.publish(self._command)

    def _restart(self, _: Any, response: Any) -> Any:
        self._progress = None
        return answer(response, True, 'the moves begin anew with the next measurement')

    def _report(self) -> None:
        """Log once a second what went wrong in it; silence is logged once."""
        log = self.get_logger()
        if self._heard == 0 and not self._is_deaf:
            log.warning(f'no {self.resolve_topic_name(JOINT_STATES.name)}: does the axis run, in this namespace, and'
                        ' with joint_interface.enabled?')
        self._is_deaf = self._heard == 0
        if self._refused:
            log.warning(f'{self._refused} measurements refused, the last: {self._refusal}')
        if self._limited:
            log.warning(f'{self._limited} commands held back by max_velocity'
                        f' ({self._following.controller.max_velocity:g} m/s)')
        self._heard = self._refused = self._limited = 0


def measurement(message: JointState, names: JointNames) -> Measured:
    """Return what joint states say of both ends of the spring; raises InputError when that is not all there."""
    slider, drive = (_state_of(message, joint) for joint in names.joints)
    return Measured(*slider, *drive)


def _state_of(message: JointState, joint: str) -> Sequence[float]:
    """Return position and velocity of a joint."""
    if joint not in message.name:
        raise InputError('name', list(message.name), f'with {joint} in it', f'{joint} is what this controller needs')
    place = message.name.index(joint)
    if place >= len(message.position) or place >= len(message.velocity):
        raise InputError(joint, (len(message.position), len(message.velocity)), 'given with position and velocity',
                         'both arrays must be as long as name')
    state = message.position[place], message.velocity[place]
    if not all(map(math.isfinite, state)):
        raise InputError(joint, state, 'of finite position and velocity', 'is the encoder lost?')
    return state
