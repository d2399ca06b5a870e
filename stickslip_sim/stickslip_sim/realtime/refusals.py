# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Commands that were not taken since the report before: of which kind, how many, and why."""

from typing import NamedTuple

from ..rig import DRIVE_FAILED
from .step_loop import StepLoop


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
