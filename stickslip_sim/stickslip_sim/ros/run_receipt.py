"""The receipt that ends a bag of the node: the figures of the run, its timing and its commands."""

from collections.abc import Sequence
from dataclasses import asdict
from typing import Any

from ..analysis import summary
from ..commands import CommandSlot
from ..pacing import Account
from ..receipt import receipt_of
from ..scene.model import Scene
from ..simulator import Simulator
from .outlet import Outlet


def run_receipt(scene: Scene, simulator: Simulator, outlet: Outlet, account: Account, slots: Sequence[CommandSlot],
                dropped: int, cost: tuple[float, float]) -> dict[str, Any]:
    """Return the receipt of the run up to now; `cost` is CPU and wall time, s."""
    period = 1.0 / scene.time.rate
    duration = max(simulator.time.seconds, period)
    events = list(outlet.events)
    figures = summary(events, duration, outlet.first_mode)
    receipt = receipt_of(scene, duration, period, figures, simulator.root_iterations, simulator.sample(),
                         simulator.energy, *cost)
    timing = asdict(account)
    timing['skipped'] = timing['skipped'] * 1e-9
    return {**receipt, 'timing': timing, 'dropped_messages': dropped,
            'commands': {slot.name: {'received': slot.received, 'refused': slot.refused} for slot in slots}}
