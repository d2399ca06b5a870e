# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""`stickslip friction`: what it prints, draws and writes, and what it refuses."""

from pathlib import Path

import pytest

from stickslip_sim.runs import simulate_events
from stickslip_sim.scene import load_scene
from tests.support.repository import ROOT
from tests.support.tool import Capture, answered, refused

CURVE = ROOT / 'examples' / 'friction_curve.csv'
AXIS = ROOT / 'examples' / 'my_axis.yaml'
GIVEN = ('friction', CURVE, '--speed-unit', 'mm/s')


def test_the_scene_runs_and_has_the_law(tmp_path: Path, capsys: Capture) -> None:
    code, out, _ = answered(capsys, *GIVEN, '--out', tmp_path / 'fitted.yaml', '--scene', AXIS,
                            '--set', 'drive.velocity=0.002')
    assert code == 0
    assert 'best: exponential, by the lowest AICc' in out
    scene = load_scene(str(tmp_path / 'fitted.yaml'))
    assert scene.summary == ('Kinetic friction from friction_curve.csv: the law exponential, rms of the residuals '
                             '0.00099; the axis of my_axis.yaml.')
    assert (scene.axis.mass, scene.values['drive.velocity']) == (120.0, 0.002)
    assert scene.values['friction.kinetic.law'] == 'exponential'
    assert simulate_events(scene, 5.0).summary.cycles > 3


def test_the_points_themselves_are_the_friction_of_the_example(tmp_path: Path, capsys: Capture) -> None:
    assert answered(capsys, *GIVEN, '--law', 'points', '--scene', AXIS, '--out', tmp_path / 'points.yaml')[0] == 0
    assert load_scene(str(tmp_path / 'points.yaml')).axis == load_scene(str(AXIS)).axis


def test_without_a_scene_it_is_the_axis_of_the_paper(tmp_path: Path, capsys: Capture) -> None:
    for law in ('table', 'gaussian', 'stribeck', 'exponential', 'hyperbolic', 'points'):
        assert answered(capsys, *GIVEN, '--law', law, '--out', tmp_path / f'{law}.yaml')[0] == 0
        scene = load_scene(str(tmp_path / f'{law}.yaml'))
        assert scene.name == 'friction_curve'
        assert scene.axis.mass == 350.0
        assert scene.axis.friction.static.initial == scene.axis.friction.kinetic.coefficient(0.0)


@pytest.mark.parametrize('ending', ['png', 'svg'])
def test_the_picture(ending: str, tmp_path: Path, capsys: Capture) -> None:
    both = tmp_path / 'both.csv'
    both.write_text(CURVE.read_text() + ''.join(f'-{line}\n' for line in CURVE.read_text().splitlines()[2:]))
    assert answered(capsys, 'friction', both, '--speed-unit', 'mm/s', '--plot', tmp_path / f'curve.{ending}')[0] == 0
    assert (tmp_path / f'curve.{ending}').stat().st_size > 20_000


def test_forces_of_both_directions(tmp_path: Path, capsys: Capture) -> None:
    forces = tmp_path / 'forces.csv'
    lines = [line.split(',') for line in CURVE.read_text().splitlines()[2:]]
    forces.write_text('v [m/min];F [N]\n' + ''.join(f'{sign * float(v) * 0.06:.9g};{sign * c * float(mu) * 800:.9g}\n'
                                                    for sign, c in ((1, 1.02), (-1, 0.98)) for v, mu in lines))
    code, out, _ = answered(capsys, 'friction', forces, '--speed-unit', 'm/min', '--force-unit', 'N',
                            '--normal-force', '800')
    assert code == 0
    assert '16 points, 8 forward and 8 backward' in out
    assert 'the directions differ' in out


@pytest.mark.parametrize(('arguments', 'said'), [
    (('--speed-unit', 'furlong'), '--speed-unit = '),
    (('--speed-unit', 'm/s'), 'must be mm/s, as the heading says'),
    (('--speed-unit', 'mm/s', '--scene', AXIS), '--scene and --set are for the scene'),
    (('--speed-unit', 'mm/s', '--out', 'scene.txt'), 'a file ending in .yaml or .yml'),
    (('--speed-unit', 'mm/s', '--plot', 'curve.pdf.txt'), '--plot = '),
    (('--speed-unit', 'mm/s', '--law', 'parabola'), 'parabola'),
    (('--speed-unit', 'mm/s', '--law', 'stribeck', '--direction', 'backward'), '--direction = '),
    ((), '--speed-unit'),
])
def test_wrong_use_is_refused(arguments: tuple[str | Path, ...], said: str, tmp_path: Path, capsys: Capture,
                              monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    assert said in refused(capsys, 'friction', CURVE, *arguments)
    assert list(tmp_path.iterdir()) == []


def test_static_friction_below_the_curve_says_how_to_go_on(tmp_path: Path, capsys: Capture) -> None:
    arguments = (*GIVEN, '--law', 'hyperbolic', '--scene', AXIS, '--out', tmp_path / 'fitted.yaml')
    said = refused(capsys, *arguments)
    assert 'add --set friction.static.initial=0.160933' in said
    assert answered(capsys, *arguments, '--set', 'friction.static.initial=0.160933')[0] == 0


def test_a_law_that_the_points_are_too_few_for(tmp_path: Path, capsys: Capture) -> None:
    few = tmp_path / 'few.csv'
    few.write_text(''.join(f'{line}\n' for line in CURVE.read_text().splitlines()[1:7]))
    assert '--law = ' in refused(capsys, 'friction', few, '--speed-unit', 'mm/s', '--law', 'stribeck')
    code, out, _ = answered(capsys, 'friction', few, '--speed-unit', 'mm/s')
    assert code == 0
    assert 'not fitted: it has too many parameters for these points' in out
