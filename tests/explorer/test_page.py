# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""`stickslip explore` in a real browser, from a file, network off: events, sliders, refusals, the copied scene."""

import json
import re
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

import pytest

from dev.browser import PROGRAM, Browser
from stickslip_sim import load_scene
from stickslip_sim.core import hot_path
from stickslip_sim.explorer.page import page_of
from stickslip_sim.runs import simulate, simulate_events
from stickslip_sim.scene import scene_names
from stickslip_sim.scene.values import scene_text
from tests.support.tool import Capture, answered, refused

pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(hot_path.UNIT is None, reason='no compiled code'),
    pytest.mark.skipif(PROGRAM is None, reason='no browser: apt install chromium'),
]
CLOSE = 1e-10       # s: the maths of a browser differ from ours in the last bit
DURATION = 20.0
FEED = 'input[data-path="drive.velocity"]'
KINETIC = {'friction.kinetic.initial': 0.11, 'friction.kinetic.limit': 0.05, 'friction.kinetic.stribeck_velocity': 0.01}
VARIANTS: dict[str, dict[str, Any]] = {
    'reversed': {'drive.velocity': -0.003}, 'kato': {'friction.static.law': 'kato', 'friction.static.exponent': 0.6},
    'hyperbolic': {'friction.static.law': 'hyperbolic', 'friction.kinetic.law': 'hyperbolic', **KINETIC},
    'logarithmic': {'friction.static.law': 'logarithmic', 'initial.rest_time': 1.0, 'friction.static.delay': 0.05},
    'constant': {'friction.static.law': 'constant'},
    'steep': {'friction.kinetic.law': 'stribeck', 'friction.kinetic.exponent': 0.7, **KINETIC},
    'rising': {'friction.kinetic.law': 'exponential', **KINETIC, 'friction.kinetic.viscous': 0.5,
               'friction.excess.law': 'power', 'friction.excess.exponent': 3.0},
    'cosine': {'friction.excess.law': 'cosine', 'friction.excess.limit_velocity': 0.02},
    'ramp': {'drive.course': 'ramp', 'drive.velocity': 0.001, 'drive.acceleration': 1e-3, 'drive.duration': 4.0},
    'sines': {'drive.amplitudes': [5.0e-3, 2.0e-3], 'drive.frequencies': [3.0, 17.0], 'force.course': 'sine',
              'force.amplitude': 50.0, 'force.frequency': 2.0, 'force.phase': 1.0},
    'steps': {'force.course': 'steps', 'force.times': [0.0, 0.4, 1.0], 'force.forces': [0.0, 300.0, -50.0],
              'force.period': 1.5},
    'slideway': {'axis.damper': 'slideway', 'contact.arrest': 'undeflected', 'contact.break_away': 'drive_force'},
    'rigid': {'contact.model': 'rigid', 'friction.acceleration_dependence': False},
}


def address_of(folder: Path, beside: Mapping[str, list[float]] | None = None) -> str:
    """Write the page and return its address."""
    page = folder / 'explore.html'
    page.write_text(page_of(load_scene('paper_fig8'), beside), encoding='utf-8')
    return page.as_uri()


@pytest.fixture(scope='module')
def browser(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Browser]:
    with Browser(tmp_path_factory.mktemp('browser')) as made:
        made.scheme('light')
        yield made


@pytest.fixture(scope='module')
def address(browser: Browser, tmp_path_factory: pytest.TempPathFactory) -> str:
    """Open the page; return its address."""
    address = address_of(tmp_path_factory.mktemp('page'))
    browser.open(address)
    return address


@pytest.fixture
def page(browser: Browser, address: str) -> Iterator[Browser]:
    """Yield the page as it opens; whatever a test does, no script fails."""
    browser.ask('explorer.openText(PAGE.scene)')
    yield browser
    assert browser.errors == []


def message(page: Browser) -> str:
    """Return what the page says is wrong."""
    return str(page.ask('document.getElementById("message").textContent'))


def is_close(of_page: list[list[float]], of_engine: list[list[float]]) -> bool:
    """Whether two lists of events are the same: kinds and modes, and times but for rounding."""
    return [event[2:] for event in of_page] == [event[2:] for event in of_engine] and all(
        abs((a[0] - b[0]) + (a[1] - b[1])) <= CLOSE for a, b in zip(of_page, of_engine, strict=True))


def events_of_page(page: Browser, text: str) -> list[list[float]]:
    return list(page.ask(f'explorer.eventsOf(explorer.axisOf(explorer.valuesOf({json.dumps(text)})), {DURATION})'
                         '.events.map(one => [one.second, one.fraction, one.kind, one.mode])'))


def events_of_engine(scene: Any) -> list[list[float]]:
    return [[one.second, one.fraction, one.kind, one.mode] for one in simulate_events(scene, DURATION).events]


def test_the_page_is_one_small_file_that_asks_for_nothing() -> None:
    text = page_of(load_scene('paper_fig8'))
    assert len(text.encode()) <= 300_000
    assert set(re.findall(r'https?://[^\s"\'`]+', text)) == {'http://www.w3.org/2000/svg'}


@pytest.mark.parametrize('name', scene_names())
def test_a_shipped_scene_has_the_events_of_the_engine(page: Browser, name: str) -> None:
    path = Path(__file__).parents[2] / 'stickslip_sim/stickslip_sim/scenes' / f'{name}.yaml'
    events = events_of_engine(load_scene(name))
    assert len(events) > 0
    assert is_close(events_of_page(page, path.read_text(encoding='utf-8')), events)


@pytest.mark.parametrize('changes', VARIANTS.values(), ids=VARIANTS)
def test_every_law_and_input_has_the_events_of_the_engine(page: Browser, changes: dict[str, Any]) -> None:
    scene = load_scene('paper_fig8', changes)
    events = events_of_engine(scene)
    assert len(events) > 10
    assert is_close(events_of_page(page, scene_text(scene.values)), events)


def test_a_slider_moves_the_picture_and_the_copied_scene_has_its_events(page: Browser, tmp_path: Path,
                                                                        capsys: Capture) -> None:
    page.until('explorer.stripCost')
    before, picture = page.ask('explorer.values["drive.velocity"]'), page.picture()
    page.drag(FEED, 0.5, 0.62)
    after = page.ask('explorer.values["drive.velocity"]')
    assert (before, page.picture() == picture) == (0.002, False)
    assert 0.004 < after < 0.01
    page.click('#copy')
    path = tmp_path / 'copied.yaml'
    path.write_text(page.ask('document.getElementById("yaml").value'), encoding='utf-8')
    page.click('#close')
    scene = load_scene(path)
    assert scene.axis == load_scene('paper_fig8').axis
    assert scene.drive.values == (after,)
    shown = page.ask('explorer.eventsOf(explorer.axisOf(explorer.values), 5).figures')
    run = simulate_events(scene, 5.0)
    assert run.summary.stick_share == pytest.approx(shown['stick_share'], rel=1e-9)
    for name in ('period', 'stick_time', 'slip_time', 'slip_travel', 'jump', 'peak_speed', 'break_away_force',
                 'static_coefficient'):
        assert getattr(run.summary.last, name) == pytest.approx(shown[name], rel=1e-9)
    assert answered(capsys, 'simulate', path, '--duration', '5')[0] == 0
    page.click('#undo')
    assert page.ask('explorer.values["drive.velocity"]') == before


def test_the_address_keeps_the_state(page: Browser) -> None:
    page.write('#axis_mass', '420')
    page.ask('document.querySelector("#contact_model").focus()')
    page.ask('(() => { const one = document.querySelector("#contact_model"); one.value = "rigid"; one.onchange(); })()')
    address, text = page.ask('location.href'), page.ask('explorer.sceneText(explorer.values)')
    page.open(address)
    assert page.ask('explorer.sceneText(explorer.values)') == text
    assert page.ask('[explorer.values["axis.mass"], explorer.values["contact.model"]]') == [420, 'rigid']


def test_the_keyboard_moves_a_slider_and_the_time(page: Browser) -> None:
    page.ask(f'document.querySelector({json.dumps(FEED)}).focus()')
    for _ in range(3):
        page.key('ArrowRight')
    page.until('explorer.values["drive.velocity"] > 0.002')
    page.ask('document.querySelector("#view_velocity .plot").focus()')
    page.key('ArrowRight')
    assert page.ask('explorer.index') > 0


@pytest.mark.parametrize(('field', 'typed', 'said'), [
    ('axis_mass', '0', 'axis.mass = 0 is refused: must be a number, >= 1e-09 and <= 1e+12 kg'),
    ('axis_mass', 'NaN', 'axis.mass = NaN is refused: must be a number'),
    ('drive_velocity', '', 'drive.velocity = nothing is refused: must be a number'),
    ('axis_drive_stiffness', '1e19', 'axis.drive_stiffness = 1e19 is refused'),
    ('friction_static_initial', '0.1', 'friction.kinetic.coefficients[0] = 0.12 is refused: must be <= '),
    ('friction_static_limit', '0.1', 'friction.static.limit = 0.1 is refused: must be >= friction.static.initial'),
    ('end', '-1', 'time shown = -1 is refused'),
    ('end', '1e5', 'more than 20000 events within 100000 s: show a shorter time'),
])
def test_a_number_that_cannot_be_is_refused_in_one_sentence(page: Browser, field: str, typed: str, said: str) -> None:
    text = page.ask('explorer.sceneText(explorer.values)')
    page.write(f'#{field}', typed)
    assert message(page).startswith(said)
    assert page.ask('explorer.sceneText(explorer.values)') == text
    page.write('#axis_drive_damping', '4000')


@pytest.mark.parametrize(('field', 'typed'), [
    ('drive_velocity', '0'), ('drive_velocity', '-2'), ('drive_velocity', '1e6'), ('axis_drive_stiffness', '0'),
    ('axis_drive_stiffness', '1e18'), ('axis_mass', '1e-9'), ('axis_mass', '1e12'), ('axis_normal_force', '0'),
    ('axis_drive_damping', '0'), ('contact_stiffness', '1e-6'), ('friction_static_time_constant', '1e-12'),
])
def test_an_extreme_number_is_drawn_or_refused_in_one_sentence(page: Browser, field: str, typed: str) -> None:
    page.write(f'#{field}', typed)
    page.ask('new Promise(go => setTimeout(go, 100))')
    finite = page.ask('[...Object.values(explorer.views)].every(one => !one.reach || one.reach.every(Number.isFinite))')
    assert finite
    assert len(message(page)) < 250


@pytest.mark.parametrize(('text', 'said'), [
    ('axis: {mass: 1.0', 'line 1 of the scene cannot be read: } is missing'),
    ('/**:\n  ros__parameters:\n    - 1', 'line 3 of the scene cannot be read: write lists in brackets'),
    ('/**:\n  ros__parameters:\n    axis: *one', 'line 3 of the scene cannot be read: *one is more YAML than'),
    ('', 'line 1 of the scene cannot be read: the text is empty'),
    ('scene: paper_fig8', 'file = scene is refused'),
    ('/**:\n  ros__parameters:\n    scene: paper_fig8\n    axis: {mas: 1.0}', 'axis.mas = 1.0 is refused'),
    ('/**:\n  ros__parameters:\n    scene: paper_fig8\n    axis: {mass: -1.0}', 'axis.mass = -1.0 is refused'),
    ('/**:\n  ros__parameters:\n    scene: paper_fig8\n    solver: {name: fixed_step}',
     'this page cannot run solver.name: fixed_step: it has the exact solver alone'),
    ('/**:\n  ros__parameters:\n    scene: paper_fig8\n    drive: {course: table, file: feed.csv}',
     'this page cannot run an input profile from a file'),
])
def test_a_scene_that_cannot_be_is_refused_in_one_sentence(page: Browser, text: str, said: str) -> None:
    assert not page.ask(f'explorer.openText({json.dumps(text)})')
    assert message(page).startswith(said)
    assert page.ask('explorer.values.scene') == 'paper_fig8'


def test_a_measured_run_lies_behind(browser: Browser, tmp_path: Path) -> None:
    samples = simulate(load_scene('paper_fig7'), 2.0).samples
    browser.open(address_of(tmp_path, {name: samples[name].tolist() for name in ('time', 'position', 'velocity')}))
    assert browser.errors == []
    drawn = 'explorer.views.NAME.list.map(one => one.colour)'
    for name in ('position', 'velocity'):
        assert browser.ask(drawn.replace('NAME', name))[0] == 'measured'
    assert 'measured' not in browser.ask(drawn.replace('NAME', 'force'))


def test_the_tool_writes_the_page_with_a_measured_run_or_says_why_not(tmp_path: Path, capsys: Capture) -> None:
    out, csv = tmp_path / 'page.html', tmp_path / 'measured.csv'
    csv.write_text('time,velocity\n0.0,0.0\n1.0,0.002\n', encoding='utf-8')
    assert answered(capsys, 'explore', 'paper_fig8', '--beside', csv, '--out', out)[:2] == (0, f'written: {out}\n')
    assert '"beside":{"time":[0.0,1.0],"velocity":[0.0,0.002]}' in out.read_text(encoding='utf-8')
    csv.write_text('time,mass\n0.0,1.0\n1.0,2.0\n', encoding='utf-8')
    assert '--beside = ' in refused(capsys, 'explore', 'paper_fig8', '--beside', csv, '--out', out)
    for change in ('solver.name=fixed_step', 'normal_load.course=constant', 'friction.scale=0.5',
                   'friction.static.backward.initial=0.13'):
        assert 'must be omitted in a page' in refused(capsys, 'explore', 'paper_fig8', '--set', change, '--out', out)


def test_a_phone_has_all_in_its_width(page: Browser) -> None:
    page.size(390, 844, 2.0, phone=True)
    try:
        assert page.ask('document.documentElement.scrollWidth') <= 390
        assert page.ask('[...document.querySelectorAll("canvas.base")].every(one => one.clientWidth > 300)')
    finally:
        page.size(1280, 900)
