# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Cost of the solvers over their error, as pictures."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, NamedTuple

from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.layout_engine import ConstrainedLayoutEngine
from matplotlib.lines import Line2D

from .style import BLACK, BLUE, GREEN, GREY, ORANGE, PURPLE, RED, SKY, legend_outside, save


class SolverCurve(NamedTuple):
    """A solver in a picture of errors and costs: one point for each setting."""

    label: str
    errors: Sequence[float]   # s
    costs: Sequence[float]    # s for each simulated second
    flawed: Sequence[bool]    # events missed or invented


def plot_trade(panels: Mapping[str, Sequence[SolverCurve]], title: str, path: Path | str) -> None:
    """Draw cost over error, a panel for each case (its name is the heading), into `path` (.png, .pdf or .svg).

    Both axes are logarithmic.  An error below LEAST_ERROR is drawn there, and the axis then says so.
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
        panel.set_ylabel('cost per simulated second (µs)')
    is_cut = any(error < LEAST_ERROR for lines in panels.values() for line in lines for error in line.errors)
    label = 'worst event-time error (s)' + (f', at least {LEAST_ERROR:.0e}' if is_cut else '')
    for panel in grid.flat[max(len(panels) - columns, 0):len(panels)]:
        panel.set_xlabel(label)
        panel.xaxis.set_tick_params(labelbottom=True)
    handles = [Line2D([], [], **looks[label]) for label in labels]
    legend_outside(figure, 'lower center', handles, labels, ncols=3, frameon=False, fontsize=9, handlelength=3.5)
    figure.suptitle(title, x=0.01, ha='left', fontsize=12)
    save(figure, path)


LEAST_ERROR = 1e-16   # s
_TRADE_LOOKS: tuple[dict[str, Any], ...] = tuple(
    {'color': colour, 'marker': marker, 'linestyle': style, 'linewidth': 1.3, 'markersize': size}
    for colour, marker, style, size in (
        (BLACK, '*', '-', 15.0), (ORANGE, 's', '-', 6.0), (BLUE, 'D', '-', 6.0), (GREEN, '^', '-', 7.0),
        (RED, 'o', '-', 6.0), (PURPLE, 'v', '-', 7.0), (SKY, 'P', '-', 7.0), (ORANGE, 'o', '--', 6.0),
        (BLUE, '^', '--', 7.0), (GREEN, 's', '--', 6.0), (RED, 'D', '--', 6.0), (PURPLE, 'X', '--', 7.0),
        (SKY, 'v', '--', 7.0), (GREY, 'o', ':', 6.0)))


def _trade_panel(panel: Axes, heading: str, lines: Sequence[SolverCurve],
                 looks: Mapping[str, Mapping[str, Any]]) -> None:
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
