# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Derivatives of a run: against closed forms, against the reference, and where there are none."""

import json
import math
import re
from collections.abc import Callable
from pathlib import Path
from textwrap import indent

import mpmath
import numpy as np
import pytest
from numpy.typing import NDArray

from stickslip_sim.core.errors import InputError
from stickslip_sim.core.types import EventKind
from stickslip_sim.inputs import load_scene
from stickslip_sim.reference import simulate
from stickslip_sim.report.text import text_lines
from stickslip_sim.runs import simulate_events
from stickslip_sim.scene import Scene, changed
from stickslip_sim.sensitivity.experiments import Wishes, default_speeds, designed, feeds
from stickslip_sim.sensitivity.information import Sensors, covariance_after, run_slopes
from stickslip_sim.sensitivity.moved_number import STENCILS, Stencil
from stickslip_sim.sensitivity.report import feed_table, scene_file
from stickslip_sim.sensitivity.sensitivities import Sensitivities, sensitivities
from stickslip_sim.study.in_memory import sweep
from tests.support.repository import ROOT
from tests.support.tool import Capture, answered, refused

CONSTANT = {'friction.static.law': 'constant', 'friction.static.initial': 0.2, 'axis.drive_damping': 0.0,
            'friction.kinetic.velocities': [0.0], 'friction.kinetic.coefficients': [0.12]}
NAMES = {'mass': 'axis.mass', 'stiffness': 'axis.drive_stiffness', 'normal_force': 'axis.normal_force',
         'static': 'friction.static.initial', 'kinetic': 'friction.kinetic.coefficients[0]',
         'velocity': 'drive.velocity'}


def constant_friction(**changes: object) -> Scene:
    """The scene whose events are known in closed form: rigid contact, constant mu_s and mu_k, no damper."""
    return changed(load_scene('paper_fig4_constant'), {**CONSTANT, **changes})


def break_away(*, stiffness: float, normal_force: float, static: float, velocity: float, **_: float) -> mpmath.mpf:
    return normal_force * static / (stiffness * velocity)


def arrest(*, mass: float, stiffness: float, normal_force: float, static: float, kinetic: float, velocity: float
           ) -> mpmath.mpf:
    """The slip goes round the circle of its phase plane, from the speed of the drive behind back to it."""
    frequency = mpmath.sqrt(stiffness / mass)
    ratio = frequency * normal_force * (static - kinetic) / (stiffness * velocity)
    return (break_away(stiffness=stiffness, normal_force=normal_force, static=static, velocity=velocity)
            + 2.0 * (mpmath.pi - mpmath.atan(ratio)) / frequency)


def peak_speed(*, mass: float, stiffness: float, normal_force: float, static: float, kinetic: float, velocity: float
               ) -> float:
    return velocity + math.hypot(velocity, normal_force * (static - kinetic) / math.sqrt(stiffness * mass))


def numbers(scene: Scene) -> dict[str, float]:
    return {key: sensitivities(scene, ['event.1.time'], [name]).numbers[0] for key, name in NAMES.items()}


@pytest.mark.parametrize(('figure', 'form'), [('breakaway.1.time', break_away), ('stick.1.time', arrest)])
def test_events_of_constant_friction_are_those_of_the_closed_form(figure: str, form: Callable[..., mpmath.mpf]
                                                                  ) -> None:
    scene = constant_friction()
    found = sensitivities(scene, [figure], NAMES.values())
    given = numbers(scene)
    assert found.values[0] == pytest.approx(float(form(**given)), rel=1e-14)
    for k, key in enumerate(NAMES):
        with mpmath.workdps(40):
            exact = float(mpmath.diff(lambda value, key=key: form(**{**given, key: value}), given[key]))
        assert abs(found.derivatives[0, k] - exact) <= found.errors[0, k]
        assert found.errors[0, k] <= 1e-7 * abs(exact) + 1e-9 / given[key]


@pytest.mark.parametrize('stencil', STENCILS, ids=lambda stencil: str(stencil.side))
def test_the_differences_of_a_cubic_are_exact(stencil: Stencil) -> None:
    values = np.array([(2.0 + 0.5 * offset) ** 3 for offset in stencil.offsets])
    derivative, error = stencil.derivative(values, 0.5, 2.0)
    assert float(derivative) == pytest.approx(12.0, rel=1e-14)
    assert 0.01 < float(error) < 1.0   # that of the better of the two before


def test_the_tenth_arrest_of_the_paper() -> None:
    """Ten times the period to the logarithm of the last static coefficient, by plain differences of any step."""
    for step in (1e-4, 1e-5, 1e-6):
        found = sensitivities('paper_fig7', ['stick.10.time'], ['friction.static.limit'], step)
        assert (found.derivatives * found.numbers)[0, 0] == pytest.approx(13.8245, abs=5e-5)


def test_the_reference_has_the_same_derivatives() -> None:
    """Brute force in 30 digits, with a step at which truncation is 1e-10 of it."""
    names = ['axis.mass', 'axis.drive_damping', 'contact.stiffness', 'friction.static.time_constant',
             'friction.kinetic.coefficients[1]', 'drive.velocity']
    scene = load_scene('paper_fig8')
    found = sensitivities(scene, ['stick.2.time', 'breakaway.2.position'], names)
    for k, name in enumerate(names):
        step = 1e-6 * float(found.numbers[k])
        up, down = (_by_the_reference(scene, name, float(found.numbers[k]) + sign * step) for sign in (1.0, -1.0))
        brute = (up - down) / (2.0 * step)
        assert found.derivatives[:, k] == pytest.approx(brute, rel=1e-6, abs=0.0)


def _by_the_reference(scene: Scene, name: str, value: float) -> NDArray[np.float64]:
    listed = 'friction.kinetic.coefficients'
    moved = changed(scene, {listed: [0.12, value]} if name.startswith(listed) else {name: value})
    run = simulate(moved.axis, moved.initial, moved.drive, moved.force, 2.2)
    arrests = [event for event in run.events if event.kind == EventKind.STICK]
    begins = [event for event in run.events if event.kind == EventKind.BREAKAWAY]
    return np.array([arrests[1].time, begins[1].position])


def test_samples_and_cycles() -> None:
    """In stick a compliant slider follows its contact; the limit cycle's figures are those of a study."""
    scene = load_scene('paper_fig8')
    found = sensitivities(scene, ['position@0.25', 'period', 'amplitude', 'peak_speed', 'stick_share',
                                  'break_away_force'], ['drive.velocity'])
    assert found.units == ('m', 's', 'm', 'm/s', '', 'N')
    around = sweep(scene, 'drive.velocity=0.00199:0.00201:3')
    for k, name in enumerate(found.figures[1:], 1):
        low, middle, high = around.columns[name].tolist()
        assert found.values[k] == pytest.approx(middle, rel=1e-6)
        assert found.derivatives[k, 0] == pytest.approx((high - low) / 2e-5, rel=1e-2)
    assert np.all(found.errors < 1e-5 * abs(found.derivatives))


def test_no_derivative_where_a_sample_stands_at_an_event() -> None:
    """The break-away passes the sample where N mu_s = c v t: at a static coefficient that is known."""
    scene = constant_friction()
    given = numbers(scene)
    time = float(break_away(**given)) * (1.0 + 3e-6)
    found = sensitivities(scene, [f'velocity@{time!r}', 'event.1.time'], ['friction.static.initial'])
    assert np.isnan(found.derivatives[0, 0])
    assert np.isfinite(found.derivatives[1, 0])
    (change,) = found.changes
    assert (change.figure, change.parameter) == (f'velocity@{time!r}', 'friction.static.initial')
    assert change.value == pytest.approx(given['static'] * (1.0 + 3e-6), rel=1e-12)
    assert change.what == 'event 1 is breakaway forwards here, none there'


def test_no_derivative_at_the_value_of_the_scene_itself() -> None:
    """A slider that moves backwards at the start comes to rest first."""
    (change,) = sensitivities('paper_fig7', ['event.1.time'], ['initial.velocity']).changes
    assert change.value == 0.0
    assert change.what == 'event 1 is breakaway forwards here, stick backwards there'


def test_no_derivative_where_a_slip_grazes_a_breakpoint() -> None:
    """The peak speed of the slip is that of a breakpoint at a static coefficient that is known."""
    given = numbers(constant_friction())
    given['static'] += 4e-6 * given['static']
    scene = constant_friction(**{'friction.kinetic.velocities': [0.0, peak_speed(**given), 1.0],
                                 'friction.kinetic.coefficients': [0.12, 0.12, 0.11]})
    found = sensitivities(scene, ['stick.1.time', 'breakaway.1.time'], ['friction.static.initial', 'axis.mass'])
    assert np.isnan(found.derivatives).tolist() == [[True, False], [False, False]]
    assert found.changes[0].value == pytest.approx(given['static'], rel=1e-9)
    finer = sensitivities(scene, ['stick.1.time'], ['friction.static.initial'], step=1e-6)
    assert np.isfinite(finer.derivatives[0, 0])
    assert not finer.changes


def test_one_side_where_the_other_is_no_scene() -> None:
    """No damping below 0, and static friction at rest not below the kinetic one: t = (N mu_s − h v)/(c v)."""
    found = sensitivities(constant_friction(), ['event.1.time'], ['axis.drive_damping', 'axis.mass'])
    assert found.sides == ('above', 'both')
    assert found.derivatives[0, 0] == pytest.approx(-1.0 / 6e5, rel=1e-9)
    assert found.derivatives[0, 1] == pytest.approx(0.0, abs=1e-12)
    tied = sensitivities('paper_fig7', ['period'], ['friction.static.initial', 'friction.kinetic.coefficients[0]'])
    assert tied.sides == ('above', 'below')
    assert np.all(tied.errors < 1e-4 * abs(tied.derivatives))


def test_all_numbers_that_decide_the_motion() -> None:
    found = sensitivities('paper_fig7', ['period'])
    assert 'friction.static.time_constant' in found.parameters
    assert 'friction.kinetic.velocities[0]' not in found.parameters   # a table begins at rest
    assert 'solver.step' not in found.parameters
    assert 'initial.rest_time' not in found.parameters                # infinite
    assert found.relative[0, found.parameters.index('axis.normal_force')] == pytest.approx(
        found.derivatives[0, found.parameters.index('axis.normal_force')] * 3432.3275 / found.values[0])


def test_as_a_data_frame() -> None:
    pytest.importorskip('pandas')
    frame = sensitivities('paper_fig7', ['period', 'event.3.time'], ['axis.mass', 'drive.velocity']).frame()
    assert list(frame['figure']) == ['period', 'period', 'event.3.time', 'event.3.time']
    assert list(frame['parameter_unit']) == ['kg', 'm/s'] * 2
    assert list(frame['parameter']) == ['axis.mass', 'drive.velocity'] * 2


@pytest.mark.parametrize(('figures', 'parameters', 'words'), [
    (['event.0.time'], ['axis.mass'], 'from 1 to 10000'),
    (['event.10.tim'], ['axis.mass'], 'did you mean time?'),
    (['brekaway.1.time'], ['axis.mass'], 'did you mean breakaway?'),
    (['position@-1'], ['axis.mass'], 'from 0 to 1e\\+06 s'),
    (['positin@1'], ['axis.mass'], 'did you mean position?'),
    (['perod'], ['axis.mass'], 'did you mean period?'),
    ([3], ['axis.mass'], 'figure = 3 is refused'),
    ([], ['axis.mass'], 'one or more names'),
    (['period', 'period'], ['axis.mass'], 'each once'),
    (['period'], [], 'one or more names'),
    (['period'], ['axis.mas'], 'did you mean axis.mass?'),
    (['period'], ['initial.rest_time'], 'finite number'),
    (['period'], ['contact.stiffness'], 'which has none there'),
    (['period'], ['friction.kinetic.coefficients[2]'], 'which has 2 numbers there'),
    (['period'], ['friction.kinetic.velocities[0]'], 'neither is a scene'),
    (['period'], ['encoder.resolution'], 'one that decides the motion'),
])
def test_refused(figures: list[str], parameters: list[str], words: str) -> None:
    with pytest.raises(InputError, match=words):
        sensitivities('paper_fig7', figures, parameters)


def test_figures_that_a_scene_does_not_have() -> None:
    with pytest.raises(InputError, match='no stick-slip within'):
        sensitivities('fast_feed', ['period'], ['axis.mass'])
    with pytest.raises(InputError, match='0 of these within'):
        sensitivities('paper_fig7', ['reverse.1.time'], ['axis.mass'])
    with pytest.raises(InputError, match=r'step = 0\.0 is refused'):
        sensitivities('paper_fig7', ['period'], ['axis.mass'], step=0.0)


def multiplier_by_hand(scene: Scene, rest_time: float) -> float:
    """N mu_s′/(c v − N mu_s′): a slip of constant friction turns the distance from its middle round."""
    static, axis = scene.axis.friction.static, scene.axis
    growth = axis.normal_force * (static.limit - static.initial) / static.time_constant * math.exp(
        -rest_time / static.time_constant)
    return growth / (axis.drive_stiffness * scene.drive.values[0] - growth)


@pytest.mark.parametrize('velocity', [0.0005, 0.002, 0.004])
def test_the_multiplier_of_the_limit_cycle_in_closed_form(velocity: float) -> None:
    scene = constant_friction(**{
        'friction.static.law': 'exponential', 'friction.static.initial': 0.12, 'friction.static.limit': 0.24,
        'friction.static.time_constant': 0.2, 'drive.velocity': velocity})
    found = sensitivities(scene, ['period', 'breakaway.200.rest_time'], ['axis.mass'])
    assert found.multiplier.rounds == 1
    assert found.multiplier.period == pytest.approx(found.values[0], rel=1e-9)
    exact = multiplier_by_hand(scene, float(found.values[1]))
    assert found.multiplier.value == pytest.approx(exact, abs=found.multiplier.error)
    assert found.multiplier.error < 1e-7


def test_a_limit_cycle_that_is_reached_at_once() -> None:
    """With constant static friction every slip begins alike."""
    found = sensitivities(constant_friction(), ['period'], ['axis.mass']).multiplier
    assert found.value == pytest.approx(0.0, abs=1e-9)


@pytest.mark.parametrize('scene', ['paper_fig7', 'paper_fig8', 'stribeck'])
def test_the_multiplier_is_how_fast_cycles_approach(scene: str) -> None:
    found: Sensitivities = sensitivities(scene, [f'breakaway.{k}.drive_force' for k in range(3, 6)], ['axis.mass'])
    first, second, third = found.values
    assert found.multiplier.value == pytest.approx((third - second) / (second - first), rel=0.2, abs=1e-6)


def test_a_damper_on_the_slideway_has_the_multiplier_of_one_on_the_drive_and_a_force() -> None:
    """−h ẋ = h (v − ẋ) − h v."""
    on_slideway = {'axis.damper': 'slideway', 'force.constant': 4000.0 * 0.002}
    drive, slideway = (sensitivities(changed(load_scene('paper_fig7'), changes), ['period'], ['axis.mass']).multiplier
                       for changes in ({}, on_slideway))
    assert slideway.value == pytest.approx(drive.value, rel=1e-6)


@pytest.mark.parametrize(('scene', 'words'), [('fast_feed', 'no limit cycle'), ('cutting_force', 'not constant')])
def test_no_multiplier(scene: str, words: str) -> None:
    found = sensitivities(scene, ['position@0.1'], ['axis.mass']).multiplier
    assert math.isnan(found.value)
    assert words in found.note


# The experiment that would narrow parameters most: what a run says of them, the feeds, and the tool.

SCENE = load_scene('paper_fig7')
SENSORS = Sensors(rate=100.0, resolution=1e-6, noise=0.0, force_noise=None)
FREE_NAMES = ('friction.static.time_constant', 'friction.static.limit')


def wishes(**changes: object) -> Wishes:
    given = {'parameters': FREE_NAMES, 'duration': 4.0, 'speeds': (2e-4, 2e-2), 'sensors': SENSORS, 'known': 0.3,
             'scatter': 0.01, 'travel': math.inf, 'criterion': 'D', **changes}
    return Wishes(**given)  # type: ignore[arg-type]


def test_slopes_are_the_sensitivities_of_samples() -> None:
    times = np.array([0.5, 0.71, 1.39])
    found = run_slopes(SCENE, list(FREE_NAMES), times, ['position', 'drive_force'])
    for channel, slopes in found.by_channel.items():
        same = sensitivities(SCENE, [f'{channel}@{time!r}' for time in times.tolist()], FREE_NAMES)
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
    names = (*FREE_NAMES, 'friction.static.initial')
    found = designed(SCENE, wishes(parameters=names, duration=10.0, sensors=Sensors(1000.0, 1e-6, 0.0, None)))
    page = (ROOT / 'docs' / 'sensitivities.md').read_text(encoding='utf-8')
    for row in [*text_lines([feed_table(found)])][:4]:
        assert any(line.split() == row.split() for line in page.splitlines()), row


def test_the_code_of_the_page_prints_what_it_shows(capsys: Capture) -> None:
    page = (ROOT / 'docs' / 'sensitivities.md').read_text(encoding='utf-8')
    code, = re.findall(r'^```python\n(.*?)^```$', page, re.MULTILINE | re.DOTALL)
    exec(code, {})
    assert f'\n\n{indent(capsys.readouterr().out, "    ")}\n' in page


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
    code, said, error = answered(capsys, 'design', 'paper_fig7', '--for', ','.join(FREE_NAMES), '--duration', '4',
                                 '--rate', '100', '--force-noise', '30', '--criterion', 'A', '--out', out)
    assert (code, error) == (0, '')
    assert said.splitlines()[0].split() == ['feed', 'A-optimal', *FREE_NAMES, 'travel']
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
    (['--for', 'drive.velocity'], 'the feed is the proposal'),
    (['--for', 'initial.stretch'], 'other than 0'),
    (['--for', 'axis.mass,axis.mass'], 'each once'),
    (['--for', ''], "parameter = '' is refused"),
    (['--speeds', '2'], 'two numbers in m/s'),
    (['--speeds', '2:1'], '0 < LOW < HIGH'),
    (['--duration', '-1'], '--duration = -1.0 is refused'),
    (['--duration', 'nan'], '--duration = nan is refused'),
    (['--rate', '1e-3'], 'readings in'),
    (['--resolution', '0'], 'readings are never exact'),
    (['--noise', '-1e-6'], '--noise = -1e-06 is refused'),
    (['--force-noise', '0'], '--force-noise = 0.0 is refused'),
    (['--known', '0'], '--known = 0.0 is refused'),
    (['--scatter', '2'], '--scatter = 2.0 is refused'),
    (['--travel', '1e-9'], 'such that a feed is left'),
    (['--set', 'drive.velocity=0.0'], '--speeds is missing'),
])
def test_refused_designs(capsys: Capture, tmp_path: Path, options: list[str], words: str) -> None:
    wanted = [] if '--for' in options else ['--for', 'axis.mass']
    shorter = [] if {'--duration', '--rate'} & set(options) else ['--duration', '1', '--rate', '10']
    out = tmp_path / 'experiment'
    assert words in refused(capsys, 'design', 'paper_fig7', *wanted, *options, *shorter, '--out', out)
    assert not out.exists()
