# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""What every run shows of itself: its cycles, a data frame, a picture."""

from pathlib import Path
from typing import Any

import numpy as np

from ..core.arrays import data_frame
from ..core.paths import check_picture_name
from ..figures.cycles import Cycle, cycle_figures
from .run import COLUMNS, LOAD_COLUMN, Run, kept


class Views:
    """The part of `Run` that follows from the rest of it."""

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

    def plot(self: Run, path: Path | str, window: tuple[float, float] | None = None) -> None:
        """Draw the run over time into `path` (.png, .pdf or .svg), and beside it a `window` (begin and end, s) of it.

        Without a window the last cycles of a long run are beside it.  Raises InputError for other endings, and for a
        window that is not in the run.
        """
        check_picture_name('path', path)
        from .picture import draw_run  # matplotlib takes half a second

        draw_run(self, window, path)


@kept
def _cycles(run: Run) -> list[Cycle]:
    return cycle_figures(run.events)
