# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""What every run shows of itself: its cycles, a data frame, a picture."""

from pathlib import Path
from typing import Any

import numpy as np

from ..core.errors import InputError
from ..simulation.cycles import Cycle, cycle_figures
from .frame import data_frame
from .kept import kept
from .run import COLUMNS, Run
from .wording import headline

_PICTURES = '.png', '.svg'


class Views:
    """The part of `Run` that follows from the rest of it."""

    @property
    def duration(self: Run) -> float:
        """From the start to the end, s."""
        return self.end - self.begin

    def cycles(self: Run) -> list[Cycle]:
        """Return the complete cycles of stick-slip, from break-away to break-away."""
        return _cycles(self)

    def frame(self: Run) -> Any:
        """Return the samples as a pandas.DataFrame with COLUMNS; raises InputError without pandas."""
        whole = {name: self.samples[name].astype(np.int8) for name in ('mode', 'direction')}
        return data_frame({name: whole.get(name, self.samples[name]) for name in COLUMNS}, 'samples')

    def plot(self: Run, path: Path | str) -> None:
        """Draw position, velocity, forces and mode over time into `path` (.png or .svg).

        Raises InputError without samples, and for other endings.
        """
        if Path(path).suffix.lower() not in _PICTURES:
            raise InputError('path', str(path), f'a file ending in {" or ".join(_PICTURES)}', 'name it so')
        if not len(self.samples['time']):
            raise InputError('samples', 0, 'at least one', 'simulate with samples')
        from ..plots import plot_run  # matplotlib takes half a second

        plot_run(self.samples, self.events, f'{self.scene.name}, {self.duration:g} s\n{headline(self.summary)}', path)


@kept
def _cycles(run: Run) -> list[Cycle]:
    return cycle_figures(run.events)
