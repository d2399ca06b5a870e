# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Figures of ISO 230-2 on a table whose figures are worked out by hand, in micrometres.

The published table of examples/test/fat_sat/report.md in github.com/paulscherrerinstitute/ecmccfg was tried too: its
rows, M (27.7 nm), B (12.2 nm) and A (88.8 nm) come out; E is 36.8 nm and R 68.8 nm by its own rows.
"""

import math

import numpy as np
import pytest

from stickslip_sim.figures.positioning import Approaches, PositioningFigures, position_figures, positioning_figures

MICRO = 1e-6


def figures_of(*rows: tuple[tuple[float, ...], tuple[float, ...]]) -> PositioningFigures:
    """Return the figures of approaches in micrometres, forward and backward a row."""
    return positioning_figures([position_figures(Approaches(0.01 * i, MICRO * np.array(up), MICRO * np.array(down)))
                                for i, (up, down) in enumerate(rows)])


def test_a_table_by_hand() -> None:
    """The means are 2 and -1, 4 and -2, -3 and -5; s is 1 and 2, 3 and 1, 1 and 1."""
    found = figures_of(((1.0, 2.0, 3.0), (-3.0, -1.0, 1.0)), ((1.0, 4.0, 7.0), (-3.0, -2.0, -1.0)),
                       ((-4.0, -3.0, -2.0), (-6.0, -5.0, -4.0)))
    expected = PositioningFigures(
        positioning_accuracy=10.0 + 7.0, positioning_accuracy_forward=10.0 + 5.0,
        positioning_accuracy_backward=3.0 + 7.0,
        positioning_repeatability=6.0 + 2.0 + 6.0, positioning_repeatability_forward=12.0,
        positioning_repeatability_backward=8.0,
        systematic_positioning_error=4.0 + 5.0, systematic_positioning_error_forward=4.0 + 3.0,
        systematic_positioning_error_backward=-1.0 + 5.0,
        mean_positioning_error=1.0 + 4.0, reversal_error=6.0, mean_reversal_error=11.0 / 3.0)
    assert found == pytest.approx([MICRO * value for value in expected], abs=1e-18)


def test_one_way_may_scatter_more_than_both_together() -> None:
    position = position_figures(Approaches(0.0, MICRO * np.array([-3.0, 0.0, 3.0]), np.zeros(3)))
    assert position.repeatability == pytest.approx(12.0 * MICRO)
    assert (position.mean, position.reversal) == pytest.approx((0.0, 0.0))


def test_signed_reversals_do_not_make_up_for_each_other_in_their_largest() -> None:
    found = figures_of(((5.0, 5.0), (0.0, 0.0)), ((0.0, 0.0), (5.0, 5.0)))
    assert (found.reversal_error, found.mean_reversal_error) == pytest.approx((5.0 * MICRO, 0.0))
    assert (found.mean_positioning_error, found.systematic_positioning_error) == pytest.approx((0.0, 5.0 * MICRO))


def test_a_single_approach_has_means_and_no_scatter() -> None:
    found = figures_of(((5.0,), (1.0,)), ((6.0, 6.0), (1.0, 1.0)))
    assert (found.reversal_error, found.systematic_positioning_error) == pytest.approx((5.0 * MICRO, 5.0 * MICRO))
    assert all(map(math.isnan, found[:6]))


def test_both_ways_are_no_better_than_either() -> None:
    scatter = np.random.default_rng(3).normal(size=(4, 2, 5))
    found = figures_of(*((tuple(up), tuple(down)) for up, down in scatter.tolist()))
    for both, forward, backward in (
            (found.positioning_accuracy, found.positioning_accuracy_forward, found.positioning_accuracy_backward),
            (found.positioning_repeatability, found.positioning_repeatability_forward,
             found.positioning_repeatability_backward),
            (found.systematic_positioning_error, found.systematic_positioning_error_forward,
             found.systematic_positioning_error_backward)):
        assert both >= max(forward, backward)
