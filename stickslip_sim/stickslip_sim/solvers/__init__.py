# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""What brings a state through time: exact, adaptive, fixed steps.  The physics they solve are in `axis`."""

from collections.abc import Callable
from typing import Any, NamedTuple, Protocol, runtime_checkable

from ..axis.layout import Parameters
from ..axis.records import PLAIN
from ..axis.rows import EnergyRow, Events, SampleRow, Sinusoids
from ..axis.state_record import State
from ..core.input_profile import InputProfile

# how `advance` ended: at its time, with a full event table, stuck, before a state beyond the range of numbers, or at an
# event that contradicts the motion or its energy
DONE, FULL, NO_PROGRESS, OUT_OF_RANGE, UNSOUND = 0, 1, 2, 3, 4


class Records(Protocol):
    """Where the classes of records are that a solver works on: of plain Python, or of the compiled unit."""

    Parameters: type[Parameters]
    State: type[State]
    Events: type[Events]
    Sinusoids: type[Sinusoids]
    SampleRow: type[SampleRow]
    EnergyRow: type[EnergyRow]


@runtime_checkable
class Solver(Protocol):
    """What brings a state through time.

    A time is two numbers: whole seconds and the fraction of one.  Inputs are v + v_rate t and f + f_rate t (m/s, m/s²,
    N, N/s) from a time on, and sinusoids.  A method with `events, row` writes rows into that table from `row` on and
    returns the rows in use.
    """

    @property
    def name(self) -> str:
        """As `solver.name` of a scene."""

    @property
    def records(self) -> Records:
        """The records that it works on."""

    @property
    def advice(self) -> str:
        """What to try when it gives up."""

    def start(self, p: Parameters, s: State, position: float, velocity: float, rest: float, stretch: float,
              deflection: float, v: float, v_rate: float, f: float, f_rate: float, sinusoids: Sinusoids, events: Events,
              row: int, /) -> int:
        """Set the state at time 0: position, stretch and deflection in m, velocity in m/s, rest time in s."""

    def advance(self, p: Parameters, s: State, second: float, fraction: float, events: Events, row: int, /
                ) -> tuple[int, int]:
        """Bring the state to a time that is not before it; return the rows in use and how it ended (DONE, ...)."""

    def set_inputs(self, p: Parameters, s: State, second: float, fraction: float, v: float, v_rate: float, f: float,
                   f_rate: float, sinusoids: Sinusoids, events: Events, row: int, /) -> int:
        """Let the inputs be others from a time on, up to which the state was advanced."""

    def set_parameters(self, p: Parameters, new: Parameters, s: State, second: float, fraction: float, events: Events,
                       row: int, /) -> int:
        """Let the axis have other parameters from a time on, up to which the state was advanced with the old ones."""

    def set_load(self, p: Parameters, s: State, second: float, fraction: float, normal_force: float,
                 normal_rate: float, v: float, v_rate: float, f: float, f_rate: float, sinusoids: Sinusoids,
                 events: Events, row: int, /) -> int:
        """Let the normal force N + N′ t (N, N/s) and the inputs be others from a time on, both at once."""

    @property
    def bring(self) -> 'Callable[[Parameters, State, float, float], None] | None':
        """What is called before `set_parameters` of another solver, with the old parameters; None: nothing need be."""

    @property
    def with_normal_force(self) -> 'Callable[[InputProfile], Solver] | None':
        """What returns the solver for a normal force that may vary smoothly, N; None: it takes one that jumps alone."""

    def sample(self, p: Parameters, s: State, second: float, fraction: float, out: SampleRow, /) -> None:
        """Fill a row with the state at the time that it was advanced to."""

    @property
    def energy(self) -> Callable[[Parameters, State, float, float, EnergyRow], None] | None:
        """What fills a row with the energies up to a time, as `sample` does; None of a solver without an account.

        A solver with `energy` and `is_sound` keeps the account, and holds its run to it, while `accounting` of the
        state, which `start` leaves as it is, is not 0.
        """

    @property
    def is_sound(self) -> Callable[[Parameters, State, float, float], bool] | None:
        """What says whether the state at a time obeys its mode and the balance of energy; None without an account."""

    @property
    def step(self) -> Callable[..., tuple[int, int]] | None:
        """What lets inputs be others, advances and samples in one call (`exact.engine.step`); None: these do."""

    @property
    def walk(self) -> 'PieceWalk | None':
        """What goes through many pieces of the inputs in one call; None: `solvers.walk` does, by the methods above."""


class PieceWalk(NamedTuple):
    """A way through the pieces of the inputs, which it takes as what `pieces_of` made of their profiles.

    `run` does what `walk.walk` does, `sample` what `walk.sample_pieces` does.
    """

    pieces_of: Callable[[InputProfile], Any]
    run: Callable[..., tuple[float, int, int]]
    sample: Callable[..., tuple[int, float, int, int]]


class SolverOfFunctions(NamedTuple):
    """A solver whose methods are functions, compiled or not."""

    name: str
    start: Callable[..., int]
    advance: Callable[..., tuple[int, int]]
    set_inputs: Callable[..., int]
    set_parameters: Callable[..., int]
    set_load: Callable[..., int]
    sample: Callable[..., None]
    energy: Callable[[Parameters, State, float, float, EnergyRow], None] | None = None
    is_sound: Callable[[Parameters, State, float, float], bool] | None = None
    records: Any = PLAIN
    advice: str = 'a parameter or an input is too extreme for this axis: check the scene'
    walk: PieceWalk | None = None
    with_normal_force: 'Callable[[InputProfile], Solver] | None' = None
    bring: 'Callable[[Parameters, State, float, float], None] | None' = None
    step: Callable[..., tuple[int, int]] | None = None


def with_advance(solver: Solver, advance: Callable[..., tuple[int, int]]) -> Solver:
    """Return a solver that advances in another way."""
    return SolverOfFunctions(solver.name, solver.start, advance, solver.set_inputs, solver.set_parameters,
                             solver.set_load, solver.sample, solver.energy, solver.is_sound, solver.records,
                             solver.advice)
