# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""What the node reports about itself once a second: StepTiming and the statuses of /diagnostics."""

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import asdict
from typing import Any, NamedTuple

from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus, KeyValue
from rclpy.clock import Clock, ClockType

from stickslip_msgs.msg import StepTiming

from ...bags import topics
from ...realtime.pacing import StepClock
from ...realtime.step_loop import StepLoop
from ...realtime.timing_statistics import TimingWindow, Worst
from ...realtime.verdict import Refusal, Refusals, TimingVerdict, verdict
from ...recording.recordings import Recordings
from ...runs.simulated import receipt_of
from ...scene.model import Scene
from ...simulation import DRIVE_FAILED, SILENT_BRIDGE, RigEvent, RigEventKind
from .endpoints import publisher, set_stamp
from .graph_monitor import GraphMonitor
from .parameters import SceneNode
from .publishers import Publishers, RigEvents
from .record_service import RecordService

OK, WARN, ERROR = DiagnosticStatus.OK, DiagnosticStatus.WARN, DiagnosticStatus.ERROR
_MANY_OVERRUNS = 0.05    # share of the steps; the odd one is what a desktop kernel does


class Second(NamedTuple):
    """What happened in the window since the report before."""

    window: TimingWindow
    real_time_factor: float
    overruns: int
    caught_up: int
    skipped: float          # s of wall time given up
    refusals: Sequence[Refusal]


class Reporter:
    """Sums up window after window; remembers what it saw last."""

    def __init__(self, loop: StepLoop) -> None:
        self._loop, self._refusals = loop, Refusals(loop)
        self._wall = self._time = 0
        self.forget_counts()

    def forget_counts(self) -> None:
        """Begin anew, as the counters do."""
        self._before = (0, 0, 0)
        self._refusals.forget()

    def begin(self, now: int) -> None:
        """Let the first window begin; `now` is ns on the steady clock."""
        self._wall = now

    def look(self, now: int) -> Second:
        """Return what happened since the look before; `now` is ns on the steady clock."""
        window = self._loop.timing_statistics.take()
        time, counters = self._loop.time_ns, self._loop.pacing_counters
        passed = now - self._wall
        factor = (time - self._time) / passed if passed > 0 and time >= self._time else math.nan
        self._wall, self._time = now, time
        counts = (counters.overruns, counters.caught_up, counters.skipped)
        overruns, caught_up, skipped = (new - old for new, old in zip(counts, self._before))
        self._before = counts
        return Second(window, factor, overruns, caught_up, skipped * 1e-9, self._refusals.look())


def timing_message(second: Second, loop: StepLoop, period: float, valid: bool, stamp_ns: int) -> StepTiming:
    """Return the message of a window that ends with the latest step."""
    counters, totals, window = loop.pacing_counters, loop.command_totals, second.window
    lateness, latency = loop.timing_statistics.worst('lateness'), loop.timing_statistics.worst('latency')
    message = StepTiming(
        step=max(loop.step, 0), period=period, real_time_factor=second.real_time_factor, steps=window.steps,
        overruns=second.overruns, total_overruns=counters.overruns, caught_up=second.caught_up,
        total_caught_up=counters.caught_up, total_received=totals.received, total_refused=totals.refused,
        total_lost=totals.lost, total_limited=totals.limited, total_timed_out=totals.timed_out,
        total_skipped=counters.skipped * 1e-9, worst_lateness=lateness.value, worst_lateness_time=lateness.time,
        worst_latency=latency.value, worst_latency_time=latency.time, valid=valid)
    set_stamp(message.header.stamp, stamp_ns)
    for name, quantiles in (('cost', window.cost), ('lateness', window.lateness), ('command_age', window.age),
                            ('latency', window.latency)):
        for quantile, value in quantiles._asdict().items():
            setattr(message, f'{name}_{quantile}', value)
    return message


def diagnostics(stamp_ns: int, node: str, statuses: Sequence[DiagnosticStatus]) -> DiagnosticArray:
    """Return the message that carries the statuses of a node; an aggregator distinguishes nodes by their names."""
    message = DiagnosticArray(status=list(statuses))
    set_stamp(message.header.stamp, stamp_ns)
    for status in message.status:
        status.hardware_id, status.name = node, f'{node}: {status.name}'
    return message


def loop_status(loop: StepLoop, second: Second, verdict: TimingVerdict) -> DiagnosticStatus:
    """Report whether the steps keep their time."""
    level, text = _pace(loop, second)
    counters, window = loop.pacing_counters, second.window
    worst = {f'worst {name} / s': f'{case.value:.9g} at t = {case.time:.9g} s'
             for name in ('cost', 'lateness',
                          'latency') if not math.isnan((case := loop.timing_statistics.worst(name)).value)}
    return _status('step loop', level, text, {
        'verdict': verdict.text, 'scheduling': loop.step_thread.granted or 'as any thread',
        'not granted': '; '.join(loop.step_thread.missing) or 'none',
        'step': loop.step, 'simulation time / s': loop.time_ns * 1e-9, 'real-time factor': second.real_time_factor,
        'cost p50 / s': window.cost.p50, 'cost p99 / s': window.cost.p99,
        'lateness p50 / s': window.lateness.p50, 'lateness p99 / s': window.lateness.p99,
        'lateness max / s': window.lateness.max, **worst, 'overruns': counters.overruns,
        'caught up': counters.caught_up, 'times skipped': counters.skips, 'skipped / s': counters.skipped * 1e-9})


def _pace(loop: StepLoop, second: Second) -> tuple[bytes, str]:
    steps = second.window.steps
    if loop.failure:
        return ERROR, 'stopped by the solver'
    if loop.paused:
        return OK, 'paused: simulation time stands still'
    if loop.by_request:
        return OK, 'lock-step: time moves with ~/step'
    if steps == 0 and loop.step > 0:
        return ERROR, 'no step in the last second'
    if second.skipped > 0.0:
        return WARN, f'{second.skipped:.3f} s behind the clock given up: too slow, or suspended'
    if second.overruns > _MANY_OVERRUNS * max(steps, 1):
        return WARN, f'{second.overruns} of {steps} steps began more than a period late'
    return OK, 'on time'


def command_status(loop: StepLoop, second: Second) -> DiagnosticStatus:
    """Report what came in, and what was refused since the report before."""
    slots, totals, rig = loop.slots, loop.command_totals, loop.rig
    level, text = OK, 'waiting for the first' if all(slot.latest is None for slot in slots) else 'in force'
    if second.refusals:
        level, text = WARN, '; '.join(f'{refusal.number} refused: {refusal.reason}' for refusal in second.refusals)
    if rig.is_silent:
        level, text = WARN, f'timed out: no drive velocity comes; {SILENT_BRIDGE}'
    if rig.has_failed:
        level, text = ERROR, DRIVE_FAILED
    values: dict[str, object] = {
        'age p99 / s': second.window.age.p99, 'latency p50 / s': second.window.latency.p50,
        'latency p99 / s': second.window.latency.p99, 'lost': totals.lost, 'limited': totals.limited,
        'timed out': totals.timed_out, 'faults': ', '.join(rig.fault_ids) or 'none'}
    for slot in slots:
        values |= {f'{slot.name} / ({slot.unit})': slot.latest.value if slot.latest else 'none',
                   f'{slot.name} received': slot.received, f'{slot.name} refused': slot.refused,
                   f'{slot.name} last refusal': slot.last_refusal or 'none'}
    return _status('command', level, text, values)


def solver_status(loop: StepLoop, name: str, last_event: float | None) -> DiagnosticStatus:
    """Report whether the solver goes on, and what it located."""
    return _status('solver', ERROR if loop.failure else OK, loop.failure or 'goes on', {
        'solver': name,
        **{f'events {kind.name.lower()}': count for kind, count in loop.rig.simulator.event_counts.items()},
        'root iterations': loop.rig.simulator.root_iterations,
        'last event / s': 'none' if last_event is None else last_event})


def recorder_status(recordings: Recordings) -> DiagnosticStatus:
    """Report where messages are written, and whether any were lost."""
    recorder = recordings.recorder
    text = f'recording into {recordings.folder}' if recorder else 'not recording'
    level = WARN if recordings.total_dropped else OK
    if recordings.failure:
        level, text = ERROR, recordings.failure
    return _status('recorder', level, text, {
        'folder': recordings.folder or 'none', 'written': recorder.written if recorder else 0,
        'waiting': recorder.waiting if recorder else 0, 'dropped': recordings.total_dropped})


def graph_status(troubles: Sequence[str]) -> DiagnosticStatus:
    """Report who else publishes where one should, and who fell silent."""
    return _status('neighbours', WARN if troubles else OK, '; '.join(troubles) or 'nobody in the way', {})


def _status(name: str, level: bytes, text: str, values: Mapping[str, object]) -> DiagnosticStatus:
    pairs = [KeyValue(key=key, value=f'{value:.9g}' if isinstance(value, float) else str(value))
             for key, value in values.items()]
    return DiagnosticStatus(name=name, level=level, message=text, values=pairs)


# What the node does once a second: it publishes its timing and its statuses, and logs what went wrong.

PERIOD = 1.0      # s; tests have less


class PeriodicReport:
    """Looks at the loop, the bag and the graph; `stamp_ns` returns the time that the reports bear."""

    def __init__(self, node: SceneNode, loop: StepLoop, clock: StepClock, publishers: Publishers, rig_events: RigEvents,
                 record_service: RecordService, stamp_ns: Callable[[], int]) -> None:
        self._node, self._loop, self._clock, self._stamp_ns = node, loop, clock, stamp_ns
        self._publishers, self._rig_events, self._record_service = publishers, rig_events, record_service
        self._reporter = Reporter(loop)
        self._graph_monitor = GraphMonitor(node, node.scene, loop)
        self._logged = ''        # the failure of the solver that was logged
        self._timing_out = publisher(node, topics.TIMING)
        self._diagnostics_out = publisher(node, topics.DIAGNOSTICS)
        node.create_timer(PERIOD, self.report, clock=Clock(clock_type=ClockType.STEADY_TIME))

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
        message = timing_message(second, self._loop, self._clock.period * 1e-9, bool(said.valid), stamp_ns)
        self._timing_out.publish(message)
        self._publishers.record_message(topics.TIMING, message, self._loop.time_ns, max(self._loop.step, 0))
        self._diagnostics_out.publish(diagnostics(stamp_ns, self._node.get_fully_qualified_name(), [
            loop_status(self._loop, second, said),
            command_status(self._loop, second),
            solver_status(self._loop, self._node.scene.solver.name, self._publishers.events.latest_time),
            recorder_status(self._record_service.recordings),
            graph_status(self._graph_monitor.look())]))

    def _log_troubles(self, second: Second) -> None:
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
