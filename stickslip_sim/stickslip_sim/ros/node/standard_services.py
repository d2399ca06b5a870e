# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The standard services of simulators, where the ROS package simulation_interfaces is installed."""

import math
from typing import Any

from rclpy.node import Node
from std_srvs.srv import SetBool, Trigger

from stickslip_msgs.srv import Step

from ...realtime.step_loop import StepLoop
from .time_services import TimeServices

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
        wanted = Step.Request(steps=min(request.steps, _MOST), velocity=math.nan, force=math.nan)
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
