# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Lines that the theory draws into a map of feed against another parameter."""

from typing import NamedTuple

import numpy as np

from ..core.arrays import Numbers
from .points import scene_at
from .steady import sliding_slope
from .study import Study
from .theory import feed_of_theory
from .variation import Variation

FEED = 'drive.velocity'
_FINE = 300   # values of either parameter


class Borders(NamedTuple):
    """Over `others`, values of the other parameter: the critical feed (m/s) in closed form, NaN where there is none.

    `is_lost` has for each of them (rows) and each of `feeds` 1 where steady sliding is unstable, NaN without any.
    """

    others: Numbers
    critical_feed: Numbers
    feeds: Numbers
    is_lost: Numbers


def borders(study: Study) -> Borders | None:
    """Return the lines for a study of the feed and one more parameter; None for any other study."""
    variations = {one.name: one for one in study.ranges}
    feed = variations.pop(FEED, None)
    if feed is None or len(variations) != 1 or not study.works_in_batches:
        return None
    (other,) = variations.values()
    others, feeds = _finely(other), _finely(feed)
    axes = [scene_at(study.values, [other.name], np.array([value])).axis for value in others]
    known = [feed_of_theory(axis) for axis in axes]
    critical = np.array([np.nan if value is None else value for value in known], dtype=float)
    slopes = np.array([sliding_slope(axis, {'drive_velocity': feeds}) for axis in axes])
    return Borders(others, critical, feeds, np.where(np.isnan(slopes), np.nan, slopes < 0.0))


def _finely(one: Variation) -> Numbers:
    return Variation(one.name, one.low, one.high, _FINE, one.log).grid()
