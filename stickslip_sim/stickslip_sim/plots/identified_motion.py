# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""A fitted motion over the measured one, and what is left: over time, and over the phase of the cycle."""

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from itertools import pairwise
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from matplotlib.axes import Axes

from ..core.arrays import Numbers
from ..figures.catalogue import in_words
from .style import BLACK, BLUE, DOUBLE_COLUMN, GREY, ORANGE, RED, journal, labelled, legend_of, letters, thinned

_ROW = 1.7        # in
_LEGEND = 0.5     # in
_BINS = 50        # of the phase
_FEWEST = 3       # readings in one of them
_BUNDLE = 6000    # readings that are drawn one by one
_SCALES = {'m': (1e3, 'mm'), 'm/s': (1e3, 'mm/s')}


class FittedChannel(NamedTuple):
    """A channel over `times` (s): measured and fitted numbers in `unit`.

    `residuals` (n,) are measured less fitted, or what is new in that, in standard deviations of the sensor, `phases`
    (n,) shares of the cycle, NaN outside of one; `misfits` are the times (from, to) where a test rejects it.  `free` is
    the run of the model by itself where `fitted` restarts; None where they are one.
    """

    name: str
    unit: str
    times: Numbers
    measured: Numbers
    fitted: Numbers
    residuals: Numbers
    phases: Numbers
    misfits: Sequence[tuple[float, float]]
    free: Numbers | None = None


def plot_fit(channels: Sequence[FittedChannel], window: tuple[float, float], restarts: Sequence[float],
             path: Path | str) -> None:
    """Draw a row for each channel: the whole run, and a `window` of it (s); thin on top what was fitted.

    At its `restarts` (s) the fitted motion begins anew from a measured arrest: there it has a gap and a mark.
    """
    with _rows(len(channels), False, ('time / s', 'time / s'), path) as rows:
        for panels, channel in zip(rows, channels):
            _motion(panels[0], channel, (channel.times[0], channel.times[-1]), restarts)
            _motion(panels[1], channel, window, restarts)
            unit = _SCALES.get(channel.unit, (1.0, channel.unit))[1]
            panels[0].set_ylabel(labelled(in_words(channel.name), unit))
            panels[0].axvspan(*window, color=GREY, alpha=0.15, linewidth=0.0)


def plot_residuals(channels: Sequence[FittedChannel], slip_share: float, path: Path | str) -> None:
    """Draw what is left of each channel, in standard deviations of its sensor: over time, and over the phase.

    `slip_share` is the share of a cycle after which its slip has ended.
    """
    with _rows(len(channels), True, ('time / s', 'phase of the cycle'), path) as rows:
        for panels, channel in zip(rows, channels):
            _over_time(panels[0], channel)
            _over_phase(panels[1], channel, slip_share)


class PredictedChannel(NamedTuple):
    """A channel over `times` (s), measured and predicted, in `unit`."""

    name: str
    unit: str
    times: Numbers
    measured: Numbers
    predicted: Numbers


def plot_prediction(channels: Sequence[PredictedChannel], path: Path | str) -> None:
    """Draw a row for each channel: measured and predicted over the whole run, and measured less predicted."""
    with _rows(len(channels), False, ('time / s', 'time / s'), path) as rows:
        for (motion, left), channel in zip(rows, channels):
            scale, unit = _SCALES.get(channel.unit, (1.0, channel.unit))
            measured, predicted = scale * channel.measured, scale * channel.predicted
            motion.plot(*thinned(channel.times, measured), color=GREY, linewidth=2.4, alpha=0.5, label='measured')
            motion.plot(*thinned(channel.times, predicted), color=BLUE, linewidth=0.9, label='predicted')
            left.axhline(0.0, color=BLACK, linewidth=0.6)
            left.plot(*thinned(channel.times, measured - predicted), color=ORANGE, linewidth=0.6,
                      label='measured less predicted')
            motion.set_ylabel(labelled(in_words(channel.name), unit))
            left.set_ylabel(labelled('residual', unit))


@contextmanager
def _rows(count: int, share: bool, labels: Sequence[str], path: Path | str) -> Iterator[Sequence[Sequence[Axes]]]:
    """Yield two panels for each channel, which `share` the upright axis or not; then finish the figure."""
    with journal(DOUBLE_COLUMN, _ROW * count + _LEGEND, path) as figure:
        grid = figure.subplots(count, 2, squeeze=False, sharex='col', sharey='row' if share else 'none',
                               width_ratios=(3, 2))
        yield grid.tolist()
        for panel, label in zip(grid[-1], labels):
            panel.set_xlabel(label)
        letters(grid.flat)
        legend_of(figure, 'upper center', *grid.flat, ncols=4)


def _motion(panel: Axes, channel: FittedChannel, window: tuple[float, float], restarts: Sequence[float]) -> None:
    scale, _ = _SCALES.get(channel.unit, (1.0, ''))
    inside = (channel.times >= window[0]) & (channel.times <= window[1])
    times = channel.times[inside]
    panel.plot(*thinned(times, scale * channel.measured[inside]), color=GREY, linewidth=2.4, alpha=0.5,
               label='measured')
    if channel.free is not None:
        limits = _limits(scale * channel.measured[inside], scale * channel.free[inside])
        panel.plot(*thinned(times, scale * channel.free[inside]), color=ORANGE, linewidth=0.9,
                   linestyle=(0, (3.0, 1.0)), label='free run from the start')
        panel.set_ylim(*limits)
    within = [time for time in restarts if window[0] <= time <= window[1]]
    label = 'fitted'
    if restarts:
        label = 'fitted slip by slip'
        panel.plot(within, np.zeros(len(within)), '^', color=BLUE, markersize=3.0, clip_on=False,
                   transform=panel.get_xaxis_transform(), label='restart at a measured arrest')
    edges = np.searchsorted(times, within)
    for k, (first, last) in enumerate(pairwise([0, *edges.tolist(), len(times)])):
        panel.plot(*thinned(times[first:last], scale * channel.fitted[inside][first:last]), color=BLUE, linewidth=0.9,
                   label=label if k == 0 else None)
    panel.set_xlim(*window)


def _limits(measured: Numbers, free: Numbers) -> tuple[float, float]:
    """Return from where to where both are drawn: a free run that goes far away from the measured one leaves it."""
    low, high = float(measured.min()), float(measured.max())
    room = high - low
    return (max(min(low, float(free.min())), low - room) - 0.05 * room,
            min(max(high, float(free.max())), high + room) + 0.05 * room)


def _over_time(panel: Axes, channel: FittedChannel) -> None:
    _lines(panel)
    panel.plot(*thinned(channel.times, channel.residuals), color=BLUE, linewidth=0.5, label='measured less fitted')
    for begin, end in channel.misfits:
        panel.axvspan(begin, end, color=RED, alpha=0.15, linewidth=0.0, label='a test rejects the model')
    panel.set_ylabel(f'{channel.name.replace("_", " ")}\nresidual / σ')
    panel.set_xlim(channel.times[0], channel.times[-1])


def _over_phase(panel: Axes, channel: FittedChannel, slip_share: float) -> None:
    _lines(panel)
    known = np.flatnonzero(np.isfinite(channel.phases))
    some = known[::max(1, len(known) // _BUNDLE)]
    panel.plot(channel.phases[some], channel.residuals[some], '.', color=BLUE, markersize=1.2, alpha=0.4,
               markeredgewidth=0.0)
    places, means = _means(channel.phases[known], channel.residuals[known])
    panel.plot(places, means, color=ORANGE, linewidth=1.4, label='its mean at this phase')
    if 0.0 < slip_share < 1.0:
        panel.axvline(slip_share, color=BLACK, linewidth=0.6, linestyle=(0, (2.0, 2.0)))
        panel.annotate('slip', (slip_share, 1.0), xycoords=('data', 'axes fraction'), xytext=(-2.0, -8.0),
                       textcoords='offset points', ha='right', fontsize=6.5, color=GREY)
        panel.annotate('stick', (slip_share, 1.0), xycoords=('data', 'axes fraction'), xytext=(2.0, -8.0),
                       textcoords='offset points', ha='left', fontsize=6.5, color=GREY)
    if not len(known):
        panel.text(0.5, 0.5, 'no complete cycle', transform=panel.transAxes, ha='center', va='center')
    panel.set_xlim(0.0, 1.0)


def _means(phases: Numbers, values: Numbers) -> tuple[Numbers, Numbers]:
    """Return the mean of the values in each bin of the phase that has enough of them."""
    bins = np.minimum((phases * _BINS).astype(np.int64), _BINS - 1)
    full = [k for k in range(_BINS) if (bins == k).sum() >= _FEWEST]
    return (np.array(full) + 0.5) / _BINS, np.array([values[bins == k].mean() for k in full], dtype=np.float64)


def _lines(panel: Axes) -> None:
    panel.axhline(0.0, color=BLACK, linewidth=0.6)
    panel.axhspan(-2.0, 2.0, color=GREY, alpha=0.15, linewidth=0.0, label='±2 σ of the sensor')


# How the errors of numbers that were found together go together: a matrix of correlations.

_CELL, _MARGIN, _NAMES = 0.42, 0.5, 2.4   # in
_BARE: dict[str, Any] = {'axes.grid': False, 'axes.spines.left': False, 'axes.spines.bottom': False}
_DARK = 0.6                               # of a colour: white numbers above it


def plot_correlations(names: Sequence[str], matrix: Numbers, path: Path | str) -> None:
    """Draw correlations (k, k) by colour, with their numbers; what is NaN is not determined."""
    count = len(names)
    with journal(_NAMES + _MARGIN + _CELL * count, _NAMES / 2 + _CELL * count, path, **_BARE) as figure:
        panel = figure.subplots()
        panel.imshow(matrix, cmap='RdBu_r', vmin=-1.0, vmax=1.0, aspect='equal')
        for i in range(count):
            for j in range(count):
                value = matrix[i, j]
                text = f'{value:.2f}' if np.isfinite(value) else '–'
                colour = 'white' if abs(value) > _DARK else GREY if not np.isfinite(value) else 'black'
                panel.text(j, i, text, ha='center', va='center', fontsize=6.5, color=colour)
        panel.set_yticks(range(count), names)
        panel.set_xticks(range(count), names, rotation=45, ha='right', rotation_mode='anchor')
        panel.tick_params(length=0.0)
