# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""A run over time: position, stretch, velocity, forces, modes, faults; the whole of it, and beside it a part.

The normal force has a panel where it varies; what is not known has none.
"""

from collections.abc import Callable, Sequence
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from .run_panels import DrawnRun, TimeWindow, WindowPanels
from .style import GREY, RED, dress, head, save

_WIDTH, _WIDTH_OF_TWO = 11.0, 15.0            # in
_DPI = 120
_TALL, _STRETCH, _NORMAL_FORCE, _MODES = 1.9, 1.4, 1.1, 1.1   # in, of panels
_LANE = 0.24                                  # in, of a lane of marks
_GAP = 0.35                                   # in, between panels: a legend
_LEFT, _RIGHT, _TOP, _BOTTOM = 1.4, 0.25, 1.0, 0.55   # in, around them: names of modes and faults, the title
_LABEL = 0.7                                  # in, from a panel to what it shows

_Draw = Callable[[WindowPanels, Axes], None]


def plot_run(run: DrawnRun, windows: Sequence[TimeWindow], *paths: Path | str) -> None:
    """Draw a run in one window, or in two beside each other, the second a part of the first, into each path.

    The ending of a path (.png, .pdf, .svg) says how.  The places of the panels are fixed: a layout that looks at what
    is in them takes as long as all of the drawing.
    """
    lanes = len({mark.label for mark in run.marks})
    lines = _panels_of_lines(run)
    heights = [*(height for height, _ in lines), _MODES, *([_LANE * lanes + 0.1] if lanes else [])]
    rows, columns = len(heights), len(windows)
    width = _WIDTH if columns == 1 else _WIDTH_OF_TWO
    height = sum(heights) + _GAP * (rows - 1) + _TOP + _BOTTOM
    panel = (width - columns * (_LEFT + _RIGHT)) / columns
    figure = Figure(figsize=(width, height), dpi=_DPI)
    grid = figure.subplots(rows, columns, sharex='col', squeeze=False, height_ratios=heights, gridspec_kw={
        'left': _LEFT / width, 'right': 1.0 - _RIGHT / width, 'top': 1.0 - _TOP / height, 'bottom': _BOTTOM / height,
        'hspace': _GAP * rows / sum(heights), 'wspace': (_LEFT + _RIGHT) / panel})
    for k, (column, window) in enumerate(zip(grid.T, windows)):
        _draw_column(column, WindowPanels(run, window, panel * _DPI), [draw for _, draw in lines])
        _dress_column(column, run, window, windows[k + 1:], len(lines))
        for one in column:
            one.yaxis.set_label_coords(-_LABEL / panel, 0.5)
    head(grid[0, 0], run.title)
    for one, window in zip(grid[0, 1:], windows[1:]):
        one.set_title(f'{window.begin:.6g} to {window.end:.6g} s', loc='left', fontsize=10, color=GREY)
    save(figure, *paths)


def _panels_of_lines(run: DrawnRun) -> list[tuple[float, _Draw]]:
    """Return the height (in) of each panel in which a run has something, and what draws it."""
    known = {name for name, column in run.motion.items() if np.isfinite(column).any()}
    panels: list[tuple[float, _Draw]] = [(_TALL, WindowPanels.position)] if 'position' in known else []
    panels += [(_STRETCH, WindowPanels.stretch)] if {'position', 'drive_position'} <= known else []
    panels += [(_TALL, WindowPanels.velocity)]
    has_force = {'drive_force', 'friction_force'} & known or np.isfinite(run.inputs['external_force']).any()
    panels += [(_TALL, WindowPanels.forces)] if has_force else []
    return panels + ([(_NORMAL_FORCE, WindowPanels.normal_force)] if 'normal_force' in run.inputs else [])


def _draw_column(panels: Sequence[Axes], view: WindowPanels, lines: Sequence[_Draw]) -> None:
    for panel, draw_panel in zip(panels, (*lines, WindowPanels.modes, WindowPanels.marks)):
        draw_panel(view, panel)
        dress(panel)


def _dress_column(panels: Sequence[Axes], run: DrawnRun, window: TimeWindow, parts: Sequence[TimeWindow], lines: int
                  ) -> None:
    """Mark in the panels of a window, first those of `lines`, its `parts` that are shown beside it, and faults."""
    for panel in panels:
        for part in parts:
            panel.axvspan(*part, color=GREY, alpha=0.15, linewidth=1.0, zorder=0.5)
    for panel in panels[:lines]:
        for mark in run.marks:
            if mark.is_span and not mark.is_of_host:
                panel.axvspan(mark.begin, mark.end, color=RED, alpha=0.08, linewidth=0.0, zorder=0.4)
    for panel in panels[lines:]:
        panel.grid(visible=False, axis='y')
    panels[-1].set_xlabel('time / s')
    if window.end > window.begin:
        panels[-1].set_xlim(*window)
    panels[-1].ticklabel_format(axis='x', style='plain', useOffset=False)   # late times are read as they are
