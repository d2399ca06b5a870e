# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The friction of one direction: its static law, and its tables as straight lines over the speed."""

from __future__ import annotations

from dataclasses import dataclass, field

from mpmath import mp, mpf

from .problem import Line, SideOfProblem
from .statics import StaticLaw


@dataclass
class Side:
    """mu_s, mu_k and psi of motion, or against a force, in one direction."""

    given: SideOfProblem
    breakpoints: list[mpf] = field(init=False)   # above zero

    def __post_init__(self) -> None:
        self.breakpoints = self.given.breakpoints()

    @property
    def static(self) -> StaticLaw:
        """The static law."""
        return self.given.static

    @property
    def at_rest(self) -> mpf:
        """mu_k(0)."""
        return self.given.kinetic.values[0]

    @property
    def highest(self) -> mpf:
        """The largest coefficient that stands in the data."""
        return max(max(self.given.kinetic.values), self.static.initial, self.static.limit)

    def lower_breakpoint(self, segment: int) -> mpf:
        """Return the speed at which a segment begins."""
        return self.breakpoints[segment - 1] if segment else mpf(0)

    def upper_breakpoint(self, segment: int) -> mpf | None:
        """Return the speed at which a segment ends; None for the last one."""
        return self.breakpoints[segment] if segment < len(self.breakpoints) else None

    def locate(self, speed: mpf, rising: bool) -> int:
        """Return the segment of a speed; on a breakpoint the sign of the acceleration decides."""
        tiny = mpf(10) ** (18 - mp.dps)
        side = tiny if rising else -tiny
        return sum(1 for k in self.breakpoints if speed >= k * (1 - side))

    def kinetic_line(self, segment: int) -> Line:
        """Return mu_k(w) on a segment."""
        return self.given.kinetic.segment_above(self.lower_breakpoint(segment))

    def psi_line(self, segment: int) -> Line:
        """Return psi(w) on a segment."""
        if self.given.excess is None:
            return Line(mpf(0), mpf(0))
        return self.given.excess.segment_above(self.lower_breakpoint(segment))

    def kinetic_at(self, speed: mpf) -> mpf:
        """Return mu_k(w)."""
        return self.kinetic_line(self.locate(speed, True)).at(speed)

    def psi_at(self, speed: mpf) -> mpf:
        """Return psi(w)."""
        return self.psi_line(self.locate(speed, True)).at(speed)

    def excess_at(self, static: mpf, speed: mpf) -> mpf:
        """E with mu_k(w) + E psi(w) = mu_b; 0 where psi = 0; never negative."""
        psi = self.psi_at(speed)
        return max(mpf(0), (static - self.kinetic_at(speed)) / psi) if psi > 0 else mpf(0)
