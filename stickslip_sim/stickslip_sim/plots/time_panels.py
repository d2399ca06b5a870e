# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""A panel over time: its lines, its look, the title above."""

from collections.abc import Mapping
from typing import Any

import numpy as np
from matplotlib.axes import Axes

from ..core.arrays import Numbers
from .style import GREY, shortened, thinned

_KILO_FROM = 1e4     # N: larger forces are shown in kN
_LONGEST = 70        # letters of a heading


def force_unit(*forces: Numbers) -> tuple[float, str]:
    """Return the scale and the unit in which forces (N) are shown."""
    known = (force[np.isfinite(force)] for force in forces)
    largest = max((float(np.abs(force).max()) for force in known if len(force)), default=0.0)
    return (1e-3, 'kN') if largest >= _KILO_FROM else (1.0, 'N')


def line(panel: Axes, samples: Mapping[str, Numbers], name: str, scale: float, label: str, **look: Any) -> None:
    """Draw a column over time; one of NaN was not measured."""
    if np.isnan(samples[name]).all():
        return
    time, values = thinned(samples['time'], samples[name])
    panel.plot(time, values * scale, label=label, **look)


def dress(panel: Axes) -> None:
    """Give a panel over time its grid and legend."""
    if not panel.has_data():
        panel.text(0.5, 0.5, 'not measured', transform=panel.transAxes, ha='center', va='center', color=GREY)
    panel.spines[['top', 'right']].set_visible(False)
    panel.grid(axis='both', color='#dddddd', linewidth=0.6)
    panel.set_axisbelow(True)
    panel.margins(x=0.0)
    if panel.get_legend_handles_labels()[0]:
        panel.legend(loc='lower right', bbox_to_anchor=(1.0, 0.98), ncols=4, frameon=False, fontsize=9,
                     borderaxespad=0.0, handlelength=2.2)


def head(first: Axes, title: str) -> None:
    """Write a title of up to three lines above the first panel; the first line is the heading."""
    heading, _, rest = title.partition('\n')
    first.set_title(shortened(heading, _LONGEST), loc='left', fontsize=14, fontweight='bold',
                    pad=(22, 42, 56)[min(title.count('\n'), 2)])
    first.annotate(rest, (0.0, 1.0), xytext=(0.0, 25.0), xycoords='axes fraction', textcoords='offset points',
                   fontsize=10, color=GREY, in_layout=False)
