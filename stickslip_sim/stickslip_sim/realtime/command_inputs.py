# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Where the step loop takes its commands from: a slot for each kind, and which of them are new to a step."""

from collections.abc import Sequence
from typing import NamedTuple

from ..rig.step_result import Counts
from .command_slot import Command, CommandSlot


class CommandTotals(NamedTuple):
    """What befell the commands of a run."""

    received: int
    refused: int
    lost: int         # to a fault
    limited: int      # changed by a limit of the drive
    timed_out: int    # times that they stopped coming


class NewCommands(NamedTuple):
    """What a step takes up; None where nothing new has come."""

    velocity: float | None    # m/s
    force: float | None       # N
    age: int | None           # ns since the newest command in force arrived, None without one
    arrival: int              # of the newest of these, ns on the steady clock; 0 without one


class CommandInputs:
    """Hands out each new command once, and remembers which are in force; for the thread of the loop."""

    def __init__(self, slots: tuple[CommandSlot, CommandSlot]) -> None:
        self.slots = slots
        self._velocity, self._force = slots
        self._held_velocity: Command | None = None
        self._held_force: Command | None = None

    @property
    def held(self) -> list[float | None]:
        """The commands in force, by input; None where the input profile of the scene is."""
        return [command.value if command else None for command in (self._held_velocity, self._held_force)]

    def totals(self, counts: Counts) -> CommandTotals:
        """Return what befell the commands so far, with what the rig counted."""
        return CommandTotals(sum(slot.received for slot in self.slots),
                             sum(slot.refused for slot in self.slots) + counts.refused,
                             counts.lost, counts.limited, counts.timed_out)

    def put(self, values: Sequence[float | None], now: int) -> None:
        """Let these be the latest commands, arrived now; None leaves the one in force."""
        for slot, value in zip(self.slots, values):
            if value is not None:
                slot.received += 1
                slot.latest = Command(value, now)

    def take(self, now: int) -> NewCommands:
        """Return what has come since the last time; it is in force then."""
        velocity, force = self._velocity.latest, self._force.latest
        new_velocity = velocity if velocity is not self._held_velocity else None
        new_force = force if force is not self._held_force else None
        self._held_velocity, self._held_force = velocity, force
        newest = _later(velocity, force)
        return NewCommands(new_velocity.value if new_velocity else None, new_force.value if new_force else None,
                           now - newest if newest else None, _later(new_velocity, new_force))

    def forget(self) -> None:
        """Begin anew, as if no command had come."""
        for slot in self.slots:
            slot.forget()
        self._held_velocity = self._held_force = None


def _later(one: Command | None, other: Command | None) -> int:
    """Return when the later of two commands arrived, ns; 0 without any."""
    return max(one.arrival if one else 0, other.arrival if other else 0)
