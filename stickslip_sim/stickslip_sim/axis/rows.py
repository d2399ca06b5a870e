# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""What goes into a solver and comes out of it: sinusoids, a table of events, rows to be filled."""

from array import array
from collections.abc import Sequence
from dataclasses import dataclass

from .fields import flat, names_of


@dataclass(slots=True)
class GivenSinusoid:
    """A sinusoid of the inputs as it is given."""

    frequency: float = 0.0   # Hz
    phase: float = 0.0       # turns at time 0
    v: float = 0.0           # m/s, amplitude in the drive's velocity
    f: float = 0.0           # N, amplitude in the external force
    n: float = 0.0           # N, amplitude in the normal force


@dataclass(slots=True, init=False)
class Sinusoids:
    """Sinusoids as they are given to a solver, from a flat row of their numbers."""

    count: int
    rows: list[GivenSinusoid]

    def __init__(self, numbers: Sequence[float]) -> None:
        size = len(GIVEN_SINUSOID_FIELDS)
        self.rows = [GivenSinusoid(*numbers[i:i + size]) for i in range(0, len(numbers), size)]
        self.count = len(self.rows)


@dataclass(slots=True)
class EventRow:
    """A row of the event table; `types.Event` has the same order."""

    second: float = 0.0        # s, whole ones
    fraction: float = 0.0      # s
    kind: float = 0.0          # `types.EventKind`
    mode: float = 0.0          # `types.Mode` that follows
    direction: float = 0.0
    position: float = 0.0      # m
    velocity: float = 0.0      # m/s
    drive: float = 0.0         # m
    drive_force: float = 0.0   # N
    friction: float = 0.0      # N
    static: float = 0.0        # mu_s
    rest: float = 0.0          # s


@dataclass(slots=True, init=False)
class Events:
    """A table of events."""

    count: int
    rows: list[EventRow]

    def __init__(self, count: int) -> None:
        self.count, self.rows = count, [EventRow() for _ in range(count)]

    def row(self, i: int) -> tuple[float, ...]:
        """Return a row as a tuple."""
        return flat(self.rows[i])


@dataclass(slots=True)
class SampleRow:
    """The state at a time; `types.Sample` has the same order."""

    second: float = 0.0         # s, whole ones
    fraction: float = 0.0       # s
    mode: float = 0.0           # what the slider does: `types.Mode`
    direction: float = 0.0      # of slip, 0 in stick
    position: float = 0.0       # m, of the slider
    velocity: float = 0.0       # m/s, of the slider
    acceleration: float = 0.0   # m/s², of the slider
    drive: float = 0.0          # m, position of the drive
    drive_velocity: float = 0.0   # m/s, of the drive
    drive_force: float = 0.0    # N, of the spring and the damper of the drive
    external: float = 0.0       # N, on the slider
    friction: float = 0.0       # N, on the slider, against a slip
    coefficient: float = 0.0    # |friction| over the normal force
    deflection: float = 0.0     # m, of a compliant contact
    rest: float = 0.0           # s, rest time, 0 where it does not stick

    def tolist(self) -> list[float]:
        """Return the numbers."""
        return list(flat(self))

    def tobytes(self) -> bytes:
        """Return the numbers as the machine has them."""
        return array('d', flat(self)).tobytes()


@dataclass(slots=True)
class EnergyRow:
    """The energies up to a time, J; `energy.EnergyBalance` has the same order."""

    drive: float = 0.0
    external: float = 0.0
    friction: float = 0.0
    damper: float = 0.0
    contact: float = 0.0
    contact_exchange: float = 0.0
    parameter_exchange: float = 0.0
    stored: float = 0.0
    stored_at_start: float = 0.0
    throughput: float = 0.0

    def tolist(self) -> list[float]:
        """Return the numbers."""
        return list(flat(self))


GIVEN_SINUSOID_FIELDS = names_of(GivenSinusoid)
