# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The motion as in Fig. 7 and 8 of the paper: its panels, letters and units, for a journal's double column."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from itertools import pairwise
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from ..core.arrays import Numbers, rows_between
from ..core.types import Mode
from . import style

KILO = 1e-3   # N to kN
_EARLIER = '#b0b0b0'
_DASHES = {Mode.STICK: (0, (1.0, 1.2)), Mode.ACCELERATING: 'solid', Mode.COASTING: (0, (5.0, 1.5)),
           Mode.DECELERATING: (0, (6.0, 1.5, 1.0, 1.5)), Mode.YIELDING: (0, (2.0, 1.5))}
_DRIVE_DASHES: Any = (0, (4.0, 1.6))
_MODE_NAMES = [mode.name.lower() for mode in Mode]
_ABOVE: dict[str, Any] = {'loc': 'lower right', 'bbox_to_anchor': (1.0, 0.99), 'ncols': 2, 'borderaxespad': 0.0}
_IN_A_LINE, _OF_A_LINE = 125, 8   # letters of a legend, and as many as a line in it takes
_LETTERS = 'adbecf'   # the paper counts down the columns
_ARROWED = 0.15   # of the picture's extent: a shorter stretch gets no arrow

DrawnSpan = tuple[float, float]   # s, from and to
_STRETCH = 'stretch of the drive spring'
RANGED: dict[str, Callable[[Mapping[str, Numbers]], Numbers]] = {
    'velocity': lambda columns: columns['velocity'],
    'friction_force': lambda columns: columns['friction_force'],
    _STRETCH: lambda columns: columns['drive_position'] - columns['position'],
}


class DrawnMotion(NamedTuple):
    """The drawn parts of a run: columns named as in `types.Sample`, and `time`, with the state before each event.

    `ranges` are the lowest and the highest value of RANGED in all of the run.
    """

    columns: Mapping[str, Numbers]
    opening: DrawnSpan           # of panels a and b
    slip: DrawnSpan              # of panels c and d
    break_away: float | None   # s, 0 of their time axis
    orbit: DrawnSpan             # that panels e and f show in grey
    cycle: DrawnSpan | None      # that they stress
    ranges: Mapping[str, tuple[float, float]]


def plot_motion(motion: DrawnMotion, *paths: Path | str) -> None:
    """Draw forces (a), velocity and acceleration (d) over time; (b), (e) the same magnified; the loops (c), (f)."""
    with style.journal(style.DOUBLE_COLUMN, 7.8, *paths, pads=(0.06, 0.06)) as figure:
        panels = list(figure.subplots(3, 2).flat)
        opening, slip = part(motion.columns, *motion.opening), part(motion.columns, *motion.slip)
        label = 'time / s'
        if motion.break_away is not None:
            slip['time'] = (slip['time'] - motion.break_away) * style.MILLI
            label = 'time after the break-away / ms'
        forces(panels[0], opening, 'time / s')
        _speed_and_acceleration(panels[1], opening, 'time / s')
        forces(panels[2], slip, label)
        _speed_and_acceleration(panels[3], slip, label)
        friction_loop(panels[4], motion)
        _drive_force_loop(panels[4], motion)
        phase_plane(panels[5], motion)
        style.letters(panels, _LETTERS)
        legend_below(figure, panels[4])


def legend_below(figure: Figure, *panels: Axes) -> None:
    """Explain the lines of panels below the whole picture, those of one name once."""
    lines = style.lines_by_label(*panels)
    labels = sorted(lines, key=lambda label: _MODE_NAMES.index(label) if label in _MODE_NAMES else -1)
    style.legend_outside(figure, 'lower center', [lines[label] for label in labels], labels, ncols=_columns(labels),
                         handlelength=3.6)


def _columns(labels: Sequence[str]) -> int:
    return max(min(len(labels), 5, _IN_A_LINE // (max(map(len, labels), default=0) + _OF_A_LINE)), 1)


def part(columns: Mapping[str, Numbers], begin: float, end: float) -> dict[str, Numbers]:
    """Return the columns from `begin` to `end` (s)."""
    rows = rows_between(columns['time'], begin, end)
    return {name: column[rows] for name, column in columns.items()}


def forces(panel: Axes, columns: Mapping[str, Numbers], label: str) -> None:
    """Draw the drive force and the friction force over time."""
    for name, what, colour, dashes, width in (('friction_force', 'friction force', style.RED, 'solid', 1.3),
                                              ('drive_force', 'drive force', style.BLACK, _DRIVE_DASHES, 1.0)):
        panel.plot(*style.thinned(columns['time'], columns[name] * KILO), color=colour, linestyle=dashes,
                   linewidth=width, label=what)
    panel.set(xlabel=label, ylabel='force / kN')
    panel.margins(x=0.0)
    panel.legend(**_ABOVE)


def velocity(panel: Axes, columns: Mapping[str, Numbers], label: str) -> None:
    """Draw the velocity over time."""
    panel.plot(*style.thinned(columns['time'], columns['velocity'] * style.MILLI), color=style.BLUE, label='velocity')
    panel.set(xlabel=label, ylabel='velocity / (mm/s)')
    panel.margins(x=0.0)


def friction_loop(panel: Axes, motion: DrawnMotion) -> None:
    """Draw the friction force over the velocity: all of it, and the stressed cycle by mode."""
    _orbit(panel, motion, ('velocity', style.MILLI), ('friction_force', KILO))
    panel.set(xlabel='velocity / (mm/s)', ylabel='friction force / kN')


def _drive_force_loop(panel: Axes, motion: DrawnMotion) -> None:
    """Add the drive force over the velocity, in slip alone."""
    shown = _rows(motion, *motion.orbit)
    slips = motion.columns['mode'][shown] != Mode.STICK
    force = np.where(slips, motion.columns['drive_force'][shown] * KILO, np.nan)
    panel.plot(motion.columns['velocity'][shown] * style.MILLI, force, color=style.BLACK, linewidth=0.6,
               linestyle=_DRIVE_DASHES, label='drive force, in slip')
    panel.set_ylabel('friction and drive force / kN')


def _speed_and_acceleration(panel: Axes, columns: Mapping[str, Numbers], label: str) -> None:
    """Draw velocity (left axis) and acceleration (right axis), with their zeros at one height."""
    velocity(panel, columns, label)
    twin = panel.twinx()
    twin.plot(*style.thinned(columns['time'], columns['acceleration']), color=style.ORANGE, linestyle=(0, (3.0, 1.2)),
              linewidth=0.9, label='acceleration')
    twin.set_ylabel('acceleration / (m/s²)')
    twin.grid(visible=False)
    twin.spines['right'].set_visible(True)
    twin.margins(x=0.0)
    _align_zeros(panel, twin)
    panel.legend(handles=[*panel.get_lines(), *twin.get_lines()], **_ABOVE)


def phase_plane(panel: Axes, motion: DrawnMotion) -> None:
    """Draw the velocity over the stretch of the drive spring, which closes where the position would run away."""
    _orbit(panel, motion, (_STRETCH, style.MILLI), ('velocity', style.MILLI))
    panel.set(xlabel=f'{_STRETCH} s − x / mm', ylabel='velocity / (mm/s)')


def _orbit(panel: Axes, motion: DrawnMotion, *axes: tuple[str, float]) -> None:
    """Draw two of RANGED, each with its scale, over each other."""
    x, y = (RANGED[name](motion.columns) * scale for name, scale in axes)
    shown = _rows(motion, *motion.orbit)
    panel.plot(x[shown], y[shown], color=_EARLIER, linewidth=0.6, label='the run')
    if motion.cycle is None:
        return
    whole = _rows(motion, *motion.cycle)
    panel.plot(x[whole], y[whole], color='white', linewidth=2.2)   # so that the gaps of dashes are white
    ranges = [(motion.ranges[name], scale) for name, scale in axes]
    extent = np.array([high * scale - low * scale or 1.0 for (low, high), scale in ranges])
    labels = dict(zip(Mode, _MODE_NAMES))
    for mode, rows in _stretches(motion, *motion.cycle):
        panel.plot(x[rows], y[rows], color=style.MODE_COLOURS[mode], linestyle=_DASHES[mode], linewidth=1.5,
                   label=labels.pop(mode, None), solid_capstyle='butt')
        _arrow(panel, np.stack([x[rows], y[rows]], axis=1), extent, style.MODE_COLOURS[mode])


def _stretches(motion: DrawnMotion, begin: float, end: float) -> Iterator[tuple[Mode, slice]]:
    """Yield the rows of each mode, from the last row of the mode before on, so that the line has no gap."""
    modes, rows = motion.columns['mode'], _rows(motion, begin, end)
    changes = rows.start + 1 + np.flatnonzero(np.diff(modes[rows]))
    for a, b in pairwise([rows.start, *changes.tolist(), rows.stop]):
        yield Mode(int(modes[a])), slice(max(a - 1, rows.start), b)


def _rows(motion: DrawnMotion, begin: float, end: float) -> slice:
    """Return the rows from just after `begin` to just before `end` (s)."""
    time = motion.columns['time']
    return slice(int(np.searchsorted(time, begin, side='right')) - 1, int(np.searchsorted(time, end)) + 1)


def _arrow(panel: Axes, points: Numbers, extent: Numbers, colour: str) -> None:
    """Show the sense of a stretch in its middle, if it is long enough."""
    way = np.concatenate([[0.0], np.cumsum(np.hypot(*(np.diff(points, axis=0) / extent).T))])
    if len(points) < 3 or way[-1] < _ARROWED:
        return
    at = int(np.clip(np.searchsorted(way, 0.5 * way[-1]), 1, len(points) - 1))
    panel.annotate('', points[at], points[at - 1],
                   arrowprops={'arrowstyle': '-|>', 'color': colour, 'linewidth': 0.0, 'mutation_scale': 9.0,
                               'shrinkA': 0.0, 'shrinkB': 0.0})


def _align_zeros(left: Axes, right: Axes) -> None:
    """Widen both ranges so that 0 is at one height."""
    ranges = [(min(low, 0.0), max(high, 0.0)) for low, high in (left.get_ylim(), right.get_ylim())]
    share = max(-low / (high - low) for low, high in ranges)
    for panel, (low, high) in zip((left, right), ranges) if share < 1.0 else ():
        top = max(high, -low * (1.0 - share) / share) if share else high
        panel.set_ylim(-share / (1.0 - share) * top, top)


# Runs below each other as in Fig. 4 of the paper: forces and velocity over time, friction over velocity.

_ROW, _LEGEND = 2.05, 0.6   # in
_ABOVE_LETTERS = 15.0        # points: a long name reaches over them
_LONGEST = 100             # letters of a name over three panels
ALIKE = 5.0               # so many times as large an extent, and rows do not share an axis


def plot_side_by_side(motions: Mapping[str, DrawnMotion], *paths: Path | str) -> None:
    """Draw a row for each run, by its name; runs that are alike have the same axes."""
    with style.journal(style.DOUBLE_COLUMN, _ROW * len(motions) + _LEGEND, *paths) as figure:
        grid = figure.subplots(len(motions), 3, squeeze=False)
        lengths = _lengths(list(motions.values()))
        for row, (name, motion), length in zip(grid, motions.items(), lengths):
            _draw_row(row, name, motion, length)
        for column in grid.T:
            _share(column, 'x')
            _share(column, 'y')
        for panel in grid[:-1].flat:
            panel.set_xlabel('')
        style.letters(grid.flat)
        legend_below(figure, grid[0, 0], *grid[:, 2])


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
    row[0].annotate(style.shortened(name, _LONGEST), (0.0, 1.0), xytext=(0.0, _ABOVE_LETTERS), xycoords='axes fraction',
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
