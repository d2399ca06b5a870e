# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Where the step loop takes its commands from: a slot for each kind, and the order that a command in it becomes."""

from collections.abc import Callable, Sequence
from typing import NamedTuple

from ..rig.step_result import Counts
from .command_slot import Command, CommandSlot

Order = Callable[[float], None]


class CommandTotals(NamedTuple):
    """What befell the commands of a run."""

    received: int
    refused: int
    lost: int         # to a fault
    limited: int      # the drive could not follow at once
    timed_out: int    # times that they stopped coming


class CommandInputs:
    """Gives each new command as an order once, and remembers which are in force; for the thread of the loop."""

    def __init__(self, slots: Sequence[CommandSlot], orders: Sequence[Order]) -> None:
        self.slots = slots
        self._orders = orders
        self._held: list[Command | None] = [None] * len(slots)

    @property
    def held(self) -> list[float | None]:
        """The commands in force, by input; None where the course of the scene is."""
        return [command.value if command else None for command in self._held]

    def totals(self, counts: Counts) -> CommandTotals:
        """Return what befell the commands so far, with what the rig counted."""
        return CommandTotals(sum(slot.received for slot in self.slots),
                             sum(slot.refused for slot in self.slots) + counts.refused,
                             counts.lost, counts.limited, counts.timed_out)

    def put(self, values: Sequence[float | None], now: int) -> None:
        """Let these be the latest commands, arrived now; None leaves the one in force."""
        for slot, value in zip(self.slots, values):
            if value is not None:
                slot.latest = Command(value, now)

    def take(self, now: int) -> tuple[int | None, int]:
        """Order what is new; return the age of the newest command in force, and when the newest new one arrived."""
        newest = fresh = 0
        for kind, slot in enumerate(self.slots):
            command = slot.latest
            if command is None:
                continue
            newest = max(newest, command.arrival)
            if command is not self._held[kind]:
                self._orders[kind](command.value)
                self._held[kind] = command
                fresh = max(fresh, command.arrival)
        return (now - newest if newest else None), fresh

    def forget(self) -> None:
        """Begin anew, as if no command had come."""
        for slot in self.slots:
            slot.forget()
        self._held = [None] * len(self.slots)
