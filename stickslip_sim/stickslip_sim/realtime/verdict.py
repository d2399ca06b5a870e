# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""One line on whether a run can be trusted in real time, and what befell its commands."""

from typing import NamedTuple

from ..scene.model import Scene, TimingSettings
from ..simulation import DRIVE_FAILED
from .pacing import PacingCounters
from .step_loop import StepLoop
from .timing_statistics import TimingStatistics


class TimingVerdict(NamedTuple):
    """`valid` is None when there was no real-time clock to keep."""

    valid: bool | None
    text: str


def verdict(scene: Scene, loop: StepLoop) -> TimingVerdict:
    """Return the verdict on the run so far, against the limits in the section `timing` of the scene."""
    commands = _commands(loop) + _scheduling(loop)
    if scene.time.mode != 'realtime':
        return TimingVerdict(None, f'not in real time (time.mode {scene.time.mode}); {commands}')
    reasons = _reasons(scene.timing, loop.timing_statistics, loop.pacing_counters)
    lateness = loop.timing_statistics.worst('lateness')
    worst = f'worst {lateness.value * 1e3:.2f} ms at t = {lateness.time:.4g} s'
    why = f' ({"; ".join(reasons)})' if reasons else ''
    return TimingVerdict(not reasons, f'real-time valid: {"no" if reasons else "yes"}, {worst}{why}; {commands}')


def _reasons(limits: TimingSettings, timing_statistics: TimingStatistics, counters: PacingCounters) -> list[str]:
    """Return what is beyond the limits."""
    reasons = []
    if counters.skipped:
        reasons.append(f'{counters.skipped * 1e-9:.3f} s of wall time given up')
    for name, limit in (('lateness', limits.max_lateness), ('latency', limits.max_latency)):
        worst = timing_statistics.worst(name)
        if worst.value > limit:
            reasons.append(f'{name} {worst.value * 1e3:.2f} ms at t = {worst.time:.4g} s is over {limit * 1e3:g} ms')
    share = counters.overruns / max(counters.steps, 1)
    if share > limits.max_overruns:
        reasons.append(f'{share:.2%} of the steps more than a period late, over {limits.max_overruns:.2%}')
    return reasons


def _scheduling(loop: StepLoop) -> str:
    """Return what the kernel grants the step thread, and whether anything is missing; nothing of what is not wanted."""
    thread = loop.step_thread
    if not (thread.granted or thread.missing):
        return ''
    granted = thread.granted or 'as any thread'
    return f'; scheduling: {granted}{" (not all that is wanted)" if thread.missing else ""}'


def _commands(loop: StepLoop) -> str:
    totals = loop.command_totals
    return (f'commands: {totals.received} received, {totals.refused} refused, {totals.lost} lost, {totals.limited}'
            f' limited, {totals.timed_out} time-out{"" if totals.timed_out == 1 else "s"}')


# Commands that were not taken since the report before: of which kind, how many, and why.

class Refusal(NamedTuple):
    """Commands of one kind that were refused at one place, and why the latest of them was."""

    name: str
    reason: str
    number: int


class Refusals:
    """Looks at where commands arrive, and at the drive, which takes none after a time-out with on_timeout: fault."""

    def __init__(self, loop: StepLoop) -> None:
        self._loop = loop
        self.forget()

    def forget(self) -> None:
        """Begin anew, as the counters do."""
        self._known = [0] * len(self._so_far())

    def look(self) -> list[Refusal]:
        """Return what was refused since the look before."""
        so_far = self._so_far()
        new = [refusal._replace(number=refusal.number - known) for refusal, known in zip(so_far, self._known)]
        self._known = [refusal.number for refusal in so_far]
        return [refusal for refusal in new if refusal.number > 0]

    def _so_far(self) -> list[Refusal]:
        return [*(Refusal(slot.name, slot.last_refusal, slot.refused) for slot in self._loop.slots),
                Refusal('velocity', DRIVE_FAILED, self._loop.rig.counts.refused)]
