# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""`stickslip check --circle` and `--positioning`: runs of axes in, figures of ISO 230 and a verdict out."""

import json
import math
import re
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import pytest

from benchmarks.glitch_map import CircleAt, glitches
from examples.circle import circle as circle_in_process
from stickslip_sim.bags.schemas import MessageCodec
from stickslip_sim.bags.topics import SLIDER_STATE, recorded_topics
from stickslip_sim.check.circle import circle_outcomes, circular_test, paths_of
from stickslip_sim.check.limits import NominalCircle, limits_of, outcomes_of, positions_of
from stickslip_sim.core.errors import InputError
from stickslip_sim.figures.circular import CircularTest
from stickslip_sim.inputs import load_scene
from stickslip_sim.recording import RecordedRun, RunFacts, read_run, write_bag
from stickslip_sim.recording.messages import SETPOINT, Packer, header
from stickslip_sim.recording.run import open_run, receipt_file
from stickslip_sim.runs import SimulatedRun, simulate
from stickslip_sim.scene import scene_from_values
from stickslip_sim.scene.ros_yaml import read_yaml
from tests.support.check_files import checked, limits_file, refused
from tests.support.repository import ROOT
from tests.support.tool import Capture, done

RADIUS, RATE = 0.05, 5.0                   # m, rad/s
MASS, STIFFNESS, DAMPING = 10.0, 1.0e5, 2.0e3
X, Y = (str(ROOT / 'examples' / f'circle_{axis}.yaml') for axis in 'xy')
CIRCLE, POSITIONS = (str(ROOT / 'examples' / f'{name}_limits.yaml') for name in ('circle', 'positioning'))
DURATION = '7'
GLITCH, REVERSAL = (f'limits: {{{name}: {{max: 1.0}}}}' for name in ('quadrant_glitch', 'reversal_error'))


def linear_axis(name: str, phase: float, stiffness: float = STIFFNESS, turns: float = 2.0) -> SimulatedRun:
    """Return an axis without friction whose drive goes like a sine of the given phase, from its steady state on."""
    values = {'axis.mass': MASS, 'axis.drive_stiffness': stiffness, 'axis.drive_damping': DAMPING,
              'axis.normal_force': 0.0, 'drive.course': 'sine', 'drive.amplitude': RADIUS * RATE,
              'drive.frequency': RATE / (2.0 * math.pi), 'drive.phase': phase}
    scene = scene_from_values(values, name)
    return simulate(scene, round(2.0 * math.pi * turns / RATE, 3), 0.001)


def response(stiffness: float) -> complex:
    """Return what the slider does with the motion of its drive."""
    return (stiffness + 1j * RATE * DAMPING) / (stiffness - MASS * RATE**2 + 1j * RATE * DAMPING)


def circle(*, sense: int = 1, of_y: float = STIFFNESS) -> list[tuple[str, SimulatedRun]]:
    return [('x', linear_axis('x', math.pi)), ('y', linear_axis('y', sense * 0.5 * math.pi, of_y))]


def bag_of_both(folder: Path, runs: list[tuple[str, SimulatedRun]], setpoints: Mapping[str, tuple[str, float]] = {}
                ) -> RecordedRun:
    """Return a bag of two axes; the setpoint of each, with its joint, is so many times the position of the drive."""
    topics = [*(topic for axis in 'xy' for topic in recorded_topics(f'/{axis}')),
              *(SETPOINT.resolved(f'/{axis}') for axis in setpoints)]
    names = [topic.name for topic in topics]
    writer = open_run(folder, RunFacts.of(runs[0][1].scene), topics)
    pack, codec = Packer(SLIDER_STATE).pack, MessageCodec([SETPOINT.type])
    for step, samples in enumerate(zip(*(run.sample_rows() for _, run in runs))):
        time = step * 10**6
        for axis, sample in zip('xy', samples):
            writer.write(names.index(f'/{axis}/slider_state'), pack(time, step, sample), time, time, step)
            if axis in setpoints:
                joint, factor = setpoints[axis]
                writer.write(names.index(f'/{axis}/setpoint'), codec.encode(SETPOINT.type, {
                    'header': header(time), 'name': [joint], 'position': np.array([factor * sample.drive_position]),
                    'velocity': np.zeros(1), 'effort': np.zeros(0)}), time, time, step)
    writer.close(receipt_file({}))
    return read_run(folder)


class TestRuns:
    """The axes are linear: what is left of the start after a turn is exp(-100 s/s)."""

    def test_equal_axes_make_a_circle_that_is_a_little_larger(self) -> None:
        outcomes = {one.name: one.value for one in circle_outcomes(limits_of(read_yaml(
            'limits: {radial_deviation: {max: 1.0}, circular_deviation: {max: 1.0}}')), paths_of(circle()))}
        assert outcomes['radial_deviation'] == pytest.approx(RADIUS * (abs(response(STIFFNESS)) - 1.0), abs=1e-9)
        assert outcomes['circular_deviation'] == pytest.approx(0.0, abs=1e-9)

    def test_the_nominal_circle_is_that_of_the_drives_or_the_one_that_is_given(self) -> None:
        paths = paths_of(circle())
        assert circular_test(paths, NominalCircle()).nominal == pytest.approx((-RADIUS, 0.0, RADIUS), abs=1e-12)
        given = circular_test(paths, NominalCircle(0.04, (-0.05, 0.001)))
        assert given.nominal == (-0.05, 0.001, 0.04)
        assert circular_test(paths, NominalCircle(radius=0.04)).nominal == pytest.approx((-RADIUS, 0.0, 0.04))

    def test_the_nominal_circle_of_closed_loops_is_that_of_their_setpoints(self) -> None:
        """Drives that go ahead of their setpoints by a tenth: the slider's circle is that much too large."""
        runs = [(name, replace(run, setpoint={
            'time': run.samples['time'], 'position': run.samples['drive_position'] / 1.1})) for name, run in circle()]
        found = circular_test(paths_of(runs), NominalCircle())
        assert found.nominal.radius == pytest.approx(RADIUS / 1.1, abs=1e-12)

    @pytest.mark.parametrize('again', ['x', './x/'])
    def test_the_same_run_twice(self, again: str) -> None:
        (_, run), _ = circle()
        with pytest.raises(InputError, match='two runs: this is the same twice'):
            paths_of([('x', run), (again, run)])

    def test_both_senses_and_what_only_they_have(self) -> None:
        soft = 0.5 * STIFFNESS
        paths = paths_of([*circle(of_y=soft), *circle(of_y=soft, sense=-1)])
        limits = limits_of(read_yaml('limits: {bidirectional_circular_deviation: {max: 1.0}, '
                                     'mean_radial_deviation: {max: 1.0}, circular_deviation: {max: 1.0}}'))
        both, mean, single = (float(one.value or 0.0) for one in circle_outcomes(limits, paths))
        x, y = response(STIFFNESS), response(soft)
        skew = np.angle(y / x)   # the axes lag by different times: opposite ellipses in both senses
        axes = np.linalg.svd(RADIUS * np.array([[abs(x), 0.0], [abs(y) * math.sin(skew), abs(y) * math.cos(skew)]]))[1]
        assert single == pytest.approx(axes[0] - axes[1], abs=1e-9)
        assert both >= single
        assert mean == pytest.approx(float(np.mean(axes)) - RADIUS, abs=1e-7)

    def test_a_bag_of_two_axes_is_both(self, tmp_path: Path) -> None:
        runs = circle()
        (path,), (expected,) = paths_of([('both', bag_of_both(tmp_path / 'both', runs))]), paths_of(runs)
        assert path.name == 'both:/x/slider_state, both:/y/slider_state'
        assert (path.actual == expected.actual).all()
        assert (path.commanded == expected.commanded).all()

    def test_the_setpoint_of_each_axis_in_a_bag_of_both(self, tmp_path: Path) -> None:
        """That of y, in another joint, is half as large, and of x there is none from a third node."""
        runs = circle()
        run = bag_of_both(tmp_path / 'both', runs, {'x': ('axis_slider', 2.0), 'y': ('left/axis_slider', 0.5)})
        (path,), (expected,) = paths_of([('both', run)]), paths_of(runs)
        assert path.commanded == pytest.approx(expected.commanded * [2.0, 0.5], abs=1e-15)
        run = bag_of_both(tmp_path / 'one', runs, {'y': ('axis_slider', 0.5)})
        (path,) = paths_of([('one', run)])
        assert path.commanded == pytest.approx(expected.commanded * [1.0, 0.5], abs=1e-15)

    def test_recorded_runs_are_as_simulated_ones(self, tmp_path: Path) -> None:
        runs = circle()
        for name, run in runs:
            write_bag(tmp_path / name, RunFacts.of(run.scene), run.sample_rows(), run.events, {})
        (path,) = paths_of([(name, read_run(tmp_path / name)) for name, _ in runs])
        assert (path.actual == paths_of(runs)[0].actual).all()


class TestTool:
    def test_the_example_and_its_files(self, tmp_path: Path, capsys: Capture) -> None:
        picture, xml, found = (tmp_path / name for name in ('c.png', 'c.xml', 'c.json'))
        out = done(capsys, 'check', '--circle', X, Y, '--duration', '14', '--limits', CIRCLE, '--plot', picture,
                   '--junit', xml, '--json', found)
        text = (ROOT / 'docs' / 'check.md').read_text()
        assert '\n'.join(out.splitlines()[1:-1]) in text
        assert picture.read_bytes().startswith(b'\x89PNG')
        suite = ElementTree.parse(xml).getroot()
        assert (suite.attrib['tests'], suite.attrib['failures']) == ('3', '0')
        circle = json.loads(found.read_text())['circle']
        assert circle['nominal']['radius'] == pytest.approx(RADIUS, rel=1e-12)
        assert [*circle['turns'][0]['quadrant_glitches']] == ['+x', '+y', '-x', '-y']

    def test_friction_opens_the_circle_by_what_it_winds_up(self, capsys: Capture) -> None:
        """In motion each axis is behind by 120 N over 170 N/µm, on one side of a reversal and on the other."""
        code, out, _ = checked(capsys, '--circle', X, Y, '--duration', DURATION, '--json', '-')
        (turn,) = json.loads(out)['circle']['turns']
        behind = 0.003 * 4.0e4 / 1.7e8
        assert code == 0
        assert turn['smallest_radial_deviation'] == pytest.approx(-0.004 / 0.003 * behind, rel=0.2)
        assert turn['circular_deviation'] > 2.0 * behind

    def test_the_map_of_glitches_has_that_of_the_example(self, capsys: Capture) -> None:
        """From a single axis, at fewer times."""
        (glitch,) = glitches([CircleAt(RADIUS, 0.05, 0.0)])
        _, out, _ = checked(capsys, '--circle', X, Y, '--duration', '14', '--json', '-')
        (turn,) = json.loads(out)['circle']['turns']
        assert glitch == pytest.approx(turn['quadrant_glitches']['+x'], rel=0.02)

    def test_the_example_in_process(self) -> None:
        found = circle_in_process('ball_screw', RADIUS, 0.1)
        assert isinstance(found.test, CircularTest)
        assert found.test.is_bidirectional
        assert found.test.nominal.radius == pytest.approx(RADIUS, rel=1e-9)

    def test_a_limit_that_fails(self, tmp_path: Path, capsys: Capture) -> None:
        limits = limits_file(tmp_path, 'limits: {quadrant_glitch: {max: 1.0e-7}, circular_deviation: {max: 1.0e-3}}')
        code, out, err = checked(capsys, '--circle', X, Y, '--duration', DURATION, '--limits', limits)
        assert code == 3
        assert out.splitlines()[-1] == 'FAILED: 1 of 2: quadrant_glitch'
        assert re.search(r'quadrant_glitch .* FAIL  outwards at [+-][xy], counterclockwise', out)
        assert err == f'stickslip: {X}, {Y} does not keep {limits}: quadrant_glitch\n'

    @pytest.mark.parametrize(('text', 'words'), [
        (f'circle: {{radius: -1.0}}\n{GLITCH}', ['circle.radius = -1.0', '> 0']),
        (f'circle: {{centre: [0.0]}}\n{GLITCH}', ['circle.centre = [0.0]', 'two numbers']),
        (f'circle: {{diameter: 0.1}}\n{GLITCH}', ['circle.diameter', 'one of radius, centre']),
        ('limits: {mean_radial_deviation: {max: 1.0}}', ['mean_radial_deviation', 'counterclockwise', 'either sense',
                                                         'OTHER_X']),
        ('limits: {quadrant_glitch: {max: 1.0, window: {begin: first_command}}}', ['no command is known']),
        ('limits: {timing: valid}', ['timing', 'real time']),
    ])
    def test_limits_that_say_nothing(self, text: str, words: list[str], tmp_path: Path, capsys: Capture) -> None:
        refused(capsys, '--circle', X, Y, '--duration', DURATION, '--limits', limits_file(tmp_path, text), words=words)

    def test_axes_at_other_times(self, tmp_path: Path, capsys: Capture) -> None:
        slow = tmp_path / 'y.yaml'
        slow.write_text(Path(Y).read_text() + '    time: {rate: 300.0}\n')
        assert 'states of both axes at the same times' in refused(capsys, '--circle', X, slow, '--duration', '1')


class TestPositioning:
    def test_the_scene_and_its_limits(self, tmp_path: Path, capsys: Capture) -> None:
        out = done(capsys, 'check', 'ball_screw', '--positioning', '--duration', '30', '--limits', POSITIONS, '--json',
                   tmp_path / 'p.json')
        assert 'ISO 230-2: 5 targets' in out
        found = json.loads((tmp_path / 'p.json').read_text())['positioning']
        assert [one['target'] for one in found['targets']] == pytest.approx([0.02, 0.11, 0.205, 0.29, 0.385])
        assert found['reversal_error'] == max(abs(one['reversal']) for one in found['targets'])
        assert 0.0 < found['positioning_repeatability_forward'] < 1e-9 < found['positioning_repeatability'] < 1e-6

    def test_a_stair_by_hand(self) -> None:
        """The slider of an axis without friction comes to its drive: what it lacks of a target is put there."""
        scene = load_scene('positioning', {
            'drive.course': 'position', 'drive.times': [0.0, 0.5, 1.0, 1.5, 2.0, 2.5, 3.0, 3.5],
            'drive.positions': [0.0, 0.01, 0.01, 0.02, 0.02, 0.01, 0.01, 0.0], 'drive.period': 4.0,
            'axis.normal_force': 0.0, 'axis.drive_damping': 4.0e4})
        run = simulate(scene, 8.0)
        text = ('positioning: {targets: [0.0099, 0.02], dwell: 0.3, tolerance: 2.0e-4}\n'
                'limits: {reversal_error: {max: 1.0}, mean_positioning_error: {max: 1.0}}')
        with pytest.raises(InputError, match=r'targets = 0.02 .* 2 moves ended there from below and 0 from above'):
            outcomes_of(limits_of(read_yaml(text)), run)
        limits = limits_of(read_yaml(text.replace(', 0.02]', ']')))
        (position,) = positions_of(limits, run)
        assert (position.mean_forward, position.mean_backward) == pytest.approx((1e-4, 1e-4), abs=1e-5)
        assert outcomes_of(limits, run)[0].value == abs(position.reversal)

    @pytest.mark.parametrize(('text', 'duration', 'words'), [
        ('limits: {positioning_accuracy: {max: 1.0}}', '14', ['positioning_accuracy.targets', 'twice or more']),
        ('limits: {reversal_error: {max: 1.0}}', '4', ['reversal_error.targets = ', 'rests', 'check a longer run']),
        ('limits: {reversal_error: {max: 1.0, dwell: 2.0}}', '14', ['0 rests', 'a shorter dwell']),
        (f'positioning: {{dwell: 0.0}}\n{REVERSAL}', '1', ['positioning.dwell = 0.0', '>= 1e-06']),
        (f'positioning: {{target: 1.0}}\n{REVERSAL}', '1', ['positioning.target', 'one of targets, dwell, tolerance']),
    ])
    def test_refusals(self, text: str, duration: str, words: list[str], tmp_path: Path, capsys: Capture) -> None:
        refused(capsys, 'ball_screw', '--duration', duration, '--limits', limits_file(tmp_path, text), words=words)
