# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Many closed loops: each point is the loop that it names, resumed studies and vectorized ones have the same bits."""

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy.stats import binomtest

import stickslip_sim as stickslip
from stickslip_sim.closed_loop.many import ClosedLoops
from stickslip_sim.closed_loop.report import loops_report
from stickslip_sim.controllers.own_controller import Command, Measurement
from stickslip_sim.core.errors import InputError
from stickslip_sim.recording import read_run
from stickslip_sim.report.text import text_lines
from stickslip_sim.study import Sobol
from stickslip_sim.study.sweep import WorkerError
from tests.support.tool import Capture, answered, refused

pytestmark = pytest.mark.slow

DURATION = 0.4
SCENE: dict[str, Any] = {'drive.course': 'constant', 'drive.velocity': 0.0, 'encoder.resolution': 1e-7}
OVER: dict[str, Any] = {'friction.scale': (0.7, 1.3), 'axis.drive_stiffness': '3e5:1e6:log'}
GAINS: dict[str, Any] = {'gain': (2.0, 20.0), 'feed': 1.0}
LIMITS = 'limits:\n  following_error: {max: 1.25e-3}\n  sticks: {max: 1}\n'
SOURCE = '''
import os
import numpy as np

class Simple:
    def __init__(self, gain=10.0, feed=1.0, limit=0.05):
        self.gain, self.feed, self.limit = gain, feed, limit
    def __call__(self, t, measured):
        position, velocity = measured.setpoint
        wanted = self.feed * velocity + self.gain * (position - measured.slider_position)
        return min(max(wanted, -self.limit), self.limit)

class Picky(Simple):
    def __call__(self, t, measured):
        if self.gain > 10.0 and t > 0.1:
            raise RuntimeError('too high a gain')
        return super().__call__(t, measured)

class Deadly(Simple):
    def __call__(self, t, measured):
        os._exit(7)
'''


def setpoint(t: float) -> tuple[float, float]:
    return 0.004 * t, 0.004


class Simple:
    def __init__(self, gain: float = 10.0, feed: float = 1.0, limit: float = 0.05) -> None:
        self.gain, self.feed, self.limit = gain, feed, limit

    def reset(self) -> None:
        self.asked = 0

    def __call__(self, t: float, measured: Measurement) -> float:
        self.asked += 1
        assert measured.setpoint is not None
        wanted = self.feed * measured.setpoint.velocity + self.gain * (measured.setpoint.position
                                                                       - measured.slider_position)
        return min(max(wanted, -self.limit), self.limit)


class Lanes(Simple):
    """The same on arrays, with a force."""

    def __call__(self, t: float, measured: Any) -> Any:
        wanted = self.feed * measured.setpoint.velocity + self.gain * (measured.setpoint.position
                                                                       - measured.slider_position)
        return Command(np.clip(wanted, -self.limit, self.limit), 10.0 * np.sign(measured.slider_velocity))


class Failing(Lanes):
    """Answers no number, or raises, where the gain is high."""

    def __call__(self, t: float, measured: Any) -> Any:
        answer = super().__call__(t, measured)
        if t < 0.1:
            return answer
        if (np.asarray(self.gain) > 19.0).any():
            raise RuntimeError('far too high')
        return answer._replace(velocity=np.where(np.asarray(self.gain) > 12.0, np.nan, answer.velocity))


def loops(controller: Any = Simple, changes: dict[str, Any] | None = None, **options: Any) -> ClosedLoops:
    scene = stickslip.load_scene('positioning', {**SCENE, **(changes or {})})
    given = {'over': OVER, 'samples': 8, 'setpoint': setpoint, 'gains': GAINS, **options}
    return stickslip.close_loops(controller, scene, DURATION, **given)


def same(first: ClosedLoops, second: ClosedLoops) -> bool:
    return first.columns.keys() == second.columns.keys() and all(
        np.array_equal(first.columns[name], second.columns[name], equal_nan=True) for name in first.columns)


@pytest.fixture
def limits(tmp_path: Path) -> str:
    (tmp_path / 'limits.yaml').write_text(LIMITS)
    return str(tmp_path / 'limits.yaml')


@pytest.fixture
def source(tmp_path: Path) -> Path:
    (tmp_path / 'my_many_controllers.py').write_text(SOURCE)
    return tmp_path / 'my_many_controllers.py'


def test_a_point_is_the_closed_loop_of_its_scene_to_the_bit(limits: str) -> None:
    changes = {'faults.ids': ['a'], 'faults.kinds': ['encoder_dropout'], 'faults.starts': [0.1],
               'faults.durations': [0.1], 'faults.values': [0.5], 'seed': 3}
    found = loops(changes=changes, over={**OVER, 'encoder.delay': (0.0, 0.004), 'faults.values[0]': (0.1, 0.9)},
                  limits=limits)
    for i in range(0, found.study.count, 3):
        point = found.point(i)
        scene = stickslip.load_scene('positioning', {
            **SCENE, **changes, **{name: value for name, value in point.items() if not name.startswith('gain.')
                                   and '[' not in name}, 'faults.values': [point['faults.values[0]']]})
        run = stickslip.close_loop(Simple(point['gain.gain'], 1.0), scene, DURATION, setpoint=setpoint)
        again = found.run(i)
        for name in run.samples:
            assert np.array_equal(run.samples[name], again.samples[name], equal_nan=True)
        checked = run.check(limits)
        assert [found.columns[one.name][i] for one in checked.outcomes] == [one.value for one in checked.outcomes]
        assert (found.outcomes[i] == 'passed') == checked.passed == bool(found.matrix[i].all())
        error = np.abs(run.samples['position'] - run.setpoint['position'])
        assert found.columns['largest_error'][i] == error.max()
        assert found.columns['rms_error'][i] == pytest.approx(np.sqrt(np.mean(error**2)), rel=1e-12)


def test_the_pass_rate_the_worst_and_the_percentiles_are_those_of_the_table(limits: str) -> None:
    found = loops(limits=limits, samples=16)
    passed = sum(word == 'passed' for word in found.outcomes)
    assert 0 < passed < 16
    interval = binomtest(passed, 16).proportion_ci(0.95, 'wilson')
    assert found.pass_rate == (passed, 16, interval.low, interval.high)
    errors = found.columns['following_error']
    assert errors[found.worst['following_error']] == errors.max()
    assert found.percentiles['following_error'] == dict(zip((5, 25, 50, 75, 95),
                                                            np.percentile(errors, (5, 25, 50, 75, 95))))
    assert found.matrix.sum(axis=0).tolist() == [(errors <= 1.25e-3).sum(), (found.columns['sticks'] <= 1).sum()]


def test_the_worst_of_a_limit_from_below_is_the_least(tmp_path: Path) -> None:
    file = tmp_path / 'creep.yaml'
    file.write_text('limits:\n  creep: {check: lowest_speed, min: 1.0e-5, window: {begin: 0.3}}\n')
    found = loops(limits=file, samples=8)
    speeds = found.columns['creep']
    assert speeds.min() < 1e-5 < speeds.max()
    assert speeds[found.worst['creep']] == speeds.min()
    assert found.matrix[:, 0].tolist() == (speeds >= 1e-5).tolist()
    assert any('at least 10 µm/s' in line for line in text_lines(loops_report(found)))


def test_a_grid_runs_every_combination() -> None:
    found = loops(over={'friction.scale': (0.8, 1.2, 3)}, gains={'gain': '2:8:2'}, samples=None)
    assert found.columns['friction.scale'].tolist() == [0.8, 0.8, 1.0, 1.0, 1.2, 1.2]
    assert found.columns['gain.gain'].tolist() == [2.0, 8.0] * 3
    assert set(found.outcomes) == {'passed'}


def test_distributions_come_first_and_keep_their_correlation(tmp_path: Path) -> None:
    path = tmp_path / 'posterior.yaml'
    path.write_text("""seed: 4
parameters:
  axis.mass: {distribution: normal, mean: 350.0, standard_deviation: 10.0, between: [310.0, 390.0]}
  axis.drive_damping: {distribution: uniform, low: 3000.0, high: 5000.0}
correlations: {axis.mass: {axis.drive_damping: 0.95}}
""")
    given: dict[str, Any] = {'over': {}, 'known': path, 'gains': {'gain': (2.0, 20.0)}, 'out': tmp_path / 'out'}
    first = loops(**given, samples=4)
    assert same(first, loops(**given, samples=4, resume=True))
    study = loops(**{**given, 'out': None}, samples=64, setpoint=lambda _: 0.0).study
    assert study.names == ('axis.mass', 'axis.drive_damping', 'gain.gain')
    assert isinstance(study.sample, Sobol)
    assert study.sample.seed == 4
    together = np.corrcoef(study.points(0, 64).T)
    assert together[0, 1] > 0.85
    assert abs(together[0, 2]) < 0.3
    assert np.array_equal(np.concatenate([study.points(0, 40), study.points(40, 64)]), study.points(0, 64))


@pytest.mark.parametrize('changes', [
    {}, {'encoder.resolution': 0.0}, {'encoder.noise': 1e-7, 'encoder.velocity_steps': 4, 'encoder.offset': 1e-5},
    {'command.velocity_limit': 0.005, 'contact.model': 'rigid'}])
def test_vectorized_it_is_the_same_to_the_bit(changes: dict[str, Any], limits: str) -> None:
    """Each point that a controller on arrays makes of many is the one that it makes of one axis alone."""
    if changes.get('contact.model') == 'rigid':
        changes = {**changes, 'contact.stiffness': None, 'contact.damping': None}
    over = {**OVER, 'encoder.delay': (0.0, 0.003)}
    for given in (limits, None):
        many = loops(Lanes, changes, over=over, rate=250.0, vectorized=True, limits=given)
        alone = [many.attempt(i) for i in range(many.study.count)]
        for i, attempt in enumerate(alone):
            assert attempt.run is not None
            assert many.study.words[float(attempt.outcome)] == many.outcomes[i]
            error = np.abs(attempt.run.samples['position'] - attempt.run.setpoint['position'])
            assert many.columns['largest_error'][i] == error.max()
            assert [one.value for one in attempt.limits] == [many.columns[one.name][i] for one in attempt.limits]


def test_vectorized_and_written_for_one_axis_agree(limits: str) -> None:
    class Plain(Lanes):
        def __call__(self, t: float, measured: Any) -> Any:
            answer = super().__call__(t, measured)
            return Command(float(answer.velocity), float(answer.force))

    assert same(loops(Plain, limits=limits), loops(Lanes, limits=limits, vectorized=True))


def test_a_point_that_fails_counts_as_failed_and_the_rest_goes_on(limits: str) -> None:
    found = loops(Failing, vectorized=True, limits=limits, samples=16)
    gains = found.columns['gain.gain']
    assert [word == 'controller failed' for word in found.outcomes] == (gains > 12.0).tolist()
    assert (found.columns['until'][gains > 12.0] == 0.1).all()
    assert np.isnan(found.columns['following_error']).tolist() == (gains > 12.0).tolist()
    assert found.pass_rate.points == 16
    for i, reason in found.reasons.items():
        assert 't = 0.1 s' in reason
        assert ('far too high' in reason) == (gains[i] > 19.0)


def test_interrupted_and_resumed_it_is_the_same_table(source: Path, limits: str, tmp_path: Path) -> None:
    controller = f'{source}:Picky'
    whole = loops(controller, limits=limits, out=tmp_path / 'whole')

    def interrupt(share: float) -> None:
        if share < 1.0:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt, match='--resume goes on'):
        loops(controller, limits=limits, out=tmp_path / 'parts', progress=interrupt)
    assert not (tmp_path / 'parts' / 'points.csv').exists()
    resumed = loops(controller, limits=limits, out=tmp_path / 'parts', resume=True, workers=2)
    assert resumed.ran < 8
    assert same(whole, resumed)
    for name in ('points.csv', 'result.json'):
        assert (tmp_path / 'whole' / name).read_bytes() == (tmp_path / 'parts' / name).read_bytes()
    assert 'controller failed' in whole.outcomes
    reasons = json.loads((tmp_path / 'whole' / 'result.json').read_text())['reasons']
    assert all('RuntimeError: too high a gain (my_many_controllers.py, line 16), asked after step 101' in one['reason']
               for one in reasons.values())
    worst = read_run(tmp_path / 'whole' / 'worst' / 'following_error')
    run = whole.run(whole.worst['following_error'])
    assert np.array_equal(worst.samples['position'], run.samples['position'])
    assert {path.name for path in (tmp_path / 'whole').iterdir()} >= {'map.png', 'worst', 'study.json'}
    source.write_text(SOURCE + '# another\n')
    with pytest.raises(InputError, match='its controller_digest is another'):
        loops(controller, limits=limits, out=tmp_path / 'parts', resume=True)


def test_what_is_never_reached_is_resumed_and_ranked(source: Path, tmp_path: Path) -> None:
    file = tmp_path / 'settled.yaml'
    file.write_text('limits: {move_settling_time: {band: 2.0e-5, max: 0.05}}\n')
    given: dict[str, Any] = {'limits': file, 'out': tmp_path / 'out', 'setpoint': lambda t: min(0.004 * t, 0.0008)}
    found = loops(f'{source}:Simple', **given)
    times = found.columns['move_settling_time']
    assert np.isinf(times).any()
    assert not np.isinf(times).all()
    percentiles = found.percentiles['move_settling_time']
    assert percentiles is not None
    assert not np.isnan(list(percentiles.values())).any()
    assert percentiles[95] == np.inf
    again = loops(f'{source}:Simple', **given, resume=True)
    assert again.ran == 0
    assert same(found, again)


def test_a_worker_that_dies_is_one_line(source: Path) -> None:
    with pytest.raises(WorkerError, match='a worker process ended with exit code 7'):
        loops(f'{source}:Deadly', workers=2)


@pytest.mark.parametrize(('options', 'said'), [
    ({'over': {'friction.scael': (1.0, 2.0)}}, 'did you mean friction.scale'),
    ({'over': {'time.rate': (100.0, 200.0)}}, 'time.rate'), ({'over': {}, 'gains': {}}, 'over is missing'),
    ({'over': {'friction.scale': (1.2, 0.8)}}, 'swap the two'), ({'over': {'friction.scale': 1.0}}, 'LOW, HIGH'),
    ({'over': {'axis.mass': (-1.0, 3.0)}}, 'axis.mass'), ({'samples': 0}, 'samples = 0'),
    ({'samples': None}, 'LOW:HIGH:N'), ({'controller': lambda t, measured: 0.0, 'gains': {}, 'workers': 2}, 'FILE.py'),
    ({'gains': {'gian': (1.0, 2.0)}}, 'unexpected keyword'), ({'workers': 0}, 'workers'),
    ({'workers': 1.5}, 'workers = 1.5'), ({'rate': 300.0}, 'rate'), ({'limits': 'no.yaml'}, 'no.yaml'),
    ({'vectorized': True, 'changes': {'command.timeout': 0.1}}, 'command.timeout'),
    ({'vectorized': True, 'over': {'command.acceleration_limit': (1.0, 2.0)}}, 'command.acceleration_limit')])
def test_wrong_use_gets_one_line(options: dict[str, Any], said: str) -> None:
    with pytest.raises(InputError, match='must be') as error:
        loops(**options)
    assert said in str(error.value)
    assert '\n' not in str(error.value)


def test_a_vectorized_answer_of_another_shape_is_refused() -> None:
    class Wide(Lanes):
        def __call__(self, t: float, measured: Any) -> Any:
            return np.zeros(3)

    with pytest.raises(stickslip.ControllerError, match=r'shape \(3,\); must be an array of shape \(8,\)'):
        loops(Wide, vectorized=True)


def test_the_verb_writes_a_folder_and_judges(source: Path, limits: str, tmp_path: Path, capsys: Capture) -> None:
    (tmp_path / 'move.csv').write_text('time,position\n0,0\n2,0.008\n')
    given: list[str | Path] = [
             'close-loop', f'{source}:Simple', '--scene', 'positioning', '--duration', str(DURATION), '--setpoint',
             tmp_path / 'move.csv', '--set', 'encoder.resolution=1e-7', '--over', 'friction.scale=0.7:1.3', '--gain',
             'gain=2:20', '--gain', 'limit=0.04', '--samples', '6', '--limits', limits]
    code, out, err = answered(capsys, *given, '--out', tmp_path / 'out', '--plot', tmp_path / 'map.svg')
    assert (code, err.count('\n')) == (3, 1)
    assert 'do not pass' in err
    assert 'with 95 % confidence' in out
    assert 'the same noise' not in out
    found = json.loads((tmp_path / 'out' / 'result.json').read_text())
    assert found['points'] == 6
    assert set(found['limits']) == {'following_error', 'sticks'}
    assert (tmp_path / 'map.svg').stat().st_size > 1000
    code, again, _ = answered(capsys, *given, '--out', tmp_path / 'out', '--resume')
    assert (code, again.splitlines()[1:-1]) == (3, out.splitlines()[1:-1])
    assert '0 run now' in again
    assert 'a folder that does not exist' in refused(capsys, *given, '--out', tmp_path / 'out')
    assert 'needs --over' in refused(capsys, *given[:8], '--samples', '4')


def test_all_points_have_the_noise_of_the_scene(source: Path, tmp_path: Path, capsys: Capture) -> None:
    """Axes that are the same, to the last bit, under a controller that hands on what it measures."""
    (tmp_path / 'own.py').write_text('def echo(t, measured):\n    return 1e3 * measured.slider_position\n')
    code, out, _ = answered(
        capsys, 'close-loop', f'{tmp_path}/own.py:echo', '--scene', 'positioning', '--duration', '0.1', '--over',
        'command.max_force=1e3:1e4:2', '--set', 'encoder.noise=1e-6', '--set', 'seed=7', '--out', tmp_path / 'out')
    assert code == 0
    assert 'note: all points have the seed of the scene, 7: the same noise, losses and scatter' in out
    one, other = (loops(f'{tmp_path}/own.py:echo', over={'command.max_force': (1e3, 1e4, 2)}, samples=None, gains={},
                        changes={'encoder.noise': 1e-6}).run(i) for i in (0, 1))
    assert one.measured['slider_position'].any()
    assert np.array_equal(one.measured['slider_position'], other.measured['slider_position'])
