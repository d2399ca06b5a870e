# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Runs over a measured one, from a break-away on: forces, velocity, travel over time, force over velocity."""

from collections.abc import Mapping
from pathlib import Path
from typing import NamedTuple

import numpy as np
from matplotlib import rc_context
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.layout_engine import ConstrainedLayoutEngine

from ..core.arrays import Numbers
from .paper_panels import legend_below, part
from .style import (
    BLACK,
    BLUE,
    DOUBLE_COLUMN,
    GREEN,
    JOURNAL,
    MILLI,
    ORANGE,
    PURPLE,
    RED,
    dress,
    force_unit,
    head,
    letter,
    line,
    save,
    shortened,
    thinned,
)

_LONGEST = 45   # letters of a name
_COLOURS = RED, BLUE, GREEN, ORANGE, PURPLE
_FORCES = {'drive_force': 'drive force', 'friction_force': 'friction force'}
_DASHES = {'drive_force': 'solid', 'friction_force': (0, (4.0, 1.6))}


class DrawnOver(NamedTuple):
    """A run from `zero` (s) on, `length` seconds of it; columns named as in `types.Sample`, and `time`."""

    columns: Mapping[str, Numbers]
    zero: float
    length: float
    is_measured: bool


def plot_over_measured(runs: Mapping[str, DrawnOver], time: str, *paths: Path | str) -> None:
    """Draw runs by their names over each other over a `time` so called, those that were measured in grey below."""
    length = max(run.length for run in runs.values())
    shown = {name: _part(run, length) for name, run in runs.items()}
    known = [name for name in _FORCES if all(np.isfinite(shown[each][name]).all() for each, run in runs.items()
                                             if run.is_measured)]
    scale, unit = force_unit(*(columns[name] for columns in shown.values() for name in known))
    colours = iter(_COLOURS * len(runs))
    with rc_context(JOURNAL):
        figure = Figure(figsize=(DOUBLE_COLUMN, 5.6), layout=ConstrainedLayoutEngine(w_pad=0.06, h_pad=0.06))
        panels = list(figure.subplots(2, 2).flat)
        for name, run in sorted(runs.items(), key=lambda item: not item[1].is_measured):
            look = (BLACK, 2.6, 0.4) if run.is_measured else (next(colours), 1.0, 1.0)
            _draw(panels, _named(name, run), shown[name], known, scale, look)
        for panel, label in zip(panels, (f'force / {unit}', 'velocity / (mm/s)', 'travel / mm', f'force / {unit}')):
            panel.set_ylabel(label)
            panel.set_xlabel('velocity / (mm/s)' if panel is panels[3] else time)
            if not panel.has_data():
                panel.text(0.5, 0.5, 'not measured', transform=panel.transAxes, ha='center', va='center')
        for panel, name in zip(panels, 'abcd'):
            letter(panel, name)
        if len(known) > 1:
            panels[0].set_title('solid: drive force, dashed: friction force', fontsize=7.0, loc='right')
        elif known:
            panels[0].set_title(_FORCES[known[0]], fontsize=7.0, loc='right')
        if known:
            panels[3].set_title(_FORCES[known[-1]], fontsize=7.0, loc='right')
        legend_below(figure, panels[1])
        save(figure, *paths)


def _named(name: str, run: DrawnOver) -> str:
    name = shortened(name, _LONGEST)
    return f'{name}, measured' if run.is_measured else name


def _part(run: DrawnOver, length: float) -> dict[str, Numbers]:
    columns = part(run.columns, run.zero, run.zero + length)
    start = float(np.interp(run.zero, run.columns['time'], run.columns['position']))
    return {**columns, 'time': columns['time'] - run.zero, 'travel': columns['position'] - start}


def _draw(panels: list[Axes], label: str, columns: Mapping[str, Numbers], known: list[str], scale: float,
          look: tuple[str, float, float]) -> None:
    """Draw a run into the four panels."""
    colour, width, alpha = look
    for force in known:
        panels[0].plot(*thinned(columns['time'], columns[force] * scale), color=colour, linewidth=width, alpha=alpha,
                       linestyle=_DASHES[force])
    for panel, what in ((panels[1], 'velocity'), (panels[2], 'travel')):
        if np.isfinite(columns[what]).all():
            panel.plot(*thinned(columns['time'], columns[what] * MILLI), color=colour, linewidth=width, alpha=alpha,
                       label=label)
    if known:
        panels[3].plot(columns['velocity'] * MILLI, columns[known[-1]] * scale, color=colour, linewidth=width,
                       alpha=alpha)


# A recorded run and its what-if run, one over the other.

def plot_beside(recorded: Mapping[str, Numbers], other: Mapping[str, Numbers], title: str, path: Path | str) -> None:
    """Draw position, velocity and friction force of both over time into `path` (.png, .pdf or .svg).

    Columns are named as in `types.Sample`, and `time`; the first line of `title` is the heading.
    """
    figure = Figure(figsize=(11.0, 8.0), dpi=150, layout=ConstrainedLayoutEngine(w_pad=0.1, h_pad=0.08))
    panels = figure.subplots(3, 1, sharex=True)
    scale, unit = force_unit(recorded['friction_force'], other['friction_force'])
    for panel, name, factor, label in zip(panels, ('position', 'velocity', 'friction_force'), (MILLI, MILLI, scale),
                                          ('position / mm', 'velocity / (mm/s)', f'friction force / {unit}')):
        line(panel, recorded, name, factor, 'recorded', color=BLUE, linewidth=2.2)
        line(panel, other, name, factor, 'what if', color=ORANGE, linewidth=1.3, linestyle=(0, (4, 1.5)))
        panel.set_ylabel(label)
        dress(panel)
    panels[-1].set_xlabel('time / s')
    figure.align_ylabels(panels)
    head(panels[0], title)
    save(figure, path)
