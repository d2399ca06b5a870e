# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Commands on their way in: checked when they arrive, the latest good one kept until the step loop takes it."""

import math
from collections.abc import Sequence
from typing import NamedTuple

from ..core.time_grid import NANOSECONDS
from ..simulation.step_result import Counts


class Command(NamedTuple):
    """A command and when it arrived, ns on the steady clock."""

    value: float
    arrival: int


class CommandSlot:
    """The latest good command of one kind; one thread offers, one takes.

    `limit` bounds its magnitude; what lies beyond, and NaN, is refused and counted.
    """

    def __init__(self, name: str, unit: str, limit: float) -> None:
        self.name = name
        self.unit = unit
        self.limit = limit
        self.received = 0
        self.refused = 0
        self.last_refusal = ''
        self.latest: Command | None = None

    def offer(self, value: float, arrival: int) -> str:
        """Take a value that arrived; return why it is refused, or an empty text.  The one before stays then."""
        refusal = self.refusal(value)
        if refusal:
            return self.refuse(refusal)
        self.received += 1
        self.latest = Command(value, arrival)
        return ''

    def refuse(self, reason: str) -> str:
        """Count what arrived and is no command, for a reason; return what to log.  The one before stays."""
        self.received += 1
        self.last_refusal = f'{reason}; the previous command stays'
        self.refused += 1
        return self.last_refusal

    def refusal(self, value: float) -> str:
        """Return why a value would be refused, or an empty text."""
        if -self.limit <= value <= self.limit:   # false for NaN
            return ''
        return f'{self.name} = {value!r} is refused: must be finite and within ±{self.limit!r} {self.unit}'

    def forget(self) -> None:
        """Drop the command that waits or holds, and begin to count anew, as if none had come."""
        self.latest = None
        self.received = self.refused = 0
        self.last_refusal = ''


# Where the step loop takes its commands from: a slot for each kind, and which of them are new to a step.

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


# Notices that commands stop coming.

class Watchdog:
    """Is asked before each step, from the first command on; `timeout` in s, 0: never."""

    def __init__(self, timeout: float) -> None:
        self._timeout = math.ceil(timeout * NANOSECONDS)
        self.forget()

    @property
    def is_on(self) -> bool:
        """Whether there is a time-out at all."""
        return self._timeout > 0

    def forget(self) -> None:
        """Begin anew, as if no command had come."""
        self._heard = self._since = self._before = 0
        self._is_stale = False

    def silence(self, heard: int, now: int) -> float:
        """Return how long nothing came, s, when that has just become too long, else 0.

        `heard` counts the commands up to now, ns: what it counts anew came with the step before.
        """
        if heard != self._heard:
            self._heard, self._since, self._is_stale = heard, self._before, False
        self._before = now
        silence = now - self._since
        if self._is_stale or not heard or not self.is_on or silence <= self._timeout:
            return 0.0
        self._is_stale = True
        return silence / NANOSECONDS
