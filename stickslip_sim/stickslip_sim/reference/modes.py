# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The modes of the automaton."""

from __future__ import annotations

from dataclasses import dataclass

from mpmath import mpf

from ..core import types

ACCELERATE, COAST, DECELERATE = 'accelerate', 'coast', 'decelerate'


@dataclass(frozen=True)
class Stick:
    """Rest since an instant, entered with an age of the contact (0 after a slip); ``still``: a swing that died out."""

    since: mpf
    age: mpf
    still: bool = False

    def rest_time(self, t: mpf) -> mpf:
        """Return the age of the contact at an instant."""
        return self.age + (t - self.since)


@dataclass(frozen=True)
class Slip:
    """Motion in a direction: sub-mode, excess E of this slip, table segment; ``silent``: an unlisted coast."""

    direction: int
    phase: str
    excess: mpf
    segment: int
    silent: bool = False


@dataclass(frozen=True)
class Yield:
    """A compliant contact that gives way at its limit, in the direction of its force, while the slider does not."""

    direction: int


Mode = Stick | Slip | Yield
_WORDS = {ACCELERATE: types.Mode.ACCELERATING, COAST: types.Mode.COASTING, DECELERATE: types.Mode.DECELERATING}


def word(mode: Mode) -> types.Mode:
    """Return the package's name of a mode."""
    if isinstance(mode, Stick):
        return types.Mode.STICK
    if isinstance(mode, Yield):
        return types.Mode.YIELDING
    return types.Mode.ACCELERATING if mode.silent else _WORDS[mode.phase]
