# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The node `feed_axis`: wires topics, services and parameters to the step loop.  No physics in here."""

import gc
from collections.abc import Callable, Sequence
from typing import Any

from rclpy.parameter import Parameter

from stickslip_msgs.srv import Step

from ...bags import topics
from ...core.errors import InputError, SolverError
from ...core.time_grid import Grid
from ...realtime.commands import CommandSlot, Watchdog
from ...realtime.pacing import step_clock
from ...realtime.step_loop import Sink, StepLoop
from ...realtime.verdict import verdict
from ...recording import RECORDED, RunFacts, messages
from ...runs.simulated import CostMeter, warm_up
from ...scene.load import NODE
from ...scene.model import Scene
from ..programs import GivenParameters
from . import endpoints
from .clock import ClockIn, ClockOut
from .endpoints import publisher
from .joints import JointNames, JointStates
from .parameters import SceneNode, scheduling_of
from .publishers import DeferredLog, Publishers, RigEvents
from .record_service import RecordService
from .reports import PeriodicReport, run_receipt
from .subscribers import HidingNode, Subscribers
from .time_services import FaultServices, TimeServices, offer_standard_services

_LEAD = 20_000_000   # ns from the instant that stamps count from to step 0, which finds all prepared then


class FeedAxis(HidingNode, SceneNode):
    """Publishes the motion of one axis; callbacks run in an executor, the steps in the loop's thread.

    `is_stopping` is asked while many steps are made.  Raises InputError when the parameters are no scene, or one for
    offline use only.
    """

    def __init__(self, given: GivenParameters, is_stopping: Callable[[], bool]) -> None:
        super().__init__(NODE, given)
        scene = self.scene
        if scene.solver.name == 'adaptive':
            raise InputError('solver.name', 'adaptive', 'exact or fixed_step in the node',
                             'a step of adaptive may take any time, too long for a real-time loop')
        warm_up(scene)
        self._slots = (CommandSlot('velocity', 'm/s', scene.command.max_velocity),
                       CommandSlot('force', 'N', scene.command.max_force))
        grid = Grid(scene.time.rate)
        self._step_clock = step_clock(grid, scene.time.mode, scene.time.factor)
        self._clock_in = ClockIn(self, self._step_clock.now)
        # as many states as one request may make: without a clock they come faster than they are heard
        depth = Step.Request.MAX_STEPS if scene.time.mode == 'lockstep' else 0
        self._outputs = Publishers(self, self._delay, depth)
        self.log = DeferredLog(self.get_logger())
        self._rig_events = RigEvents(self, self._outputs, self.log)
        joints = JointNames.of(scene.joint_prefix) if scene.rig.measures else None
        sinks = self._sinks(grid, joints, depth)
        self._subscribers = Subscribers(self, *self._slots, self._step_clock.now, self.log, joints)
        self.hide(self._subscribers.hidden)
        self.loop = StepLoop(scene.make_rig(), self._step_clock, self._slots, sinks, Watchdog(scene.command.timeout),
                             by_request=scene.time.mode == 'lockstep', hear=self._subscribers.hear,
                             scheduling=scheduling_of(self, self.given.values, scene.time))
        self._cost = CostMeter()
        self._open_endpoints(is_stopping)

    def is_ready(self) -> bool:
        """Return whether stamps have a time to start from; raises InputError when it does not come."""
        return self._clock_in.has_come()

    def begin(self) -> None:
        """Start recording if the scene wants it, and the steps; raises RecordingError when it cannot be recorded."""
        self._record_service.recordings.prepare()
        for missing in self.loop.step_thread.missing:
            self.get_logger().warning(missing)
        self.loop.step_thread.lead(self.log.warning)
        gc.collect()
        gc.freeze()      # a full collection would take tens of ms out of the loop
        self._cost.begin()
        self._report.begin()
        if self.scene.record.enabled:
            self._record_service.begin_at_start(self._start)
        else:
            self._start(self._publish_run_info)
        if self._subscribers.trouble:
            self.get_logger().info(f'commands are heard by callbacks: {self._subscribers.trouble}')
        if not (self.scene.time.is_wall_time or self.scene.time.makes_clock):
            self.get_logger().warning(
                f'time.factor: {self.scene.time.factor:g}: stamps are simulation time from the start on, and drift from'
                ' the time of other nodes; time.mode: free_run gives them a /clock')
        self.get_logger().info(f'{self.scene.name}: {self.scene.time.rate:g} steps a second, {self.scene.time.mode}')

    def end(self) -> None:
        """Stop the steps and close the bag; raises RecordingError when a bag was not written to its end."""
        self.loop.stop()
        if self._record_service.is_recording:
            self._report.report()    # the second that was cut short
        self.log.write()
        if self.loop.step >= 0:
            self.get_logger().info(verdict(self.scene, self.loop).text)
        self._record_service.close()

    def check_change(self, scene: Scene) -> None:
        """Raise InputError on a folder of bags that lies elsewhere."""
        self._record_service.recordings.allowed(scene.record.folder)

    def scene_changed(self, scene: Scene, changed: Sequence[Parameter]) -> None:
        """Let changed parameters take effect together at the next boundary between two steps."""
        self._slots[0].limit, self._slots[1].limit = scene.command.max_velocity, scene.command.max_force

        def apply() -> None:
            self.loop.rig.change_axis(scene.axis)
            stamp_ns = self._outputs.start_ns + self.loop.time_ns
            event = endpoints.parameter_event(self.get_fully_qualified_name(), stamp_ns,
                                               [parameter.to_parameter_msg() for parameter in changed])
            data = self._record_service.recordings.parameter_event(endpoints.fields_of(event))
            self._outputs.record(RECORDED.index(topics.PARAMETER_EVENTS), data, self.loop.time_ns, self.loop.step + 1)

        if not self.loop.at_boundary(apply):
            self.get_logger().error('the step loop is busy: the changed parameters did not take effect')

    def _sinks(self, grid: Grid, joints: JointNames | None, depth: int) -> list[Sink]:
        sinks: list[Sink] = [self._rig_events.take, self._outputs.take]
        if joints:
            sinks.append(JointStates(self, self._outputs, joints, depth).take)
        if self.scene.time.makes_clock:
            sinks += [ClockOut(self, grid, self.scene.time.clock_rate).take, self._outputs.keep_pace]
        return sinks

    def _open_endpoints(self, is_stopping: Callable[[], bool]) -> None:
        self._run_info_out = publisher(self, topics.RUN_INFO)
        self._record_service: RecordService = RecordService(self, self.loop, self._outputs, self._publish_run_info,
                                                            self._receipt)
        times = TimeServices(self, self.loop, self._outputs, self._restart,
                             lambda: self._record_service.is_recording, is_stopping)
        offer_standard_services(self, self.loop, times)
        FaultServices(self, self.loop)
        self._report = PeriodicReport(self, self.loop, self._step_clock, self._outputs, self._rig_events,
                                    self._record_service, self._stamp_ns)

    def _restart(self) -> bool:
        def restart() -> None:
            self.loop.restart()
            self._begin_run()

        bags = self._record_service
        done = self.loop.at_boundary(lambda: bags.renew(restart) if self.scene.record.each_reset else restart())
        if done:
            self._report.forget_counts()
            self._cost.begin()
        self._publish_run_info()
        return done

    def _start(self, announce: Callable[[], object]) -> None:
        """Start the steps: their clock and their stamps at the same instant, after all that takes its time."""
        def prepare() -> None:
            self._begin_run(_LEAD + self._clock_in.age)    # all that was prepared took its time
            announce()

        self.loop.start(_LEAD, prepare)

    def _begin_run(self, lead: int = 0) -> None:
        """Let the publishers begin where the rig is before its first step, due `lead` ns from now."""
        self._outputs.begin_run(self._start_ns(lead), self.loop.rig.simulator.sample().mode)

    def _receipt(self) -> dict[str, Any]:
        try:
            dropped = self._record_service.recordings.total_dropped
            return run_receipt(self.scene, self.loop, self._outputs, dropped, self._cost.so_far())
        except SolverError as error:    # the state has left the range of numbers
            return {'failure': str(error)}

    def _publish_run_info(self) -> None:
        message = endpoints.run_info_message(messages.run_info(
            RunFacts.of(self.scene), self._now_ns(), self._outputs.begin_ns, self._record_service.recordings.folder))
        self._run_info_out.publish(message)
        self._outputs.record_message(topics.RUN_INFO, message, self.loop.time_ns, max(self.loop.step, 0))

    def _start_ns(self, lead: int) -> int:
        """Return the stamp of simulation time 0, `lead` ns from now: 0 where it is the time of the graph."""
        return 0 if self.scene.time.makes_clock else self._now_ns() + lead

    def _stamp_ns(self) -> int:
        """Return the stamp of what happens now."""
        return self._now_ns() if self.scene.time.is_wall_time else self._outputs.start_ns + self.loop.time_ns

    def _delay(self) -> int:
        """Return by how much simulation time has fallen behind the time of the graph, ns, where it goes as fast."""
        return self._step_clock.delay if self.scene.time.is_wall_time else 0

    def _now_ns(self) -> int:
        nanoseconds: int = self.get_clock().now().nanoseconds
        return nanoseconds
