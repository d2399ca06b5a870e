# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The records that the hot path works on: the parameters of an axis, and its state.

A state is the state of motion at the segment start (the last event or jump of an input), the inputs from there on, the
closed form of the motion since, and the next event.  Nothing in it changes until the next event, however time is split.
Python reads and sets only the numbers that a state has itself; the groups in it are the hot path's own, and `numbers`
has them all.
"""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Annotated

from .fields import RowOf, filled, names_of, numbers_in, places_of, record_fields, zeros


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
    normal_force: float       # N
    compliant: float          # 1 in a compliant contact, 0 in a rigid one
    contact_stiffness: float  # N/m
    contact_damping: float    # N s/m
    arrest_share: float       # of the friction force, that a compliant contact carries as stick begins: 1, or 0
    judges_drive: float       # 1 where such a stick ends by the drive's force, 0 where by that of the contact
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
    segments: list[Segment]

    def __init__(self, numbers: Sequence[float]) -> None:
        for name, number in zip(PARAMETER_FIELDS, numbers, strict=False):
            setattr(self, name, number)
        self.segments = [Segment(*numbers[i:i + SEGMENT_SIZE]) for i in range(TABLE, len(numbers), SEGMENT_SIZE)]


@dataclass(slots=True)
class InputsRecord:
    """The inputs from the segment start on: v + v_rate t, f + f_rate t."""

    v: float        # m/s
    v_rate: float   # m/s²
    f: float        # N
    f_rate: float   # N/s
    base_v: float   # m/s, v at the segment start without the sinusoids of the exact engine
    base_f: float   # N, f likewise


@dataclass(slots=True)
class OscillatorRecord:
    """An oscillator y″ + 2γ y′ + ω² y, see `linear.oscillator.Oscillator`."""

    gamma: float    # 1/s
    omega2: float   # 1/s²
    nu: float       # 1/s
    slow: float     # 1/s
    fast: float     # 1/s


@dataclass(slots=True)
class NextEvent:
    """The next event, and how far it was searched."""

    time: float       # s after the segment start
    kind: float       # `types.EventKind`, or the exact engine's `RENEWAL`
    searched: float   # s after the segment start, up to when there is no other
    progress: float   # s after the segment start, up to where a search under sinusoids has come


@dataclass(slots=True)
class Evaluation:
    """g, g′, G₁ and G₂ (see `linear.oscillator`) at a time after the segment start."""

    time: float     # s; negative where there is none
    g: float
    rate: float
    first: float
    second: float


@dataclass(slots=True)
class TickEvaluation:
    """An `Evaluation` for the oscillator with these γ and ω²: what ticks of one length share."""

    time: float
    gamma: float
    omega2: float
    g: float
    rate: float
    first: float
    second: float


@dataclass(slots=True)
class Cache:
    """What the exact engine keeps to be quicker; no result depends on it."""

    at: Evaluation             # near the next event, or where its search ended
    near: TickEvaluation       # at the nearest time of 36 bits, see `motion.tick_integrals`
    last: Annotated[list[float], RowOf(4)]                # s, how long each mode lasted last time: a first guess
    oscillators: Annotated[list[OscillatorRecord], RowOf(4, OscillatorRecord)]   # that each mode had last


@dataclass(slots=True)
class EnergySums:
    """Sums of the works, the exchanges and the throughput of `energy.EnergyBalance`, J; 0 where none are kept."""

    drive: float
    external: float
    friction: float
    damper: float
    contact: float
    contact_exchange: float
    parameter_exchange: float
    throughput: float


@dataclass(slots=True)
class GivenInputs:
    """Inputs of a solver that steps, sinusoids apart: v + v_rate t and f + f_rate t from a time on."""

    second: float     # s, whole ones
    fraction: float   # s
    v: float          # m/s
    v_rate: float     # m/s²
    f: float          # N
    f_rate: float     # N/s


@dataclass(slots=True)
class StepGrid:
    """The grid of fixed steps."""

    method: float         # `fixed_step.steps.EULER` or `RK4`
    second: float         # s, of the last grid point, whole ones
    ticks: float          # and ticks within that second
    step_ticks: float     # ticks in a step
    second_ticks: float   # and in a second
    lead: float           # s, from the last grid point to the state


@dataclass(slots=True)
class SinusoidRecord:
    """A sinusoid of the inputs: as it is given, and at the segment start (see `axis.sinusoids`)."""

    frequency: float   # Hz
    phase: float       # turns at time 0
    v: float           # m/s, amplitude in the drive's velocity
    f: float           # N, amplitude in the external force
    turns: float       # phase at the segment start, turns
    sine: float        # of that phase
    cosine: float
    force_rate_re: float     # N/s, the complex amplitude of its force rate there
    force_rate_im: float


@dataclass(slots=True, init=False)
class State:
    """The state of an axis, with room for so many sinusoids."""

    # the segment start: time, mode and state of motion there
    second: float             # s, whole ones
    fraction: float           # s
    mode: float               # `types.Mode`
    direction: float          # of the slip: 1, −1, in stick 0
    segment: float            # of the friction tables, its index among those of both directions
    position: float           # m, from `origin`
    drive: float              # m, position of the drive from `origin`
    spring: float             # m, drive position − position
    velocity: float           # m/s
    deflection: float         # m, of a compliant contact
    rest: float               # s, rest time so far
    acceleration: float       # m/s², of a moving mode; its force residual over the mass
    residual: float           # N, coasting: drive force + external force − lower friction, along the slip
    excess: float             # E of this slip
    jerk: float               # m/s³, q′ − ω² u₀ of the closed form's right side
    snap: float               # m/s⁴, its q″
    origin: float             # m, where the run began: position and drive count from there
    sinusoid_count: float     # of the exact engine
    iterations: float         # of all searches for events so far
    accounting: float         # 1 where an account of energy is kept
    stored_at_start: float    # J, where it is
    given_sinusoids: float    # how many, of a solver that steps
    # of the axis
    inputs: InputsRecord
    oscillator: OscillatorRecord   # of the mode
    # of the exact engine
    next: NextEvent
    cache: Cache
    # of the account of energy, up to the segment start
    sums: EnergySums
    lost: EnergySums               # what rounding lost of each sum
    # of the solvers that step; the `inputs` are then those at the state
    given: GivenInputs
    grid: StepGrid
    sinusoids: list[SinusoidRecord]

    def __init__(self, sinusoids: int = 0) -> None:
        clear_state(self)
        self.sinusoids = [filled(SinusoidRecord, zeros()) for _ in range(sinusoids)]

    def numbers(self) -> list[float]:
        """Return all numbers, from which `take` goes on to the last bit."""
        return [*numbers_in([self]), *numbers_in(self.sinusoids)]

    def take(self, numbers: Iterable[float]) -> None:
        """Take the numbers of another state of this size."""
        left = iter(map(float, numbers))
        for field in record_fields(State):
            setattr(self, field.name, field.value(left))
        self.sinusoids = [filled(SinusoidRecord, left) for _ in self.sinusoids]


def clear_state(s: State) -> None:
    """Set all numbers but those of the sinusoids to 0."""
    for field in record_fields(State):
        setattr(s, field.name, field.value(zeros()))


PARAMETER_FIELDS, SEGMENT_FIELDS = names_of(Parameters), names_of(Segment)
STATE_PLACES = places_of(State)

# where the numbers of `pack` stand
(MASS, STIFFNESS, DAMPING, _, NORMAL, COMPLIANT, CONTACT_STIFFNESS, CONTACT_DAMPING, _, _, STATIC_LAW, STATIC_INITIAL,
 STATIC_LIMIT, STATIC_TAU, STATIC_EXPONENT, _, BRANCHES, END_SLOPE, SEGMENT_COUNT, SIDED, BACKWARD_INITIAL,
 BACKWARD_LIMIT, BACKWARD_TAU, BACKWARD_EXPONENT, BACKWARD_SEGMENT, TABLE) = range(26)
SEGMENT_SIZE = len(SEGMENT_FIELDS)
