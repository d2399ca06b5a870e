# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""An input profile in multiple precision: its segments one after the other, with periods and sinusoids."""

from __future__ import annotations

import math
from collections.abc import Iterator
from decimal import Decimal
from typing import NamedTuple

from mpmath import cos, inf, mpf, pi, sin

from ..core.input_profile import InputProfile
from .series import Series, series, to_decimal


class Segment(NamedTuple):
    """A straight segment from one instant on: value + slope (t - start)."""

    start: mpf
    value: mpf
    slope: mpf


class Turn(NamedTuple):
    """A sinusoid seen from an instant: amplitude sin(φ + ω τ), kept as sine and cosine of φ."""

    amplitude: mpf
    omega: mpf
    sine: mpf
    cosine: mpf

    def add_to(self, terms: Series) -> None:
        """Add the terms of the sinusoid to a power series in τ, as many as it has."""
        size, omega = to_decimal(self.amplitude), to_decimal(self.omega)
        cycle = [to_decimal(c) for c in (self.sine, self.cosine, -self.sine, -self.cosine)]
        for k in range(len(terms)):
            terms[k] += size * cycle[k % 4]
            size = size * omega / (k + 1)


class Signal(NamedTuple):
    """An input from an instant on, until the next segment begins."""

    value: mpf
    offset: mpf
    slope: mpf
    turns: tuple[Turn, ...]

    def series(self, order: int) -> Series:
        """Return its power series in the time since that instant: two terms, and up to `order` with sinusoids."""
        terms = series(self.offset, self.slope)
        if self.turns:
            terms += [Decimal(0)] * max(order - 1, 0)
            for turn in self.turns:
                turn.add_to(terms)
        return terms

    @property
    def rate(self) -> mpf:
        """Return the highest circular frequency in it."""
        return max((turn.omega for turn in self.turns), default=mpf(0))

    @property
    def is_constant(self) -> bool:
        """Return whether it keeps its value."""
        return not self.slope and not self.turns

    @property
    def reach(self) -> mpf:
        """Return a size that its value does not exceed now, at any phases."""
        return abs(self.offset) + sum((abs(turn.amplitude) for turn in self.turns), mpf(0))


class Input:
    """An input profile v(t), F(t) or N(t), followed in time; right-continuous.

    `until` is the instant at which the next segment begins (infinite behind the last).
    """

    def __init__(self, profile: InputProfile) -> None:
        self._sinusoids = profile.sinusoids
        self._segments = _segments(profile)
        self._here = next(self._segments)
        self._next = next(self._segments, None)

    @property
    def until(self) -> mpf:
        """Return the end of the segment that holds."""
        return self._next.start if self._next else inf

    def enter(self, t: mpf) -> None:
        """Let the segment hold that begins at or before `t`; t never goes back."""
        while self._next and self._next.start <= t:
            self._here, self._next = self._next, next(self._segments, None)

    def at(self, t: mpf) -> Signal:
        """Return the input from an instant of the present segment on; sinusoids run over absolute time."""
        here = self._here
        offset = here.value + here.slope * (t - here.start)
        turns = tuple(_turn(t, *map(mpf, sinusoid)) for sinusoid in self._sinusoids)
        value = offset + sum((turn.amplitude * turn.sine for turn in turns), mpf(0))
        return Signal(value, offset, here.slope, turns)


def _turn(t: mpf, amplitude: mpf, frequency: mpf, phase: mpf) -> Turn:
    omega = 2 * pi * frequency
    angle = omega * t + phase
    return Turn(amplitude, omega, sin(angle), cos(angle))


def _segments(profile: InputProfile) -> Iterator[Segment]:
    """Yield the segments in the order of time, without end when the input profile is periodic."""
    turn = 0
    segments = [Segment(*map(mpf, segment)) for segment in zip(profile.starts, profile.values, profile.rates)]
    while True:
        begin = turn * mpf(profile.period) if turn else mpf(0)
        for segment in segments:
            yield segment._replace(start=begin + segment.start)
        if math.isinf(profile.period):
            return
        turn += 1
