# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""A measured friction curve and the laws that fit it, over the speed and over its logarithm, and what is left."""

from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

import numpy as np
from matplotlib.axes import Axes
from matplotlib.ticker import FuncFormatter
from numpy.typing import NDArray

from ..core.arrays import Numbers
from . import style

_HEIGHT = 4.6   # in
_OPEN = 'white'
_COLOURS = (style.BLUE, style.ORANGE, style.GREEN, style.PURPLE, style.RED)
_DASHES = ((0, (4.0, 1.5)), (0, (1.0, 1.2)), (0, (4.0, 1.5, 1.0, 1.5)), (0, (6.0, 3.0)))
_LOWEST = 0.7   # of the lowest speed above 0: there lines begin on a logarithmic axis
_REST = 0.4     # of the same: there such an axis shows what was measured at rest
_FEW = 100      # points: of more the residuals of the best law alone are drawn


class MeasuredPoints(NamedTuple):
    """Measured points: speeds in m/s, coefficients (or forces, N), and which are of the forward direction.

    `spread` has the quartiles of each, (2, n), where there are some.
    """

    speeds: Numbers
    coefficients: Numbers
    forward: NDArray[np.bool_]
    spread: Numbers | None = None
    are_forces: bool = False


class FittedLine(NamedTuple):
    """A law: its `label`, mu at the speeds of all lines, half its band there (empty: none), and at the points."""

    label: str
    coefficients: Numbers
    band: Numbers
    at_points: Numbers


def plot_speeds(points: MeasuredPoints) -> Numbers:
    """Return the speeds at which lines are drawn: from rest to just beyond the fastest point, dense near rest."""
    slowest, fastest = points.speeds[points.speeds > 0.0].min(), points.speeds.max()
    return np.concatenate([[0.0], np.geomspace(_LOWEST * slowest, 1.08 * fastest, 500)])


def plot_friction_fits(points: MeasuredPoints, lines: Sequence[FittedLine], heading: str, path: Path | str) -> None:
    """Draw points and lines, the first of them as the best, above the residuals; left over the speed, right its log."""
    speeds = plot_speeds(points)
    with style.journal(style.DOUBLE_COLUMN, _HEIGHT, path) as figure:
        panels = figure.subplots(2, 2, sharey='row', sharex='col', height_ratios=(2.2, 1.0))
        for column, log in enumerate((False, True)):
            _curves(panels[0, column], points, speeds, lines, log)
            _residuals(panels[1, column], points, lines, log)
        _axes(panels, points)
        panels[0, 0].set_title(heading, loc='left', fontsize=8.0)
        style.legend_of(figure, 'upper center', panels[0, 0], ncols=4)


def _curves(panel: Axes, points: MeasuredPoints, speeds: Numbers, lines: Sequence[FittedLine], log: bool) -> None:
    many = len(points.speeds) > _FEW
    if points.spread is not None:
        panel.vlines(_shown(points.speeds, points, log), *points.spread, color=style.GREY, linewidth=0.7,
                     label='quartiles')
    for chosen, face, label in _directions(points):
        panel.plot(_shown(points.speeds[chosen], points, log), points.coefficients[chosen], 'o', label=label,
                   zorder=1.5 if many else 4.0, markersize=_size(points), markerfacecolor=face,
                   markeredgecolor=style.GREY if many else style.BLACK, markeredgewidth=0.7)
    drawn = slice(1, None) if log else slice(None)    # rest is no place on a logarithmic axis
    places = style.MILLI * speeds[drawn]
    for k, line in enumerate(lines):
        panel.plot(places, line.coefficients[drawn], color=_COLOURS[k % len(_COLOURS)], zorder=3.0 - 0.1 * k,
                   linestyle='solid' if k == 0 else _DASHES[(k - 1) % len(_DASHES)],
                   linewidth=1.6 if k == 0 else 0.9, label=line.label)
    best = lines[0]
    if len(best.band):
        panel.fill_between(places, (best.coefficients - best.band)[drawn], (best.coefficients + best.band)[drawn],
                           color=style.SKY, alpha=0.35, linewidth=0.0, label=f'95 % band of {best.label.split()[0]}')
    if log and not points.speeds.all():
        panel.plot([style.MILLI * _rest(points)], best.coefficients[:1], '_', color=style.BLUE, markersize=9.0,
                   markeredgewidth=1.6)


def _residuals(panel: Axes, points: MeasuredPoints, lines: Sequence[FittedLine], log: bool) -> None:
    panel.axhline(0.0, color=style.BLACK, linewidth=0.6)
    places = _shown(points.speeds, points, log)
    for k, line in enumerate(lines if len(points.speeds) <= _FEW else lines[:1]):
        left = (1.0 if points.are_forces else 1e3) * (points.coefficients - line.at_points)
        for chosen, face, _ in _directions(points):
            if k:
                panel.plot(places[chosen], left[chosen], color=_COLOURS[k % len(_COLOURS)], linewidth=0.6,
                           linestyle=_DASHES[(k - 1) % len(_DASHES)])
                continue
            panel.plot(places[chosen], left[chosen], 'o', markersize=_size(points),
                       markerfacecolor=face if face == _OPEN else style.BLUE, markeredgecolor=style.BLUE,
                       markeredgewidth=0.7)


def _directions(points: MeasuredPoints) -> list[tuple[NDArray[np.bool_], str, str]]:
    """Return which points are of a direction, their colour inside, and their name."""
    if points.forward.all() or not points.forward.any():
        return [(np.full(points.forward.shape, True), _dark(points), 'measured')]
    return [(points.forward, _dark(points), 'measured forward'), (~points.forward, _OPEN, 'measured backward')]


def _dark(points: MeasuredPoints) -> str:
    return style.GREY if len(points.speeds) > _FEW else style.BLACK


def _size(points: MeasuredPoints) -> float:
    return 3.5 if len(points.speeds) <= _FEW else 1.5


def _shown(speeds: Numbers, points: MeasuredPoints, log: bool) -> Numbers:
    """Return speeds in mm/s; on a logarithmic axis rest is moved to its left end."""
    return style.MILLI * (np.maximum(speeds, _rest(points)) if log else speeds)


def _rest(points: MeasuredPoints) -> float:
    return float(_REST * points.speeds[points.speeds > 0.0].min())


def _axes(panels: NDArray[np.object_], points: MeasuredPoints) -> None:
    for row, label in enumerate(('friction / N', 'residual / N') if points.are_forces else
                                ('friction coefficient', 'residual / 10⁻³')):
        panels[row, 0].set_ylabel(label)
        style.letter(panels[row, 0], 'ac'[row])
        style.letter(panels[row, 1], 'bd'[row])
    for panel in panels[:, 1]:
        panel.set_xscale('log')
        panel.xaxis.set_major_formatter(FuncFormatter(lambda speed, _: f'{speed:g}'))
    panels[1, 0].set_xlabel('speed / (mm/s)')
    panels[1, 1].set_xlabel('speed / (mm/s), logarithmic')
    if not points.speeds.all():
        panels[0, 1].annotate('rest', (style.MILLI * _rest(points), 0.0), xycoords=('data', 'axes fraction'),
                              xytext=(2.0, 3.0), textcoords='offset points', fontsize=7.0, color=style.GREY)
