# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The receipt that ends a bag of the node: the figures of the run, its timing and its commands."""

from dataclasses import asdict
from typing import Any

from ...realtime.step_loop import StepLoop
from ...realtime.timing_statistics import Worst
from ...realtime.verdict import verdict
from ...runs.receipt import receipt_of
from ...scene.model import Scene
from ..node.publishers import Publishers


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
