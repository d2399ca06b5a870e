"""A scene: everything that decides a run, checked and ready for the simulator."""

from dataclasses import dataclass, field
from fractions import Fraction

from ..axis import Axis, InitialState
from ..courses import Course
from .solver import SolverSettings


@dataclass(frozen=True, slots=True)
class TimeSettings:
    """How simulation time goes: `rate` in steps per second of it, `factor` in simulation time per real time."""

    mode: str
    rate: float
    factor: float

    @property
    def step(self) -> Fraction:
        """Simulation time of a step, s, exactly."""
        return 1 / Fraction(repr(self.rate))


@dataclass(frozen=True, slots=True)
class CommandSettings:
    """Commands whose magnitude is beyond `max_velocity` (m/s) or `max_force` (N) are refused; held for ever."""

    max_velocity: float
    max_force: float
    timeout: float
    on_timeout: str


@dataclass(frozen=True, slots=True)
class RecordSettings:
    """Whether the node records from its start, and into which folder (empty: it chooses one)."""

    enabled: bool
    folder: str


@dataclass(frozen=True, slots=True)
class Scene:
    """One scene; `values` are all effective parameters by dotted name, `text` is the same as a parameter file.

    `hash` is the sha256 of the text in hexadecimal.  `summary` is one line for people and no part of the scene.
    """

    name: str
    summary: str = field(compare=False)
    axis: Axis
    initial: InitialState
    drive: Course   # m/s
    force: Course   # N
    solver: SolverSettings
    time: TimeSettings
    command: CommandSettings
    record: RecordSettings
    seed: int
    values: dict[str, object] = field(hash=False)
    text: str
    hash: str
