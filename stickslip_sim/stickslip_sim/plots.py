"""Pictures of a run.

The only file that imports matplotlib, and without its global state, so that no display is needed.
"""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from matplotlib import rc_context
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.layout_engine import ConstrainedLayoutEngine
from matplotlib.lines import Line2D
from matplotlib.ticker import AutoMinorLocator
from numpy.typing import NDArray

from .analysis import mode_spans
from .words import Event, EventKind, Mode

Numbers = NDArray[np.float64]

# Okabe and Ito's colours, which stay apart for colour-blind eyes
_BLACK, _ORANGE, _SKY, _GREEN = '#222222', '#E69F00', '#56B4E9', '#009E73'
_BLUE, _RED, _PURPLE = '#0072B2', '#D55E00', '#CC79A7'
_GREY = '#666666'
_MODE_COLOURS = {Mode.STICK: _SKY, Mode.ACCELERATING: _ORANGE, Mode.COASTING: _GREEN, Mode.DECELERATING: _PURPLE}
_POINTS = 8000       # per line: more than a picture can show
_MILLI = 1e3         # m to mm
_CROWD = 50          # break-aways that are marked smaller
_KILO_FROM = 1e4     # N: forces beyond are told in kN


def plot_run(samples: Mapping[str, Numbers], events: Sequence[Event], title: str, path: Path | str) -> None:
    """Draw position, velocity, forces and mode over time into `path` (.png or .svg).

    `samples` are columns named as in `words.Sample`, and `time`; the first line of `title` is the heading.
    """
    layout = ConstrainedLayoutEngine(w_pad=0.1, h_pad=0.08)
    figure = Figure(figsize=(11.0, 8.5), dpi=150, layout=layout)
    panels = figure.subplots(4, 1, sharex=True, height_ratios=(3, 3, 3, 1.5))
    _position(panels[0], samples)
    _velocity(panels[1], samples)
    _forces(panels[2], samples, events)
    _modes(panels[3], samples, events)
    for panel in panels:
        _dress(panel)
    panels[-1].grid(visible=False, axis='y')
    panels[-1].set_xlabel('time / s')
    if len(samples['time']) > 1:
        panels[-1].set_xlim(samples['time'][0], samples['time'][-1])
    figure.align_ylabels(panels[:3])
    _head(panels[0], title)
    _save(figure, path)


class Line(NamedTuple):
    """A solver in a picture of errors and costs: one point for each setting."""

    label: str
    errors: Sequence[float]   # s
    costs: Sequence[float]    # s for each simulated second
    flawed: Sequence[bool]    # events missed or invented


def plot_trade(panels: Mapping[str, Sequence[Line]], title: str, path: Path | str) -> None:
    """Draw cost over error, a panel for each case (its name is the heading), into `path` (.png or .svg).

    Both axes are logarithmic.  An error below LEAST_ERROR is drawn there, as the axis says.
    """
    columns = 1 if len(panels) == 1 else 2
    count = -(-len(panels) // columns)
    figure = Figure(figsize=(6.5 * columns + 0.5, 4.6 * count + 1.6), dpi=130, layout=ConstrainedLayoutEngine())
    grid = figure.subplots(count, columns, squeeze=False, sharex=True)
    labels = list(dict.fromkeys(line.label for lines in panels.values() for line in lines))
    looks = {label: _TRADE_LOOKS[i % len(_TRADE_LOOKS)] for i, label in enumerate(labels)}
    for panel, (heading, lines) in zip(grid.flat, panels.items()):
        _trade_panel(panel, heading, lines, looks)
    for panel in grid.flat[len(panels):]:
        panel.set_visible(False)
    for panel in grid[:, 0]:
        panel.set_ylabel('cost: µs for each simulated second')
    for panel in grid.flat[max(len(panels) - columns, 0):len(panels)]:
        panel.set_xlabel(f'worst error of an event time / s (below {LEAST_ERROR:.0e}: drawn there)')
        panel.xaxis.set_tick_params(labelbottom=True)
    handles = [Line2D([], [], label=label, **looks[label]) for label in labels]
    figure.legend(handles=handles, loc='outside lower center', ncols=3, frameon=False, fontsize=9, handlelength=3.5)
    figure.suptitle(title, x=0.01, ha='left', fontsize=12)
    _save(figure, path)


LEAST_ERROR = 1e-16   # s
_TRADE_LOOKS: tuple[dict[str, Any], ...] = tuple(
    {'color': colour, 'marker': marker, 'linestyle': style, 'linewidth': 1.3, 'markersize': size}
    for colour, marker, style, size in (
        (_BLACK, '*', '-', 15.0), (_ORANGE, 's', '-', 6.0), (_BLUE, 'D', '-', 6.0), (_GREEN, '^', '-', 7.0),
        (_RED, 'o', '-', 6.0), (_PURPLE, 'v', '-', 7.0), (_SKY, 'P', '-', 7.0), (_ORANGE, 'o', '--', 6.0),
        (_BLUE, '^', '--', 7.0), (_GREEN, 's', '--', 6.0), (_RED, 'D', '--', 6.0), (_PURPLE, 'X', '--', 7.0),
        (_SKY, 'v', '--', 7.0), (_GREY, 'o', ':', 6.0)))


def _trade_panel(panel: Axes, heading: str, lines: Sequence[Line], looks: Mapping[str, Mapping[str, Any]]) -> None:
    for line in lines:
        errors = [max(error, LEAST_ERROR) for error in line.errors]
        costs = [1e6 * cost for cost in line.costs]
        look = looks[line.label]
        panel.plot(errors, costs, **{**look, 'marker': ''})
        for error, cost, flawed in zip(errors, costs, line.flawed):
            panel.plot(error, cost, **{**look, 'linestyle': ''}, markerfacecolor='white' if flawed else look['color'])
    panel.set(xscale='log', yscale='log')
    panel.set_title(heading, loc='left', fontsize=10)
    panel.grid(which='major', color='#dddddd', linewidth=0.6)
    panel.set_axisbelow(True)
    panel.spines[['top', 'right']].set_visible(False)


def _save(figure: Figure, path: Path | str) -> None:
    path = Path(path)
    kind = path.suffix[1:].lower()
    with rc_context({'svg.hashsalt': 'stickslip'}):   # the same picture is the same file
        figure.savefig(path, format=kind, metadata={'Date': None} if kind == 'svg' else None)


def _position(panel: Axes, samples: Mapping[str, Numbers]) -> None:
    _line(panel, samples, 'drive_position', _MILLI, 'drive', color=_GREY, linewidth=1.0, linestyle=(0, (5, 2)))
    _line(panel, samples, 'position', _MILLI, 'slider', color=_BLUE, linewidth=1.6)
    panel.set_ylabel('position / mm')


def _velocity(panel: Axes, samples: Mapping[str, Numbers]) -> None:
    _line(panel, samples, 'velocity', _MILLI, 'slider', color=_BLUE, linewidth=1.4)
    _line(panel, samples, 'drive_velocity', _MILLI, 'drive', color=_GREY, linewidth=1.0, linestyle=(0, (5, 2)))
    panel.set_ylabel('velocity / (mm/s)')


def _forces(panel: Axes, samples: Mapping[str, Numbers], events: Sequence[Event]) -> None:
    names = ['drive_force', 'friction_force', 'external_force']
    largest = max(np.abs(samples[name]).max() for name in names)
    scale, unit = (1e-3, 'kN') if largest >= _KILO_FROM else (1.0, 'N')
    if np.any(samples['external_force'] != 0.0):
        _line(panel, samples, 'external_force', scale, 'external', color=_GREEN, linewidth=1.1)
    _line(panel, samples, 'friction_force', scale, 'friction', color=_RED, linewidth=2.2)
    _line(panel, samples, 'drive_force', scale, 'drive', color=_BLACK, linewidth=1.1)
    marks = [event for event in events if event.kind == EventKind.BREAKAWAY]
    if marks:
        panel.plot([event.time for event in marks], [event.friction_force * scale for event in marks], 'o',
                   markersize=4.5 if len(marks) < _CROWD else 2.5, markerfacecolor='white', markeredgecolor=_RED,
                   label='static limit at break-away')
    panel.set_ylabel(f'force / {unit}')


def _modes(panel: Axes, samples: Mapping[str, Numbers], events: Sequence[Event]) -> None:
    """Draw one lane for each mode."""
    begin, end = float(samples['time'][0]), float(samples['time'][-1])
    spans = mode_spans(events, begin, end, Mode(int(samples['mode'][0])))
    for lane, (mode, colour) in enumerate(_MODE_COLOURS.items()):
        bars = [(span.begin, span.end - span.begin) for span in spans if span.mode == mode]
        panel.broken_barh(bars, (lane - 0.4, 0.8), facecolors=colour, edgecolors=colour, linewidth=0.3, snap=False)
    panel.set_yticks(range(len(_MODE_COLOURS)), [mode.name for mode in _MODE_COLOURS], fontsize=8)
    panel.set_ylim(len(_MODE_COLOURS) - 0.4, -0.6)
    panel.tick_params(axis='y', length=0)


def _line(panel: Axes, samples: Mapping[str, Numbers], name: str, scale: float, label: str, **look: Any) -> None:
    time, values = _thinned(samples['time'], samples[name])
    panel.plot(time, values * scale, label=label, **look)


def _thinned(time: Numbers, values: Numbers) -> tuple[Numbers, Numbers]:
    """Keep the lowest and the highest point of each bundle, so that no peak is lost."""
    size = len(values) // (_POINTS // 2)
    if size < 3:
        return time, values
    whole = len(values) // size * size
    bundles = values[:whole].reshape(-1, size)
    first = np.arange(0, whole, size)
    keep = np.concatenate([[0], first + bundles.argmin(axis=1), first + bundles.argmax(axis=1), [len(values) - 1]])
    keep = np.unique(keep)
    return time[keep], values[keep]


def _dress(panel: Axes) -> None:
    panel.spines[['top', 'right']].set_visible(False)
    panel.grid(axis='both', color='#dddddd', linewidth=0.6)
    panel.set_axisbelow(True)
    panel.xaxis.set_minor_locator(AutoMinorLocator())
    panel.margins(x=0.0)
    if panel.get_legend_handles_labels()[0]:
        panel.legend(loc='lower right', bbox_to_anchor=(1.0, 0.98), ncols=4, frameon=False, fontsize=9,
                     borderaxespad=0.0, handlelength=2.2)


def _head(first: Axes, title: str) -> None:
    heading, _, rest = title.partition('\n')
    first.set_title(heading, loc='left', fontsize=14, fontweight='bold', pad=42 if rest else 22)
    first.annotate(rest, (0.0, 1.0), xytext=(0.0, 25.0), xycoords='axes fraction', textcoords='offset points',
                   fontsize=10, color=_GREY, in_layout=False)
