# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The picture of a friction curve: its lines follow one direction of motion each."""

from pathlib import Path

import numpy as np
import pytest
from matplotlib.axes import Axes

from stickslip_sim.plots.friction_fits import FittedLine, MeasuredPoints, plot_friction_fits, plot_speeds


def test_residuals_of_two_directions_are_lines_of_their_own(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A line through both went up and down at each speed."""
    points = MeasuredPoints(np.repeat([0.001, 0.01, 0.1], 2), np.tile([0.11, 0.09], 3), np.tile([True, False], 3))
    level = np.full(len(plot_speeds(points)), 0.1)
    lines = [FittedLine(name, level, np.array([]), np.full(6, 0.1)) for name in ('best', 'other')]
    drawn: list[list[float]] = []
    plot = Axes.plot

    def watched(panel: Axes, *given: object, **how: object) -> object:
        if how.get('linewidth') == 0.6:
            drawn.append(np.asarray(given[1]).tolist())
        return plot(panel, *given, **how)  # type: ignore[arg-type]

    monkeypatch.setattr(Axes, 'plot', watched)
    plot_friction_fits(points, lines, 'curve.csv', tmp_path / 'curve.png')
    assert drawn == [pytest.approx([10.0] * 3), pytest.approx([-10.0] * 3)] * 2
