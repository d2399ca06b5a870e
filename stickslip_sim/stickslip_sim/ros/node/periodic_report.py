# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""What the node does once a second: it publishes its timing and its statuses, and logs what went wrong."""

from collections.abc import Callable
from dataclasses import asdict
from typing import Any

from rclpy.clock import Clock, ClockType

from ...bags import topics
from ...realtime.pacing import StepClock
from ...realtime.step_loop import StepLoop
from ...realtime.timing_statistics import Worst
from ...realtime.verdict import verdict
from ...runs.receipt import receipt_of
from ...scene.model import Scene
from ...simulation import RigEvent, RigEventKind
from . import reports
from .endpoints import publisher
from .graph_monitor import GraphMonitor
from .parameters import SceneNode
from .publishers import Publishers, RigEvents
from .record_service import RecordService

_PERIOD = 1.0     # s


class PeriodicReport:
    """Looks at the loop, the bag and the graph; `stamp_ns` returns the time that the reports bear."""

    def __init__(self, node: SceneNode, loop: StepLoop, clock: StepClock, publishers: Publishers, rig_events: RigEvents,
                 record_service: RecordService, stamp_ns: Callable[[], int]) -> None:
        self._node, self._loop, self._clock, self._stamp_ns = node, loop, clock, stamp_ns
        self._publishers, self._rig_events, self._record_service = publishers, rig_events, record_service
        self._reporter = reports.Reporter(loop)
        self._graph_monitor = GraphMonitor(node, node.scene, loop)
        self._logged = ''        # the failure of the solver that was logged
        self._timing_out = publisher(node, topics.TIMING)
        self._diagnostics_out = publisher(node, topics.DIAGNOSTICS)
        node.create_timer(_PERIOD, self.report, clock=Clock(clock_type=ClockType.STEADY_TIME))

    def begin(self) -> None:
        """Let the first second begin."""
        self._reporter.begin(self._clock.now())

    def forget_counts(self) -> None:
        """Begin anew, as the counters of the loop do."""
        self._reporter.forget_counts()

    def report(self) -> None:
        """Report on the second that ends now."""
        stamp_ns = self._stamp_ns()
        second = self._reporter.look(self._clock.now())
        said = verdict(self._node.scene, self._loop)
        self._log_troubles(second)
        message = reports.timing_message(second, self._loop, self._clock.period * 1e-9, bool(said.valid), stamp_ns)
        self._timing_out.publish(message)
        self._publishers.record_message(topics.TIMING, message, self._loop.time_ns, max(self._loop.step, 0))
        self._diagnostics_out.publish(reports.diagnostics(stamp_ns, self._node.get_fully_qualified_name(), [
            reports.loop_status(self._loop, second, said),
            reports.command_status(self._loop, second),
            reports.solver_status(self._loop, self._node.scene.solver.name, self._publishers.events.latest_time),
            reports.recorder_status(self._record_service.recordings),
            reports.graph_status(self._graph_monitor.look())]))

    def _log_troubles(self, second: reports.Second) -> None:
        log = self._node.get_logger()
        if second.skipped > 0.0:
            text = f'{second.skipped:.3f} s behind the clock were given up; simulation time lags by that much'
            log.warning(text)
            self._report(RigEvent(RigEventKind.TIME_LOST, '', text, second.skipped))
        for refusal in second.refusals:
            self._report(RigEvent(RigEventKind.COMMAND_REFUSED, refusal.name, refusal.reason, number=refusal.number))
        if self._loop.failure and self._loop.failure != self._logged:
            log.error(f'the axis stands still: {self._loop.failure}; ~/reset begins anew')
        self._logged = self._loop.failure
        self._record_service.look()

    def _report(self, event: RigEvent) -> None:
        self._rig_events.report(self._loop.step + 1, self._loop.time_ns, event)


# The receipt that ends a bag of the node: the figures of the run, its timing and its commands.

def run_receipt(scene: Scene, loop: StepLoop, publishers: Publishers, dropped: int, cost: tuple[float, float]
                ) -> dict[str, Any]:
    """Return the receipt of the run up to now; `cost` is CPU and wall time, s.

    Raises UnsoundError when the run contradicts itself.
    """
    simulator = loop.rig.simulator
    simulator.require_sound()
    period = 1.0 / scene.time.rate
    duration = max(simulator.time.seconds, period)
    figures = publishers.events.summary(duration)
    receipt = receipt_of(scene, duration, period, figures, simulator.root_iterations, simulator.sample(),
                         simulator.energy, *cost)
    slots = {slot.name: {'received': slot.received, 'refused': slot.refused} for slot in loop.slots}
    return {**receipt, 'timing': _timing(scene, loop), 'dropped_messages': dropped,
            'commands': {**slots, **loop.command_totals._asdict()}}


def _timing(scene: Scene, loop: StepLoop) -> dict[str, Any]:
    timing, counters = verdict(scene, loop), loop.pacing_counters
    worst = {f'worst_{name}': _plain(loop.timing_statistics.worst(name)) for name in ('cost', 'lateness', 'latency')}
    return {**asdict(counters), 'skipped': counters.skipped * 1e-9, **worst, 'valid': timing.valid,
            'verdict': timing.text, 'scheduling': loop.step_thread.granted, 'not_granted': loop.step_thread.missing}


def _plain(worst: Worst) -> dict[str, float] | None:
    """Return a worst case for JSON, which knows no NaN."""
    return worst._asdict() if worst.value == worst.value else None
