# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The node of a controller of the user: `close_loop` with a live axis, in lock-step or in real time.

In lock-step it makes the steps, with the bits of `close_loop`.  Else it is asked as each state comes with its
measurement, which is lost when the next state comes before it.
"""

from collections import deque
from collections.abc import Callable, Sequence
from typing import Any

from rclpy.clock import Clock, ClockType
from sensor_msgs.msg import JointState

from stickslip_msgs.msg import DriveVelocity, ExternalForce, SliderState

from ...bags.topics import DRIVE_VELOCITY, EXTERNAL_FORCE, JOINT_STATES, SLIDER_STATE
from ...closed_loop.loop import as_setpoints, own_controller, setpoints_at, steps_between, steps_of
from ...controllers import Setpoint
from ...controllers.own_controller import Command, Measurement, OwnController, load_controller, parse_gain
from ...core.errors import InputError
from ...core.time_grid import Grid
from ...simulation import Measured
from ..lock_step import LockStep
from ..node.endpoints import publisher, subscription
from ..node.joints import JointNames
from ..node.parameters import ListedNode
from ..programs import GivenParameters
from .controller_node import measurement, repeatedly

_NOTHING = Measured(0.0, 0.0, 0.0, 0.0)    # before the first measurement
_MOST = 100                                # measurements that wait for their state
_REPORT_PERIOD = 2.0                       # s


class OwnControllerNode(ListedNode):
    """Asks the controller that the command line names; `is_over` is asked while it waits.

    Raises InputError on what is wrong there or with the axis, ControllerError on a controller that goes wrong.
    """

    def __init__(self, given: GivenParameters, is_over: Callable[[], bool]) -> None:
        single = dict(given.options)
        gains = dict(parse_gain(value) for name, value in given.options if name == '--gain')
        if '--controller' not in single:
            raise InputError('--controller', None, 'FILE.py:NAME', 'name the class or function of your controller')
        self._controller = load_controller(single['--controller'], gains)
        self._rate, self._duration = (_number(single, name) for name in ('--rate', '--duration'))
        self._file = single.get('--setpoint')
        if self._file and self._duration is None:
            raise InputError('--duration', None, 'given with --setpoint, s', 'say how long to follow it')
        super().__init__('own_controller', (), given)
        self._axis, self._is_over = LockStep(self, is_over), is_over
        self._velocity_out = publisher(self, DRIVE_VELOCITY)
        self._force_out: Any = None
        self._unmeasured: deque[SliderState] = deque()    # states whose measurement is to come
        self._measured: dict[tuple[int, int], JointState] = {}
        self._first = self._latest = -1    # steps of the axis: the one that it began with, the latest that came
        self._next = 0                     # step of its own after which it is asked
        self._held: Measured | None = None
        self._heard = self._missed = 0     # states since the latest report; and those that came too fast
        self._is_silent = False

    def is_ready(self) -> bool:
        """Find the axis, and check what was given against its scene."""
        if not self._axis.connect():
            return False
        scene = self._axis.scene
        if not scene.rig.measures:
            raise InputError('joint_interface.enabled of the axis', False, 'true, for a controller that measures',
                             'start it with -p joint_interface.enabled:=true')
        self._own: OwnController = own_controller(self._controller, scene)
        self._every, self._grid = steps_between(self._rate, scene.time.rate), Grid(scene.time.rate)
        self._joints = JointNames.of(scene.joint_prefix)
        times = None if self._duration is None else steps_of(scene, self._duration)
        self._last = None if times is None else len(times.seconds) - 1
        self._setpoints: Sequence[Setpoint | None] = () if self._file is None or times is None else list(as_setpoints(
            setpoints_at(self._file, times.seconds + times.fractions), len(times.seconds)))
        return True

    def begin(self) -> None:
        """Listen, where the axis makes its steps itself."""
        if self._axis.scene.time.mode != 'lockstep':
            subscription(self, JOINT_STATES, self._hear)
            subscription(self, SLIDER_STATE, lambda state: self._unmeasured.append(state))
            self.create_timer(_REPORT_PERIOD, self._report, clock=Clock(clock_type=ClockType.STEADY_TIME))

    def turn(self) -> bool:
        """Ask it as often as is due; return whether that was all."""
        if self._axis.scene.time.mode == 'lockstep':
            self._make_steps()
            return True
        while self._unmeasured:
            state = self._unmeasured[0]
            message = self._measured.pop(_stamp(state), None)
            if message is None and len(self._unmeasured) == 1:
                return False    # it may be on its way
            self._unmeasured.popleft()
            if self._is_answered(state, None if message is None else measurement(message, self._joints)):
                return True
        return False

    def end(self) -> None:
        """Let the drive stop, and the force, if they were commanded."""
        if self._missed:
            self._report()
        if self._first >= 0:
            repeatedly(lambda: self._send(Command(0.0, None if self._force_out is None else 0.0)))

    def _make_steps(self) -> None:
        axis, step = self._axis, 0
        self._own.reset()
        if not axis.begin():
            return
        self._first = 0
        while self._last is None or step < self._last:
            command = self._asked(step, axis.measured, axis.state.drive_force)
            count = self._every if self._last is None else min(self._every, self._last - step)
            if not axis.step(count, **{name: value for name, value in command._asdict().items() if value is not None}):
                return
            step += count
        self.get_logger().info(f'done: {step} steps, t = {axis.state.time:g} s')

    def _hear(self, message: JointState) -> None:
        self._measured[_stamp(message)] = message
        if len(self._measured) > _MOST:    # their states got lost
            self._measured.pop(next(iter(self._measured)))

    def _is_answered(self, state: SliderState, measured: Measured | None) -> bool:
        """Ask it after a step of the axis, if that is due; return whether that was the last."""
        if self._first < 0 or state.step < self._latest:
            if measured is None:
                return False
            self._own.reset()
            self._first, self._next, self._held = state.step, 0, None
            self.get_logger().info(f'begins at step {state.step} of the axis')
        else:
            self._missed += state.step - self._latest - 1
        self._heard += 1
        self._latest, step = state.step, state.step - self._first
        if self._last is not None and step >= self._last:
            self.get_logger().info(f'done: {step} steps')
            return True
        if step >= self._next:
            self._next = (step // self._every + 1) * self._every
            self._send(self._asked(step, measured, state.drive_force))
        return False

    def _asked(self, step: int, measured: Measured | None, force: float) -> Command:
        self._held = measured or self._held or _NOTHING
        instant = self._grid.instant(step)
        setpoint = self._setpoints[step] if self._setpoints else None
        return self._own.answer(Measurement(*self._held, force, measured is None, setpoint), step,
                                instant.second + instant.fraction)

    def _send(self, command: Command) -> None:
        if command.velocity is not None:
            self._velocity_out.publish(DriveVelocity(velocity=command.velocity))
        if command.force is not None:
            self._force_out = self._force_out or publisher(self, EXTERNAL_FORCE)
            self._force_out.publish(ExternalForce(force=command.force))


    def _report(self) -> None:
        """Log what went wrong since the latest report; silence is logged once."""
        if not self._heard and not self._is_silent:
            self.get_logger().warning('no states come: has the axis ended, or is it paused?')
        if self._missed:
            self.get_logger().warning(f'{self._missed} of {self._heard + self._missed} steps were missed: the '
                                      'controller, or this machine, is too slow for them; --rate asks less often')
        self._is_silent = not self._heard
        self._heard = self._missed = 0


def _number(options: dict[str, str], name: str) -> float | None:
    if name not in options:
        return None
    try:
        return float(options[name])
    except ValueError:
        raise InputError(name, options[name], 'a number', 'correct it') from None


def _stamp(message: SliderState | JointState) -> tuple[int, int]:
    return message.header.stamp.sec, message.header.stamp.nanosec
