# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""`stickslip compare`: the paper's figures and cycle figures, from scenes and from bags."""

import base64
import json
import math
import re
import shutil
from html.parser import HTMLParser
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import numpy as np
import pytest

from stickslip_sim.cli.main import run
from stickslip_sim.compare.characteristics import characteristics_beside, characteristics_of
from stickslip_sim.compare.fresh import simulate_densely
from stickslip_sim.compare.look import drawn_motion, in_order, look_at
from stickslip_sim.compare.ring_down import RING_DOWN, closed_form, identified
from stickslip_sim.compare.statements import StatementOutcome, findings_on, observed
from stickslip_sim.core.types import EventKind
from stickslip_sim.inputs import load_scene
from stickslip_sim.plots.characteristics import plot_characteristics
from stickslip_sim.plots.paper_panels import plot_motion
from stickslip_sim.recording import read_run
from stickslip_sim.runs import simulate_events
from stickslip_sim.runs.report import named_apart
from tests.support.rewritten_bags import rewritten
from tests.support.tool import Capture, answered

pytestmark = pytest.mark.slow

PNG = b'\x89PNG\r\n\x1a\n'
DRIVE = 0.002   # m/s


@pytest.fixture(scope='module')
def bag(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp('runs') / 'eight'
    assert run(['simulate', 'paper_fig8', '--duration', '4', '--bag', str(folder)]) == 0
    return folder


@pytest.fixture(scope='module')
def report(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The report on three scenes of the paper."""
    folder = tmp_path_factory.mktemp('reports') / 'paper'
    assert run(['compare', 'paper_fig4_constant', 'paper_fig7', 'paper_fig8', '--out', str(folder)]) == 0
    return folder


class Links(HTMLParser):
    """What a page would load, and its open tags."""

    def __init__(self) -> None:
        super().__init__()
        self.sources: list[str] = []
        self.open: list[str] = []

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.sources += [value or '' for name, value in attrs if name in ('src', 'href')]
        if tag not in ('meta', 'img'):
            self.open.append(tag)

    def handle_endtag(self, tag: str) -> None:
        assert self.open.pop() == tag


def test_pictures_in_both_formats(report: Path) -> None:
    names = {f'{scene}_{what}' for scene in ('paper_fig4_constant', 'paper_fig7', 'paper_fig8')
             for what in ('motion', 'friction')} | {'side_by_side'}
    assert {path.stem for path in report.glob('*.png')} == {path.stem for path in report.glob('*.svg')} == names
    for path in report.glob('*.png'):
        assert path.read_bytes().startswith(PNG)
    assert {path.name for path in report.iterdir()} > {'report.html', 'report.json'}
    assert [path.name for path in report.parent.iterdir()] == ['paper']


@pytest.mark.parametrize(('picture', 'words'), [
    ('paper_fig8_motion', ['(a)', '(f)', 'force / kN', 'velocity / (mm/s)', 'acceleration / (m/s²)', 'drive force',
                           'friction force', 'stretch of the drive spring s − x / mm', 'coasting']),
    ('paper_fig7_friction', ['coefficient of friction', 'rest time / s', 'accelerating, first slip', 'decelerating',
                             'upon prolonged rest', 'break-aways of the run']),
    ('side_by_side', ['paper_fig4_constant', 'paper_fig8', '(i)', 'friction force / kN'])])
def test_pictures_are_labelled(report: Path, picture: str, words: list[str]) -> None:
    text = (report / f'{picture}.svg').read_text()
    ElementTree.fromstring(text)
    for word in words:
        assert f'<!-- {word} -->' in text


def test_one_page_that_needs_nothing_else(report: Path) -> None:
    text = (report / 'report.html').read_text()
    links = Links()
    links.feed(text)
    assert links.open == []
    assert len(links.sources) == 7
    for source in links.sources:
        kind, data = source.split(',', 1)
        assert kind == 'data:image/svg+xml;base64'
        ElementTree.fromstring(base64.b64decode(data))
    assert not re.search(r'url\(|@import|<script|<link', text)
    for words in ('period / s', 'slip / s', 'peak speed / (mm/s)', 'peak acceleration / (m/s²)',
                  'Ring-down after a slip', '✓ holds', '– not applicable', '20.1317'):
        assert words in text
    assert ' / ms' not in text    # one unit for times


@pytest.mark.parametrize(('scene', 'period', 'jump', 'peak', 'acceleration'), [
    ('paper_fig7', 0.619075168, 1.238150336e-3, 1.23285921663e-2, (411.8793 - 235.301790949) / 350.0),
    ('paper_fig8', 0.659065697, 1.31813139e-3, 1.16642823367e-2, (411.8793 - 246.606758267) / 350.0)])
def test_cycle_figures_of_the_model(report: Path, scene: str, period: float, jump: float, peak: float,
                                    acceleration: float) -> None:
    """The slider is decelerated most just before it stops, by mu_k(0) N and the drive force there."""
    found = the_run(report, scene)
    last = found['cycles'][-1]
    assert last['period'] == pytest.approx(period, abs=6e-10)
    assert last['jump'] == pytest.approx(jump, abs=6e-12)
    assert last['peak_speed'] == pytest.approx(peak, abs=6e-14)
    assert last['peak_acceleration'] == pytest.approx(acceleration, rel=1e-9)
    assert last['rest_time'] == pytest.approx(last['stick_time'], rel=1e-12)
    assert found['cycles'][0]['rest_time'] == 'inf'
    assert found['settled']
    assert len(found['convergence']) == len(found['cycles']) - 1
    assert found['convergence'][0] > 0.05
    assert found['convergence'][-1] < 1e-12
    assert 0.05 < found['contraction'] < 0.2


def test_ring_down_is_that_of_the_closed_form(report: Path) -> None:
    rings = the_run(report, 'paper_fig8')['ring_down']
    for figures in rings.values():
        assert figures['frequency'] == pytest.approx(20.13, abs=5e-3)
        assert figures['damped_frequency'] == pytest.approx(19.66, abs=5e-3)
        assert figures['damping_ratio'] == pytest.approx(0.2146, abs=5e-5)
    assert rings['identified']['frequency'] == pytest.approx(rings['closed_form']['frequency'], rel=1e-10)
    assert the_run(report, 'paper_fig7')['ring_down'] == {'identified': None, 'closed_form': None}


@pytest.mark.parametrize('damping', [0.0, 15000.0, 60000.0, 2e5])
def test_ring_down_is_identified_from_the_motion(damping: float) -> None:
    """Also where nothing swings: a damping ratio of 2.3."""
    moving = simulate_densely(load_scene('paper_fig8', {'contact.damping': damping}), 3.0)
    form, found = closed_form(moving.scene.axis), identified(observed(moving).found[RING_DOWN])
    assert form is not None
    assert found is not None
    assert form.damping_ratio == pytest.approx((4000.0 + damping) / (2.0 * math.sqrt(5.6e6 * 350.0)), rel=1e-12)
    assert tuple(found) == pytest.approx(tuple(form), rel=1e-6)


def test_a_bag_gives_the_figures_of_the_scene(bag: Path) -> None:
    recorded, fresh = read_run(bag), simulate_densely(load_scene('paper_fig8'), 4.0)
    assert recorded.notes == ()
    assert [cycle.begin for cycle in recorded.cycles()] == pytest.approx([cycle.begin for cycle in fresh.cycles()])
    assert recorded.summary.stick_share == pytest.approx(fresh.summary.stick_share, abs=1e-12)
    assert recorded.scene.axis == fresh.scene.axis
    one, other = (identified(observed(run).found[RING_DOWN]) for run in (recorded, fresh))
    assert one is not None
    assert other is not None
    assert tuple(one) == pytest.approx(tuple(other), rel=1e-9)
    inputs = look_at(recorded).steady
    assert inputs is not None
    assert tuple(inputs) == (DRIVE, 0.0)


def test_a_bag_in_a_namespace_and_without_the_other_topics(bag: Path, tmp_path: Path) -> None:
    keep = ('/slider_state', '/friction_force', '/mode_event')
    moving = read_run(rewritten(bag, tmp_path / 'cell', lambda name: f'/cell{name}' if name in keep else None))
    assert moving.name == 'cell'
    assert len(moving.cycles()) == len(read_run(bag).cycles())


def test_a_recording_that_began_later(bag: Path, tmp_path: Path) -> None:
    late, whole = read_run(rewritten(bag, tmp_path / 'late', since=1.5)), read_run(bag)
    assert late.begin == pytest.approx(1.5)
    assert late.cycles() == whole.cycles()[-len(late.cycles()):]
    assert 0 < len(late.cycles()) < len(whole.cycles())
    assert 0.6 < late.summary.stick_share < 0.9
    verdicts = {statement.name: finding for statement, finding in findings_on(late)}
    assert verdicts['long rest'].outcome == StatementOutcome.NOT_APPLICABLE
    assert verdicts['continuous friction force'].outcome == StatementOutcome.HOLDS


def test_corners_are_where_they_are() -> None:
    """At each event there is a sample just before and one just after it, at any sample rate."""
    moving = simulate_densely(load_scene('paper_fig7'), 2.0)
    columns = in_order(look_at(moving).before, moving.samples)
    for event in moving.events:
        at = np.flatnonzero(columns['time'] == event.time)
        assert len(at) == 2
        assert columns['friction_force'][at[0]] == event.friction_force
    stop = next(event for event in moving.events if event.kind == EventKind.STICK)
    before, after = np.flatnonzero(columns['time'] == stop.time)
    assert columns['friction_force'][before] == pytest.approx(0.12 * 3432.3275)
    assert columns['friction_force'][after] == pytest.approx(stop.drive_force)
    assert columns['acceleration'][before] == pytest.approx((stop.drive_force - 0.12 * 3432.3275) / 350.0)
    assert columns['acceleration'][after] == 0.0


def test_a_jump_of_the_drive_is_sampled_on_both_sides() -> None:
    scene = load_scene('paper_fig7', {'drive.course': 'steps', 'drive.times': (0.0, 0.3),
                                      'drive.velocities': (0.0, 0.1)})
    samples = simulate_densely(scene, 0.5).samples
    at = int(np.flatnonzero(samples['time'] == 0.3)[0])
    assert samples['time'][at - 1] == pytest.approx(0.3, abs=2e-9)
    assert samples['drive_force'][at - 1:at + 1].tolist() == pytest.approx([0.0, 400.0])


@pytest.mark.parametrize(('name', 'shipped'), [('constant kinetic friction', 'paper_fig4_constant'),
                                               ('falling kinetic friction', 'paper_fig4_falling'),
                                               ('acceleration-dependent friction', 'paper_fig7')])
def test_characteristics_beside_are_those_of_the_paper(name: str, shipped: str) -> None:
    other = characteristics_beside(load_scene('paper_fig7'))[name]
    assert simulate_events(other, 3.0).events == simulate_events(load_scene(shipped), 3.0).events


def test_a_scene_has_only_the_characteristics_it_can_have() -> None:
    assert list(characteristics_beside(load_scene('paper_fig4_constant'))) == ['constant kinetic friction']


@pytest.mark.parametrize('changes', [
    {'drive.velocity': 0.0}, {'axis.normal_force': 0.0}, {'drive.velocity': 0.2},
    {'drive.course': 'sine', 'drive.amplitude': 0.01, 'drive.frequency': 3.0}])
def test_any_motion_can_be_drawn(changes: dict[str, object], tmp_path: Path) -> None:
    """Nothing moves, or without friction, smoothly, or to and fro; a warning would be an error here."""
    moving = simulate_densely(load_scene('paper_fig7', changes), 1.0)
    plot_motion(drawn_motion(moving), tmp_path / 'motion.svg')
    plot_characteristics(characteristics_of(moving), tmp_path / 'friction.svg')


def test_runs_of_one_name_get_files_of_their_own(bag: Path) -> None:
    recorded, fresh = read_run(bag), simulate_densely(load_scene('paper_fig7', {'scene': '../a b'}), 1.0)
    assert list(named_apart([recorded, recorded, fresh])) == ['eight', 'eight_2', '.._a_b']


def test_a_dot_in_the_name_of_a_run_begins_no_ending(bag: Path, tmp_path: Path, capsys: Capture,
                                                     monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    for name in ('sweep_1.0', 'sweep_1.2'):
        shutil.copytree(bag, tmp_path / name)
        assert answered(capsys, 'plot', name)[1] == f'written: {name}.png\n'
    assert list(named_apart([read_run('sweep_1.0'), read_run('sweep_1.2')])) == ['sweep_1.0', 'sweep_1.2']
    (file,) = bag.glob('*.mcap')
    assert list(named_apart([read_run(file)])) == [file.stem]


@pytest.mark.usefixtures('blank_pictures')
def test_exit_code_when_a_statement_does_not_hold(tmp_path: Path, capsys: Capture) -> None:
    """At 0.1 mm/s the contact changes the cycle by more than a tenth; the report is written all the same."""
    assert run(['compare', 'micro_feed', '--duration', '60', '--out', str(tmp_path / 'out')]) == 3
    out, err = capsys.readouterr()
    assert '  does not hold   the contact is not essential: the contact adds 12 % to the compliance' in out
    assert err.endswith('do not hold (micro_feed: the contact is not essential)\n')
    assert '✗ does not hold' in (tmp_path / 'out' / 'report.html').read_text()


def the_run(report: Path, scene: str) -> dict[str, Any]:
    runs: list[dict[str, Any]] = json.loads((report / 'report.json').read_text())['runs']
    return next(found for found in runs if found['scene'] == scene)
