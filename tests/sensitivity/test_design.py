# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The experiment that would narrow parameters most: what a run says of them, the feeds, and the tool."""

import json
import math
from pathlib import Path

import numpy as np
import pytest

from stickslip_sim.inputs import load_scene
from stickslip_sim.report.text import text_lines
from stickslip_sim.runs import simulate_events
from stickslip_sim.scene import changed
from stickslip_sim.sensitivity.experiments import Wishes, default_speeds, designed, feeds
from stickslip_sim.sensitivity.information import Sensors, covariance_after, run_slopes
from stickslip_sim.sensitivity.report import feed_table, scene_file
from stickslip_sim.sensitivity.sensitivities import sensitivities
from tests.support.repository import ROOT
from tests.support.tool import Capture, answered, refused

SCENE = load_scene('paper_fig7')
SENSORS = Sensors(rate=100.0, resolution=1e-6, noise=0.0, force_noise=None)
NAMES = ('friction.static.time_constant', 'friction.static.limit')


def wishes(**changes: object) -> Wishes:
    given = {'parameters': NAMES, 'duration': 4.0, 'speeds': (2e-4, 2e-2), 'sensors': SENSORS, 'known': 0.3,
             'scatter': 0.01, 'travel': math.inf, 'criterion': 'D', **changes}
    return Wishes(**given)  # type: ignore[arg-type]


def test_slopes_are_the_sensitivities_of_samples() -> None:
    times = np.array([0.5, 0.71, 1.39])
    found = run_slopes(SCENE, list(NAMES), times, ['position', 'drive_force'])
    for channel, slopes in found.by_channel.items():
        same = sensitivities(SCENE, [f'{channel}@{time!r}' for time in times.tolist()], NAMES)
        assert pytest.approx(same.derivatives * same.numbers, rel=1e-5, abs=1e-12) == slopes.T
    assert found.until == math.inf


def test_the_covariance_of_one_reading_in_closed_form() -> None:
    """Known to k before, with the deviation s and the slope j: 1/(1/k² + j²/(s² + n ε² j²))."""
    found = run_slopes(SCENE, ['friction.static.limit'], np.array([0.71]), ['position'])
    slope = float(found.by_channel['position'][0, 0])
    assert found.slips == 0
    for scatter in (0.0, 0.01):
        variance = 1.0 / (1.0 / 0.3**2 + slope**2 / (1e-5**2 + scatter**2 * slope**2))
        assert covariance_after(found, {'position': 1e-5}, 0.3, scatter) == pytest.approx(variance, rel=1e-12)


def test_readings_from_a_change_of_the_sequence_on_say_nothing() -> None:
    """The slip grazes a breakpoint of the table, just above its peak speed."""
    peak = max(event.velocity for event in simulate_events(SCENE, 1.0).events)
    grazing = changed(SCENE, {'friction.kinetic.velocities': [0.0, peak * (1.0 + 1e-7), 0.035],
                              'friction.kinetic.coefficients': [0.12, 0.12 - 2.0 * peak * (1.0 + 1e-7), 0.05]})
    times = np.arange(1, 101) / 100.0
    found = run_slopes(grazing, ['friction.static.limit'], times, ['position'])
    slopes = found.by_channel['position'][0]
    assert found.until == pytest.approx(0.75, abs=0.1)
    assert np.any(slopes[times < found.until] != 0.0)
    assert np.all(slopes[times >= found.until] == 0.0)


def test_the_best_feed_narrows_more_than_that_of_the_scene() -> None:
    found = designed(SCENE, wishes())
    own = next(one for one in found.experiments if one.feed.drive == {})
    assert found.best.score < 0.7 * own.score
    assert [one.score for one in found.experiments] == sorted(one.score for one in found.experiments)
    kinds = [one.feed.kind for one in found.best_of_kinds]
    assert found.best_of_kinds[0] is found.best
    assert len(kinds) == len(set(kinds)) == 8
    for one in found.experiments:   # friction that scatters limits every run
        assert np.all(one.deviations >= 0.01 / math.sqrt(max(one.slopes.slips, 1)) * 0.99)
        assert np.all(one.deviations <= 0.3 * (1.0 + 1e-9))


def test_a_run_in_which_nothing_slips_says_nothing() -> None:
    found = designed(SCENE, wishes(speeds=(1e-6, 2e-6), duration=1.0))
    still = next(one for one in found.experiments if one.feed.kind == 'constant')
    assert still.deviations == pytest.approx([0.3, 0.3])


def test_the_page_has_what_the_tool_prints() -> None:
    names = (*NAMES, 'friction.static.initial')
    found = designed(SCENE, wishes(parameters=names, duration=10.0, sensors=Sensors(1000.0, 1e-6, 0.0, None)))
    page = (ROOT / 'docs' / 'sensitivities.md').read_text(encoding='utf-8')
    for row in [*text_lines([feed_table(found)])][:4]:
        assert any(line.split() == row.split() for line in page.splitlines()), row


def test_every_feed_is_a_scene_that_runs() -> None:
    speeds = default_speeds(SCENE)
    assert speeds == pytest.approx((2e-4, 2e-2))
    found = feeds(speeds, 2.0)
    assert len({feed.name for feed in found}) == len(found)
    for feed in found:
        simulate_events(feed.scene(SCENE), 2.0)


def test_the_experiment_keeps_the_solver_of_the_scene() -> None:
    stepped = changed(SCENE, {'solver.name': 'fixed_step', 'solver.step': 1e-4})
    found = designed(stepped, wishes(duration=1.0))
    assert 'name: fixed_step' in scene_file(found)


def test_the_way_of_the_drive_is_kept() -> None:
    found = designed(SCENE, wishes(travel=0.01))
    assert all(one.travel <= 0.01 for one in found.experiments)
    assert found.left_out
    assert all('its drive goes' in reason for _, reason in found.left_out)


def test_the_tool_writes_a_scene_that_runs_and_one_page(capsys: Capture, tmp_path: Path) -> None:
    out = tmp_path / 'experiment'
    code, said, error = answered(capsys, 'design', 'paper_fig7', '--for', ','.join(NAMES), '--duration', '4', '--rate',
                                 '100', '--force-noise', '30', '--criterion', 'A', '--out', out)
    assert (code, error) == (0, '')
    assert said.splitlines()[0].split() == ['feed', 'A-optimal', *NAMES, 'travel']
    assert {path.name for path in out.iterdir()} == {'experiment.yaml', 'report.html', 'report.json', 'experiment.svg',
                                                     'experiment.png'}
    values = json.loads((out / 'report.json').read_text())
    best = values['experiments'][0]
    assert said.splitlines()[1].startswith(best['feed'])
    assert load_scene(out / 'experiment.yaml').values['drive.course'] == best['drive']['course']
    assert best['feed'] in (out / 'report.html').read_text()
    code, said, _ = answered(capsys, 'simulate', out / 'experiment.yaml', '--duration', '4')
    assert code == 0


@pytest.mark.parametrize(('options', 'words'), [
    (['--for', 'friction.static.limt'], 'did you mean friction.static.limit?'),
    (['--for', 'drive.velocity'], 'its feed is what is proposed'),
    (['--for', 'initial.stretch'], 'other than 0'),
    (['--for', 'axis.mass,axis.mass'], 'each once'),
    (['--for', ''], "parameter = '' is refused"),
    (['--speeds', '2'], 'two numbers in m/s'),
    (['--speeds', '2:1'], '0 < LOW < HIGH'),
    (['--duration', '-1'], '--duration = -1.0 is refused'),
    (['--duration', 'nan'], '--duration = nan is refused'),
    (['--rate', '1e-3'], 'readings in'),
    (['--resolution', '0'], 'no reading is exact'),
    (['--noise', '-1e-6'], '--noise = -1e-06 is refused'),
    (['--force-noise', '0'], '--force-noise = 0.0 is refused'),
    (['--known', '0'], '--known = 0.0 is refused'),
    (['--scatter', '2'], '--scatter = 2.0 is refused'),
    (['--travel', '1e-9'], 'such that a feed is left'),
    (['--set', 'drive.velocity=0.0'], '--speeds is missing'),
])
def test_refused(capsys: Capture, tmp_path: Path, options: list[str], words: str) -> None:
    wanted = [] if '--for' in options else ['--for', 'axis.mass']
    shorter = [] if {'--duration', '--rate'} & set(options) else ['--duration', '1', '--rate', '10']
    out = tmp_path / 'experiment'
    assert words in refused(capsys, 'design', 'paper_fig7', *wanted, *options, *shorter, '--out', out)
    assert not out.exists()
