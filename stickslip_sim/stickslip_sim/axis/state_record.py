# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The record of an axis's state, which the hot path works on.

A state is the state of motion at the segment start (the last event or jump of an input), the inputs from there on, the
closed form of the motion since, and the next event.  Nothing in it changes until the next event, however time is split.
Python reads and sets only the numbers that a state has itself; the groups in it are the hot path's own, and `numbers`
has them all.
"""

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Annotated

from .fields import RowOf, filled, numbers_in, places_of, record_fields, zeros

HIGHEST_ORDER = 24   # of the series of a segment under a normal force that varies


@dataclass(slots=True)
class InputsRecord:
    """The inputs from the segment start on: v + v_rate t, f + f_rate t."""

    v: float        # m/s
    v_rate: float   # m/s²
    f: float        # N
    f_rate: float   # N/s
    base_v: float   # m/s, v at the segment start without the sinusoids of the exact engine
    base_f: float   # N, f likewise
    base_n: float   # N, the normal force likewise, where it varies
    n: float        # N, the normal force at the segment start, where it varies smoothly
    n_rate: float   # N/s, its rate there


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
    last: Annotated[list[float], RowOf(5)]                # s, how long each mode lasted last time: a first guess
    oscillators: Annotated[list[OscillatorRecord], RowOf(5, OscillatorRecord)]   # that each mode had last


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
    n: float           # N, amplitude in the normal force
    turns: float       # phase at the segment start, turns
    sine: float        # of that phase
    cosine: float
    force_rate_re: float     # N/s, the complex amplitude of its force rate there
    force_rate_im: float


@dataclass(slots=True)
class SeriesOrder:
    """The terms of one order of the power series in τ = t/H of a segment that lasts H (`axis.slip_series`)."""

    u: float            # m/s, of the velocity
    deflection: float   # m, of a contact that yields


@dataclass(slots=True)
class SeriesScratch:
    """What is needed for one order while series are made and searched."""

    v: float        # m/s, of the drive's velocity
    push: float     # N, of the forces that do not depend on the motion
    n: float        # N, of the normal force
    tail: float     # N, bound on this order of the normal force and all that follow
    guard: float    # of what is searched for its first root
    control: float  # of Bernstein's form of it


@dataclass(slots=True, init=False)
class State:
    """The state of an axis, with room for so many sinusoids."""

    # the segment start: time, mode and state of motion there
    second: float             # s, whole ones
    fraction: float           # s
    mode: float               # `types.Mode`
    direction: float          # of the slip, or of the force of a contact that yields: 1, −1, in stick 0
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
    is_loaded: float          # 1 where the normal force varies smoothly from the segment start on
    series_end: float         # s, H of the series below
    series_error: float       # m/s, bound on what their velocity is off by within H, see `axis.slip_series`
    swing: float              # N, the largest force at a standstill since N mu_s was last more than 0
    sticks: float             # where the static law scatters: begun so far, the one that a run may begin with aside
    # of the axis
    inputs: InputsRecord
    oscillator: OscillatorRecord   # of the mode
    # of the exact engine
    next: NextEvent
    cache: Cache
    series: Annotated[list[SeriesOrder], RowOf(HIGHEST_ORDER + 1, SeriesOrder)]   # from the segment start on
    # of the account of energy, up to the segment start
    sums: EnergySums
    lost: EnergySums               # what rounding lost of each sum
    # of the solvers that step; the `inputs` are then those at the state
    given: GivenInputs
    grid: StepGrid
    sinusoids: list[SinusoidRecord]
    scratch: list[SeriesScratch]

    def __init__(self, sinusoids: int = 0) -> None:
        clear_state(self)
        self.sinusoids = [filled(SinusoidRecord, zeros()) for _ in range(sinusoids)]
        self.scratch = [filled(SeriesScratch, zeros()) for _ in range(HIGHEST_ORDER + 1)]

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


STATE_PLACES = places_of(State)
