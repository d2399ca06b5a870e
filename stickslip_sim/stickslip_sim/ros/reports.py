"""What the node tells about itself once a second: StepTiming and the four statuses of /diagnostics."""

import math
from collections.abc import Mapping, Sequence
from typing import NamedTuple

from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus, KeyValue

from stickslip_msgs.msg import StepTiming

from ..commands import CommandSlot
from ..pacing import Account
from ..words import Event, EventKind
from .conversion import set_stamp
from .loop import StepLoop
from .recordings import Recordings
from .timing import Quantiles

OK, WARN, ERROR = DiagnosticStatus.OK, DiagnosticStatus.WARN, DiagnosticStatus.ERROR
_MANY_OVERRUNS = 0.05    # share of the steps; the odd one is what a desktop kernel does


class Second(NamedTuple):
    """What happened in the window since the report before."""

    steps: int
    cost: Quantiles
    lateness: Quantiles
    age: Quantiles
    real_time_factor: float
    overruns: int
    caught_up: int
    skipped: float          # s of wall time given up
    refused: int            # commands


class Reporter:
    """Sums up window after window; remembers what it saw last."""

    def __init__(self, loop: StepLoop, account: Account, slots: Sequence[CommandSlot]) -> None:
        self._loop, self._account, self._slots = loop, account, slots
        self._wall = self._time = 0
        self.forget_counts()

    def forget_counts(self) -> None:
        """Begin anew, as the counters do."""
        self._before = (0, 0, 0, 0)

    def begin(self, now: int) -> None:
        """Let the first window begin; `now` is ns on the steady clock."""
        self._wall = now

    def look(self, now: int) -> Second:
        """Return what happened since the look before; `now` is ns on the steady clock."""
        steps, cost, lateness, age = self._loop.window.take()
        time, account = self._loop.time_ns, self._account
        passed = now - self._wall
        factor = (time - self._time) / passed if passed > 0 and time >= self._time else math.nan
        self._wall, self._time = now, time
        counts = (account.overruns, account.caught_up, account.skipped, sum(slot.refused for slot in self._slots))
        overruns, caught_up, skipped, refused = (new - old for new, old in zip(counts, self._before))
        self._before = counts
        return Second(steps, cost, lateness, age, factor, overruns, caught_up, skipped * 1e-9, refused)


def timing_message(second: Second, step: int, period: float, account: Account, stamp_ns: int) -> StepTiming:
    """Return the message of a window that ends with a step."""
    message = StepTiming(step=max(step, 0), period=period, real_time_factor=second.real_time_factor,
                         steps=second.steps, overruns=second.overruns, total_overruns=account.overruns,
                         caught_up=second.caught_up, total_caught_up=account.caught_up)
    set_stamp(message.header.stamp, stamp_ns)
    for name, quantiles in (('cost', second.cost), ('lateness', second.lateness), ('command_age', second.age)):
        for quantile, value in quantiles._asdict().items():
            setattr(message, f'{name}_{quantile}', value)
    return message


def diagnostics(stamp_ns: int, hardware_id: str, statuses: Sequence[DiagnosticStatus]) -> DiagnosticArray:
    """Return the message that carries the statuses."""
    message = DiagnosticArray(status=list(statuses))
    set_stamp(message.header.stamp, stamp_ns)
    for status in message.status:
        status.hardware_id = hardware_id
    return message


def loop_status(loop: StepLoop, account: Account, second: Second) -> DiagnosticStatus:
    """Tell whether the steps keep their time."""
    level, text = OK, 'on time'
    if loop.paused or loop.failure:
        text = 'paused: simulation time stands still' if loop.paused else 'stopped by the solver'
        level = ERROR if loop.failure else OK
    elif second.steps == 0 and loop.step > 0:
        level, text = ERROR, 'no step in the last second'
    elif second.skipped > 0.0:
        level, text = WARN, f'{second.skipped:.3f} s behind the clock given up: too slow, or suspended'
    elif second.overruns > _MANY_OVERRUNS * max(second.steps, 1):
        level, text = WARN, f'{second.overruns} of {second.steps} steps began more than a period late'
    return _status('step loop', level, text, {
        'step': loop.step, 'simulation time / s': loop.time_ns * 1e-9, 'real-time factor': second.real_time_factor,
        'cost p50 / s': second.cost.p50, 'cost p99 / s': second.cost.p99,
        'lateness p50 / s': second.lateness.p50, 'lateness p99 / s': second.lateness.p99,
        'lateness max / s': second.lateness.max, 'overruns': account.overruns, 'caught up': account.caught_up,
        'times skipped': account.skips, 'skipped / s': account.skipped * 1e-9})


def command_status(slots: Sequence[CommandSlot], second: Second) -> DiagnosticStatus:
    """Tell what came in, and what was refused since the report before."""
    text = 'waiting for the first' if all(slot.latest is None for slot in slots) else 'in force'
    if second.refused:
        text = f'{second.refused} refused; ' + '; '.join(slot.last_refusal for slot in slots if slot.last_refusal)
    values: dict[str, object] = {'age p99 / s': second.age.p99}
    for slot in slots:
        values |= {f'{slot.name} / ({slot.unit})': slot.latest.value if slot.latest else 'none',
                   f'{slot.name} received': slot.received, f'{slot.name} refused': slot.refused,
                   f'{slot.name} last refusal': slot.last_refusal or 'none'}
    return _status('command', WARN if second.refused else OK, text, values)


def solver_status(loop: StepLoop, name: str, counts: Mapping[EventKind, int], last: Event | None) -> DiagnosticStatus:
    """Tell whether the solver goes on, and what it located."""
    return _status('solver', ERROR if loop.failure else OK, loop.failure or 'goes on', {
        'solver': name, **{f'events {kind.name.lower()}': count for kind, count in counts.items()},
        'root iterations': loop.simulator.root_iterations, 'last event / s': last.time if last else 'none'})


def recorder_status(recordings: Recordings) -> DiagnosticStatus:
    """Tell where messages are written, and whether any were lost."""
    recorder = recordings.recorder
    text = f'recording into {recordings.folder}' if recorder else 'not recording'
    level = WARN if recordings.total_dropped else OK
    if recordings.failure:
        level, text = ERROR, recordings.failure
    return _status('recorder', level, text, {
        'folder': recordings.folder or 'none', 'written': recorder.written if recorder else 0,
        'waiting': recorder.waiting if recorder else 0, 'dropped': recordings.total_dropped})


def _status(name: str, level: bytes, text: str, values: Mapping[str, object]) -> DiagnosticStatus:
    pairs = [KeyValue(key=key, value=f'{value:.9g}' if isinstance(value, float) else str(value))
             for key, value in values.items()]
    return DiagnosticStatus(name=name, level=level, message=text, values=pairs)
