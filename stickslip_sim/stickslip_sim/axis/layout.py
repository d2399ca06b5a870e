# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The record of an axis's parameters, which the hot path works on, and where their numbers stand."""

from collections.abc import Sequence
from dataclasses import dataclass

from .fields import names_of


@dataclass(slots=True)
class Segment:
    """A segment of the friction tables of one direction: from its breakpoint up to the next one."""

    speed: float = 0.0       # m/s, of the breakpoint
    end: float = 0.0         # m/s, of the next one, infinite where there is none
    friction: float = 0.0    # mu_k there
    psi: float = 0.0         # and the share of the excess E
    slope: float = 0.0       # s/m, of mu_k
    psi_slope: float = 0.0   # s/m, of psi


@dataclass(slots=True, init=False)
class Parameters:
    """The parameters of an axis, from the numbers of `pack`: these fields, then those of each segment.

    The segments forwards come first, each breakpoint from standstill on; where friction depends on the direction those
    backwards follow.  A segment's index so says the direction, too.
    """

    mass: float               # kg
    stiffness: float          # N/m, of the drive
    damping: float            # N s/m, of the drive
    feed_share: float         # of the drive's velocity, at the far end of its damper: 1, or 0 where that is fixed
    normal_force: float       # N; where it varies, that at the segment start
    compliant: float          # 1 in a compliant contact, 0 in a rigid one
    contact_stiffness: float  # N/m
    contact_damping: float    # N s/m
    arrest_share: float       # of the friction force, that a compliant contact carries as stick begins: 1, or 0
    ends_by_drive: float      # 1 where such a stick ends by the drive's force, 0 where by that of the contact
    static_law: float         # `friction.StaticLawKind`
    static_initial: float     # mu_s at rest time 0, forwards: against a force along +x
    static_limit: float       # mu_s at infinite rest time
    static_tau: float         # s
    static_exponent: float    # of Kato's law
    static_delay: float       # s of rest before mu_s begins to grow
    branches: float           # 1 where friction depends on the sign of the acceleration, 0 elsewhere
    end_slope: float          # s/m, of mu_k forwards beyond the last breakpoint
    segment_count: float      # of both directions
    sided: float              # 1 where friction depends on the direction, 0 elsewhere
    backward_initial: float   # mu_s backwards, as the four numbers above
    backward_limit: float
    backward_tau: float
    backward_exponent: float
    backward_segment: float   # index of the first segment backwards; 0: the same table
    normal_rate: float        # N/s, of the normal force but for its sinusoids
    seed: float               # key of the draws of the static law's scatter
    scatter: float            # relative standard deviation of mu_s from stick to stick
    scatter_run: float        # and from run to run
    drawn_sticks: float       # 1 + the index of the stick whose mu_s follows; 0: none was drawn yet
    stick_initial: float      # mu_0 and mu_inf of that stick, forwards
    stick_limit: float
    stick_backward_initial: float   # and backwards
    stick_backward_limit: float
    segments: list[Segment]

    def __init__(self, numbers: Sequence[float]) -> None:
        for name, number in zip(PARAMETER_FIELDS, numbers, strict=False):
            setattr(self, name, number)
        self.segments = [Segment(*numbers[i:i + SEGMENT_SIZE]) for i in range(TABLE, len(numbers), SEGMENT_SIZE)]


PARAMETER_FIELDS, SEGMENT_FIELDS = names_of(Parameters), names_of(Segment)

# where the numbers of `pack` stand
(MASS, STIFFNESS, DAMPING, _, NORMAL, COMPLIANT, CONTACT_STIFFNESS, CONTACT_DAMPING, _, _, STATIC_LAW, STATIC_INITIAL,
 STATIC_LIMIT, STATIC_TAU, STATIC_EXPONENT, _, BRANCHES, END_SLOPE, SEGMENT_COUNT, SIDED, BACKWARD_INITIAL,
 BACKWARD_LIMIT, BACKWARD_TAU, BACKWARD_EXPONENT, BACKWARD_SEGMENT, _, _, _, _, _, _, _, _, _, TABLE) = range(35)
SEGMENT_SIZE = len(SEGMENT_FIELDS)
