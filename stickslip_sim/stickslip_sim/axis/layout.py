# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The records that the hot path works on: parameters of an axis, its state, a table of events, rows to be filled.

A state is the state of motion at the segment start (the last event or jump of an input), the inputs from there on, the
closed form of the motion since, and the next event.  Nothing in it changes until the next event, however time is split.

Every number is a float, modes, kinds, flags and counts too: a record is one row of numbers in memory, which a
checkpoint writes down as it stands, in the order of the fields.  These classes serve plain Python; the compiled unit
has its own of the same names, fields and order, made from this file.
"""

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, fields
from typing import Any, NamedTuple


@dataclass(slots=True)
class Segment:
    """A segment of the friction tables: from its breakpoint up to the next one."""

    speed: float = 0.0       # m/s, of the breakpoint
    friction: float = 0.0    # mu_k there
    psi: float = 0.0         # and the share of the excess E
    slope: float = 0.0       # s/m, of mu_k
    psi_slope: float = 0.0   # s/m, of psi


@dataclass(slots=True, init=False)
class Parameters:
    """The parameters of an axis, from the numbers of `pack`: these fields, then those of each segment."""

    mass: float               # kg
    stiffness: float          # N/m, of the drive
    damping: float            # N s/m, of the drive
    normal_force: float       # N
    compliant: float          # 1 in a compliant contact, 0 in a rigid one
    contact_stiffness: float  # N/m
    contact_damping: float    # N s/m
    static_law: float         # `friction.StaticLawKind`
    static_initial: float     # mu_s at rest time 0
    static_limit: float       # mu_s at infinite rest time
    static_tau: float         # s
    static_exponent: float    # of Kato's law
    branches: float           # 1 where friction depends on the sign of the acceleration, 0 elsewhere
    end_slope: float          # s/m, of mu_k beyond the last breakpoint
    segment_count: float
    segments: list[Segment]

    def __init__(self, numbers: Sequence[float]) -> None:
        for name, number in zip(PARAMETER_FIELDS, numbers, strict=False):
            setattr(self, name, number)
        self.segments = [Segment(*numbers[i:i + SEGMENT_SIZE]) for i in range(TABLE, len(numbers), SEGMENT_SIZE)]


@dataclass(slots=True)
class OscillatorRecord:
    """An oscillator y″ + 2γ y′ + ω² y, see `linear.oscillator.Oscillator`."""

    gamma: float = 0.0
    omega2: float = 0.0
    nu: float = 0.0
    slow: float = 0.0
    fast: float = 0.0


@dataclass(slots=True)
class Evaluation:
    """g, g′, G₁ and G₂ (see `linear.oscillator`) at a time after the segment start."""

    time: float = 0.0     # s; negative where there is none
    g: float = 0.0
    rate: float = 0.0
    first: float = 0.0
    second: float = 0.0


@dataclass(slots=True)
class TickEvaluation:
    """An `Evaluation` for the oscillator with these γ and ω²: what ticks of one length share."""

    time: float = 0.0
    gamma: float = 0.0
    omega2: float = 0.0
    g: float = 0.0
    rate: float = 0.0
    first: float = 0.0
    second: float = 0.0


@dataclass(slots=True)
class EnergySums:
    """Sums of the works, the exchanges and the throughput of `energy.EnergyBalance`, J."""

    drive: float = 0.0
    external: float = 0.0
    friction: float = 0.0
    damper: float = 0.0
    contact: float = 0.0
    contact_exchange: float = 0.0
    parameter_exchange: float = 0.0
    throughput: float = 0.0


@dataclass(slots=True)
class GivenInputs:
    """Inputs of a solver that steps, sinusoids apart: v + v_rate t and f + f_rate t from a time on."""

    second: float = 0.0     # s, whole ones
    fraction: float = 0.0   # s
    v: float = 0.0          # m/s
    v_rate: float = 0.0     # m/s²
    f: float = 0.0          # N
    f_rate: float = 0.0     # N/s


@dataclass(slots=True)
class StepGrid:
    """The grid of fixed steps."""

    method: float = 0.0         # `fixed_step.steps.EULER` or `RK4`
    second: float = 0.0         # s, of the last grid point, whole ones
    ticks: float = 0.0          # and ticks within that second
    step_ticks: float = 0.0     # ticks in a step
    second_ticks: float = 0.0   # and in a second
    lead: float = 0.0           # s, from the last grid point to the state


@dataclass(slots=True)
class GivenSinusoid:
    """A sinusoid of the inputs as it is given."""

    frequency: float = 0.0   # Hz
    phase: float = 0.0       # turns at time 0
    v: float = 0.0           # m/s, amplitude in the drive's velocity
    f: float = 0.0           # N, amplitude in the external force


@dataclass(slots=True)
class SinusoidRecord:
    """A sinusoid of the inputs: as it is given, and at the segment start (see `axis.sinusoids`)."""

    frequency: float = 0.0   # Hz
    phase: float = 0.0       # turns at time 0
    v: float = 0.0           # m/s, amplitude in the drive's velocity
    f: float = 0.0           # N, amplitude in the external force
    turns: float = 0.0       # phase at the segment start, turns
    sine: float = 0.0        # of that phase
    cosine: float = 0.0
    force_rate_re: float = 0.0     # N/s, the complex amplitude of its force rate there
    force_rate_im: float = 0.0


@dataclass(slots=True, init=False)
class State:
    """The state of an axis, with room for so many sinusoids."""

    # the segment start: time, mode and state of motion there
    second: float             # s, whole ones
    fraction: float           # s
    mode: float               # `types.Mode`
    direction: float          # of the slip: 1, −1, in stick 0
    segment: float            # of the friction tables, its index
    position: float           # m, from `origin`
    drive: float              # m, position of the drive from `origin`
    spring: float             # m, drive position − position
    velocity: float           # m/s
    deflection: float         # m, of a compliant contact
    rest: float               # s, rest time so far
    acceleration: float       # m/s², of a moving mode; its force residual over the mass
    residual: float           # N, coasting: drive force + external force − lower friction, along the slip
    excess: float             # E of this slip
    # the inputs from there on: v + v_rate t, f + f_rate t
    v: float                  # m/s
    v_rate: float             # m/s²
    f: float                  # N
    f_rate: float             # N/s
    # the closed form from there on: the oscillator of the mode, and q′ − ω² u₀ and q″ of its right side
    gamma: float              # 1/s
    omega2: float             # 1/s²
    nu: float                 # 1/s, see `linear.oscillator.Oscillator`
    slow: float               # 1/s
    fast: float               # 1/s
    jerk: float               # m/s³
    snap: float               # m/s⁴
    # the next event
    next: float               # s after the segment start
    next_kind: float          # `types.EventKind`, or the exact engine's `RENEWAL`
    searched: float           # s after the segment start, up to when it was searched
    iterations: float         # of all searches for events so far
    origin: float             # m, where the run began: position and drive count from there
    at: Evaluation            # near the next event, or where its search ended
    last: list[float]         # s, how long each mode lasted last time: a first guess for the next time
    near: TickEvaluation      # at the nearest time of 36 bits, see `motion.tick_integrals`
    # sinusoids of the exact engine: how many, and v and f at the segment start without them
    sinusoid_count: float
    base_v: float             # m/s
    base_f: float             # N
    progress: float           # s after the segment start, up to where a search for an event has come
    # the account of energy up to the segment start; sums and lost are 0 where none is kept
    accounting: float         # 1 where it is kept
    stored_at_start: float    # J
    sums: EnergySums
    lost: EnergySums             # what rounding lost of each sum
    spare: float
    # for solvers that step; v, f and their rates are then those at the state
    given: GivenInputs
    given_sinusoids: float    # how many
    grid: StepGrid
    kept: list[OscillatorRecord]   # that each mode had last
    sinusoids: list[SinusoidRecord]

    def __init__(self, sinusoids: int = 0) -> None:
        clear_state(self)
        self.sinusoids = [SinusoidRecord() for _ in range(sinusoids)]

    def numbers(self) -> list[float]:
        """Return all numbers, from which `take` goes on to the last bit."""
        return [*_numbers_in(getattr(self, field.name) for field in STATE_FIELDS), *_numbers_in(self.sinusoids)]

    def take(self, numbers: Iterable[float]) -> None:
        """Take the numbers of another state of this size."""
        left = iter(map(float, numbers))
        for field in STATE_FIELDS:
            setattr(self, field.name, field.value(left))
        self.sinusoids = [_filled(SinusoidRecord, left) for _ in self.sinusoids]


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


class Events:
    """A table of events."""

    __slots__ = ('count', 'rows')

    def __init__(self, count: int) -> None:
        self.count, self.rows = count, [EventRow() for _ in range(count)]

    def row(self, i: int) -> tuple[float, ...]:
        """Return a row as a tuple."""
        return _values(self.rows[i])


class Sinusoids:
    """Sinusoids as they are given to a solver, from a flat row of their numbers."""

    __slots__ = ('count', 'rows')

    def __init__(self, numbers: Sequence[float]) -> None:
        size = len(GIVEN_SINUSOID_FIELDS)
        self.rows = [GivenSinusoid(*numbers[i:i + size]) for i in range(0, len(numbers), size)]
        self.count = len(self.rows)


@dataclass(slots=True)
class SampleRow:
    """The state at a time; `types.Sample` has the same order."""

    second: float = 0.0         # s, whole ones
    fraction: float = 0.0       # s
    mode: float = 0.0           # `types.Mode`
    direction: float = 0.0
    position: float = 0.0       # m
    velocity: float = 0.0       # m/s
    acceleration: float = 0.0   # m/s²
    drive: float = 0.0          # m, position of the drive
    drive_velocity: float = 0.0   # m/s
    drive_force: float = 0.0    # N
    external: float = 0.0       # N
    friction: float = 0.0       # N
    coefficient: float = 0.0    # |friction| over the normal force
    deflection: float = 0.0     # m, of a compliant contact
    rest: float = 0.0           # s, rest time

    def tolist(self) -> list[float]:
        """Return the numbers."""
        return list(_values(self))


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
        return list(_values(self))


class StateField(NamedTuple):
    """A field of the state: a number, a record, or so many of them in a row."""

    name: str
    record: type[Any] | None = None
    length: int = 0

    def value(self, numbers: Iterator[float]) -> Any:
        """Return the next value."""
        def one() -> Any:
            return _filled(self.record, numbers) if self.record else next(numbers)

        return [one() for _ in range(self.length)] if self.length else one()

    @property
    def size(self) -> int:
        """How many numbers it has."""
        return max(self.length, 1) * (len(fields(self.record)) if self.record else 1)


def names_of(record: type[Any]) -> tuple[str, ...]:
    """Return the names of the numbers of a record, in order."""
    return tuple(field.name for field in fields(record) if field.type is float)


def _values(record: Any) -> tuple[float, ...]:
    return tuple(getattr(record, name) for name in record.__slots__)


def _filled(record: type[Any], numbers: Iterator[float]) -> Any:
    return record(*(next(numbers) for _ in fields(record)))


def _numbers_in(values: Iterable[Any]) -> Iterator[float]:
    for value in values:
        if isinstance(value, list):
            yield from _numbers_in(value)
        elif isinstance(value, (float, int)):
            yield value
        else:
            yield from _values(value)


def clear_state(s: State) -> None:
    """Set all numbers but those of the sinusoids to 0."""
    for field in STATE_FIELDS:
        setattr(s, field.name, field.value(_zeros()))


def _zeros() -> Iterator[float]:
    while True:
        yield 0.0


def _state_fields() -> Iterator[StateField]:
    arrays: dict[str, tuple[type[Any] | None, int]] = {'last': (None, 4), 'kept': (OscillatorRecord, 4)}
    for field in fields(State):
        if field.name in arrays:
            yield StateField(field.name, *arrays[field.name])
        elif field.name != 'sinusoids':
            record = field.type if isinstance(field.type, type) and field.type is not float else None
            yield StateField(field.name, record)


PARAMETER_FIELDS = names_of(Parameters)
SEGMENT_FIELDS = names_of(Segment)
STATE_FIELDS = tuple(_state_fields())
SINUSOID_FIELDS, GIVEN_SINUSOID_FIELDS = names_of(SinusoidRecord), names_of(GivenSinusoid)
EVENT_FIELDS, SAMPLE_FIELDS, ENERGY_FIELDS = names_of(EventRow), names_of(SampleRow), names_of(EnergyRow)

# where the numbers of `pack` stand
(MASS, STIFFNESS, DAMPING, NORMAL, COMPLIANT, CONTACT_STIFFNESS, CONTACT_DAMPING, STATIC_LAW, STATIC_INITIAL,
 STATIC_LIMIT, STATIC_TAU, STATIC_EXPONENT, BRANCHES, END_SLOPE, SEGMENT_COUNT, TABLE) = range(16)
SEGMENT_SIZE = len(SEGMENT_FIELDS)

Row = list[float]   # of figures; the compiled unit has a pointer here
