# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Runs over each other: over a measured one, from a break-away on; and any runs, over each other or side by side."""

from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from textwrap import fill
from typing import Any, NamedTuple

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.layout_engine import ConstrainedLayoutEngine

from ..core.arrays import Numbers
from ..core.types import Mode
from . import style
from .paper_panels import legend_below, part
from .run import DrawnRun, TimeWindow

_LONGEST = 45   # letters of a name
_COLOURS = style.RED, style.BLUE, style.GREEN, style.ORANGE, style.PURPLE
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
    scale, unit = style.force_unit(*(columns[name] for columns in shown.values() for name in known))
    colours = iter(_COLOURS * len(runs))
    with style.journal(style.DOUBLE_COLUMN, 5.6, *paths, pads=(0.06, 0.06)) as figure:
        panels = list(figure.subplots(2, 2).flat)
        for name, run in sorted(runs.items(), key=lambda item: not item[1].is_measured):
            look = (style.BLACK, 2.6, 0.4) if run.is_measured else (next(colours), 1.0, 1.0)
            _draw(panels, _named(name, run), shown[name], known, scale, look)
        for panel, label in zip(panels, (f'force / {unit}', 'velocity / (mm/s)', 'travel / mm', f'force / {unit}')):
            panel.set_ylabel(label)
            panel.set_xlabel('velocity / (mm/s)' if panel is panels[3] else time)
            if not panel.has_data():
                panel.text(0.5, 0.5, 'not measured', transform=panel.transAxes, ha='center', va='center')
        style.letters(panels)
        if len(known) > 1:
            panels[0].set_title('solid: drive force, dashed: friction force', fontsize=7.0, loc='right')
        elif known:
            panels[0].set_title(_FORCES[known[0]], fontsize=7.0, loc='right')
        if known:
            panels[3].set_title(_FORCES[known[-1]], fontsize=7.0, loc='right')
        legend_below(figure, panels[1])


def _named(name: str, run: DrawnOver) -> str:
    name = style.shortened(name, _LONGEST)
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
        panels[0].plot(*style.thinned(columns['time'], columns[force] * scale), color=colour, linewidth=width,
                       alpha=alpha, linestyle=_DASHES[force])
    for panel, what in ((panels[1], 'velocity'), (panels[2], 'travel')):
        if np.isfinite(columns[what]).all():
            panel.plot(*style.thinned(columns['time'], columns[what] * style.MILLI), color=colour, linewidth=width,
                       alpha=alpha, label=label)
    if known:
        panels[3].plot(columns['velocity'] * style.MILLI, columns[known[-1]] * scale, color=colour, linewidth=width,
                       alpha=alpha)


# Runs over each other or beside each other: speed, error of the position, force of the drive.

_MICRO, _FINE = 1e6, 1e-3   # m to µm; m: smaller errors are shown so
_FAR = 4.0                  # of the largest value: a limit farther away would leave the curves no room
_TITLES, _LABELS = 100, 130  # letters that titles and labels have room for, side by side
_DASHED: tuple[Any, ...] = (0, (5, 2))
_LOOKS = [(colour, dashes) for dashes in ('solid', _DASHED)
          for colour in (style.BLUE, style.RED, style.GREEN, style.ORANGE, style.SKY)]


class Bound(NamedTuple):
    """A limit by its name, either side of 0 (SI), on what a panel shows from `begin` to `end` (s)."""

    name: str
    panel: str     # speed or error
    value: float
    begin: float
    end: float


def plot_over_each_other(runs: Sequence[DrawnRun], window: TimeWindow, bounds: Sequence[Sequence[Bound]],
                         are_apart: bool, *paths: Path | str) -> None:
    """Draw runs in a window, with the bounds of each: a column for each, where they are `apart`, or all in one.

    Their titles are their names.  In a column of its own the stick of a run is blue.
    """
    columns = len(runs) if are_apart else 1
    figure = Figure(figsize=(max(11.0, 4.0 * columns), 7.6), dpi=110, layout=ConstrainedLayoutEngine(w_pad=0.08))
    grid = figure.subplots(3, columns, sharex=True, sharey='row', squeeze=False)
    for row, (name, label, scale, curves) in zip(grid, _curves_of(runs)):
        row[0].set_ylabel(label)
        panels = list(row) if are_apart else list(row) * len(runs)
        for k, (run, panel, curve) in enumerate(zip(runs, panels, curves)):
            colour, dashes = _LOOKS[0 if are_apart else k]
            if np.isfinite(curve).any():
                panel.plot(*style.thinned(run.motion['time'], curve * scale), color=colour, linewidth=1.1,
                           linestyle=dashes, label='' if are_apart else run.title)
        for run, panel, of_run in zip(runs, panels, bounds):
            if name == 'speed' and 'velocity' in run.setpoint:
                style.line(panel, run.setpoint, 'velocity', scale, 'setpoint', color=style.BLACK, linewidth=1.0,
                           linestyle=_DASHED)
            for bound in of_run:
                if bound.panel == name and bound.begin < window.end and bound.end > window.begin:
                    _draw_bound(panel, bound, window, scale, bound.value > _FAR * _largest(curves))
    for column, run in zip(grid.T, runs if are_apart else ()):
        column[0].set_title(fill(run.title, _TITLES // columns), loc='left', fontsize=11, fontweight='bold')
        _shade_sticks(column, run)
    for panel in grid.flat:
        style.dress(panel, has_legend=False)
        panel.set_xlim(*window)
        panel.ticklabel_format(useOffset=False)
        if panel in grid[-1]:
            panel.set_xlabel('time / s')
    longest = max(map(len, style.lines_by_label(*grid.flat)), default=0)
    style.legend_of(figure, 'upper left', *grid.flat, frameon=False, fontsize=9,
                    ncols=min(max(_LABELS // (longest + 6), 1), 5))
    style.save(figure, *paths)


def _curves_of(runs: Sequence[DrawnRun]) -> list[tuple[str, str, float, list[Numbers]]]:
    """Return name, label, scale and SI values of speed, error and force.

    The error is that to the drive unless all runs have a setpoint.
    """
    motions, have_setpoint = [run.motion for run in runs], all(run.setpoint for run in runs)
    errors = [(np.interp(motion['time'], run.setpoint['time'], run.setpoint['position']) if have_setpoint
               else motion['drive_position']) - motion['position'] for run, motion in zip(runs, motions)]
    scale, unit = (_MICRO, 'µm') if _largest(errors) < _FINE else (style.MILLI, 'mm')
    forces = [motion['drive_force'] for motion in motions]
    force_scale, force = style.force_unit(*forces)
    return [('speed', 'speed / (mm/s)', style.MILLI, [motion['velocity'] for motion in motions]),
            ('error', f'{"setpoint" if have_setpoint else "drive end"} less slider / {unit}', scale, errors),
            ('force', f'drive force / {force}', force_scale, forces)]


def _largest(curves: Sequence[Numbers]) -> float:
    return max(float(np.abs(curve[np.isfinite(curve)]).max(initial=0.0)) for curve in curves)


def _draw_bound(panel: Axes, bound: Bound, window: TimeWindow, scale: float, is_far: bool) -> None:
    panel.hlines([] if is_far else [scale * bound.value, -scale * bound.value], max(bound.begin, window.begin),
                 min(bound.end, window.end), color=style.PURPLE, linewidth=1.4, linestyle=(0, (6, 2, 1, 2)),
                 label=f'limit {bound.name}' + (', beyond the panel' if is_far else ''))


def _shade_sticks(panels: Iterable[Axes], run: DrawnRun) -> None:
    starts, modes = run.modes
    ends, sticks = np.append(starts[1:], max(starts[-1], run.motion['time'][-1])), modes == Mode.STICK
    for panel in panels:
        panel.broken_barh(np.column_stack([starts, ends - starts])[sticks].tolist(), (0.0, 1.0), facecolors=style.SKY,
                          alpha=0.22, transform=panel.get_xaxis_transform(), linewidth=0.0, label='stick', zorder=0)
