# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The vocabulary of the hybrid system: modes, events, samples.  SI units throughout."""

from collections.abc import Callable
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


# The energy balance of a run: what the drive and the load put in, what friction and dampers took, what is stored.

class EnergyBalance(NamedTuple):
    """Energies from the start of a run to the present time, all in J.

    The works are integrals over the motion and the stored energies are read off the state, so that what is left over
    shows how well the motion obeys m ẍ = F_d + F_e − F.

        drive_work + external_work + contact_exchange + parameter_exchange
            = friction_loss + drive_damper_loss + contact_damper_loss + (stored − stored_at_start) + residual
    """

    drive_work: float           # ∫ F_d v dt, done by the drive at its end of spring and damper
    external_work: float        # ∫ F_e ẋ dt, done by the external force on the slider
    friction_loss: float        # ∫ F_f ẋ dt over the slips, ∫ F_f z′ dt over the yields
    drive_damper_loss: float    # ∫ h (v − ẋ)² dt
    contact_damper_loss: float  # ∫ h_c δ′² dt over the sticks (δ′ = ẋ) and yields of a compliant contact
    contact_exchange: float     # c_c δ²/2 that appears at arrests, less what vanishes at break-aways
    parameter_exchange: float   # change of the stored energy at a change of parameters
    stored: float               # m ẋ²/2 + c (s − x)²/2 + c_c δ²/2 now
    stored_at_start: float
    throughput: float           # sum of the magnitudes of all works and exchanges, event by event

    @property
    def residual(self) -> float:
        """What the balance leaves unexplained, J."""
        given = self.drive_work + self.external_work + self.contact_exchange + self.parameter_exchange
        taken = self.friction_loss + self.drive_damper_loss + self.contact_damper_loss
        return (given - taken) - (self.stored - self.stored_at_start)

    @property
    def relative_residual(self) -> float:
        """|residual| over the throughput, or over the stored energy where that is larger; 0 where nothing happened."""
        scale = max(self.throughput, self.stored, self.stored_at_start)
        return abs(self.residual) / scale if scale > 0.0 else 0.0


# How work that takes a while says how far it is.

Progress = Callable[[float], None] | None   # is given the share that is done, from 0 to 1
