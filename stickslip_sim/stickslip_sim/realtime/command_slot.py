# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Commands on their way in: checked when they arrive, the latest good one kept until the step loop takes it."""

from typing import NamedTuple


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
