# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""A map of the motion over two parameters, with the lines of the theory and the phase planes of picked points."""

from collections.abc import Iterator, Sequence
from pathlib import Path
from string import ascii_uppercase
from typing import Any, NamedTuple

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.colors import ListedColormap, LogNorm, Normalize
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from matplotlib.patheffects import Normal, Stroke
from matplotlib.ticker import LogLocator
from numpy.typing import NDArray

from ..core.arrays import Numbers
from ..figures.cycles import SWINGS_ON
from . import style
from .paper_panels import DrawnMotion, phase_plane

PLAIN_MOTIONS = ('smooth sliding', SWINGS_ON, 'at rest', 'failed', 'undecided')
_PLAIN_COLOURS = ('#f2f2f2', '#c4c4c4', '#56B4E9', '#ffffff', '#ffffff')
_HATCHES = {3: ('xxxxxx', style.RED), 4: ('//////', style.BLACK)}   # unknown motions have no colour
_LOST = (0, (4.0, 2.0))
_DECADE = 10.0
_HEIGHT, _PORTRAIT_HEIGHT = 3.3, 1.6   # in


class Field(NamedTuple):
    """The colours of a map at every `x` (columns) and `y` (rows): `values` of a figure, NaN where `plain` has a colour.

    Numbers in `plain` are places in `PLAIN_MOTIONS`.
    """

    x: Numbers
    y: Numbers
    values: Numbers
    plain: NDArray[np.int64]


class Lines(NamedTuple):
    """The lines of the theory, over y: the critical feed; and for each x of `feeds` 1 where sliding is lost, or NaN."""

    y: Numbers
    critical_feed: Numbers
    feeds: Numbers
    is_lost: Numbers


class Pick(NamedTuple):
    """A point of a map, and the motion there."""

    x: float
    y: float
    motion: DrawnMotion


def plot_stability(scales: tuple[style.Scale, style.Scale, style.Scale], field: Field,
                   lines: Lines | None, picks: Sequence[Pick],
                   path: Path | str) -> None:
    """Draw a map over x and y (`scales`: x, y and the figure in colours), SI units, and the phase planes of picks."""
    rows = -(-len(picks) // 2)
    width = style.DOUBLE_COLUMN if picks else style.SINGLE_COLUMN + 1.0
    with style.journal(width, max(_HEIGHT, _PORTRAIT_HEIGHT * rows + 0.4), path) as figure:
        left, *right = figure.subfigures(1, 2, width_ratios=(1.15, 1.0)) if picks else (figure,)
        _map(left.subplots(), scales, field, lines, picks)
        if picks:
            _portraits(right[0].subplots(rows, 2, squeeze=False).ravel().tolist(), picks)


def _map(panel: Axes, scales: tuple[style.Scale, style.Scale, style.Scale], field: Field, lines: Lines | None,
         picks: Sequence[Pick]) -> None:
    x, y, colour = scales
    handles: list[Artist] = []
    at = x.edges(field.x), y.edges(field.y)
    bar = panel.pcolormesh(*at, colour.shown(field.values), norm=_norm(field.values, colour), cmap='cividis',
                           shading='flat', rasterized=True)
    plain = np.where(np.isnan(field.values), field.plain, np.nan)
    panel.pcolormesh(*at, plain, cmap=ListedColormap(_PLAIN_COLOURS), vmin=-0.5, vmax=len(PLAIN_MOTIONS) - 0.5,
                     shading='flat', rasterized=True)
    for k, (hatch, ink) in _HATCHES.items():
        if (plain == k).any():
            panel.pcolor(*at, np.where(plain == k, plain, np.nan), facecolor='none', edgecolor=ink, hatch=hatch,
                         linewidth=0.0, rasterized=True)
    handles += [_patch(k) for k in range(len(PLAIN_MOTIONS)) if (plain == k).any()]
    if not np.isnan(field.values).all():
        ticks = LogLocator(subs=(1.0, 2.0, 5.0)) if isinstance(bar.norm, LogNorm) else None
        panel.figure.colorbar(bar, ax=panel, label=colour.label, pad=0.02, ticks=ticks, format='%g').minorticks_off()
    panel.set(xlabel=x.label, ylabel=y.label, xscale=x.kind, yscale=y.kind)
    panel.grid(visible=False)
    panel.set(xlim=(at[0][0], at[0][-1]), ylim=(at[1][0], at[1][-1]))
    if lines is not None:
        handles += _theory(panel, x, y, lines)
    for pick, name in zip(picks, ascii_uppercase):
        _mark(panel, x.shown(pick.x), y.shown(pick.y), name)
    style.legend_outside(panel.figure, 'upper left', handles, [str(handle.get_label()) for handle in handles], ncols=2)


def _patch(place: int) -> Patch:
    """Return the entry of a place in `PLAIN_MOTIONS` in the legend."""
    hatch, ink = _HATCHES.get(place, ('', style.GREY))
    return Patch(facecolor=_PLAIN_COLOURS[place], edgecolor=ink, hatch=hatch, linewidth=0.4, label=PLAIN_MOTIONS[place])


def _norm(values: Numbers, scale: style.Scale) -> Normalize:
    """Return a logarithmic scale of colours for values that go over more than one decade."""
    known = scale.shown(values[np.isfinite(values)])
    if not len(known):
        return Normalize(0.0, 1.0)
    kind = LogNorm if known.min() > 0.0 and known.max() > _DECADE * known.min() else Normalize
    return kind(known.min(), known.max())


def _theory(panel: Axes, x: style.Scale, y: style.Scale, lines: Lines) -> Iterator[Artist]:
    """Draw the lines of the theory and yield their entries in the legend."""
    known = np.isfinite(lines.critical_feed) & (lines.critical_feed > 0.0)
    if known.any():
        feed = np.where(known, lines.critical_feed, np.nan)
        yield from panel.plot(x.shown(feed), y.shown(lines.y), color=style.RED, linewidth=1.6,
                              label='critical feed, closed form')
    if (lines.is_lost == 1.0).any() and (lines.is_lost == 0.0).any():
        panel.contour(x.shown(lines.feeds), y.shown(lines.y), lines.is_lost, levels=[0.5],
                      colors=[style.BLACK], linestyles=[_LOST], linewidths=1.2)
        yield Line2D([], [], color=style.BLACK, linestyle=_LOST, linewidth=1.2, label='steady sliding loses stability')


def _mark(panel: Axes, x: Numbers, y: Numbers, name: str) -> None:
    panel.plot([x], [y], marker='o', markersize=3.5, markerfacecolor='white', markeredgecolor=style.BLACK, zorder=5)
    panel.annotate(name, (float(x), float(y)), xytext=(4.0, 3.0), textcoords='offset points', fontweight='bold',
                   path_effects=[Stroke(linewidth=2.0, foreground='white'), Normal()])


def _portraits(panels: list[Axes], picks: Sequence[Pick]) -> None:
    for panel, pick, name in zip(panels, picks, ascii_uppercase):
        phase_plane(panel, pick.motion)
        panel.set_xlabel('spring stretch / mm')
        panel.set_title(name, loc='left', fontsize=8.0, fontweight='bold')
    for panel in panels[len(picks):]:
        panel.set_visible(False)
    style.legend_of(panels[0].figure, 'upper left', *panels, ncols=3)


# A bifurcation diagram: the last cycles and steady sliding over a parameter, for a journal's double column.

_DOT: dict[str, Any] = {'linestyle': '', 'marker': 'o', 'markersize': 1.6, 'markeredgewidth': 0.0}


def plot_bifurcation(over: style.Scale, cycles: Numbers, sliding: Numbers, path: Path | str) -> None:
    """Draw drive force and jump of each cycle, and steady sliding, over a parameter; SI units.

    Rows of `cycles`: value, drive force at break-away and at arrest, jump; of `sliding`: value, drive force, 1 where
    it is stable.
    """
    with style.journal(style.DOUBLE_COLUMN, 2.9, path, pads=(0.06, 0.06)) as figure:
        force, jump = figure.subplots(1, 2, sharex=True)
        _forces(force, over, cycles, sliding)
        jump.plot(over.shown(cycles[:, 0]), cycles[:, 3] * style.MILLI, color=style.GREEN, **_DOT)
        jump.set(ylabel='jump from cycle to cycle / mm')
        for panel, name in zip((force, jump), 'ab'):
            panel.set(xlabel=over.label, xscale=over.kind)
            panel.set_ylim(bottom=min(0.0, panel.get_ylim()[0]))
            style.letter(panel, name)
        style.legend_of(figure, 'upper left', force, ncols=4, markerscale=2.5)


def _forces(panel: Axes, over: style.Scale, cycles: Numbers, sliding: Numbers) -> None:
    values = over.shown(cycles[:, 0])
    panel.plot(values, cycles[:, 1], color=style.ORANGE, label='at break-away', **_DOT)
    panel.plot(values, cycles[:, 2], color=style.BLUE, label='at arrest', **_DOT)
    for stable, dashes, label in ((True, 'solid', 'stable'), (False, (0, (3.0, 2.0)), 'unstable')):
        shown = sliding.copy()
        shown[shown[:, 2] != float(stable), 1] = float('nan')
        panel.plot(over.shown(shown[:, 0]), shown[:, 1], color=style.BLACK, linestyle=dashes, linewidth=1.2,
                   label=f'steady sliding, {label}')
    panel.set(ylabel='drive force / N')


# A map of what becomes of many runs over two parameters: each point with the colour of its outcome.

_PASS_HEIGHT = 3.3   # in
_LOOKS = ((style.BLUE, 'o'), (style.RED, 'X'), (style.BLACK, 's'), (style.PURPLE, 'D'),
          (style.ORANGE, 'v'))   # passed, and so on
_SMALL, _LARGE, _MANY = 5.0, 24.0, 400   # points² of a marker


def plot_pass_map(scales: tuple[style.Scale, style.Scale], x: Numbers, y: Numbers, outcomes: Sequence[str],
                  kinds: Sequence[str], title: str, path: Path | str) -> None:
    """Draw points (SI units) over x and y, each with its outcome; `kinds` are all outcomes in their order."""
    found = np.array(outcomes)
    with style.journal(style.SINGLE_COLUMN + 1.0, _PASS_HEIGHT, path) as figure:
        panel = figure.subplots()
        size = _LARGE if len(x) <= _MANY else _SMALL
        for kind, (colour, marker) in zip(kinds, _LOOKS):
            chosen = found == kind
            if chosen.any():
                panel.scatter(scales[0].shown(x[chosen]), scales[1].shown(y[chosen]), s=size, c=colour, marker=marker,
                              linewidths=0.0, label=f'{kind} ({int(chosen.sum())})')
        panel.set(xlabel=scales[0].label, ylabel=scales[1].label, xscale=scales[0].kind, yscale=scales[1].kind)
        panel.set_title(title, loc='left', fontsize=8.0, color=style.GREY)
        style.legend_of(figure, 'upper left', panel, ncols=2)
