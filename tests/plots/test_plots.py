# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Pictures of runs: they can be drawn without a display, from any run."""

import subprocess
import sys
from io import BytesIO
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import pytest
from matplotlib.figure import Figure
from matplotlib.layout_engine import ConstrainedLayoutEngine

from stickslip_sim.plots import plot_run
from stickslip_sim.plots.style import Numbers, legend_outside, thinned
from stickslip_sim.runs import Columns, simulate
from stickslip_sim.scene import load_scene

PNG = b'\x89PNG\r\n\x1a\n'


@pytest.mark.parametrize('scene', ['paper_fig7', 'paper_fig8', 'positioning', 'fast_feed', 'cutting_force'])
def test_png(scene: str, tmp_path: Path) -> None:
    run = simulate(load_scene(scene), 3.0, 0.01)
    plot_run(run.samples, run.events, f'{scene}\nfigures', tmp_path / 'run.png')
    assert (tmp_path / 'run.png').read_bytes().startswith(PNG)
    assert (tmp_path / 'run.png').stat().st_size > 20_000


def test_svg_names_what_it_shows_and_is_reproducible(tmp_path: Path) -> None:
    run = simulate(load_scene('paper_fig8'), 3.0, 0.01)
    for name in ('a.svg', 'b.svg'):
        plot_run(run.samples, run.events, 'paper_fig8', tmp_path / name)
    ElementTree.parse(tmp_path / 'a.svg')
    text = (tmp_path / 'a.svg').read_text()
    for words in ('paper_fig8', 'position / mm', 'velocity / (mm/s)', 'force / N', 'STICK', 'DECELERATING', 'drive'):
        assert words in text
    assert text == (tmp_path / 'b.svg').read_text()


def test_external_force_is_shown_only_where_there_is_one(tmp_path: Path) -> None:
    run = simulate(load_scene('paper_fig8'), 1.0, 0.01)
    plot_run(run.samples, run.events, 'none', tmp_path / 'none.svg')
    pushed: Columns = {**run.samples, 'external_force': run.samples['external_force'] - 2e4}
    plot_run(pushed, run.events, 'some', tmp_path / 'some.svg')
    assert 'external' not in (tmp_path / 'none.svg').read_text()
    assert 'external' in (tmp_path / 'some.svg').read_text()
    assert 'force / kN' in (tmp_path / 'some.svg').read_text()


def test_one_sample_and_no_event_can_be_drawn(tmp_path: Path) -> None:
    run = simulate(load_scene('paper_fig7'), 0.1, 1.0)
    plot_run(run.samples, run.events, 'one', tmp_path / 'one.png')
    assert (tmp_path / 'one.png').read_bytes().startswith(PNG)


def test_thinning_keeps_the_peaks() -> None:
    time = np.linspace(0.0, 1.0, 100_003, dtype=np.float64)
    values: Numbers = np.sin(7.0 * time)
    values[12_345], values[54_321] = 9.0, -9.0
    thin_time, thin = thinned(time, values)
    assert len(thin) < 10_000
    assert (thin.max(), thin.min()) == (9.0, -9.0)
    assert (thin_time[0], thin_time[-1]) == (0.0, 1.0)
    assert np.all(np.diff(thin_time) > 0.0)


@pytest.mark.parametrize('place', ['upper left', 'upper right', 'lower center'])
def test_panels_make_room_for_a_legend_outside(place: str) -> None:
    figure = Figure(layout=ConstrainedLayoutEngine())
    for part in figure.subfigures(2, 1):
        panel = part.subplots()
        legend_outside(part, place, panel.plot([0, 1, 0]) * 6, 'abcdef', ncols=2)
        panel.set(xlabel='x', title='a panel')
    figure.savefig(BytesIO())
    for part in figure.subfigs:
        legend = part.legends[0].get_window_extent()
        panels = part.axes[0].get_tightbbox()
        assert panels is not None
        assert not legend.overlaps(panels)
        assert part.bbox.ymin <= legend.ymin < legend.ymax <= part.bbox.ymax


def test_no_global_state_of_matplotlib() -> None:
    program = 'import sys, stickslip_sim.plots; assert "matplotlib.pyplot" not in sys.modules'
    subprocess.run([sys.executable, '-c', program], check=True, timeout=60)
