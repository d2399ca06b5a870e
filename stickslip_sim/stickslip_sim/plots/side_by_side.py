# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Runs below each other as in Fig. 4 of the paper: forces and velocity over time, friction over velocity."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from string import ascii_lowercase

import numpy as np
from matplotlib import rc_context
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.layout_engine import ConstrainedLayoutEngine

from .paper_panels import DrawnMotion, forces, friction_loop, legend_below, part, velocity
from .style import DOUBLE_COLUMN, JOURNAL, letter, save, shortened

_ROW, _LEGEND = 2.05, 0.6   # in
_ABOVE_LETTERS = 15.0        # points: a long name reaches over them
_LONGEST = 100             # letters of a name over three panels
ALIKE = 5.0               # so many times as large an extent, and rows do not share an axis


def plot_side_by_side(motions: Mapping[str, DrawnMotion], *paths: Path | str) -> None:
    """Draw a row for each run, by its name; runs that are alike have the same axes."""
    with rc_context(JOURNAL):
        figure = Figure(figsize=(DOUBLE_COLUMN, _ROW * len(motions) + _LEGEND),
                        layout=ConstrainedLayoutEngine(w_pad=0.05, h_pad=0.05))
        grid = figure.subplots(len(motions), 3, squeeze=False)
        lengths = _lengths(list(motions.values()))
        for row, (name, motion), length in zip(grid, motions.items(), lengths):
            _draw_row(row, name, motion, length)
        for column in grid.T:
            _share(column, 'x')
            _share(column, 'y')
        for panel in grid[:-1].flat:
            panel.set_xlabel('')
        for panel, name in zip(grid.flat, ascii_lowercase):
            letter(panel, name)
        legend_below(figure, grid[0, 0], *grid[:, 2])
        save(figure, *paths)


def _lengths(motions: Sequence[DrawnMotion]) -> list[float]:
    """Return how long to show each run, s: all as long as the longest if they are alike."""
    lengths = [motion.opening[1] - motion.opening[0] for motion in motions]
    longest = max(lengths)
    return [longest] * len(lengths) if longest <= ALIKE * min(lengths) else lengths


def _draw_row(row: Sequence[Axes], name: str, motion: DrawnMotion, length: float) -> None:
    begin = motion.opening[0]
    columns = part(motion.columns, begin, begin + length)
    columns['time'] = columns['time'] - begin
    forces(row[0], columns, 'time / s')
    row[0].set_title(' ', loc='left', fontsize=8.0, pad=_ABOVE_LETTERS)   # room; the name itself widens no panel
    row[0].annotate(shortened(name, _LONGEST), (0.0, 1.0), xytext=(0.0, _ABOVE_LETTERS), xycoords='axes fraction',
                    textcoords='offset points', fontsize=8.0, in_layout=False)
    legend = row[0].get_legend()
    if legend is not None:
        legend.remove()
    velocity(row[1], columns, 'time / s')
    friction_loop(row[2], motion)


def _share(panels: Sequence[Axes], axis: str) -> None:
    """Give panels the same limits, unless the lines of one would be lost in those of another."""
    limits = np.array([getattr(panel, f'get_{axis}lim')() for panel in panels])
    extents = np.ptp(limits, axis=1)
    if extents.max() <= ALIKE * extents.min():
        for panel in panels:
            getattr(panel, f'set_{axis}lim')(limits[:, 0].min(), limits[:, 1].max())
