# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""`stickslip friction`: what it prints, draws and writes, and what it refuses."""

import re
from collections.abc import Iterable
from pathlib import Path

import numpy as np
import pytest

from stickslip_sim.identification.curve.measured_curve import FrictionCurve, Units
from stickslip_sim.identification.curve.report import BEST, EACH, fitted_curve, fitted_curves
from stickslip_sim.inputs import load_scene
from stickslip_sim.runs import simulate_events
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


def test_the_picture(tmp_path: Path, capsys: Capture) -> None:
    both = tmp_path / 'both.csv'
    both.write_text(CURVE.read_text() + ''.join(f'-{line}\n' for line in CURVE.read_text().splitlines()[2:]))
    assert answered(capsys, 'friction', both, '--speed-unit', 'mm/s', '--plot', tmp_path / 'curve.svg')[0] == 0
    assert (tmp_path / 'curve.svg').stat().st_size > 20_000


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
    forces.write_text(''.join(forces.read_text().splitlines(keepends=True)[:10]))   # one of them backward
    out = answered(capsys, 'friction', forces, '--speed-unit', 'm/min', '--force-unit', 'N', '--normal-force', '800')[1]
    assert re.search(r'^backward +0\.\d{4} of the curve, mean of 1 point$', out, re.MULTILINE), out


def test_each_direction_gets_its_own_curve(tmp_path: Path, capsys: Capture) -> None:
    both = tmp_path / 'both.csv'
    lines = [line.split(',') for line in CURVE.read_text().splitlines()[2:]]
    both.write_text(''.join(f'{sign * float(v)},{c * float(mu)}\n' for sign, c in ((1, 1.0), (-1, 0.8))
                            for v, mu in lines))
    given = ('friction', both, '--speed-unit', 'mm/s', '--law', 'points')
    ahead, made = tmp_path / 'ahead.yaml', tmp_path / 'made.yaml'
    assert answered(capsys, *given, '--direction', 'forward', '--out', ahead)[0] == 0
    assert answered(capsys, *given, '--backward', '--scene', ahead, '--out', made)[0] == 0
    forwards, backwards = load_scene(str(made)).axis.friction.sides
    assert forwards == load_scene(str(ahead)).axis.friction
    assert backwards.kinetic.coefficients == pytest.approx([0.8 * mu for mu in forwards.kinetic.coefficients], rel=1e-5)
    smooth = (*given[:-1], 'stribeck', '--backward', '--scene', ahead, '--out', tmp_path / 'other.yaml')
    assert '--law = ' in answered(capsys, *smooth)[2]
    assert '--scene' in answered(capsys, *given, '--backward', '--out', tmp_path / 'other.yaml')[2]


def test_the_law_of_both_directions_is_the_best_of_both_together() -> None:
    speeds = np.geomspace(1e-4, 0.1, 12)
    noise = 1e-3 * np.random.default_rng(3).standard_normal(12)
    falling = 0.1 + 0.1 * np.exp(-(speeds / 5e-3)**2)
    both = FrictionCurve(np.tile(speeds, 2), np.concatenate([0.1 + 0.3 * speeds + noise, falling]),
                         np.repeat([True, False], 12))
    units = Units('m/s')
    found = fitted_curves('both', both, units, EACH, BEST)
    alone = [fitted_curve('both', both.chosen(one), units, BEST).chosen.name for one in ('forward', 'backward')]
    assert alone == ['table', 'gaussian']
    assert [one.chosen.name for one in found] == ['gaussian', 'gaussian']
    assert [one.kinetic['law'] for one in found] == ['stribeck', 'stribeck']


@pytest.mark.parametrize(('arguments', 'said'), [
    (('--speed-unit', 'furlong'), '--speed-unit = '),
    (('--speed-unit', 'm/s'), 'must be mm/s, as the heading says'),
    (('--speed-unit', 'mm/s', '--scene', AXIS), '--scene and --set need --out'),
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
    few = written(tmp_path, FALLING[:6])
    said = refused(capsys, 'friction', few, '--speed-unit', 'mm/s', '--law', 'exponential')
    assert 'at most 3 parameters for these points: AICc wants 3 points more' in said
    code, out, _ = answered(capsys, 'friction', few, '--speed-unit', 'mm/s')
    assert code == 0
    assert 'not fitted: AICc wants 3 points more than a law has parameters' in out


FALLING = ((0.5, 0.158), (1.2, 0.147), (2.9, 0.13), (7.1, 0.11), (17.0, 0.094), (41.0, 0.083), (100.0, 0.076))


def written(folder: Path, points: Iterable[tuple[float, float]]) -> Path:
    """Return a file of points."""
    path = folder / 'points.csv'
    path.write_text(''.join(f'{speed},{friction}\n' for speed, friction in points))
    return path


def test_a_best_law_that_misses_the_points_is_warned_of(tmp_path: Path, capsys: Capture) -> None:
    few = written(tmp_path, FALLING[:6])
    code, out, _ = answered(capsys, 'friction', few, '--speed-unit', 'mm/s', '--out', tmp_path / 'few.yaml')
    assert code == 0
    assert re.search(r'WARNING: table misses the points by 3\d % of their range', out)
    assert 'no pattern' not in out
    assert re.search(r'3\d % of the range of the points', load_scene(str(tmp_path / 'few.yaml')).summary)
    _, out, _ = answered(capsys, 'friction', written(tmp_path, FALLING), '--speed-unit', 'mm/s')
    assert 'best: hyperbolic' in out
    assert 'not best, for all its lower AICc: table' in out
    assert 'WARNING' not in out


def test_a_curve_without_a_point_at_rest_says_from_where_it_is_extrapolated(tmp_path: Path, capsys: Capture) -> None:
    fast = written(tmp_path, ((5, 0.11), (7, 0.102), (10, 0.095), (15, 0.088), (20, 0.084), (30, 0.08), (50, 0.078),
                              (70, 0.077), (100, 0.076)))
    _, out, _ = answered(capsys, 'friction', fast, '--speed-unit', 'mm/s')
    assert re.search(r'initial +0\.18\d+ +none: extrapolated, no point below 0\.005 m/s', out)
    assert 'is extrapolated: the slowest point is 0.005 m/s, the highest measured coefficient 0.11' in out
    assert 'extrapolated' not in answered(capsys, *GIVEN)[1]


def test_the_scene_has_the_normal_force_of_the_measurement(tmp_path: Path, capsys: Capture) -> None:
    forces = written(tmp_path, ((speed, 1200.0 * friction) for speed, friction in FALLING))
    given = ('friction', forces, '--speed-unit', 'mm/s', '--force-unit', 'N', '--normal-force', '1200',
             '--out', tmp_path / 'made.yaml')
    assert answered(capsys, *given)[0] == 0
    assert load_scene(str(tmp_path / 'made.yaml')).values['axis.normal_force'] == 1200.0
    other = (*given, '--scene', 'paper_fig8', '--set', 'friction.static.initial=0.2', '--set',
             'friction.static.limit=0.2')
    assert '--set axis.normal_force=1200.0' in refused(capsys, *other)
    assert answered(capsys, *other, '--set', 'axis.normal_force=3432.3275')[0] == 0
    assert load_scene(str(tmp_path / 'made.yaml')).values['axis.normal_force'] == 3432.3275


def test_the_command_that_it_names_next_works(tmp_path: Path, capsys: Capture) -> None:
    made = tmp_path / 'made.yaml'
    _, out, _ = answered(capsys, *GIVEN, '--out', made)
    assert f'stickslip critical {made} --of drive.velocity\n' in out
    assert 'the drive at 0.007 m/s, in the middle of the measured speeds' in out
    assert answered(capsys, 'critical', made, '--of', 'drive.velocity')[0] == 0
    sine = ('--set', 'drive.course=sine', '--set', 'drive.amplitude=0.01', '--set', 'drive.frequency=1.0')
    code, out, _ = answered(capsys, *GIVEN, '--out', made, *sine)
    assert (code, 'in the middle' in out) == (0, False)


def test_the_points_report_on_the_table_that_is_written(capsys: Capture) -> None:
    _, out, _ = answered(capsys, *GIVEN, '--law', 'points')
    assert 'a table of 9 breakpoints, joined by straight segments: not fitted' in out
    assert '95 % interval' not in out


def test_a_critical_feed_about_none_says_what_to_give(tmp_path: Path, capsys: Capture) -> None:
    made = tmp_path / 'made.yaml'
    _, out, _ = answered(capsys, *GIVEN, '--set', 'drive.velocity=0.0', '--out', made)
    assert 'of drive.velocity --between LOW:HIGH, as its drive.velocity is 0' in out
    said = refused(capsys, 'critical', made, '--of', 'drive.velocity')
    assert '--between is missing: must be given for drive.velocity' in said
    assert 'add --between LOW:HIGH, or --set drive.velocity=…' in said
