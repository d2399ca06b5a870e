# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""docs/friction_curve.md: its files are those in examples/, and its figures are what the tool prints."""

import csv

import pytest

from stickslip_sim.cli.main import run
from stickslip_sim.inputs import load_scene
from tests.support.repository import ROOT

SCENE = ROOT / 'examples' / 'my_axis.yaml'


@pytest.fixture(scope='module')
def page() -> str:
    return (ROOT / 'docs' / 'friction_curve.md').read_text(encoding='utf-8')


def test_the_scene_is_the_one_of_the_page(page: str) -> None:
    _, _, scene = SCENE.read_text(encoding='utf-8').partition('friction_curve.md.\n')
    assert f'```yaml\n{scene}```\n' in page


def test_the_scene_has_the_measured_curve() -> None:
    with (ROOT / 'examples' / 'friction_curve.csv').open(encoding='utf-8') as file:
        rows = [(float(row['speed_mm_per_s']) / 1000, float(row['coefficient'])) for row in csv.DictReader(file)]
    kinetic = load_scene(str(SCENE)).axis.friction.kinetic
    assert [*zip(kinetic.velocities, kinetic.coefficients, strict=True)] == rows


def test_the_fit_is_what_the_page_says(
        page: str, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    monkeypatch.chdir(ROOT)
    assert run(['friction', 'examples/friction_curve.csv', '--speed-unit', 'mm/s']) == 0
    shown = ''.join(f'    {line}'.rstrip() + '\n' for line in capsys.readouterr().out.splitlines())
    assert shown in page


def test_the_critical_feed_is_what_the_page_says(
        page: str, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    monkeypatch.chdir(ROOT)
    assert run(['critical', 'examples/my_axis.yaml', '--of', 'drive.velocity']) == 0
    shown = ''.join(f'    {line}\n' for line in capsys.readouterr().out.splitlines())
    assert shown in page
