# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""A proposed experiment: its feed, the motion, what each parameter would change, and what other feeds would say."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import NamedTuple

from matplotlib.axes import Axes
from matplotlib.figure import SubFigure

from ..core.arrays import Numbers
from . import style

_COLOURS = (style.BLUE, style.RED, style.GREEN, style.ORANGE, style.PURPLE, style.SKY, style.BLACK)
_MARKERS = 'os^Dv'
_MICRO, _PERCENT = 1e6, 100.0
_OVER_TIME, _ROW, _MARGIN = 4.2, 0.24, 0.9   # in


class ProposedRun(NamedTuple):
    """The run of the proposed feed: `times` s, `feed` m/s and `position` m of n samples."""

    times: Numbers
    feed: Numbers
    position: Numbers


def plot_experiment(run: ProposedRun, changes: Mapping[str, Numbers], kinds: Sequence[str], deviations: Numbers,
                    known: float, *paths: Path) -> None:
    """Draw a run, and the `changes` (n,) of its position, m, for one percent of each parameter.

    Below: what is left of the deviation `known` of each parameter after the best feed of each kind, `deviations`
    (kinds, parameters), as shares.
    """
    heights = [_OVER_TIME, _ROW * len(kinds) + _MARGIN]
    with style.journal(style.DOUBLE_COLUMN, sum(heights), *paths, pads=(0.05, 0.04)) as figure:
        upper, lower = figure.subfigures(2, 1, height_ratios=heights)
        _over_time(upper, run, changes)
        _left(lower, list(changes), kinds, deviations, known)


def _over_time(part: SubFigure, run: ProposedRun, changes: Mapping[str, Numbers]) -> None:
    feed, position, change = part.subplots(3, 1, sharex=True)
    feed.plot(*style.thinned(run.times, run.feed * style.MILLI), color=style.BLACK)
    feed.set_ylabel('feed / (mm/s)')
    position.plot(*style.thinned(run.times, run.position * style.MILLI), color=style.BLACK)
    position.set_ylabel('position / mm')
    for k, (name, values) in enumerate(changes.items()):
        change.plot(*style.thinned(run.times, values * _MICRO), color=_colour(k), linewidth=0.8, label=name)
    change.set(ylabel='change for 1 % / µm', xlabel='time / s')
    for name, panel in zip('abc', (feed, position, change)):
        style.letter(panel, name)
        panel.margins(x=0.0)
    part.align_ylabels()


def _left(part: SubFigure, parameters: Sequence[str], kinds: Sequence[str], deviations: Numbers, known: float) -> None:
    panel: Axes = part.subplots()
    for k, name in enumerate(parameters):
        panel.plot(deviations[:, k] * _PERCENT, range(len(kinds)), linestyle='', marker=_MARKERS[k % len(_MARKERS)],
                   color=_colour(k), markersize=4.5, label=name)
    panel.axvline(known * _PERCENT, color=style.GREY, linestyle='dashed', linewidth=0.8, label='before')
    panel.set(xscale='log', yticks=range(len(kinds)), yticklabels=kinds, ylim=(len(kinds) - 0.5, -0.5),
              xlabel='standard deviation of each parameter after the run / %')
    style.letter(panel, 'd')
    style.legend_of(part, 'upper right', panel, ncols=2)


def _colour(k: int) -> str:
    return _COLOURS[k % len(_COLOURS)]
