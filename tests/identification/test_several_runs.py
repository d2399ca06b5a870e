# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Several runs of one axis in one fit: what they share, what each has of its own, and what they disagree about."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import stickslip_sim as stickslip
from stickslip_sim.core.errors import InputError
from stickslip_sim.identification.identified import FOUND, NOT_IDENTIFIABLE, VOID, Estimate, RunAlone
from stickslip_sim.identification.identified_scene import number_words
from stickslip_sim.identification.report import result_lines
from stickslip_sim.identification.several_runs import disagreements
from stickslip_sim.recording.measured_run import MeasuredRun
from stickslip_sim.scene import scene_from_values
from tests.support.measured_runs import ENCODER, VALUES, as_run, between, estimate_of
from tests.support.tool import Capture, answered

pytestmark = pytest.mark.usefixtures('blank_pictures')
STIFFNESS, LIMIT = 'axis.drive_stiffness', 'friction.static.initial'
FREE = {STIFFNESS: between(1e5, 4e5), LIMIT: between(0.15, 0.3)}


def measured(folder: Path, seed: int, **changes: float) -> MeasuredRun:
    """Return a run whose drive was measured, too; its encoder counts from anywhere."""
    scene = scene_from_values({**VALUES, **{name.replace('__', '.'): value for name, value in changes.items()}})
    samples = stickslip.simulate(scene, 1.6, 1.0 / 400.0).samples
    noise = np.random.default_rng(seed).standard_normal((2, len(samples['time'])))
    return as_run(folder, samples['time'], {
        'position': ENCODER * np.round((samples['position'] + 0.1 * seed) / ENCODER),
        'drive_force': samples['drive_force'] + noise[0], 'drive_velocity': samples['drive_velocity']})


def begin() -> stickslip.Scene:
    return scene_from_values({**VALUES, STIFFNESS: 1.7e5, LIMIT: 0.22})


def test_springs_and_feeds_of_two_runs_share_their_friction(tmp_path: Path) -> None:
    one = measured(tmp_path / 'one', 1)
    two = measured(tmp_path / 'two', 2, drive__velocity=0.004, axis__drive_stiffness=3e5)
    found = stickslip.identify([one, two], begin(), FREE, each=[STIFFNESS])
    assert found.fits, found.misfits
    limit = estimate_of(found, LIMIT)
    assert limit.value == pytest.approx(0.2, abs=3e-4)
    for run in found.alone:
        alone = next(each for each in run.estimates if each.name == LIMIT)
        assert limit.standard_deviation < 1.05 * alone.standard_deviation
    assert found.values[STIFFNESS] == pytest.approx(2e5, rel=2e-3)
    assert [run.own[STIFFNESS] for run in found.alone] == pytest.approx([2e5, 3e5], rel=2e-3)
    assert found.disagreements == ()
    assert [line for line in result_lines(found, 'one and two') if line.startswith(f'{STIFFNESS}:')] == [
        f'{STIFFNESS}: ' + ', '.join(f'{number_words(run.own[STIFFNESS], "N/m")} in {run.run}' for run in found.alone)]
    (second,) = found.predictions
    assert second.notes[0] == 'it was fitted, too: no test of the scene'
    assert second.channels[0].fit_percent > 99.9

    with pytest.raises(InputError, match=r"each = 'axis.mass' is refused: must be a free parameter"):
        stickslip.identify([one, two], begin(), FREE, each=['axis.mass'])
    with pytest.raises(InputError, match='omitted with one run'):
        stickslip.identify(one, begin(), FREE, each=[STIFFNESS])
    with pytest.raises(InputError, match='another run than one: its readings are the same'):
        stickslip.identify([one, one], begin(), FREE)
    with pytest.raises(InputError, match='one run where other laws are fitted'):
        stickslip.identify([one, two], begin(), FREE, laws=True)


def test_runs_that_disagree_say_about_what(tmp_path: Path, capsys: Capture) -> None:
    measured(tmp_path / 'one', 1)
    measured(tmp_path / 'two', 2, **{'friction__static__initial': 0.21})
    (tmp_path / 'start.yaml').write_text(begin().text, encoding='utf-8')
    (tmp_path / 'free.yaml').write_text(
        'parameters:\n  friction.static.initial: {distribution: uniform, low: 0.15, high: 0.3}\n'
        '  axis.drive_stiffness: {distribution: uniform, low: 1.0e5, high: 4.0e5}\n', encoding='utf-8')
    code, said, error = answered(capsys, 'identify', tmp_path / 'one', tmp_path / 'two', '--scene',
                                 tmp_path / 'start.yaml', '--free', tmp_path / 'free.yaml', '--out', tmp_path / 'out')
    assert code == 3
    line = next(line for line in said.splitlines() if 'they disagree' in line)
    assert line.startswith('friction.static.initial: 196.')
    assert ' N in one, 20' in line
    assert 'the model does not fit one and two: ' in error
    assert 'they disagree by more than their intervals' in (tmp_path / 'out' / 'report.html').read_text()


def alone(run: str, value: float, low: float, high: float, kind: str = FOUND) -> RunAlone:
    nan = float('nan')
    ends = (nan, nan) if kind == VOID else (low, high)
    one = Estimate('friction.kinetic.initial', '', value, 0.1, 0.0, 1.0, False, (high - low) / (2.0 * 1.96), ends, None,
                   kind, '')
    return RunAlone(run, kind != VOID, (one, replace(one, name='initial.position', value=float(len(run)))), {})


@pytest.mark.parametrize(('second', 'is_said'), [
    (alone('two', 0.2075, 0.203, 0.212), True), (alone('two', 0.185, 0.18, 0.19), False),
    (alone('two', 0.2075, 0.203, 0.212, VOID), True), (alone('two', 0.2075, 0.203, 0.212, NOT_IDENTIFIABLE), False)])
def test_intervals_that_do_not_meet_are_a_disagreement(second: RunAlone, is_said: bool) -> None:
    said = [*disagreements([alone('first', 0.18, 0.171, 0.189), second], (), 100.0)]
    assert len(said) == is_said
    if is_said:
        assert said[0].startswith('friction.kinetic.initial: 18 [17.1, 18.9] N in first, 20.75 [20.3, 21.2] N in two')
        assert ('which it does not fit' in said[0]) == (not second.fits)


@pytest.mark.parametrize('name', ['friction.scale', 'friction.kinetic.exponent'])
def test_a_scale_or_an_exponent_is_no_force(name: str) -> None:
    runs = [replace(run, estimates=(replace(run.estimates[0], name=name),))
            for run in (alone('first', 0.18, 0.171, 0.189), alone('two', 0.2075, 0.203, 0.212))]
    assert next(disagreements(runs, (), 100.0)).startswith(f'{name}: 0.18 [0.171, 0.189] in first, 0.2075 [0.203')


def test_what_each_run_has_of_its_own_is_no_disagreement() -> None:
    assert [*disagreements([alone('first', 0.18, 0.1, 0.3), alone('other', 0.18, 0.1, 0.3)], (), None)] == []


