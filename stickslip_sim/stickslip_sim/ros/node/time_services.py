# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The services that move time: ~/reset, ~/set_paused, ~/step."""

import math
from collections.abc import Callable
from typing import Any

from rclpy.node import Node
from std_srvs.srv import SetBool, Trigger

from stickslip_msgs.srv import InjectFault, Step

from ...core.errors import InputError
from ...core.input_profile import constant
from ...realtime.step_loop import StepLoop
from ...simulation import Fault, StepResult
from ...simulation.faults import value_of_kind
from .parameters import SceneNode
from .publishers import Publishers

# Answers of services.

BUSY = 'the step loop is busy'


def answer(response: Any, success: bool, message: str) -> Any:
    """Fill in a response that has a success and a message."""
    response.success, response.message = success, message
    return response


_STEPPING = 3600.0   # s that many steps may take


class TimeServices:
    """`restart` begins a new run at a boundary; `is_recording` and `is_stopping` are asked when it matters.

    With `record.each_reset` it begins a bag, too.
    """

    def __init__(self, node: SceneNode, loop: StepLoop, publishers: Publishers, restart: Callable[[], bool],
                 is_recording: Callable[[], bool], is_stopping: Callable[[], bool]) -> None:
        self._loop, self._publishers, self._restart = loop, publishers, restart
        self._is_recording, self._is_stopping = is_recording, is_stopping
        self._has_bags = node.scene.record.each_reset
        self._profiles, self._log = (node.scene.drive, node.scene.force), node.get_logger()
        node.create_service(Trigger, '~/reset', self.reset)
        node.create_service(SetBool, '~/set_paused', self.set_paused)
        node.create_service(Step, '~/step', self.step)

    def reset(self, _: Any, response: Any) -> Any:
        """Begin anew at simulation time 0; a bag would then hold two runs, so not while recording into only one.

        A recorded run that has not begun is what it would be after a reset.
        """
        if self._is_recording():
            if self._is_before_start:
                return answer(response, True, 'simulation time and steps are at 0; the recording goes on')
            if not self._has_bags:
                return answer(response, False, 'refused while recording: a bag holds one run; end it with ~/record'
                              ' first (stickslip call record off), or let each reset begin another'
                              ' (record.each_reset)')
        done = self._restart()
        return self._logged(response, done, 'simulation time and steps begin anew at 0')

    def set_paused(self, request: Any, response: Any) -> Any:
        """Let time stand still or go on."""
        loop = self._loop
        if loop.by_request:
            return answer(response, False, 'refused with time.mode: lockstep: time moves with ~/step only')
        if loop.failure and not request.data:
            return answer(response, False, f'the solver gave up: {loop.failure}; call ~/reset first')
        done = loop.at_boundary(lambda: loop.pause(request.data))
        word = 'paused' if request.data else 'running'
        return self._logged(response, done, f'{word} at simulation time {loop.time_ns * 1e-9:g} s')

    def step(self, request: Any, response: Any) -> Any:
        """Make steps while time does not move by itself."""
        refusal = self._refusal(request)
        if refusal:
            return answer(response, False, refusal)
        results: list[StepResult] = []
        replaced = self._replaced(request)
        velocity, force = (None if math.isnan(value) else value for value in (request.velocity, request.force))

        def run() -> None:
            results.extend(self._loop.run_steps(request.steps, velocity, force, self._is_stopping))

        done = self._loop.at_boundary(run, _STEPPING)
        if results:
            last = results[-1]
            response.state, response.friction = self._publishers.state_messages(last.step, last.sample)
            response.events = [message for result in results[:request.steps] for event in result.events
                               if (message := self._publishers.event_message(result.step, event))]
            for name, value in last.measured._asdict().items() if last.measured else ():
                setattr(response, f'measured_{name}', value)
            response.is_measured = last.measured is not None
        if replaced and results:
            self._log.warning(f'~/step: {replaced}')
        made = min(len(results), request.steps)
        return answer(response, done and made == request.steps,
                      self._report(done, request.steps, made) + (f'; {replaced}' if replaced else ''))

    def _logged(self, response: Any, done: bool, text: str) -> Any:
        """Answer, and tell in the log what was done."""
        if done:
            self._log.info(text)
        return answer(response, done, text if done else BUSY)

    @property
    def _is_before_start(self) -> bool:
        """Whether time stands still at 0, and nothing was ordered that a reset would forget."""
        loop = self._loop
        return ((loop.by_request or loop.paused) and loop.step <= 0 and not loop.failure and not loop.rig.has_orders
                and all(slot.latest is None for slot in loop.slots))

    def _refusal(self, request: Any) -> str:
        """Return why steps are not made, or an empty text."""
        loop = self._loop
        least = 0 if math.isnan(request.velocity) and math.isnan(request.force) else 1
        if not least <= request.steps <= Step.Request.MAX_STEPS:
            return f'steps = {request.steps} is refused: must be 1 to {Step.Request.MAX_STEPS}; call it again for more'
        for slot, value in zip(loop.slots, (request.velocity, request.force)):
            if not math.isnan(value) and (refusal := slot.refusal(value)):
                return refusal + '; NaN leaves the one in force'
        if loop.failure:
            return f'the solver gave up: {loop.failure}; call ~/reset first'
        if not (loop.by_request or loop.paused):
            return ('refused while time runs by itself: use time.mode: lockstep, or ~/set_paused first'
                    ' (stickslip call pause)')
        return ''

    def _replaced(self, request: Any) -> str:
        """Return what to report of a request with the zeros of its type, which may not have been meant as commands."""
        if (request.velocity, request.force) != (0.0, 0.0):
            return ''
        names = [slot.name for slot, held, profile in zip(self._loop.slots, self._loop.held, self._profiles)
                 if held is None and profile != constant(0.0)]
        return f'{" and ".join(names)} = 0 in place of the input profile of the scene: NaN leaves it' if names else ''

    def _report(self, done: bool, wanted: int, made: int) -> str:
        time = f'at simulation time {self._loop.time_ns * 1e-9:g} s'
        if self._loop.failure:
            return f'{made} of {wanted} steps made, then the solver gave up: {self._loop.failure}'
        if not done or made < wanted:
            return f'{made} of {wanted} steps made: {"the node is stopping" if done else BUSY}'
        return f'{made} step{"" if made == 1 else "s"} made, {time}'


# The services that let things go wrong: ~/inject_fault, ~/clear_faults.

_CLEAR = 'clear'
_TIMEOUT = 'the command time-out (the drive takes commands again)'


class FaultServices:
    """Faults on request; they take effect with the next step."""

    def __init__(self, node: SceneNode, loop: StepLoop) -> None:
        self._loop, self._log = loop, node.get_logger()
        for fault in node.scene.rig.faults:
            self._warn(fault)
        node.create_service(InjectFault, '~/inject_fault', self._inject)
        node.create_service(Trigger, '~/clear_faults', self._clear_all)

    def _inject(self, request: Any, response: Any) -> Any:
        rig = self._loop.rig
        response.id = request.id
        if request.kind == _CLEAR:
            return self._at_boundary(response, lambda: rig.clear_fault(request.id), lambda: f'{request.id} cleared')
        asked = Fault(request.id, request.kind, request.start, request.duration, request.value)

        def inject() -> None:
            response.id = rig.inject(asked).id

        what = f'{asked.kind} {asked.value:g}' if value_of_kind(asked.kind) else asked.kind
        return self._at_boundary(response, inject, lambda: (
            f'{response.id} ({what}) begins {asked.start:g} s from now{self._warn(asked)}'))

    def _warn(self, fault: Fault) -> str:
        """Log that a fault does nothing; return that for an answer."""
        reason = self._loop.rig.idle_reason(fault)
        if not reason:
            return ''
        self._log.warning(reason)
        return f'; {reason}'

    def _clear_all(self, _: Any, response: Any) -> Any:
        cleared: list[str] = []

        def clear() -> None:
            rig = self._loop.rig
            of_timeout = [_TIMEOUT] if rig.has_failed else []
            cleared.extend(rig.clear_faults() + of_timeout)

        return self._at_boundary(response, clear, lambda: f'cleared: {", ".join(cleared) or "there were none"}')

    def _at_boundary(self, response: Any, action: Callable[[], object], report: Callable[[], str]) -> Any:
        refusals: list[InputError] = []

        def do() -> None:
            try:
                action()
            except InputError as error:
                refusals.append(error)

        if not self._loop.at_boundary(do):
            return answer(response, False, BUSY)
        return answer(response, not refusals, str(refusals[0]) if refusals else report())


# The standard services of simulators, where the ROS package simulation_interfaces is installed.

_HOW = ('the standard services of simulators are not offered: for them install the package simulation_interfaces'
        ' (ros-$ROS_DISTRO-simulation-interfaces)')
_MOST = 2**63 - 1    # steps that ~/step can be asked for; it makes far fewer


def offer_standard_services(node: Node, loop: StepLoop, times: TimeServices) -> None:
    """Offer them beside the services of this node, which do the work; or say how to get them."""
    try:
        from simulation_interfaces import msg, srv
    except ImportError:
        node.get_logger().info(_HOW)
        return
    StandardServices(node, loop, times, msg, srv)


class StandardServices:
    """Answers with the messages of the modules `msg` and `srv` of that package."""

    def __init__(self, node: Node, loop: StepLoop, times: TimeServices, msg: Any, srv: Any) -> None:
        self._loop, self._times, self._msg = loop, times, msg
        self._whole = (srv.ResetSimulation.Request.SCOPE_DEFAULT, srv.ResetSimulation.Request.SCOPE_ALL)
        node.create_service(srv.GetSimulatorFeatures, '~/get_simulator_features', self._features)
        node.create_service(srv.ResetSimulation, '~/reset_simulation', self._reset)
        node.create_service(srv.StepSimulation, '~/step_simulation', self._step)
        node.create_service(srv.GetSimulationState, '~/get_simulation_state', self._get_state)
        node.create_service(srv.SetSimulationState, '~/set_simulation_state', self._set_state)

    def _features(self, _: Any, response: Any) -> Any:
        known = self._msg.SimulatorFeatures
        features = [known.SIMULATION_RESET, known.SIMULATION_STATE_GETTING, known.SIMULATION_STATE_SETTING,
                    known.STEP_SIMULATION_SINGLE, known.STEP_SIMULATION_MULTIPLE]
        if not self._loop.by_request:
            features.append(known.SIMULATION_STATE_PAUSE)
        response.features = known(features=features, custom_info='one axis; see docs/hil.md')
        return response

    def _reset(self, request: Any, response: Any) -> Any:
        if request.scope in self._whole:
            response.result = self._done(self._times.reset(Trigger.Request(), Trigger.Response()))
        else:
            response.result = self._result('FEATURE_UNSUPPORTED', f'scope = {request.scope} is refused: must be one of '
                                           f'{self._whole}; time and state begin anew together')
        return response

    def _step(self, request: Any, response: Any) -> Any:
        refused = 0.0    # the standard has no 0 steps, with which ~/step only answers
        wanted = Step.Request(steps=min(request.steps, _MOST), force=math.nan,
                              velocity=math.nan if request.steps else refused)
        response.result = self._done(self._times.step(wanted, Step.Response()))
        return response

    def _get_state(self, _: Any, response: Any) -> Any:
        response.state.state = self._state
        response.result = self._result('OK', self._loop.failure)
        return response

    def _set_state(self, request: Any, response: Any) -> Any:
        states, wanted = self._msg.SimulationState, request.state.state
        if wanted == self._state:
            response.result.result = response.ALREADY_IN_TARGET_STATE
        elif wanted == states.STATE_STOPPED:
            response.result = self._done(self._stop())
        elif wanted in (states.STATE_PLAYING, states.STATE_PAUSED):
            response.result = self._done(self._pause(wanted == states.STATE_PAUSED))
        else:
            response.result = self._result('FEATURE_UNSUPPORTED', f'state = {wanted} is refused: must be 0 (stopped),'
                                           ' 1 (playing) or 2 (paused); Ctrl-C ends the node')
        return response

    @property
    def _state(self) -> int:
        states = self._msg.SimulationState
        if self._loop.paused and self._loop.step <= 0:
            return int(states.STATE_STOPPED)
        stands = self._loop.paused or self._loop.by_request or self._loop.failure
        return int(states.STATE_PAUSED if stands else states.STATE_PLAYING)

    def _stop(self) -> Any:
        """Pause and begin anew; go on as before where that is refused."""
        was_paused = self._loop.paused
        self._pause(True)
        answer = self._times.reset(Trigger.Request(), Trigger.Response())
        if not answer.success:
            self._pause(was_paused)
        return answer

    def _pause(self, paused: bool) -> Any:
        return self._times.set_paused(SetBool.Request(data=paused), SetBool.Response())

    def _done(self, answer: Any) -> Any:
        return self._result('OK', '') if answer.success else self._result('OPERATION_FAILED', answer.message)

    def _result(self, name: str, text: str) -> Any:
        result = self._msg.Result
        return result(result=getattr(result, f'RESULT_{name}'), error_message=text)
