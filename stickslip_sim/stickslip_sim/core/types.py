# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The vocabulary of the hybrid system: modes, events, samples.  SI units throughout."""

from enum import IntEnum
from typing import NamedTuple

tuple_of = tuple.__new__    # tuple_of(Instant, (0.0, 0.5)) costs half of what Instant(0.0, 0.5) does


class Mode(IntEnum):
    """What the slider does: it sticks, slips in one of three sub-modes, or its compliant contact yields."""

    STICK = 0
    ACCELERATING = 1
    COASTING = 2
    DECELERATING = 3
    YIELDING = 4


class EventKind(IntEnum):
    """Why the mode changed (KNOT: the speed crossed a breakpoint of a friction table)."""

    BREAKAWAY = 0
    COAST = 1
    ACCELERATE = 2
    DECELERATE = 3
    STICK = 4
    REVERSE = 5
    KNOT = 6
    YIELD = 7


class Instant(NamedTuple):
    """A point of simulation time, kept in two parts so that late times stay exact."""

    second: float    # whole seconds
    fraction: float  # s, in [0, 1)

    @property
    def seconds(self) -> float:
        """The instant as one number of seconds."""
        return self.second + self.fraction

    @property
    def nanoseconds(self) -> int:
        """The instant rounded to nanoseconds."""
        return int(self.second) * 1_000_000_000 + round(self.fraction * 1e9)


class Event(NamedTuple):
    """One transition, with the state and the forces at that instant (before the mode changes)."""

    second: float              # whole seconds of the time
    fraction: float            # s, rest of the time
    kind: EventKind
    mode: Mode                 # after the event
    direction: int             # of the slip that begins, goes on or ends; of the force of a contact that yields
    position: float            # m
    velocity: float            # m/s
    drive_position: float      # m
    drive_force: float         # N
    friction_force: float      # N
    static_coefficient: float  # mu_s(rest_time)
    rest_time: float           # s, 0 where it does not stick

    @property
    def instant(self) -> Instant:
        """When it happened."""
        return Instant(self.second, self.fraction)

    @property
    def time(self) -> float:
        """When it happened, s."""
        return self.second + self.fraction


class Sample(NamedTuple):
    """The state at one instant."""

    second: float                # whole seconds of the time
    fraction: float              # s, rest of the time
    mode: Mode
    direction: int               # of slip, 0 in stick; of the force of a contact that yields
    position: float              # m
    velocity: float              # m/s
    acceleration: float          # m/s²
    drive_position: float        # m
    drive_velocity: float        # m/s
    drive_force: float           # N
    external_force: float        # N
    friction_force: float        # N
    friction_coefficient: float  # |friction force| / normal force, 0 without one
    contact_deflection: float    # m
    rest_time: float             # s, 0 where it does not stick

    @property
    def instant(self) -> Instant:
        """When it was taken."""
        return Instant(self.second, self.fraction)

    @property
    def time(self) -> float:
        """When it was taken, s."""
        return self.second + self.fraction
