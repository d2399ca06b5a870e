# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Advice: the parts that a scene has, what leaving them out changes, and the least scene for a tolerance."""

import json
import math
import shlex
from pathlib import Path

import pytest

from stickslip_sim.advise.advice import Advice, advise, best_trial, least_scene, sensitivities_of
from stickslip_sim.advise.parts import absent_parts, parts_of, without_idle_sinusoids
from stickslip_sim.advise.report import advice_as_values, advice_report, is_needed, numbers_as_values, numbers_report
from stickslip_sim.advise.trial_runs import (
    ExactRun,
    Trial,
    costs,
    default_duration,
    reference_of,
    solver_settings,
    try_changes,
)
from stickslip_sim.bench.race import Cost
from stickslip_sim.cli.main import run
from stickslip_sim.figures.distance import Distance, distance_between, event_difference
from stickslip_sim.inputs import load_scene
from stickslip_sim.report.text import text_lines
from stickslip_sim.report.values import json_text
from stickslip_sim.scene import Scene, changed, scene_from_values
from tests.support.tool import Capture

DURATION = 2.0   # s; the second break-away of paper_fig7 comes at 1.33 s
TWO_SINUSOIDS: dict[str, object] = {'force.amplitudes': [1.0, 1.0], 'force.frequencies': [5.0, 5.0],
                               'force.phases': [0.0, 0.0]}
KNOTTED: dict[str, object] = {'friction.kinetic.velocities': [0.0, 0.0175, 0.035],
                             'friction.kinetic.coefficients': [0.12, 0.085, 0.05]}


def scene(name: str = 'paper_fig7', **sections: dict[str, object]) -> Scene:
    return load_scene(name, {key: value for section in sections.values() for key, value in section.items()})


@pytest.fixture(scope='module')
def advised() -> Advice:
    return advise(scene(sinusoids=TWO_SINUSOIDS, breakpoints=KNOTTED), 1e-3, DURATION, rounds=1)


def test_parts_are_those_of_the_scene() -> None:
    names = [part.name for part in parts_of(scene('paper_fig8'))]
    assert names == ['contact compliance', 'contact damping', 'acceleration dependence', 'rest-time growth of mu_s',
                     'speed dependence of mu_k', 'drive damping']
    assert [part.name for part in parts_of(scene_from_values({'axis.drive_damping': 0.0}))] == []
    smooth = [part.name for part in parts_of(scene('stribeck', excess={'friction.excess.law': 'cosine'}))]
    assert {'curved shape of psi', 'viscous friction', 'table of mu_k: error 10 times as large',
            'table of psi: error 100 times as large'} <= set(smooth)
    assert 'external force' in [part.name for part in parts_of(scene('cutting_force'))]


@pytest.mark.parametrize(('name', 'values'), [
    ('paper_fig8', {}), ('paper_fig8', KNOTTED), ('paper_fig8', TWO_SINUSOIDS), ('stribeck', {}), ('cutting_force', {}),
    ('cutting_force', {'drive.course': 'sine', 'drive.amplitude': 0.001, 'drive.frequency': 2.0}),
    ('stribeck', {'friction.excess.velocities': [0.0, 0.01, 0.035], 'friction.excess.fractions': [1.0, 0.4, 0.0]}),
    ('paper_fig8', {'friction.kinetic.end_slope': 0.1}), ('stribeck', {'friction.excess.law': 'cosine'}),
])
def test_all_parts_can_be_left_out_one_after_the_other(name: str, values: dict[str, object]) -> None:
    left = scene(name, values=values)
    parts = parts_of(left)
    for part in parts:
        if changes := part.variants[0].changes(left.values):
            left = changed(left, changes)
    assert [part.name for part in parts_of(left)] == []
    assert not any('amplitudes' in key for key in without_idle_sinusoids(left.values))
    assert scene_from_values(without_idle_sinusoids(left.values)).axis == left.axis


def test_what_a_scene_leaves_out_is_tried_at_its_neutral_value() -> None:
    names = {part.name for part in absent_parts(scene('paper_fig7'))}
    assert names == {'sine on the drive', 'sine on the force', 'external force', 'encoder', 'command time-out'}
    assert 'rest-time growth of mu_s' in {part.name for part in absent_parts(scene_from_values({}))}
    assert 'contact damping' in {part.name for part in absent_parts(scene('paper_fig8', c={'contact.damping': 0.0}))}


def test_a_run_does_not_differ_from_itself_and_by_all_from_another_motion() -> None:
    reference = reference_of(scene(), DURATION)
    same = distance_between(reference.figures, reference.figures)
    assert same.largest == 0.0
    assert set(same.by_figure) == {'event times', 'stick share', 'end position', 'period', 'jump', 'peak speed',
                                   'break-away force'}
    other = try_changes(reference, 'no drive', {'drive.velocity': 0.0}).difference
    assert other == Distance({'kind of motion': math.inf})


def test_relative_differences_are_those_of_the_figures() -> None:
    reference = reference_of(scene(), DURATION)
    trial = try_changes(reference, 'faster', {'drive.velocity': 0.00201})
    assert trial.difference is not None
    other = reference_of(scene(d={'drive.velocity': 0.00201}), DURATION)
    periods = [[cycle.period for cycle in found.figures.cycles] for found in (reference, other)]
    assert len(periods[0]) == len(periods[1]) == 2
    assert trial.difference.by_figure['period'] == pytest.approx(abs(sum(periods[1]) / sum(periods[0]) - 1.0), rel=1e-9)
    assert trial.difference.by_figure['event times'] == pytest.approx(
        max(abs(a.time - b.time) for a, b in zip(reference.figures.events, other.figures.events)) / DURATION, rel=1e-9)


def test_events_without_a_partner_count_by_the_time_that_is_left() -> None:
    events = reference_of(scene(), DURATION).figures.events
    assert event_difference(events, events, DURATION) == 0.0
    assert event_difference(events, events[:-1], DURATION) == pytest.approx(1.0 - events[-1].time / DURATION)
    turned = [*events[:2], events[2]._replace(direction=-1), *events[3:]]
    assert event_difference(events, turned, DURATION) == pytest.approx(1.0 - events[2].time / DURATION)


@pytest.mark.parametrize('values', [
    {'drive.velocity': 0.0}, {'drive.velocity': 0.1}, {'friction.static.law': 'constant',
     'friction.static.initial': 0.12, 'friction.kinetic.velocities': [0.0], 'friction.kinetic.coefficients': [0.12],
     'friction.acceleration_dependence': False}, {'axis.normal_force': 0.0}])
def test_scenes_without_cycles_are_compared_too(values: dict[str, object]) -> None:
    reference = reference_of(scene('paper_fig8', values=values), 1.0)
    assert reference.figures.cycles == []
    for part in parts_of(reference.scene):
        assert best_trial(reference, part).trial.difference is not None


def test_the_run_is_as_long_as_twenty_cycles_take() -> None:
    assert default_duration(scene('paper_fig8')) == 20.0      # 0.66 s each
    assert default_duration(scene('cutting_force')) == 10.0   # 16 a second
    assert default_duration(scene('fast_feed')) == 10.0       # none
    stepped = scene('paper_fig8', s={'solver.name': 'fixed_step', 'solver.step': 1e-6})
    assert default_duration(stepped) == 20.0   # found by the exact solver, in no time


def test_a_part_that_changes_nothing_is_left_out_and_the_others_stay(advised: Advice) -> None:
    needed = {found.part.name: is_needed(advised, k) for k, found in enumerate(advised.parts)}
    assert needed['breakpoint of mu_k at 17.5 mm/s'] is False
    assert needed['acceleration dependence'] is True
    assert needed['rest-time growth of mu_s'] is True
    sizes = {found.part.name: found.trial.difference for found in advised.parts}
    inner, growth = sizes['breakpoint of mu_k at 17.5 mm/s'], sizes['rest-time growth of mu_s']
    assert inner is not None
    assert growth is not None
    assert inner.largest < 1e-12 < 1e-3 < growth.largest
    assert advised.least.trial.difference is not None
    assert advised.least.trial.difference.largest <= 1e-3
    assert all(trial.identical for trial in advised.absent)
    exact = advised.solvers[0]
    assert (exact.name, exact.identical) == ('exact', True)
    assert all(trial.cost is not None and trial.cost.median > 0.0 for trial in advised.solvers)


def test_what_is_left_out_together_stays_within_the_tolerance() -> None:
    """Either sinusoid may go, for which the tolerance is just enough; both may not."""
    reference = reference_of(scene(sinusoids=TWO_SINUSOIDS), DURATION)
    trials = [best_trial(reference, part) for part in parts_of(reference.scene)]
    sinusoids = [found for found in trials if found.part.name.startswith('sine')]
    one, other = (found.trial.difference.largest for found in sinusoids if found.trial.difference is not None)
    assert one == other > 0.0
    both = try_changes(reference, 'both', {'force.amplitudes': (0.0, 0.0)}).difference
    assert both is not None
    assert both.largest > 1.5 * one
    assert len(least_scene(reference, sinusoids, [exact_trial(reference, 1.0)], 1.2 * one).parts) == 1
    assert len(least_scene(reference, sinusoids, [exact_trial(reference, 1.0)], 1.01 * both.largest).parts) == 2


def test_the_cheapest_solver_within_the_tolerance_is_advised() -> None:
    reference = reference_of(scene(), DURATION)
    name, changes = next(item for item in solver_settings(reference.scene).items() if 'rk4, step 0.1' in item[0])
    rival = try_changes(reference, name, changes)
    assert rival.difference is not None
    found = rival.difference.largest
    for cost, tolerance, chosen in ((0.5, 1.1 * found, name), (2.0, 1.1 * found, 'exact'), (0.5, 0.9 * found, 'exact')):
        solvers = [exact_trial(reference, 1.0), rival._replace(cost=of(cost))]
        least = least_scene(reference, [], solvers, tolerance)
        assert least.solver == chosen
        assert least.trial.scene is not None
        assert least.trial.scene.solver.name == ('exact' if chosen == 'exact' else 'fixed_step')


def exact_trial(reference: ExactRun, cost: float) -> Trial:
    return try_changes(reference, 'exact', {})._replace(cost=of(cost))


def of(cost: float) -> Cost:
    return Cost(cost, cost, cost, 1)


def test_a_solver_that_cannot_do_a_scene_is_reported() -> None:
    reference = reference_of(scene('paper_fig8', contact={'contact.stiffness': 1e12}), DURATION)
    trial = try_changes(reference, 'euler', {'solver.name': 'fixed_step', 'solver.step': 1e-3})
    assert trial.difference is None
    assert 'solver.step' in trial.note
    assert costs([reference.scene], DURATION, 1)[0] is not None


def test_the_scene_names_its_own_solver_among_the_others() -> None:
    own = scene(solver={'solver.name': 'fixed_step', 'solver.step': 5e-5})
    assert 'fixed_step euler, step 0.05 ms' in solver_settings(own)
    assert reference_of(own, DURATION).scene.solver.name == 'exact'


def test_a_part_of_what_is_left_out_goes_with_it() -> None:
    """The contact damper alone is needed, but not without the contact."""
    advice = advise(scene('positioning'), 0.2, 4.0, rounds=1)
    rows = {line.split('  ')[0]: line for line in text_lines(advice_report(advice))}
    assert rows['contact compliance'].endswith(' no')
    assert rows['contact damping'].endswith(' goes with another')


def test_advice_as_text_and_json(advised: Advice) -> None:
    text = '\n'.join(text_lines(advice_report(advised)))
    for words in ('paper_fig7: stick-slip', 'breakpoint of mu_k at 17.5 mm/s', 'not in the scene',
                  'identical to the bit',
                  'fixed_step euler, step 1 ms'):
        assert words in text
    data = json.loads(json_text(advice_as_values(advised, advised.least.changes)))
    assert data['least']['largest'] <= data['tolerance'] == 1e-3
    assert [part['needed'] for part in data['parts']] == [is_needed(advised, k) for k in range(len(advised.parts))]


def test_the_tool_prints_overrides_that_give_the_least_scene(tmp_path: Path, capsys: Capture) -> None:
    """The same one that is written; a choice that the user made and the advice undoes is not repeated."""
    out, least = tmp_path / 'advice.json', tmp_path / 'least.yaml'
    assert run(['advise', 'paper_fig8', '--tolerance', '0.5', '--duration', '0.2', '--rounds', '1', '--set',
                'contact.stiffness=6.0e6', '--set', 'force.amplitudes=[1.0]', '--set', 'force.frequencies=[2.0]',
                '--out', str(out), '--scene-out', str(least)]) == 0
    line, said = capsys.readouterr().out.splitlines()[-2:]
    assert said == f'written: {out}, {least}'
    words = [word for word in shlex.split(line) if word != '--set']
    assert 'contact.model=rigid' in words
    assert not any(word.startswith('contact.stiffness') for word in words)
    assert run(['simulate', 'paper_fig8', '--duration', '1', *shlex.split(line)]) == 0
    written = load_scene(str(least))
    assert written.values['contact.model'] == 'rigid'
    assert written.force.sinusoids == ()
    assert json.loads(out.read_text())['least']['changes']['contact.model'] == 'rigid'


# Which numbers of a scene matter most.

def test_the_numbers_of_a_limit_cycle_by_their_effect() -> None:
    """The forces of a cycle go with friction: one percent more of N mu_s is at least one of the period."""
    found = sensitivities_of(reference_of(load_scene('paper_fig7'), 4.0))
    assert found is not None
    head, first, *rest = text_lines(numbers_report(found))
    assert head.split()[-6:] == ['stick', 'share', 'peak', 'speed', 'break-away', 'force']
    assert first.split() == ['friction.static.limit', '2.386', '2.386', '1.128', '4.016', '1.379']
    assert len(rest) == 10
    assert (numbers_as_values(found) or {})['axis.mass']['period'] < 0.0


def test_a_scene_without_a_limit_cycle_has_the_time_of_an_event() -> None:
    found = sensitivities_of(reference_of(load_scene('positioning'), 4.0))
    assert found is not None
    assert found.figures[0].endswith('.time')
    lines = text_lines(numbers_report(found))
    assert not any(line.startswith('initial.') for line in lines)   # of 0 there is no percent


def test_a_scene_at_rest_has_none() -> None:
    found = sensitivities_of(reference_of(load_scene('paper_fig7', {'drive.velocity': 0.0}), 1.0))
    assert found is None
    assert numbers_as_values(found) is None
