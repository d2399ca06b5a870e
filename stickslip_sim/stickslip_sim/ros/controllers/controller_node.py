# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The node of an example controller: measurements in on `joint_states`, drive velocities out on `joint_commands`.

It acts on each measurement, and the stamp of that is its time.  So it goes with the bench in real time, in lock-step
and as fast as possible alike, with `use_sim_time` or without.
"""

import math
import time
from collections.abc import Callable, Mapping, Sequence
from typing import Any

from rclpy.clock import Clock, ClockType
from sensor_msgs.msg import JointState
from std_srvs.srv import Trigger

from ...axis import Axis
from ...bags.topics import JOINT_COMMANDS, JOINT_STATES
from ...controllers import BranchCompensation, Cascade, Controller, Following, MoveProgress, Moves
from ...core.errors import InputError
from ...core.time_grid import NANOSECONDS
from ...inputs import load_scene
from ...scene.load import named
from ...scene.parameter import Parameter
from ...scene.schema import JOINT_PREFIX
from ...simulation import Measured
from ..node.endpoints import publisher, subscription
from ..node.joints import JointNames
from ..node.parameters import ListedNode
from ..node.time_services import answer
from ..programs import GivenParameters

# The parameters of the example controllers: their list, and what they make.

_LEAST = 1e-12       # of what must not be zero
_MOVES, _GAINS = Moves(), Cascade()
_FIELDS = BranchCompensation.__dataclass_fields__

COMMON = (
    Parameter('moves.travel', 'double', _MOVES.travel, 'm', 'Travel of each move, out and back.', _LEAST, 1e3),
    Parameter('moves.feed', 'double', _MOVES.feed, 'm/s', 'Feed of the moves.', _LEAST, 1e3),
    Parameter('moves.acceleration', 'double', _MOVES.acceleration, 'm/s²', 'Acceleration to and from the feed.', 1e-9,
              1e6),
    Parameter('moves.dwell', 'double', _MOVES.dwell, 's', 'Rest after each move.', 0.0, 1e6),
    Parameter('position_gain', 'double', _GAINS.position_gain, '1/s', 'Gain K_v of the position loop.', 0.0, 1e4,
              live=True),
    Parameter('velocity_gain', 'double', _GAINS.velocity_gain, '', 'Gain K_p of the velocity loop.', 0.0, 1e4,
              live=True),
    Parameter('integral_time', 'double', _GAINS.integral_time, 's', 'Integral time T_n of the velocity loop; .inf'
              ' disables it.', 1e-6, 1e6, infinite=True, live=True),
    Parameter('max_velocity', 'double', 1.0, 'm/s', 'Largest commanded drive velocity; the integrator does not wind up'
              ' beyond it.', 1e-9, 1e6),
    Parameter('max_gap', 'double', 0.5, 's', 'Longest gap between two measurements; after a longer one the moves'
              ' restart.', 1e-6, 1e6),
    JOINT_PREFIX,
)
COMPENSATION = (
    Parameter('compensation.model', 'string', 'positioning', '', 'Scene, shipped or a file, whose axis models spring'
              ' and friction.'),
    Parameter('compensation.share', 'double', _FIELDS['share'].default, '', 'Share of the gap between the friction'
              ' branches to compensate.', 0.0, 1.0, live=True),
    Parameter('compensation.rate', 'double', _FIELDS['rate'].default, '1/s', 'Rate of crossing that gap.', 0.0, 1e4,
              live=True),
    Parameter('compensation.threshold', 'double', _FIELDS['threshold'].default, 'm/s', 'Velocity error above which'
              ' the compensation acts in full.', _LEAST, 1e3, live=True),
)


def model_of(values: Mapping[str, object]) -> Axis | None:
    """Return the axis that the compensation takes for its model; raises InputError when it is no scene."""
    model = values.get('compensation.model')
    if model is None:
        return None
    with named('compensation.model'):
        return load_scene(str(model)).axis


def following(values: Mapping[str, object], model: Axis | None) -> Following:
    """Return the controller, which compensates friction if it has a model, and its moves."""
    of = {name: value for name, value in values.items() if isinstance(value, float)}
    moves = Moves(of['moves.travel'], of['moves.feed'], of['moves.acceleration'], of['moves.dwell'])
    cascade = Cascade(of['position_gain'], of['velocity_gain'], of['integral_time'])
    compensation = BranchCompensation(model, of['compensation.share'], of['compensation.rate'],
                                      of['compensation.threshold']) if model else None
    return Following(Controller(cascade, compensation, of['max_velocity']), moves, of['max_gap'])


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
        """Let the drive stop, if it was moved."""
        if self._progress is not None:
            repeatedly(lambda: self._send(0.0))

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


def repeatedly(send: Callable[[], None]) -> None:
    """Send several times: best effort may lose what is sent last."""
    for _ in range(_STOPS):
        send()
        time.sleep(_STOP_PAUSE)


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
