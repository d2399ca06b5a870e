# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""A run as one thing: the same to read whether it was simulated or recorded."""

from collections.abc import Callable, Iterator
from functools import wraps
from pathlib import Path
from typing import Any, Protocol, TypeVar
from weakref import WeakKeyDictionary

import numpy as np
from numpy.typing import NDArray

from ..core.arrays import Columns, data_frame
from ..core.paths import check_picture_name
from ..core.types import Event, Sample
from ..figures.cycles import Cycle, Summary, cycle_figures, summary_report
from ..report.html import Shown
from ..report.model import Part
from ..scene import Scene
from ..simulation.step_result import Mark

COLUMNS = ('time', *Sample._fields[2:])   # of the samples of every run
STANDS = 1e-12   # m, from one sample to the next: less is rounding of a command or setpoint that stands


class Run(Protocol):
    """What an axis did from `begin` to `end`, and what is known of it.

    What stands in a file is read when it is asked for, and raises RecordingError then.
    """

    @property
    def name(self) -> str:
        """Of the scene, or of the folder."""

    @property
    def title(self) -> str:
        """Of a picture."""

    @property
    def source(self) -> str:
        """Where it comes from, for people."""

    @property
    def scene(self) -> Scene:
        """What was simulated."""

    @property
    def begin(self) -> float:
        """Time of the first sample, s."""

    @property
    def end(self) -> float:
        """Time at the end, s."""

    @property
    def duration(self) -> float:
        """From the start to the end, s."""

    @property
    def samples(self) -> Columns:
        """Columns by name (COLUMNS, and what one kind of run has more), each just after what happened at its time."""

    @property
    def states(self) -> Columns:
        """The state of the axis at its steps; a recorded run has it also where a friction force is missing."""

    @property
    def events(self) -> list[Event]:
        """The transitions in the order of time."""

    @property
    def commands(self) -> Columns:
        """The drive velocities that were taken: `time` and `velocity`, m/s; empty where the scene alone decides."""

    @property
    def setpoint(self) -> Columns:
        """Where the slider should have been: `time`, `position` (m), `velocity` (m/s); empty where none was given."""

    @property
    def marks(self) -> list[Mark]:
        """When faults were in force, and commands refused, limited, lost or missing."""

    @property
    def summary(self) -> Summary:
        """What the run amounts to."""

    @property
    def receipt(self) -> dict[str, Any]:
        """Versions, figures, energy, cost (docs/receipt.md); empty when there is none."""

    @property
    def notes(self) -> tuple[str, ...]:
        """What a user must know."""

    @property
    def is_recorded(self) -> bool:
        """Whether it was read from a bag."""

    @property
    def is_complete(self) -> bool:
        """Whether it goes up to its end; a recording may be cut off."""

    @property
    def is_changed(self) -> bool:
        """Whether parameters were changed while it ran."""

    @property
    def missing_steps(self) -> int:
        """How many steps have no recorded state between the first and the last that has."""

    def sample_blocks(self) -> Iterator[Columns]:
        """Yield the samples block by block, in memory that does not grow with them."""

    def command_blocks(self) -> Iterator[Columns]:
        """Yield the commands block by block, at least one, in memory that does not grow with them."""

    def cycles(self) -> list[Cycle]:
        """Return the complete cycles of stick-slip, from break-away to break-away."""

    def frame(self) -> Any:
        """Return the samples as a pandas.DataFrame with COLUMNS; raises InputError without pandas."""

    def plot(self, path: Path | str | None = None, window: tuple[float, float] | None = None) -> Any:
        """Draw the run over time, and beside it a `window` (begin and end, s) of it; return the figure.

        It is written to `path` (.png, .pdf or .svg), if there is one.  Without a window the last cycles of a long run
        are beside it.  Raises InputError for other endings, and for a window that is not in the run.
        """


# What is found of a run once and kept as long as the run.

_Found = TypeVar('_Found')


def kept(find: Callable[[Run], _Found]) -> Callable[[Run], _Found]:
    """Return a function that finds the same, but looks at each run only once; what it finds must not hold the run."""
    known: WeakKeyDictionary[Run, _Found] = WeakKeyDictionary()

    @wraps(find)
    def kept_or_found(run: Run) -> _Found:
        if run not in known:
            known[run] = find(run)
        return known[run]

    return kept_or_found


# The normal force on the slideway as a column beside the samples of a run, where it varies.

LOAD_COLUMN = 'normal_force'


def normal_force_of(scene: Scene, times: NDArray[np.float64]) -> Columns:
    """Return the column of the normal force at times (s), N, as the scene has it; none where it does not vary."""
    return {} if scene.normal_load is None else {LOAD_COLUMN: scene.normal_force.values_at(times)}


def recorded_normal_force(scene: Scene, samples: Columns, is_changed: bool) -> Columns:
    """Return the column of a recorded run, as `normal_force_of`.

    Where a parameter was changed it is friction over its coefficient, NaN where that is 0.
    """
    column = normal_force_of(scene, samples['time'])
    if not column or not is_changed:
        return column
    coefficient: NDArray[Any] = samples['friction_coefficient']
    with np.errstate(all='ignore'):
        ratio = np.abs(samples['friction_force']) / coefficient
    return {LOAD_COLUMN: np.where(coefficient > 0.0, ratio, np.nan)}


# What every run shows of itself: its cycles, a data frame, a picture.

class Views(Shown):
    """The part of `Run` that follows from the rest of it."""

    def _shown(self: Run) -> Iterator[Part]:
        yield f'{type(self).__name__} {self.name}: {self.source}'
        yield from summary_report(self.summary)
        yield from self.notes

    @property
    def duration(self: Run) -> float:
        """From the start to the end, s."""
        return self.end - self.begin

    @property
    def title(self: Run) -> str:
        """Of a picture."""
        return self.name

    def cycles(self: Run) -> list[Cycle]:
        """Return the complete cycles of stick-slip, from break-away to break-away."""
        return _cycles(self)

    def frame(self: Run) -> Any:
        """Return the samples as a pandas.DataFrame with COLUMNS; raises InputError without pandas.

        A normal force that varies is a column more.
        """
        whole = {name: self.samples[name].astype(np.int8) for name in ('mode', 'direction')}
        names = [*COLUMNS, *([LOAD_COLUMN] if LOAD_COLUMN in self.samples else [])]
        return data_frame({name: whole.get(name, self.samples[name]) for name in names}, 'samples')

    def plot(self: Run, path: Path | str | None = None, window: tuple[float, float] | None = None) -> Any:
        """Draw the run over time, and beside it a `window` (begin and end, s) of it; return the figure.

        It is written to `path` (.png, .pdf or .svg), if there is one.  Without a window the last cycles of a long run
        are beside it.  Raises InputError for other endings, and for a window that is not in the run.
        """
        if path is not None:
            check_picture_name('path', path)
        from .picture import draw_run  # matplotlib takes half a second

        return draw_run(self, window, *([] if path is None else [path]))


@kept
def _cycles(run: Run) -> list[Cycle]:
    return cycle_figures(run.events)
