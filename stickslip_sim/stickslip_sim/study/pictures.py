# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The pictures of a study: a map of two parameters, a bifurcation diagram of one, or how figures spread."""

from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from ..core.arrays import Numbers
from ..core.callbacks import Progress
from ..core.errors import InputError
from ..plots.bifurcation import plot_bifurcation
from ..plots.scale import Scale, unit_read
from ..plots.stability_map import Field, Lines, Pick, plot_stability
from ..plots.uncertainty import Shares, Spread, plot_uncertainty
from .bifurcation import bifurcation
from .borders import FEED, borders
from .critical_sample import CriticalSpread, CriticalStudy
from .point_figures import Motion
from .sample import EvenGrid, Saltelli
from .study import Study
from .table import TableColumns, figures_among
from .uncertainty import SPREAD, Index, Uncertainty, spread_of
from .variation import Variation, place_of

_UNITS = {'amplitude': 'm', 'period': 's', 'stick_share': '', 'peak_speed': 'm/s', 'break_away_force': 'N',
         'settling_time': 's', 'cycles': '', 'duration': 's'}
_PLAIN = {Motion.AT_REST: 2, Motion.SMOOTH_SLIDING: 0, Motion.SWINGS_ON: 1, Motion.FAILED: 3,
          Motion.UNDECIDED: 4}


def check_drawable(study: Study, shown: str) -> None:
    """Raise InputError unless a study can be drawn, and the figure `shown` in colours."""
    if not isinstance(study.sample, EvenGrid) or len(study.names) > 2:
        raise InputError('--over', ', '.join(study.names), 'a grid of two parameters for a map, of one for a'
                         ' bifurcation diagram', 'read other studies from their table')
    if shown not in _UNITS:
        raise InputError('--show', shown, 'one of ' + ', '.join(_UNITS), 'leave it out for the amplitude')


def draw_bifurcation(study: Study, columns: TableColumns, paths: Sequence[str], progress: Progress = None) -> None:
    """Draw the last cycles over the one parameter of a study into each of `paths`."""
    found = bifurcation(study, figures_among(columns), progress)
    (over,) = study.ranges
    for path in paths:
        plot_bifurcation(_scale(study, over), found.cycles, found.sliding, path)


def draw_map(study: Study, columns: TableColumns, shown: str, picks: Sequence[Pick], paths: Sequence[str]) -> None:
    """Draw one figure over the two parameters of a study, the feed along x, into each of `paths`."""
    first, second = study.ranges
    turned = second.name == FEED
    x, y = (second, first) if turned else (first, second)

    def table(values: Numbers) -> Numbers:
        grid = values.reshape(first.count, second.count)
        return grid if turned else grid.T

    motion = table(columns['motion'])
    values = np.where(motion == Motion.STICK_SLIP, table(columns[shown]), np.nan)
    field = Field(x.grid(), y.grid(), values, _plain(motion, table(columns['settled'])))
    known = borders(study)
    lines = Lines(known.others, known.critical_feed, known.feeds, known.is_lost) if known else None
    scales = _scale(study, x), _scale(study, y), Scale(shown, unit_read(_UNITS[shown], values))
    for path in paths:
        plot_stability(scales, field, lines, picks, path)


def draw_uncertainty(study: Study, sample: Saltelli, columns: TableColumns, found: Uncertainty, path: str) -> None:
    """Draw how the figures of a sample spread, and the indices of those that have them."""
    spreads = [Spread(Scale(name, unit_read(SPREAD[name], values)), values, found.percentiles[name] or ())
               for name, values in spread_of(sample, columns).items()]
    heading = ('of no point it is known' if found.stick_slip is None else
               f'{100.0 * found.stick_slip:.3g} % of {found.known} points stick and slip')
    _draw_spreads(study, spreads, heading, found.indices, path)


def draw_critical_spread(study: CriticalStudy, found: Mapping[str, CriticalSpread], path: str) -> None:
    """Draw how the critical values from rest and from sliding spread, and the indices of those that have them."""
    over = study.over
    spreads = [Spread(Scale(f'critical {over.name} {start}', unit_read(over.unit, one.values)), one.values,
                      one.percentiles or ()) for start, one in found.items()]
    heading = f'{next(iter(found.values())).points} independent points'
    _draw_spreads(study.study, spreads, heading, {start: one.indices for start, one in found.items()}, path)


def _draw_spreads(study: Study, spreads: Sequence[Spread], heading: str,
                  indices: Mapping[str, Mapping[str, Index] | None], path: str) -> None:
    shares = [_shares(figure, [of[name] for name in study.names]) for figure, of in indices.items() if of]
    labels = [Scale(name, '', place=place_of(study.values, name)).label for name in study.names]
    plot_uncertainty(spreads, heading, labels, shares, path)


def _shares(figure: str, indices: Sequence[Index]) -> Shares:
    return Shares(figure, *np.array(indices).T)


def _scale(study: Study, one: Variation) -> Scale:
    return Scale(one.name, one.unit, one.log, place_of(study.values, one.name))


def _plain(motion: Numbers, settled: Numbers) -> NDArray[np.int64]:
    """Return the kind of motion where there is no stick-slip, as places in `plots.stability_map.PLAIN`."""
    plain = np.zeros(motion.shape, dtype=np.int64)
    for code, place in _PLAIN.items():
        plain[motion == code] = place
    plain[(motion == Motion.SMOOTH_SLIDING) & (settled == 0.0)] = 1   # of tables that had no word for it
    return plain
