# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""A run over time: position, stretch, velocity, forces, modes, faults; the whole of it, and beside it a part.

The normal force has a panel where it varies; what is not known has none.
"""

import math
from collections.abc import Callable, Mapping, Sequence
from itertools import groupby
from pathlib import Path
from typing import NamedTuple

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from ..core.arrays import Numbers
from ..core.types import Event, EventKind, Mode
from ..simulation.step_result import Mark
from . import style

# The panels of a run over time, in one window: as lines, or as envelopes where lines would run into each other.

# What a picture of a run is drawn from.

_INPUTS = ('drive_velocity', 'external_force', 'normal_force')
_OF_EVENTS = ('position', 'velocity', 'drive_position', 'drive_force', 'friction_force')


class TimeWindow(NamedTuple):
    """A part of a run, s."""

    begin: float
    end: float


NO_SETPOINT: Mapping[str, Numbers] = {}


class DrawnRun(NamedTuple):
    """A run as it is drawn, SI units; the first line of `title` is the heading.

    `motion`: columns of samples and of the states before events, in the order of time; `inputs`: `time`,
    `drive_velocity`, `external_force`, and `normal_force` where it varies; `commands`: `time` and `velocity` as they
    were taken, both empty where none is known; `modes`: when each began, and which; `setpoint`: `time` and `position`
    of the slider, empty without one.
    """

    title: str
    motion: Mapping[str, Numbers]
    inputs: Mapping[str, Numbers]
    commands: Mapping[str, Numbers]
    modes: tuple[Numbers, Numbers]
    break_aways: tuple[Numbers, Numbers]   # s, N: times and friction forces
    event_times: Numbers
    marks: Sequence[Mark]
    setpoint: Mapping[str, Numbers] = NO_SETPOINT


def drawn_run(title: str, samples: Mapping[str, Numbers], events: Sequence[Event], commands: Mapping[str, Numbers],
              marks: Sequence[Mark]) -> DrawnRun:
    """Return a run as it is drawn, from its samples (columns named as in `types.Sample`, and `time`) and events.

    A drive that never exerts a force, as of an axis without a spring, is none.
    """
    if not np.any(samples['drive_force']):
        none = np.full(len(samples['time']), np.nan)
        samples = {**samples, 'drive_position': none, 'drive_velocity': none, 'drive_force': none}
        events = [event._replace(drive_position=np.nan, drive_force=np.nan) for event in events]
    times = np.array([event.time for event in events], dtype=np.float64)
    breaks = [event for event in events if event.kind == EventKind.BREAKAWAY and math.isfinite(event.friction_force)]
    modes = np.array([samples['mode'][0], *(event.mode for event in events)], dtype=np.float64)
    return DrawnRun(
        title, _with_events(samples, events, times),
        {name: samples[name] for name in ('time', *_INPUTS) if name in samples}, commands,
        (np.concatenate([samples['time'][:1], times]), modes),
        (np.array([event.time for event in breaks]), np.array([event.friction_force for event in breaks])),
        times, marks)


def mode_shares(modes: tuple[Numbers, Numbers], edges: Numbers) -> dict[Mode, Numbers]:
    """Return the share of each mode in the time between adjacent edges (s)."""
    starts, which = modes
    ends = np.append(starts[1:], max(edges[-1], starts[-1]))
    shares = {}
    for mode in Mode:
        spent = np.concatenate([[0.0], np.cumsum(np.where(which == mode, ends - starts, 0.0))])
        shares[mode] = np.diff(np.interp(edges, np.append(starts, ends[-1]), spent)) / np.diff(edges)
    return shares


def _with_events(samples: Mapping[str, Numbers], events: Sequence[Event], times: Numbers) -> dict[str, Numbers]:
    """Return columns with the states at the events between the samples, each before the sample of its time."""
    places = np.searchsorted(samples['time'], times)
    columns = {'time': np.insert(samples['time'], places, times)}
    for name in _OF_EVENTS:
        columns[name] = np.insert(samples[name], places, [getattr(event, name) for event in events])
    return columns


BINS = 240            # of a band, and of the shares of the modes, at most
_OF_A_CYCLE = 6       # pixels that a cycle of lines takes at least
_OF_A_PART = 8        # parts: longer cycles are resolved by parts of them
_OF_A_MODE = 2        # pixels of a mode in its lane
_MICRO, _FINE = 1e6, 1e-4   # m to µm; m: smaller errors are shown so
_MANY = 50            # break-aways that are marked smaller
_CLOSEST, _CLOSEST_POSITION = 1e-4, 1e-6   # of the largest value: what changes less is drawn as a constant
_DASHES = (0, (5, 2))
_ENVELOPE = 'envelope'
_MARK_COLOURS = {'refused': style.RED, 'limited': style.ORANGE, 'lost': style.PURPLE, 'time lost': style.BLACK,
                 'time-out': style.RED}


class WindowPanels:
    """Draws a run in a window, `width` pixels wide; `is_crowded` where it has too many slips for lines."""

    def __init__(self, run: DrawnRun, window: TimeWindow, width: float) -> None:
        self._run, self._window, self._width = run, window, width
        self._motion, self._inputs = _part(run.motion, window), _part(run.inputs, window)
        self.is_crowded = _within(run.break_aways[0], window) > width / _OF_A_CYCLE
        self._edges = bin_edges(run, window)

    def position(self, panel: Axes) -> None:
        """Draw the positions of the slider and of the drive end of the spring."""
        style.line(panel, self._motion, 'drive_position', style.MILLI, 'drive end of the spring', color=style.GREY,
                   linewidth=1.0, linestyle=_DASHES)
        style.line(panel, self._motion, 'position', style.MILLI, 'slider', color=style.BLUE, linewidth=1.4)
        if self._run.setpoint:
            style.line(panel, _part(self._run.setpoint, self._window), 'position', style.MILLI, 'setpoint',
                       color=style.BLACK, linewidth=0.9, linestyle=_DASHES)
        panel.set_ylabel('position / mm')
        _no_closer(panel, _CLOSEST_POSITION)

    def stretch(self, panel: Axes) -> None:
        """Draw the stretch of the drive spring: the position of its drive end less that of the slider."""
        stretch = self._motion['drive_position'] - self._motion['position']
        fine = float(np.abs(stretch[np.isfinite(stretch)]).max(initial=0.0)) < _FINE
        self._curve(panel, stretch * (_MICRO if fine else style.MILLI), 'drive end less slider', style.BLUE, 1.2)
        panel.set_ylabel(f'stretch / {"µm" if fine else "mm"}')
        _no_closer(panel, _CLOSEST)

    def error(self, panel: Axes) -> None:
        """Draw the error of the position: the setpoint less the slider."""
        wanted = np.interp(self._motion['time'], self._run.setpoint['time'], self._run.setpoint['position'])
        self._curve(panel, (wanted - self._motion['position']) * _MICRO, 'setpoint less slider', style.RED, 1.2)
        panel.set_ylabel('error / µm')
        _no_closer(panel, _CLOSEST)

    def velocity(self, panel: Axes) -> None:
        """Draw the velocities of slider and drive, and the commands."""
        self._curve(panel, self._motion['velocity'] * style.MILLI, 'slider', style.BLUE, 1.3)
        commands = _held(self._run.commands, self._window)
        if len(commands['time']):
            panel.plot(commands['time'], commands['velocity'] * style.MILLI, color=style.ORANGE, linewidth=2.0,
                       label='command', drawstyle='steps-post', alpha=0.8)
        style.line(panel, self._inputs, 'drive_velocity', style.MILLI, 'drive', color=style.GREY, linewidth=1.0,
                   linestyle=_DASHES)
        panel.set_ylabel('velocity / (mm/s)')
        _no_closer(panel, _CLOSEST)

    def forces(self, panel: Axes) -> None:
        """Draw the forces on the slider."""
        motion, inputs = self._motion, self._inputs
        scale, unit = style.force_unit(motion['drive_force'], motion['friction_force'], inputs['external_force'])
        if np.any(self._run.inputs['external_force'] != 0.0):
            style.line(panel, inputs, 'external_force', scale, 'external', color=style.GREEN, linewidth=1.1)
        self._curve(panel, motion['friction_force'] * scale, 'friction', style.RED, 2.0)
        self._curve(panel, motion['drive_force'] * scale, 'drive', style.BLACK, 1.0)
        times, forces = self._run.break_aways
        first, last = np.searchsorted(times, self._window)
        if last > first and not self.is_crowded:
            panel.plot(times[first:last], forces[first:last] * scale, 'o', markerfacecolor='white',
                       markersize=4.5 if last - first < _MANY else 2.5, markeredgecolor=style.RED,
                       label='static limit at break-away')
        panel.set_ylabel(f'force / {unit}')
        _no_closer(panel, _CLOSEST)

    def normal_force(self, panel: Axes) -> None:
        """Draw the normal force on the slideway."""
        scale, unit = style.force_unit(self._run.inputs['normal_force'])
        style.line(panel, self._inputs, 'normal_force', scale, '', color=style.PURPLE, linewidth=1.3)
        panel.set_ylabel(f'normal force / {unit}')
        _no_closer(panel, _CLOSEST)

    def modes(self, panel: Axes) -> None:
        """Draw one lane for each mode, or their shares of the time."""
        if self.is_crowded or _within(self._run.event_times, self._window) > self._width / _OF_A_MODE:
            self._mode_shares(panel)
            return
        starts, modes = self._run.modes
        first = max(int(np.searchsorted(starts, self._window.begin, side='right')) - 1, 0)
        last = int(np.searchsorted(starts, self._window.end))
        ends = np.append(starts[1:], max(self._window.end, float(starts[-1])))[first:last]
        lanes = self._colours
        for lane, (mode, colour) in enumerate(lanes.items()):
            bars = [(begin, end - begin) for begin, end, which in zip(starts[first:last].tolist(), ends.tolist(),
                                                                      modes[first:last].tolist()) if which == mode]
            panel.broken_barh(bars, (lane - 0.4, 0.8), facecolors=colour, edgecolors=colour, linewidth=0.3, snap=False)
        _lanes(panel, [mode.name for mode in lanes])

    def marks(self, panel: Axes) -> None:
        """Draw one lane for each kind of fault and refusal."""
        lanes = {label: list(marks) for label, marks in groupby(sorted(self._run.marks, key=_label), _label)}
        for lane, (label, marks) in enumerate(lanes.items()):
            colour = style.GREY if marks[0].is_of_host else _MARK_COLOURS.get(label, style.RED)
            spans = [(mark.begin, mark.end - mark.begin) for mark in marks if mark.is_span]
            panel.broken_barh(spans, (lane - 0.35, 0.7), facecolors=colour, edgecolors=colour, linewidth=0.5, alpha=0.7)
            instants = [mark.begin for mark in marks if not mark.is_span]
            panel.plot(instants, [lane] * len(instants), '|', color=colour, markersize=9, markeredgewidth=1.2)
        _lanes(panel, [_counted(label, marks) for label, marks in lanes.items()])

    @property
    def _colours(self) -> dict[Mode, str]:
        """The lanes of the modes and their colours; YIELDING has one in a run that yields."""
        yields = Mode.YIELDING in self._run.modes[1]
        return {mode: colour for mode, colour in style.MODE_COLOURS.items() if yields or mode != Mode.YIELDING}

    def _mode_shares(self, panel: Axes) -> None:
        edges = self._edges
        shares = mode_shares(self._run.modes, edges)
        middles = 0.5 * (edges[1:] + edges[:-1])
        lanes = self._colours
        panel.stackplot(middles, [100.0 * shares[mode] for mode in lanes], colors=list(lanes.values()),
                        labels=[mode.name.lower() for mode in lanes], step='mid')
        panel.set(ylabel='time / %', ylim=(0.0, 100.0))

    def _curve(self, panel: Axes, values: Numbers, label: str, colour: str, width: float) -> None:
        time = self._motion['time']
        if np.isnan(values).all():   # not measured
            return
        if not self.is_crowded and not self._is_dense(time, values):
            style.line(panel, {'time': time, 'values': values}, 'values', 1.0, label, color=colour, linewidth=width)
            return
        middles, low, high = band(time, values, self._edges)
        panel.fill_between(middles, low, high, facecolor=colour, edgecolor=colour, linewidth=0.5, alpha=0.45,
                           label=f'{label}, {_ENVELOPE}')

    def _is_dense(self, time: Numbers, values: Numbers) -> bool:
        """Return whether a curve goes up and down, by all of its range, more often than its pixels show."""
        _, shown = style.thinned(time, values)
        return bool(np.nansum(np.abs(np.diff(shown))) > 2.0 * self._width / _OF_A_CYCLE * np.ptp(shown))


def band(time: Numbers, values: Numbers, edges: Numbers) -> tuple[Numbers, Numbers, Numbers]:
    """Return the middles (s) of the parts between edges that have values, with the least and the largest in each."""
    places = np.searchsorted(time, edges)
    has_any = np.diff(places) > 0
    starts = places[:-1][has_any]
    middles = (0.5 * (edges[1:] + edges[:-1]))[has_any]
    end = int(places[-1])
    return middles, np.minimum.reduceat(values[:end], starts), np.maximum.reduceat(values[:end], starts)


def bin_edges(run: DrawnRun, window: TimeWindow) -> Numbers:
    """Return the edges (s) of equal parts of a window, each as long as some whole cycles.

    Parts of half a cycle more or less would show a beat that is none of the motion.
    """
    begin, end = window
    starts = run.break_aways[0]
    inside = starts[(starts >= begin) & (starts <= end)]
    period = (inside[-1] - inside[0]) / (len(inside) - 1) if len(inside) > 1 else 0.0
    least = (end - begin) / BINS
    length = math.ceil(least / period) * period if 0.0 < period < _OF_A_PART * least else least
    return np.asarray(np.linspace(begin, end, max(round((end - begin) / length), 1) + 1), dtype=np.float64)


def _within(times: Numbers, window: TimeWindow) -> int:
    first, last = np.searchsorted(times, window)
    return int(last - first)


def _part(columns: Mapping[str, Numbers], window: TimeWindow) -> dict[str, Numbers]:
    """Return the rows of a window, with one more on either side, so that lines reach its edges."""
    time = columns['time']
    first = max(int(np.searchsorted(time, window.begin)) - 1, 0)
    last = int(np.searchsorted(time, window.end, side='right')) + 1
    return {name: column[first:last] for name, column in columns.items()}


def _held(commands: Mapping[str, Numbers], window: TimeWindow) -> dict[str, Numbers]:
    """Return the commands of a window, the last one held up to its end."""
    part = _part(commands, window)
    part = {name: column[:-1] if len(column) and part['time'][-1] > window.end else column
            for name, column in part.items()}
    if not len(part['time']):
        return part
    return {'time': np.append(np.maximum(part['time'], window.begin), window.end),
            'velocity': np.append(part['velocity'], part['velocity'][-1])}


def _label(mark: Mark) -> str:
    return mark.label


def _counted(label: str, marks: list[Mark]) -> str:
    number = sum(mark.number for mark in marks)
    words = label.replace('_', ' ')
    return f'{words} ({number})' if number > 1 else words


def _no_closer(panel: Axes, share: float) -> None:
    """Widen the range of values to a share of the largest one, and let the numbers be read as they are."""
    low, high = panel.get_ylim()
    if 0.0 < high - low < (least := share * max(abs(low), abs(high))):
        middle = 0.5 * (low + high)
        panel.set_ylim(middle - 0.5 * least, middle + 0.5 * least)
    panel.ticklabel_format(axis='y', useOffset=False)


def _lanes(panel: Axes, names: list[str]) -> None:
    panel.set_yticks(range(len(names)), names, fontsize=8)
    panel.set_ylim(len(names) - 0.4, -0.6)
    panel.tick_params(axis='y', length=0)
    panel.grid(visible=False, axis='y')


_WIDTH, _WIDTH_OF_TWO = 11.0, 15.0            # in
_DPI = 120
_TALL, _STRETCH, _NORMAL_FORCE, _MODES = 1.9, 1.4, 1.1, 1.1   # in, of panels
_LANE = 0.24                                  # in, of a lane of marks
_GAP = 0.35                                   # in, between panels: a legend
_LEFT, _RIGHT, _TOP, _BOTTOM = 1.4, 0.25, 1.0, 0.55   # in, around them: names of modes and faults, the title
_LABEL = 0.7                                  # in, from a panel to what it shows

_Draw = Callable[[WindowPanels, Axes], None]


def plot_run(run: DrawnRun, windows: Sequence[TimeWindow], *paths: Path | str) -> Figure:
    """Return a run in one window, or in two beside each other, the second a part of the first, drawn into each path.

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
    figure = style.ShownFigure(figsize=(width, height), dpi=_DPI)
    grid = figure.subplots(rows, columns, sharex='col', squeeze=False, height_ratios=heights, gridspec_kw={
        'left': _LEFT / width, 'right': 1.0 - _RIGHT / width, 'top': 1.0 - _TOP / height, 'bottom': _BOTTOM / height,
        'hspace': _GAP * rows / sum(heights), 'wspace': (_LEFT + _RIGHT) / panel})
    for k, (column, window) in enumerate(zip(grid.T, windows)):
        _draw_column(column, WindowPanels(run, window, panel * _DPI), [draw for _, draw in lines])
        _dress_column(column, run, window, windows[k + 1:], len(lines))
        for one in column:
            one.yaxis.set_label_coords(-_LABEL / panel, 0.5)
    style.head(grid[0, 0], run.title)
    for one, window in zip(grid[0, 1:], windows[1:]):
        one.set_title(f'{window.begin:.6g} to {window.end:.6g} s', loc='left', fontsize=10, color=style.GREY)
    style.save(figure, *paths)
    return figure


def _panels_of_lines(run: DrawnRun) -> list[tuple[float, _Draw]]:
    """Return the height (in) of each panel in which a run has something, and what draws it."""
    known = {name for name, column in run.motion.items() if np.isfinite(column).any()}
    panels: list[tuple[float, _Draw]] = [(_TALL, WindowPanels.position)] if 'position' in known else []
    panels += [(_STRETCH, WindowPanels.error)] if run.setpoint and 'position' in known else []
    panels += [(_STRETCH, WindowPanels.stretch)] if {'position', 'drive_position'} <= known else []
    panels += [(_TALL, WindowPanels.velocity)]
    has_force = {'drive_force', 'friction_force'} & known or np.isfinite(run.inputs['external_force']).any()
    panels += [(_TALL, WindowPanels.forces)] if has_force else []
    return panels + ([(_NORMAL_FORCE, WindowPanels.normal_force)] if 'normal_force' in run.inputs else [])


def _draw_column(panels: Sequence[Axes], view: WindowPanels, lines: Sequence[_Draw]) -> None:
    for panel, draw_panel in zip(panels, (*lines, WindowPanels.modes, WindowPanels.marks)):
        draw_panel(view, panel)
        style.dress(panel)


def _dress_column(panels: Sequence[Axes], run: DrawnRun, window: TimeWindow, parts: Sequence[TimeWindow], lines: int
                  ) -> None:
    """Mark in the panels of a window, first those of `lines`, its `parts` that are shown beside it, and faults."""
    for panel in panels:
        for part in parts:
            panel.axvspan(*part, color=style.GREY, alpha=0.15, linewidth=1.0, zorder=0.5)
    for panel in panels[:lines]:
        for mark in run.marks:
            if mark.is_span and not mark.is_of_host:
                panel.axvspan(mark.begin, mark.end, color=style.RED, alpha=0.08, linewidth=0.0, zorder=0.4)
    for panel in panels[lines:]:
        panel.grid(visible=False, axis='y')
    panels[-1].set_xlabel('time / s')
    if window.end > window.begin:
        panels[-1].set_xlim(*window)
    panels[-1].ticklabel_format(axis='x', style='plain', useOffset=False)   # late times are read as they are
