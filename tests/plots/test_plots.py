# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Pictures of runs: they can be drawn without a display, from any run."""

import re
from io import BytesIO
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import pytest
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.layout_engine import ConstrainedLayoutEngine

from stickslip_sim.compare.characteristics import characteristics_of
from stickslip_sim.compare.fresh import simulate_densely
from stickslip_sim.compare.look import drawn_motion
from stickslip_sim.core.arrays import Numbers
from stickslip_sim.core.types import Mode
from stickslip_sim.inputs import load_scene
from stickslip_sim.plots import paper_panels, plot_run, style
from stickslip_sim.plots.characteristics import plot_characteristics
from stickslip_sim.plots.friction_fits import FittedLine, MeasuredPoints, plot_friction_fits, plot_speeds
from stickslip_sim.plots.run import BINS, DrawnRun, TimeWindow, band, bin_edges, drawn_run, mode_shares
from stickslip_sim.plots.style import legend_outside, thinned
from stickslip_sim.runs import Run, simulate, simulate_events
from stickslip_sim.runs.picture import sampled
from stickslip_sim.simulation.step_result import Mark

pytestmark = pytest.mark.slow

EDGES: Numbers = np.linspace(0.0, 10.0, BINS + 1, dtype=np.float64)
PNG = b'\x89PNG\r\n\x1a\n'


def drawn(run: Run, title: str = 'paper_fig8', **samples: Numbers) -> DrawnRun:
    return drawn_run(title, {**run.samples, **samples}, run.events, run.commands, run.marks)


def whole(run: Run) -> list[TimeWindow]:
    return [TimeWindow(run.begin, run.end)]


@pytest.mark.parametrize('scene', ['positioning', 'cutting_force'])
def test_png(scene: str, tmp_path: Path) -> None:
    run = simulate(load_scene(scene), 3.0, 0.01)
    plot_run(drawn(run, f'{scene}\nfigures'), whole(run), tmp_path / 'run.png')
    assert (tmp_path / 'run.png').read_bytes().startswith(PNG)
    assert (tmp_path / 'run.png').stat().st_size > 20_000


def test_svg_names_what_it_shows_and_pictures_are_reproducible(tmp_path: Path) -> None:
    run = simulate(load_scene('paper_fig8'), 3.0, 0.01)
    for name in ('a.svg', 'b.svg', 'a.pdf', 'b.pdf'):
        plot_run(drawn(run), whole(run), tmp_path / name)
    ElementTree.parse(tmp_path / 'a.svg')
    text = (tmp_path / 'a.svg').read_text()
    for words in ('paper_fig8', 'position / mm', 'drive end of the spring', 'stretch / mm', 'velocity / (mm/s)',
                  'force / N', 'STICK', 'DECELERATING', 'drive'):
        assert words in text
    assert not re.search('yielding|external', text.lower())
    assert text == (tmp_path / 'b.svg').read_text()
    content = (tmp_path / 'a.pdf').read_bytes()
    assert content.startswith(b'%PDF')
    assert content == (tmp_path / 'b.pdf').read_bytes()
    assert b'/CIDFontType2' in content    # letters, and no bitmaps of them
    assert b'/Type3' not in content


def words_of(path: Path) -> list[str]:
    """Return the texts of an SVG file, which stand in it as comments beside their outlines."""
    return re.findall(r'<!-- (.*?) -->', path.read_text())


def test_what_there_is_nothing_of_has_no_panel(tmp_path: Path) -> None:
    """Of a motor that pushes the slider without a spring: no drive end, no stretch, no drive force."""
    scene = load_scene('paper_fig7', {'axis.drive_stiffness': 0.0, 'axis.drive_damping': 0.0, 'drive.velocity': 0.0,
                                      'force.course': 'sine', 'force.amplitude': 1500.0, 'force.frequency': 1.0})
    run = simulate(scene, 3.0, 0.001)
    plot_run(drawn(run), whole(run), tmp_path / 'motor.svg')
    words = words_of(tmp_path / 'motor.svg')
    assert {'slider', 'external', 'friction', 'position / mm'} <= set(words)
    assert not [word for word in words if 'drive' in word or 'stretch' in word]
    samples = {name: column if name in ('time', 'mode', 'position', 'velocity') else np.full(len(column), np.nan)
               for name, column in run.samples.items()}
    plot_run(drawn_run('', samples, [], run.commands, []), whole(run), tmp_path / 'bare.svg')
    words = words_of(tmp_path / 'bare.svg')
    assert 'not measured' not in words
    assert not [word for word in words if word.startswith(('force', 'stretch'))]


@pytest.mark.parametrize(('duration', 'is_envelope'), [(23.0, False), (100.0, False), (150.0, True), (1000.0, True)])
def test_lines_as_long_as_pixels_allow(duration: float, is_envelope: bool, tmp_path: Path) -> None:
    """34 cycles and 150 are lines, of 6 pixels a cycle or more; beyond, the envelope says that it is one."""
    run = simulate_events(load_scene('paper_fig8'), duration)
    samples = sampled(run.scene, run.events, [TimeWindow(0.0, duration)])
    plot_run(drawn_run('', samples, run.events, run.commands, []), whole(run), tmp_path / 'run.svg')
    words = words_of(tmp_path / 'run.svg')
    assert ('slider, envelope' in words) == ('friction, envelope' in words) == is_envelope
    assert ('static limit at break-away' in words) == (not is_envelope)
    assert ('STICK' in words) == (duration == 23.0)    # of lanes a mode has two pixels; else the shares of the time


def test_a_long_name_stays_clear_of_letters_and_of_the_edge(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    shown: list[Figure] = []
    monkeypatch.setattr(style, 'save', lambda figure, *paths: shown.append(figure))
    run = simulate_densely(load_scene('paper_fig7'), 2.0)
    names = 'axis_at_1.2_mm_s_' * 3, 'axis_at_1.2_mm_s_' * 12
    paper_panels.plot_side_by_side(dict.fromkeys(names, drawn_motion(run)), tmp_path / 'a.png')
    monkeypatch.undo()
    (figure,) = shown
    figure.savefig(BytesIO())
    boxes = {text.get_text(): text.get_window_extent() for panel in figure.axes for text in panel.texts}
    letters = [box for text, box in boxes.items() if re.fullmatch(r'\([a-f]\)', text)]
    long = [box for text, box in boxes.items() if text.startswith('axis')]
    assert (len(letters), len(long)) == (6, 2)
    assert not any(box.overlaps(letter) for box in long for letter in letters)
    assert all(box.xmax < figure.bbox.xmax for box in long)
    plot_run(drawn(run, names[1]), whole(run), tmp_path / 'run.svg')
    assert any('…' in word for word in words_of(tmp_path / 'run.svg'))


def test_one_sample_and_no_event_can_be_drawn(tmp_path: Path) -> None:
    run = simulate(load_scene('paper_fig7'), 0.1, 1.0)
    plot_run(drawn(run), whole(run), tmp_path / 'one.png')
    assert (tmp_path / 'one.png').read_bytes().startswith(PNG)


def test_an_external_force_is_shown_and_faults_and_refusals_have_a_lane_each(tmp_path: Path) -> None:
    run = simulate(load_scene('paper_fig8'), 1.0, 0.01)
    pushed = drawn(run, external_force=run.samples['external_force'] - 2e4)
    marks = [Mark(0.2, 0.4, 'friction_scale'), Mark(0.5, 0.5, 'refused', 7), Mark(0.6, 0.6, 'refused', 5)]
    plot_run(pushed._replace(marks=marks), whole(run), tmp_path / 'marks.svg')
    text = (tmp_path / 'marks.svg').read_text()
    for words in ('external', 'force / kN', 'friction scale', 'refused (12)'):
        assert words in text


def test_a_band_has_every_extreme(tmp_path: Path) -> None:
    time = np.linspace(0.0, 10.0, 100_001, dtype=np.float64)
    values: Numbers = np.sin(100.0 * time)
    values[70_000] = 5.0
    middles, low, high = band(time, values, EDGES)
    assert len(middles) == len(low) == len(high) == BINS
    assert (high.max(), round(float(middles[high.argmax()]), 1)) == (5.0, 7.0)
    assert low.min() == values.min()
    middles, low, high = band(np.array([1.0, 9.0]), np.array([2.0, 3.0]), EDGES)
    assert (low.tolist(), high.tolist()) == ([2.0, 3.0], [2.0, 3.0])   # nothing between them


@pytest.mark.parametrize('duration', [75.0, 100.0, 130.0, 260.0, 1000.0])
def test_a_settled_run_has_no_beat_in_its_picture(duration: float) -> None:
    """However the cycles fall into the parts of a picture: behind the first all bands and shares are level."""
    run = simulate_events(load_scene('paper_fig8'), duration)
    window = TimeWindow(0.0, duration)
    samples = sampled(run.scene, run.events, [window])
    shown = drawn_run('', samples, run.events, run.commands, run.marks)
    edges = bin_edges(shown, window)
    assert len(edges) <= BINS + 1
    for name in ('velocity', 'friction_force'):
        _, low, high = band(samples['time'], samples[name], edges)
        size = high.max() - low.min()
        assert np.ptp(low[5:-1]) < 0.01 * size
        assert np.ptp(high[5:-1]) < 0.01 * size
    assert np.ptp(mode_shares(shown.modes, edges)[Mode.STICK][5:-1]) < 0.06


def test_the_shares_of_the_modes_are_those_of_the_time() -> None:
    modes = np.array([0.0, 1.0, 4.0]), np.array([Mode.STICK, Mode.ACCELERATING, Mode.STICK], dtype=np.float64)
    shares = mode_shares(modes, np.array([0.0, 2.0, 4.0, 6.0]))
    assert shares[Mode.STICK].tolist() == pytest.approx([0.5, 0.0, 1.0])
    assert shares[Mode.ACCELERATING].tolist() == pytest.approx([0.5, 1.0, 0.0])
    assert shares[Mode.COASTING].tolist() == [0.0, 0.0, 0.0]


@pytest.mark.parametrize('duration', [1.5, 60.0])   # lanes, and shares of the time
def test_a_contact_that_yields_has_a_lane(duration: float, tmp_path: Path) -> None:
    load = {'normal_load.course': 'sine', 'normal_load.amplitude': 1000.0, 'normal_load.frequency': 25.0}
    run = simulate(load_scene('paper_fig8', load), duration, 0.01)
    plot_run(drawn(run), whole(run), tmp_path / 'run.svg')
    assert 'yielding' in (tmp_path / 'run.svg').read_text().lower()


def test_the_panels_of_a_comparison_have_room(tmp_path: Path) -> None:
    """With a layout and as finely as they are written; a layout that fails warns, which would be an error here."""
    run = simulate_densely(load_scene('paper_fig7'), 1.0)
    paper_panels.plot_motion(drawn_motion(run), tmp_path / 'motion.png')
    plot_characteristics(characteristics_of(run), tmp_path / 'friction.png')
    assert all((tmp_path / f'{name}.png').read_bytes().startswith(PNG) for name in ('motion', 'friction'))


def test_what_has_settled_is_no_mountain(tmp_path: Path) -> None:
    """Sliding that has settled is a line, not the rounding of its last digits."""
    run = simulate(load_scene('fast_feed'), 10.0, 0.001)
    plot_run(drawn(run), [TimeWindow(9.0, 10.0)], tmp_path / 'settled.svg')
    assert not re.search(r'1e.?1\d', (tmp_path / 'settled.svg').read_text().partition('<defs>')[2].lower())


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


# The picture of a friction curve: its lines follow one direction of motion each.

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
