# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""A scene as values by dotted name, and what is run of it."""

from dataclasses import dataclass
from functools import cached_property
from typing import Any, NamedTuple

from stickslip_sim.core.errors import InputError, SolverError
from stickslip_sim.core.types import EnergyBalance, Event, Sample
from stickslip_sim.proof.axes import Parts, instant
from stickslip_sim.proof.judges import Find
from stickslip_sim.scene import Scene, scene_from_values
from tests.support.time_and_memory import within

Values = dict[str, Any]
MOST_EVENTS = 120        # of a run that is judged; what comes later is cut off
_SLICES = 32             # in which it is seen how far that many events go,
_PATIENCE = 2.0          # s for a slice; some million events
_HALVINGS = 40           # and parts of the first, each twice as long as the one before: it may hold any number


class LastBits(Find):
    """The same events, but for digits that rounding may change."""


class Undecided(Exception):  # noqa: N818
    """A judge cannot decide: the data differ from a tie by rounding, or it takes too long."""


@dataclass
class Case:
    """A scene and the seconds to run it."""

    values: Values
    duration: float

    @cached_property
    def scene(self) -> Scene:
        """The scene; raises InputError."""
        return scene_from_values(self.values, 'hostile')

    @property
    def parts(self) -> Parts:
        """What is run; raises InputError."""
        scene = self.scene
        return Parts(scene.axis, scene.initial, scene.drive, scene.force, self.duration, scene.normal_load)

    @property
    def events(self) -> list[Event]:
        """The events of its run; none of one that is refused."""
        try:
            return self.parts.events()
        except (InputError, SolverError):
            return []


class Run(NamedTuple):
    """A run of the engine, cut into its inputs' pieces: events before the start, and (events, state) to each border."""

    parts: Parts
    at_start: list[Event]
    start: Sample
    stretches: list[tuple[list[Event], Sample]]
    energy: EnergyBalance
    size: int             # events

    @property
    def events(self) -> list[Event]:
        """All events in the order of time."""
        return self.at_start + [event for events, _ in self.stretches for event in events]


def run(parts: Parts) -> Run:
    """Run with a state at each border of the inputs, about as far as MOST_EVENTS go.  Raises SolverError."""
    parts = _cut(parts)
    sim = parts.simulator(accounting=True)
    at_start = list(sim.reset())
    start = sim.sample()
    stretches: list[tuple[list[Event], Sample]] = []
    count, first = len(at_start), len(at_start)
    for border in borders(parts):
        events = sim.advance(instant(border))[first:]
        first = 0
        stretches.append((events, sim.sample()))
        count += len(events)
    sim.require_sound()
    energy = sim.energy
    assert energy is not None
    return Run(parts, at_start, start, stretches, energy, count)


def _cut(parts: Parts) -> Parts:
    """Return the parts with a duration in which MOST_EVENTS fall, or few more."""
    sim, count = parts.simulator(), 0
    if len(ends := borders(parts)) > MOST_EVENTS:
        parts = parts._replace(duration=ends[MOST_EVENTS])
    begin = 0.0
    for share in (*(2.0 ** -k for k in range(_HALVINGS, 0, -1)), *range(1, _SLICES + 1)):
        end = parts.duration * share / _SLICES
        try:
            with within(_PATIENCE):
                count += len(sim.advance(instant(end)))
        except TimeoutError:    # a slice after years at rest may hold any number, too
            return parts._replace(duration=begin)
        if count > MOST_EVENTS:
            return parts._replace(duration=end)
        begin = end
    return parts


def borders(parts: Parts) -> list[float]:
    """Return the times at which a piece of an input ends, and the end of the run."""
    times: list[float] = []
    time = 0.0
    while len(times) <= MOST_EVENTS:
        time = min(profile.piece_at(time).end for profile in parts.inputs)
        if not time < parts.duration:
            break
        times.append(time)
    return [*times, parts.duration]
