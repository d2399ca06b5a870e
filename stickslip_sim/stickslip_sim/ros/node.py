# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The node `feed_axis`: wires topics, services and parameters to the step loop.  No physics in here."""

import gc
import time
from collections.abc import Callable, Sequence
from typing import Any

from rclpy.clock import Clock, ClockType
from rclpy.parameter import Parameter
from rclpy.serialization import serialize_message

from ..commands import CommandSlot
from ..errors import InputError, SolverError
from ..grid import Grid
from ..offline import warm_up
from ..pacing import step_clock
from ..recording import RECORDED, RunFacts, messages
from ..recording import topics as names
from ..rig import Note, NoteKind
from ..rig.watchdog import Watchdog
from ..scene.model import Scene
from . import conversion, reports
from .clock import ClockOut
from .fault_services import FaultServices
from .inlet import Inlet
from .joints import JointStates
from .loop import StepLoop, Taker
from .neighbours import Neighbours
from .outlet import Outlet
from .parameters import FileParameters, SceneNode
from .record_service import RecordService
from .rig_events import RigEvents
from .run_receipt import run_receipt
from .standard_services import offer_standard_services
from .time_services import TimeServices
from .topics import publisher
from .verdict import verdict

NAME = 'feed_axis'
_REPORT_PERIOD = 1.0     # s


class FeedAxis(SceneNode):
    """Publishes the motion of one axis; callbacks run in an executor, the steps in the loop's thread.

    `is_stopping` is asked while many steps are made.  Raises InputError when the parameters are no scene, or one for
    offline use only.
    """

    def __init__(self, files: FileParameters, is_stopping: Callable[[], bool]) -> None:
        super().__init__(NAME, files)
        scene = self.scene
        if scene.solver.name == 'adaptive':
            raise InputError('solver.name', 'adaptive', 'exact or fixed_step in the node',
                             'the steps of adaptive take any time, and no real-time loop can wait for them')
        warm_up(scene)
        self._slots = (CommandSlot('velocity', 'm/s', scene.command.max_velocity),
                       CommandSlot('force', 'N', scene.command.max_force))
        self._outlet = Outlet(self)
        self._rig_events = RigEvents(self, self._outlet)
        grid = Grid(scene.time.rate)
        self._step_clock = step_clock(grid, scene.time.mode, scene.time.factor)
        self.loop = StepLoop(scene.make_rig(), self._step_clock, self._slots, self._takers(grid),
                             Watchdog(scene.command.timeout), by_request=scene.time.mode == 'lockstep')
        self._reporter = reports.Reporter(self.loop)
        self._told = ''          # the failure of the solver that was logged
        self._wall, self._cpu = time.monotonic(), time.process_time()
        self._open_endpoints(is_stopping)

    def begin(self) -> None:
        """Start recording if the scene wants it, and the steps."""
        self._record_service.recordings.prepare()
        gc.collect()
        gc.freeze()      # a full collection would take tens of ms out of the loop
        self._outlet.begin_run(self._start_ns())
        if self.scene.record.enabled:
            self._record_service.begin(lambda attach: attach())
        else:
            self._publish_run_info()
        self._wall, self._cpu = time.monotonic(), time.process_time()
        self._reporter.begin(self._step_clock.now())
        self.loop.start()
        self.get_logger().info(f'{self.scene.name}: {self.scene.time.rate:g} steps a second, {self.scene.time.mode}')

    def end(self) -> None:
        """Stop the steps and close the bag; raises RecordingError when it could not be written to its end."""
        self.loop.stop()
        if self._record_service.is_recording:
            self._report()       # the second that was cut short
        if self.loop.step >= 0:
            self.get_logger().info(verdict(self.scene, self.loop).text)
        self._record_service.close()

    def scene_changed(self, scene: Scene, changed: Sequence[Parameter]) -> None:
        """Let changed parameters take effect together at the next boundary between two steps."""
        self._slots[0].limit, self._slots[1].limit = scene.command.max_velocity, scene.command.max_force

        def apply() -> None:
            self.loop.rig.change_axis(scene.axis)
            stamp_ns = self._outlet.start_ns + self.loop.time_ns
            event = conversion.parameter_event(self.get_fully_qualified_name(), stamp_ns,
                                               [parameter.to_parameter_msg() for parameter in changed])
            data = self._record_service.recordings.parameter_event(conversion.fields_of(event))
            self._outlet.record(RECORDED.index(names.PARAMETER_EVENTS), data, self.loop.time_ns, self.loop.step + 1)

        if not self.loop.at_boundary(apply):
            self.get_logger().error('the step loop is busy: the changed parameters did not take effect')

    def _takers(self, grid: Grid) -> list[Taker]:
        takers: list[Taker] = [self._rig_events.take, self._outlet.take]
        if self.scene.rig.measures:
            takers.append(JointStates(self, self._outlet).take)
        if self.scene.time.makes_clock:
            takers += [ClockOut(self, grid, self.scene.time.clock_rate).take, self._outlet.keep_pace]
        return takers

    def _open_endpoints(self, is_stopping: Callable[[], bool]) -> None:
        self._run_info_out = publisher(self, names.RUN_INFO)
        self._timing_out = publisher(self, names.TIMING)
        self._diagnostics_out = publisher(self, names.DIAGNOSTICS)
        Inlet(self, *self._slots, self._step_clock.now, with_joints=self.scene.rig.measures)
        self._neighbours = Neighbours(self, self.scene, self.loop)
        self._record_service: RecordService = RecordService(self, self.loop, self._outlet, self._publish_run_info,
                                                            self._receipt)
        times = TimeServices(self, self.loop, self._outlet, self._restart,
                             lambda: self._record_service.is_recording, is_stopping)
        offer_standard_services(self, self.loop, times)
        FaultServices(self, self.loop)
        self.create_timer(_REPORT_PERIOD, self._report, clock=Clock(clock_type=ClockType.STEADY_TIME))

    def _restart(self) -> bool:
        def restart() -> None:
            self.loop.restart()
            self._outlet.begin_run(self._start_ns())

        done = self.loop.at_boundary(restart)
        if done:
            self._reporter.forget_counts()
            self._wall, self._cpu = time.monotonic(), time.process_time()
        self._publish_run_info()
        return done

    def _receipt(self) -> dict[str, Any]:
        cost = (time.process_time() - self._cpu, time.monotonic() - self._wall)
        try:
            dropped = self._record_service.recordings.total_dropped
            return run_receipt(self.scene, self.loop, self._outlet, dropped, cost)
        except SolverError as error:    # the state has left the range of numbers
            return {'failure': str(error)}

    def _report(self) -> None:
        stamp_ns = self._outlet.start_ns + self.loop.time_ns if self.scene.time.makes_clock else self._now_ns()
        second = self._reporter.look(self._step_clock.now())
        judged = verdict(self.scene, self.loop)
        self._tell_troubles(second)
        period = self._step_clock.period * 1e-9
        message = reports.timing_message(second, self.loop, period, bool(judged.valid), stamp_ns)
        self._timing_out.publish(message)
        self._record(names.TIMING, message, max(self.loop.step, 0))
        self._diagnostics_out.publish(reports.diagnostics(stamp_ns, self.get_fully_qualified_name(), [
            reports.loop_status(self.loop, second, judged),
            reports.command_status(self.loop, second),
            reports.solver_status(self.loop, self.scene.solver.name, self._outlet.events.latest_time),
            reports.recorder_status(self._record_service.recordings),
            reports.neighbours_status(self._neighbours.look())]))

    def _tell_troubles(self, second: reports.Second) -> None:
        log = self.get_logger()
        if second.skipped > 0.0:
            text = f'{second.skipped:.3f} s behind the clock were given up; simulation time lags by that much'
            log.warning(text)
            self._tell(Note(NoteKind.TIME_LOST, '', text, second.skipped))
        if second.refused:
            reasons = [slot.last_refusal for slot in self._slots if slot.last_refusal]
            self._tell(Note(NoteKind.COMMAND_REFUSED, '', '; '.join(reasons), number=second.refused))
        if self.loop.failure and self.loop.failure != self._told:
            log.error(f'the axis stands still: {self.loop.failure}; ~/reset begins anew')
        self._told = self.loop.failure
        self._record_service.look()

    def _tell(self, note: Note) -> None:
        self._rig_events.tell(self.loop.step + 1, self.loop.time_ns, note)

    def _publish_run_info(self) -> None:
        message = conversion.run_info(messages.run_info(
            RunFacts.of(self.scene), self._now_ns(), self._outlet.start_ns, self._record_service.recordings.folder))
        self._run_info_out.publish(message)
        self._record(names.RUN_INFO, message, max(self.loop.step, 0))

    def _record(self, topic: names.Topic, message: Any, step: int) -> None:
        self._outlet.record(RECORDED.index(topic), serialize_message(message), self.loop.time_ns, step)

    def _start_ns(self) -> int:
        """Return the stamp of simulation time 0: 0 where simulation time is the time of the graph."""
        return 0 if self.scene.time.makes_clock else self._now_ns()

    def _now_ns(self) -> int:
        nanoseconds: int = self.get_clock().now().nanoseconds
        return nanoseconds
