# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""A run in multiple precision: its events, and its motion as power series."""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Iterable
from dataclasses import dataclass

import mpmath
from mpmath import mpf

from ..core import types
from .flow import Flow, State, after
from .modes import Mode, word
from .physics import Physics
from .problem import Input, Signal
from .result import Final, ReferenceRun
from .series import working


@dataclass(frozen=True)
class Event:
    """One transition, with `mode` after it.

    The state is continuous.  `friction_force` is the limit σ N mu_s at a break-away, that of the slip which ends at a
    stick or reversal, and that of the new sub-mode otherwise (different from the old one only where an input jumps).
    """

    time: mpf
    kind: str
    mode: types.Mode
    direction: int
    position: mpf
    velocity: mpf
    drive_position: mpf
    drive_force: mpf
    friction_force: mpf
    static_coefficient: mpf
    rest_time: mpf


@dataclass(frozen=True)
class Sample:
    """State at a given time (after the transition when there is one at that time)."""

    time: mpf
    mode: types.Mode
    position: mpf
    velocity: mpf
    drive_position: mpf
    drive_force: mpf
    friction_force: mpf


@dataclass(frozen=True)
class Stretch:
    """A stretch of one mode: it starts at ``start`` in ``state`` and is followed by a power series."""

    start: mpf
    length: mpf
    state: State
    flow: Flow
    mode: Mode


class Run(list[Event]):
    """The events of a simulation, with its motion as power series.

    `final` is the state at its end.
    `disputed` counts compliant break-aways on which the model is silent: force and motion of opposite signs where the
    drive's force ends a stick, or kinetic friction at the break-away speed above the static limit (E is then 0).
    """

    def __init__(self, physics: Physics, digits: int) -> None:
        super().__init__()
        self.physics = physics
        self.digits = digits
        self.stretches: list[Stretch] = []
        self.disputed = 0
        self.final: Sample

    def state_at(self, times: Iterable[float | mpf]) -> list[Sample]:
        """Return position, velocity, drive force and friction force at the given times."""
        with working(self.digits):
            return [self._sample(mpf(t)) for t in times]

    def _sample(self, t: mpf) -> Sample:
        index = bisect_right(self.stretches, t, key=lambda stretch: stretch.start) - 1
        if index < 0 or t > self.stretches[-1].start + self.stretches[-1].length:
            raise ValueError('the time lies outside the simulated interval')
        stretch = self.stretches[index]
        inputs = self._inputs(t)
        series = stretch.flow.expand(stretch.state, stretch.length)
        place = after(stretch.state, stretch.flow, series, t - stretch.start)
        return sample(self.physics, stretch.mode, t, State(*place, *inputs))

    def _inputs(self, t: mpf) -> list[Signal]:
        inputs = [Input(profile) for profile in self.physics.axis.inputs]
        for one in inputs:
            one.enter(t)
        return [one.at(t) for one in inputs]


def sample(physics: Physics, mode: Mode, t: mpf, state: State) -> Sample:
    """Return a state of a mode with its forces."""
    return Sample(
        t,
        word(mode),
        state.position,
        state.velocity,
        state.position + state.stretch,
        physics.drive_force(state),
        physics.friction(mode, state),
    )


# From multiple precision to the floats of the package.

_KINDS = {kind.name.lower(): kind for kind in types.EventKind}


def rounded(run: Run) -> ReferenceRun:
    """Return the run with its numbers rounded to floats."""
    with mpmath.workdps(run.digits):
        return ReferenceRun([_event(event) for event in run], _final(run), run)


def _event(event: Event) -> types.Event:
    second, fraction = split(event.time)
    return types.Event(
        second,
        fraction,
        _KINDS[event.kind],
        event.mode,
        event.direction,
        float(event.position),
        float(event.velocity),
        float(event.drive_position),
        float(event.drive_force),
        float(event.friction_force),
        float(event.static_coefficient),
        float(event.rest_time),
    )


def split(time: mpf) -> tuple[float, float]:
    """Return whole seconds and the rest, which is the nearest float below 1 s."""
    second = mpmath.floor(time)
    fraction = float(time - second)
    return (float(second), fraction) if fraction < 1.0 else (float(second) + 1.0, 0.0)


def _final(run: Run) -> Final:
    end = run.final
    return Final(float(end.position), float(end.velocity), float(end.drive_position), end.mode)
