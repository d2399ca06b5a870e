"""The node `feed_axis`: wires topics, services and parameters to the step loop.  No physics in here."""

import gc
import time
from collections.abc import Callable, Sequence
from typing import Any

from rclpy.clock import Clock, ClockType
from rclpy.parameter import Parameter
from rclpy.serialization import serialize_message
from std_srvs.srv import SetBool, Trigger

from ..commands import CommandSlot
from ..errors import InputError, RecordingError, SolverError
from ..offline import warm_up
from ..pacing import Grid, Pacer
from ..recording import RECORDED, RunFacts, messages
from ..recording import topics as names
from ..scene.model import Scene
from ..simulator import Simulator
from . import conversion, reports
from .loop import StepLoop
from .outlet import Outlet
from .parameters import FileParameters, SceneNode
from .recordings import Recordings
from .run_receipt import run_receipt
from .topics import publisher, subscription

NAME = 'feed_axis'
_REPORT_PERIOD = 1.0     # s
_QUIET = 1_000_000_000   # ns between two warnings of refused commands of a topic


class FeedAxis(SceneNode):
    """Publishes the motion of one axis in real time; callbacks run in an executor, the steps in the loop's thread.

    Raises InputError when the parameters are no scene, or one for offline use only.
    """

    def __init__(self, files: FileParameters) -> None:
        super().__init__(NAME, files)
        scene = self.scene
        if scene.solver.name == 'adaptive':
            raise InputError('solver.name', 'adaptive', 'exact or fixed_step in the node',
                             'the steps of adaptive take any time, and no real-time loop can wait for them')
        warm_up(scene)
        self._grid = Grid(scene.time.rate)
        self._pacer = Pacer(self._grid, scene.time.factor)
        self._slots = (CommandSlot('velocity', 'm/s', scene.command.max_velocity),
                       CommandSlot('force', 'N', scene.command.max_force))
        self._outlet = Outlet(self)
        self._recordings = Recordings(self.get_namespace())
        self._simulator = Simulator(scene.axis, scene.initial, scene.drive, scene.force, scene.solver.make(scene.axis),
                                    accounting=True)
        self.loop = StepLoop(self._simulator, self._grid, self._pacer, self._slots, self._outlet)
        self._reporter = reports.Reporter(self.loop, self._pacer.account, self._slots)
        self._quiet_until: dict[str, int] = {}   # by kind of command
        self._told = ''          # the failure of the solver that was logged
        self._wall, self._cpu = time.monotonic(), time.process_time()
        self._open_endpoints()

    def begin(self) -> None:
        """Start recording if the scene wants it, and the steps."""
        self._recordings.prepare()
        gc.collect()
        gc.freeze()      # a full collection would take tens of ms out of the loop
        self._outlet.begin_run(self._now_ns())
        if self.scene.record.enabled:
            self._begin_recording(lambda attach: attach())
        else:
            self._publish_run_info()
        self._wall, self._cpu = time.monotonic(), time.process_time()
        self._reporter.begin(self._pacer.now())
        self.loop.start()
        self.get_logger().info(f'{self.scene.name}: {self.scene.time.rate:g} steps a second')

    def end(self) -> None:
        """Stop the steps and close the bag; raises RecordingError when it could not be written to its end."""
        self.loop.stop()
        if self._recordings.recorder:
            self._report()       # the second that was cut short
        self._outlet.recorder = None
        if self._recordings.recorder:
            folder = self._recordings.folder
            self._recordings.end(self._receipt())
            self.get_logger().info(f'recorded into {folder}')

    def scene_changed(self, scene: Scene, changed: Sequence[Parameter]) -> None:
        """Let changed parameters take effect together at the next boundary between two steps."""
        self._slots[0].limit, self._slots[1].limit = scene.command.max_velocity, scene.command.max_force

        def apply() -> None:
            if scene.axis != self._simulator.axis:
                self._simulator.change_axis(scene.axis)
            stamp_ns = self._outlet.start_ns + self.loop.time_ns
            event = conversion.parameter_event(self.get_fully_qualified_name(), stamp_ns,
                                               [parameter.to_parameter_msg() for parameter in changed])
            data = self._recordings.parameter_event(conversion.fields_of(event))
            self._outlet.record(RECORDED.index(names.PARAMETER_EVENTS), data, self.loop.time_ns, self.loop.step + 1)

        if not self.loop.at_boundary(apply):
            self.get_logger().error('the step loop is busy: the changed parameters did not take effect')

    def _open_endpoints(self) -> None:
        self._run_info_out = publisher(self, names.RUN_INFO)
        self._timing_out = publisher(self, names.TIMING)
        self._diagnostics_out = publisher(self, names.DIAGNOSTICS)
        subscription(self, names.DRIVE_VELOCITY, lambda message: self._take(self._slots[0], message.velocity))
        subscription(self, names.EXTERNAL_FORCE, lambda message: self._take(self._slots[1], message.force))
        self.create_service(Trigger, '~/reset', self._reset)
        self.create_service(SetBool, '~/set_paused', self._set_paused)
        self.create_service(SetBool, '~/record', self._set_recording)
        self.create_timer(_REPORT_PERIOD, self._report, clock=Clock(clock_type=ClockType.STEADY_TIME))

    def _take(self, slot: CommandSlot, value: float) -> None:
        now = self._pacer.now()
        refusal = slot.offer(value, now)
        if refusal and now >= self._quiet_until.get(slot.name, now):
            self._quiet_until[slot.name] = now + _QUIET
            self.get_logger().warning(refusal)

    def _reset(self, _: Any, response: Any) -> Any:
        """Begin anew at simulation time 0; a bag would then hold two runs, hence not while recording."""
        if self._recordings.recorder:
            return _answer(response, False, 'refused while recording: a bag holds one run; stop it with ~/record first')

        def restart() -> None:
            self.loop.restart()
            self._outlet.begin_run(self._now_ns())

        done = self.loop.at_boundary(restart)
        if done:
            self._pacer.account.clear()
            self._reporter.forget_counts()
            self._wall, self._cpu = time.monotonic(), time.process_time()
        self._publish_run_info()
        return _answer(response, done, 'simulation time and steps begin anew at 0' if done else 'the step loop is busy')

    def _set_paused(self, request: Any, response: Any) -> Any:
        if self.loop.failure and not request.data:
            return _answer(response, False, f'the solver gave up: {self.loop.failure}; call ~/reset first')
        done = self.loop.at_boundary(lambda: self.loop.pause(request.data))
        word = 'paused' if request.data else 'running'
        return _answer(response, done, f'{word} at simulation time {self.loop.time_ns * 1e-9:g} s')

    def _set_recording(self, request: Any, response: Any) -> Any:
        folder = self._recordings.folder
        if not request.data:
            failure = self._end_recording()
            return _answer(response, not failure, failure or (f'recorded into {folder}' if folder else 'not recording'))
        if folder:
            return _answer(response, True, f'already recording into {folder}')
        failure = self._begin_recording(self.loop.at_boundary)
        return _answer(response, not failure, failure or f'recording into {self._recordings.folder}')

    def _begin_recording(self, at_boundary: Callable[[Callable[[], None]], object]) -> str:
        """Return why it failed, or an empty text."""
        try:
            self._recordings.begin(self.scene)
        except RecordingError as error:
            self.get_logger().error(f'no recording: {error}')
            self._publish_run_info()
            return str(error)
        if at_boundary(self._attach_recorder) is False:
            self._recordings.end({})
            return 'the step loop is busy'
        self.get_logger().info(f'recording into {self._recordings.folder}')
        return ''

    def _attach_recorder(self) -> None:
        self._outlet.recorder = self._recordings.recorder
        self._publish_run_info()
        self.loop.repeat_commands()

    def _end_recording(self) -> str:
        """Return why the bag could not be finished, or an empty text."""
        receipts: list[dict[str, Any]] = []

        def detach() -> None:
            self._outlet.recorder = None
            receipts.append(self._receipt())

        self.loop.at_boundary(detach)
        try:
            self._recordings.end(receipts[0] if receipts else {})
        except RecordingError as error:
            self.get_logger().error(f'recording failed: {error}')
            return str(error)
        finally:
            self._publish_run_info()
        return ''

    def _receipt(self) -> dict[str, Any]:
        cost = (time.process_time() - self._cpu, time.monotonic() - self._wall)
        try:
            return self._whole_receipt(cost)
        except SolverError as error:    # the state has left the range of numbers
            return {'failure': str(error)}

    def _whole_receipt(self, cost: tuple[float, float]) -> dict[str, Any]:
        return run_receipt(self.scene, self._simulator, self._outlet, self._pacer.account, self._slots,
                           self._recordings.total_dropped, cost)

    def _report(self) -> None:
        account, now = self._pacer.account, self._now_ns()
        second = self._reporter.look(self._pacer.now())
        self._tell_troubles(second)
        message = reports.timing_message(second, self.loop.step, self._pacer.period * 1e-9, account, now)
        self._timing_out.publish(message)
        self._record(names.TIMING, message, max(self.loop.step, 0))
        events = self._outlet.events
        self._diagnostics_out.publish(reports.diagnostics(now, self.get_fully_qualified_name(), [
            reports.loop_status(self.loop, account, second),
            reports.command_status(self._slots, second),
            reports.solver_status(self.loop, self.scene.solver.name, self._simulator.event_counts,
                                  events[-1] if events else None),
            reports.recorder_status(self._recordings)]))

    def _tell_troubles(self, second: reports.Second) -> None:
        log = self.get_logger()
        if second.skipped > 0.0:
            log.warning(f'{second.skipped:.3f} s behind the clock were given up; simulation time lags by that much')
        if self.loop.failure and self.loop.failure != self._told:
            log.error(f'the axis stands still: {self.loop.failure}; ~/reset begins anew')
        self._told = self.loop.failure
        failure = self._recordings.check()
        if failure:
            self._outlet.recorder = None
            log.error(f'recording failed, the axis goes on: {failure}')
            self._publish_run_info()

    def _publish_run_info(self) -> None:
        message = conversion.run_info(messages.run_info(
            RunFacts.of(self.scene), self._now_ns(), self._outlet.start_ns, self._recordings.folder))
        self._run_info_out.publish(message)
        self._record(names.RUN_INFO, message, max(self.loop.step, 0))

    def _record(self, topic: names.Topic, message: Any, step: int) -> None:
        self._outlet.record(RECORDED.index(topic), serialize_message(message), self.loop.time_ns, step)

    def _now_ns(self) -> int:
        nanoseconds: int = self.get_clock().now().nanoseconds
        return nanoseconds


def _answer(response: Any, success: bool, message: str) -> Any:
    response.success, response.message = success, message
    return response
