# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Critical values: the closed forms of the literature, bistability, and what is refused."""

import csv
import json
import math
import re
from pathlib import Path

import numpy as np
import pytest

from stickslip_sim.axis import InitialState
from stickslip_sim.cli.main import run
from stickslip_sim.core.arrays import Numbers
from stickslip_sim.core.errors import InputError
from stickslip_sim.core.types import EventKind
from stickslip_sim.figures.rounds import group_size
from stickslip_sim.inputs import load_scene
from stickslip_sim.proof.axes import make, of_kind
from stickslip_sim.runs import simulate_events
from stickslip_sim.scene import Scene, changed
from stickslip_sim.study import Saltelli, Study, Variation
from stickslip_sim.study.answer_changes import (
    ALL_OVER,
    FAILED,
    NO,
    NOWHERE,
    OPEN,
    YES,
    Answers,
    Doubt,
    Findings,
    Places,
    find_transitions,
    highest_changes,
)
from stickslip_sim.study.critical import (
    ACCURACY as STUDY_ACCURACY,
)
from stickslip_sim.study.critical import (
    Critical,
    CriticalStudy,
    critical_drop,
    critical_of,
    critical_values,
    default_range,
    feed_of_theory,
    healing_critical_feed,
    spreads_of,
    table_fact,
)
from stickslip_sim.study.points import scene_at
from stickslip_sim.study.sample import Distribution
from stickslip_sim.study.sweep import processes
from tests.support.axes import instant
from tests.support.repository import ROOT
from tests.support.tool import Capture, done

pytestmark = pytest.mark.slow

CONSTANT = {'friction.static.law': 'constant', 'friction.static.initial': 0.24,
            'friction.kinetic.velocities': [0.0], 'friction.kinetic.coefficients': [0.12]}
GROWING = {**CONSTANT, 'friction.static.initial': 0.12, 'friction.static.limit': 0.24,
           'friction.static.time_constant': 0.2, 'axis.drive_damping': 0.0}
IMPEDANCE = math.sqrt(350.0 * 6e5)   # N s/m
ACCURACY = 1e-9


def of_the_feed(scene: Scene, low: float, high: float, accuracy: float = ACCURACY) -> Critical:
    return critical_of(scene, Variation('drive.velocity', low, high, log=True), accuracy)


@pytest.mark.parametrize(('zeta', 'drop'), [(0.01, 0.365065), (0.1, 1.470118), (0.2, 2.724989)])
def test_constant_friction_has_the_critical_feed_of_the_closed_form(zeta: float, drop: float) -> None:
    scene = load_scene('paper_fig4_constant', {**CONSTANT, 'axis.drive_damping': 2.0 * zeta * IMPEDANCE})
    assert critical_drop(zeta) == pytest.approx(drop, abs=1e-6)
    expected = 0.12 * 3432.3275 / (critical_drop(zeta) * IMPEDANCE)
    found = of_the_feed(scene, 1e-3, 1.0)
    (transition,) = found.from_rest.transitions
    assert transition.resolved
    assert not transition.rises
    assert transition.value == pytest.approx(expected, rel=ACCURACY)
    assert transition.low <= expected * (1.0 + 1e-12)
    assert transition.high >= expected * (1.0 - 1e-12)
    assert found.from_sliding == Findings(NO, ())
    assert found.both == [(1e-3, transition.value)]


@pytest.mark.parametrize('law', ['exponential', 'hyperbolic'])
def test_growth_at_rest_has_its_critical_feed_within_what_is_reported(law: str) -> None:
    """Near it the drops shrink as 1/n: nearer than this nothing can be decided in some thousand cycles."""
    scene = load_scene('paper_fig4_constant', {**GROWING, 'friction.static.law': law})
    expected = healing_critical_feed(6e5, 3432.3275 * 0.12 / 0.2)
    assert feed_of_theory(scene.axis) == expected
    (transition,) = of_the_feed(scene, 5e-3, 9e-3, 2e-3).from_rest.transitions
    assert transition.resolved
    assert transition.low < expected < transition.high
    assert transition.high - transition.low < 2e-3 * expected


def test_katos_law_below_one_has_no_critical_feed() -> None:
    scene = load_scene('paper_fig4_constant', {**GROWING, 'friction.static.law': 'kato',
                                               'friction.static.exponent': 0.5})
    assert of_the_feed(scene, 1e-3, 0.1).from_rest == Findings(YES, ())


def test_sliding_on_the_papers_slope_is_lost_from_2000_newtons_on_and_both_motions_are_reported() -> None:
    scene = load_scene('paper_fig4_falling')
    found = critical_of(scene, Variation('axis.normal_force', 500.0, 5000.0), 1e-12)
    (lost,) = found.from_sliding.transitions
    assert lost.value == pytest.approx(4000.0 * 0.035 / 0.07, rel=1e-12)
    (sticks,) = found.from_rest.transitions
    assert sticks.rises
    assert sticks.value < 1500.0
    assert not sticks.resolved
    assert found.both == [(sticks.high, lost.value)]


def test_runs_from_sliding_agree() -> None:
    scene = load_scene('paper_fig4_falling', {'drive.velocity': 0.0175})
    found = critical_of(scene, Variation('axis.drive_damping', 5000.0, 9000.0), 1e-5)
    (lost,) = found.from_sliding.transitions
    for share, grows in ((0.999, True), (1.001, False)):
        axis = load_scene('paper_fig4_falling', {'axis.drive_damping': share * lost.value}).axis
        balance = axis.normal_force * axis.friction.kinetic.coefficient(0.0175)
        events = make(axis, 0.0175, balance, InitialState(velocity=0.0176)).advance(instant(20.0))
        swings = [abs(event.velocity - 0.0175) for event in events]
        assert len(swings) > 100
        assert (swings[-1] > swings[0]) == grows


def sticks_late(scene: Scene, duration: float, late: float) -> int:
    """Return how many sticks come in the last `late` seconds of a run."""
    simulator = make(scene.axis, scene.drive, scene.force, scene.initial)
    simulator.skip(instant(duration - late))
    return len(of_kind(simulator.advance(instant(duration)), EventKind.STICK))


def test_sticks_between_reversals_last_however_heavy_the_slider_is() -> None:
    """Forward slip, reversal, stick and again: the last complete cycle may be the one without a stick."""
    scene = load_scene('paper_fig7', {'drive.velocity': 0.02})
    found = critical_of(scene, Variation('axis.mass', 20000.0, 32000.0, log=True), 1e-6)
    assert found.from_rest == Findings(YES, ())


def test_what_is_reported_of_intermittent_stick_slip_is_what_long_runs_do() -> None:
    """Between sticks the slider swings, ever longer towards the border, and may slip out by chance."""
    scene, name = load_scene('paper_fig8', {'drive.velocity': 0.02}), 'axis.drive_damping'
    (one,) = critical_of(scene, Variation(name, 3e3, 1e5, log=True), 1e-9).from_rest.transitions
    assert not one.resolved
    ends = [sticks_late(scene_at(scene.values, [name], np.array([value])), 1e4, 5e3) for value in (one.low, one.high)]
    assert [count > 0 for count in ends] == [not one.rises, one.rises]


def test_a_cycle_about_to_vanish_is_not_taken_for_one_that_stays() -> None:
    """Just beyond the tangent bifurcation 8600 sticks come, ever more alike, and then none."""
    scene = load_scene('paper_fig4_constant')
    (one,) = critical_of(scene, Variation('axis.mass', 13.0, 14.0, log=True), 1e-9).from_rest.transitions
    assert one.high > 13.453134863828902
    value = np.array([max(one.high, 13.4531349)])
    assert sticks_late(scene_at(scene.values, ['axis.mass'], value), 1e4, 5e3) > 1000


def test_several_changes_are_all_found() -> None:
    found = find_transitions(lambda values: (np.sin(values) > 0.0).astype(np.int64), 1.0, 10.0, False, 1e-12)
    assert found.first == YES
    assert [one.value for one in found.transitions] == pytest.approx([math.pi, 2.0 * math.pi, 3.0 * math.pi], rel=1e-12)
    assert [one.rises for one in found.transitions] == [False, True, False]
    assert [found.at(value) for value in (3.0, 4.0, 7.0, 9.9)] == [YES, NO, YES, NO]


def test_what_cannot_be_decided_stays_open() -> None:
    def question(values: Numbers) -> Answers:
        return np.where(abs(values - 2.0) < 1e-3, OPEN, values > 2.0).astype(np.int64)

    (one,) = find_transitions(question, 1.0, 3.5, False, 1e-9).transitions
    assert not one.resolved
    assert one.low == pytest.approx(1.999, abs=3e-4)
    assert one.high == pytest.approx(2.001, abs=3e-4)
    for answer in (OPEN, FAILED):
        found = find_transitions(lambda values: np.full(len(values), answer), 1.0, 2.0, False, 1e-9)  # noqa: B023
        assert found == Findings(answer, (), (Doubt(1.0, 2.0, answer == FAILED),))


def test_what_cannot_be_decided_between_two_equal_answers_or_at_an_end_is_reported() -> None:
    def question(values: Numbers) -> Answers:
        found = np.where((values > 2.0) & (values < 3.0), OPEN, YES)
        return np.where(values > 8.0, FAILED, found).astype(np.int64)

    found = find_transitions(question, 1.0, 9.0, False, 1e-9)
    assert (found.first, found.transitions) == (YES, ())
    assert [(one.low, one.high, one.failed) for one in found.doubts] == [(2.0, 3.0, False), (8.0, 9.0, True)]
    assert [found.at(value) for value in (1.5, 2.5, 5.0, 8.5)] == [YES, OPEN, YES, OPEN]


def test_a_failed_run_between_two_answers_is_reported() -> None:
    def question(values: Numbers) -> Answers:
        return np.where(abs(values - 2.0) < 1e-3, FAILED, values > 2.0).astype(np.int64)

    (one,) = find_transitions(question, 1.0, 3.5, False, 1e-9).transitions
    assert (one.resolved, one.failed) == (False, True)


def test_answers_that_come_by_turns_are_no_figure() -> None:
    """As near a motion that sticks by chance: beyond the ends of what is reported no answer contradicts."""
    def question(values: Numbers) -> Answers:
        by_chance = np.mod(1e9 * np.sin(12345.0 * values), 1.0) > 0.5
        return np.where(abs(values - 2.0) < 3e-3, by_chance, values > 2.0).astype(np.int64)

    (one,) = find_transitions(question, 1.0, 3.5, False, 1e-9).transitions
    assert not one.resolved
    assert one.rises
    assert 1.99 < one.low <= 1.997 + 1e-4
    assert 2.003 - 1e-4 <= one.high < 2.01


@pytest.mark.parametrize('seed', range(40))
def test_both_ends_of_what_is_reported_have_the_answer_that_is_reported(seed: int) -> None:
    rng = np.random.default_rng(seed)
    width, likely = 10.0 ** rng.uniform(-6.0, -1.0), rng.uniform(0.1, 0.9)

    def question(values: Numbers) -> Answers:
        by_chance = np.mod(1e9 * np.sin(12345.0 * values + seed), 1.0) < likely
        found = np.where(abs(values - 2.0) < width, by_chance, values > 2.0)
        return np.where(abs(values - 2.0) < 0.1 * width, OPEN, found).astype(np.int64)

    for one in find_transitions(question, 1.0, 3.5, False, 1e-9).transitions:
        assert question(np.array([one.low, one.high])).tolist() == [int(not one.rises), int(one.rises)]


def test_three_clear_changes_between_two_values_of_the_scan_are_three() -> None:
    def question(values: Numbers) -> Answers:
        return (((values > 2.03) & (values < 2.05)) | (values > 2.07)).astype(np.int64)

    found = find_transitions(question, 1.0, 6.0, False, 1e-12).transitions
    assert [one.value for one in found] == pytest.approx([2.03, 2.05, 2.07], rel=1e-11)
    assert [(one.rises, one.resolved) for one in found] == [(True, True), (False, True), (True, True)]


def test_the_finest_accuracy_ends() -> None:
    (one,) = find_transitions(lambda values: (values > math.pi).astype(np.int64), 1.0, 10.0, False, 1e-15).transitions
    assert one.resolved
    assert one.low <= math.pi < one.high
    assert one.high - one.low <= 2.0 * math.ulp(math.pi)


def test_a_feed_on_a_breakpoint_and_a_load_decided_by_a_segment_say_so() -> None:
    scene = load_scene('paper_fig8')
    feed = critical_of(scene, Variation('drive.velocity', 0.034, 0.036), 1e-4).by_table
    assert [(fact.from_sliding, fact.breakpoint, fact.low) for fact in feed] == [(True, 1, 0.035)]
    load = critical_of(scene, Variation('axis.normal_force', 1990.0, 2010.0), 1e-4).by_table
    assert [(fact.from_sliding, fact.breakpoint, fact.low, fact.high) for fact in load] == [(True, None, 0.0, 0.035)]


def test_a_smooth_law_decides_by_its_own_slope() -> None:
    found = critical_of(load_scene('stribeck'), Variation('drive.velocity', 0.02, 0.025), 1e-3)
    assert found.from_sliding.transitions
    assert found.by_table == ()


def test_beyond_the_last_breakpoint_the_segment_has_no_end() -> None:
    changes = {'friction.kinetic.end_slope': 0.5, 'drive.velocity': 0.05, 'axis.drive_damping': 0.0}
    [fact] = [table_fact(load_scene('paper_fig7', changes).values, 'axis.normal_force', 1e3, 1e-9, from_sliding=True)]
    assert fact == (True, 1e3, None, 0.035, math.inf, 'friction.kinetic.velocities')


def test_without_a_range_it_looks_about_the_value_of_the_scene() -> None:
    over = default_range(load_scene('paper_fig7'), 'drive.velocity')
    assert (over.low, over.high, over.log) == (2e-5, 0.2, True)
    assert default_range(load_scene('paper_fig7'), 'friction.kinetic.coefficients[1]').high == pytest.approx(5.0)


def test_inputs_that_change_with_time_are_refused() -> None:
    with pytest.raises(InputError, match='constant inputs'):
        critical_of(load_scene('cutting_force'), Variation('axis.mass', 100.0, 500.0), ACCURACY)


@pytest.mark.parametrize(('damping', 'grows'), [(7300.0, True), (7450.0, True), (7510.0, False), (7700.0, False)])
def test_sliding_at_a_breakpoint_is_lost_by_the_mean_of_both_slopes(damping: float, grows: bool) -> None:
    """Each swing is half on either side: the damper must hold the mean of 1.04e4 and 4.56e3 N s/m, 7480."""
    scene = load_scene(str(ROOT / 'examples' / 'my_axis.yaml'), {'axis.drive_damping': damping})
    feed, axis = scene.drive.values[0], scene.axis
    assert feed in axis.friction.kinetic.velocities
    stretch = axis.normal_force * axis.friction.kinetic.coefficient(feed) / axis.drive_stiffness
    disturbed = {'initial.velocity': feed * (1.0 + 1e-4), 'initial.stretch': stretch,
                 'axis.drive_damping': damping}
    run = simulate_events(load_scene(str(ROOT / 'examples' / 'my_axis.yaml'), disturbed), 20.0)
    peaks = [abs(event.velocity - feed) for event in run.events if event.kind == EventKind.DECELERATE]
    assert (len(peaks) > 3 and peaks[-1] > 1.2 * peaks[0]) == grows


# Rounds that repeat, one by one or in groups, by all four of their numbers.

ROUND = np.array([0.5, 0.75, 800.0, 0.02])   # stick and period, s; force, N; speed, m/s
COUNT = 12


def size_of(rounds: Numbers) -> float:
    return float(group_size(rounds[None], np.array([float(COUNT)]), np.array([800.0]), 1e-6, 1e-11)[0])


@pytest.mark.parametrize('size', [1, 2, 3])
def test_the_shortest_group_is_found(size: int) -> None:
    turns = 1.0 + 0.1 * (np.arange(COUNT) % size)
    assert size_of(ROUND * turns[:, None]) == size


@pytest.mark.parametrize('number', range(4))
def test_rounds_of_which_a_number_still_changes_do_not_repeat(number: int) -> None:
    rounds = np.tile(ROUND, (COUNT, 1))
    assert size_of(rounds) == 1.0
    rounds[:, number] *= 1.0 + 1e-5 * np.arange(COUNT)
    assert size_of(rounds) == 0.0


# The critical value where parameters are known only roughly: point by point that of `critical`, and its spread.

FEED = Variation('drive.velocity', 2e-3, 0.2, 0, True)
COULOMB = {'friction.static.law': 'constant', 'friction.static.initial': 0.24, 'friction.kinetic.velocities': (0.0,),
           'friction.kinetic.coefficients': (0.12,)}


def study_of(changes: dict[str, object], *laws: Distribution, name: str = 'paper_fig4_constant') -> CriticalStudy:
    scene = changed(load_scene(name), changes)
    return CriticalStudy(Study(scene.values, Saltelli(laws, 16), None), FEED)


def uniform(name: str, low: float, high: float) -> Distribution:
    return Distribution(name, 'uniform', (low, high), low, high)


def test_each_point_has_the_critical_feed_of_the_closed_form() -> None:
    study = study_of(COULOMB, uniform('axis.drive_damping', 1e3, 5e3), uniform('friction.scale', 0.9, 1.1))
    found = study.values(0, 20)
    exact = [feed_of_theory(study.study.scene_at(point).axis) for point in study.study.points(0, 20)]
    assert found[:, 0] == pytest.approx(exact, rel=STUDY_ACCURACY)
    assert (found[:, 1] == NOWHERE).all()    # friction that does not fall loses no sliding


def test_each_point_has_the_values_of_critical() -> None:
    laws = uniform('axis.normal_force', 2500.0, 3500.0), uniform('friction.kinetic.coefficients[1]', 0.04, 0.07)
    study = study_of({}, *laws, name='paper_fig7')
    found = study.values(0, 3)
    for k in range(3):
        alone = critical_of(study.study.scene_at(study.study.points(k, k + 1)[0]), FEED, 1e-6)
        assert found[k, 0] == pytest.approx(alone.from_rest.transitions[-1].value, rel=2 * STUDY_ACCURACY)
        assert found[k, 1] == pytest.approx(alone.from_sliding.transitions[-1].value, rel=2 * STUDY_ACCURACY)


def test_workers_find_the_same() -> None:
    study = study_of(COULOMB, uniform('axis.drive_damping', 1e3, 5e3))
    with processes(2) as workers:
        assert np.array_equal(critical_values(study, workers), critical_values(study))


def test_the_spread_counts_what_has_no_value() -> None:
    sample = Saltelli((uniform('axis.mass', 300.0, 400.0),), 16)
    values = np.linspace(1.0, 2.0, sample.count)
    values[[0, 1, 3]] = ALL_OVER, NOWHERE, np.nan    # A and B of the first sample, A of the second
    spread = spreads_of(sample, np.column_stack([values, values]))['from_rest']
    assert (spread.points, spread.all_over, spread.nowhere, spread.unknown, len(spread.values)) == (32, 1, 1, 1, 29)
    assert spread.indices is None
    assert spread.percentiles is not None
    assert spread.percentiles[2] == pytest.approx(np.median(spread.values))


def asked_about(changes: list[float], unknown: tuple[float, float] = (math.inf, math.inf)) -> Numbers:
    def question(rows: Places, numbers: Numbers) -> Answers:
        answers = np.where(numbers < np.array(changes)[rows], YES, NO)
        return np.where((unknown[0] < numbers) & (numbers < unknown[1]), OPEN, answers)

    return highest_changes(question, len(changes), Variation('drive.velocity', 1.0, 100.0, 0, True), 1e-6)


def test_changes_are_found_side_by_side() -> None:
    assert asked_about([2.0, 50.0, 0.5, 200.0, 99.9]) == pytest.approx([2.0, 50.0, NOWHERE, ALL_OVER, 99.9], rel=1e-6)


def test_what_is_open_is_known_as_far_as_it_is() -> None:
    assert asked_about([10.0], (9.99, 10.01)) == pytest.approx([10.0], rel=2e-3)
    assert np.isnan(asked_about([10.0], (8.0, 12.0)))
    assert np.isnan(asked_about([200.0], (50.0, 60.0)))   # in there it might have changed twice


def test_the_tool_prints_draws_and_writes_it(tmp_path: Path, capsys: Capture) -> None:
    known = tmp_path / 'known.yaml'
    known.write_text('parameters:\n  axis.normal_force: {distribution: uniform, low: 3000.0, high: 3600.0}\n')
    out = done(capsys, 'uncertainty', 'paper_fig7', '--with', known, '--of', 'drive.velocity', '--between', '0.01:0.1',
               '--samples', '16', '--out', tmp_path / 'spread', '--plot', tmp_path / 'u.png')
    assert 'critical drive.velocity from 0.01 to 0.1 m/s, the highest one, to 0.0001 of the value' in out
    found = json.loads((tmp_path / 'spread/uncertainty.json').read_text())
    low, high = (found['from_rest']['percentiles'][percent] for percent in ('5', '95'))
    assert 0.02 < low < high < 0.04
    assert found['from_rest']['indices']['axis.normal_force']['total'] == pytest.approx(1.0, abs=0.2)
    with (tmp_path / 'spread/critical.csv').open() as file:
        rows = list(csv.DictReader(file))
    assert len(rows) == 16 * 3
    assert 3000.0 <= float(rows[0]['axis.normal_force']) <= 3600.0
    assert 0.02 < float(rows[0]['critical_from_rest']) < 0.04
    assert (tmp_path / 'u.png').stat().st_size > 10_000


def test_a_parameter_that_is_drawn_is_refused() -> None:
    with pytest.raises(InputError, match='another parameter than those that are drawn'):
        study_of({}, uniform('drive.velocity', 1e-3, 1e-2))


# `stickslip critical`: what it prints, and what it refuses in one line.

def test_the_tool_prints_both_values(capsys: Capture) -> None:
    out = done(capsys, 'critical', 'paper_fig4_falling', '--of', 'axis.normal_force', '--between', '500:5000')
    assert 'from rest' in out
    assert 'bistable' in out
    assert 'to 2000 N both go on' in out


def test_the_tool_names_breakpoint_and_segment(capsys: Capture) -> None:
    given = ('critical', 'paper_fig7', '--accuracy', '1e-4')
    assert run([*given, '--of', 'drive.velocity', '--between', '0.034:0.036']) == 0
    assert 'the feed is a breakpoint, friction.kinetic.velocities[1]' in capsys.readouterr().out
    assert run([*given, '--of', 'axis.normal_force', '--between', '1990:2010']) == 0
    assert 'the straight segment of mu_k from 0 to 0.035 m/s decides' in capsys.readouterr().out


def test_the_tool_says_that_there_is_no_transition(capsys: Capture) -> None:
    out = done(capsys, 'critical', 'paper_fig7', '--of', 'drive.velocity', '--between', '1e-4:1e-3')
    assert out.count('no transition') == 2
    assert 'stick-slip all over the range' in out


def test_the_tool_prints_what_is_undecided(capsys: Capture) -> None:
    """With no more digits than the stretch has a use for, rounded outwards."""
    out = done(capsys, 'critical', 'paper_fig8', '--set', 'drive.velocity=0.02', '--of', 'axis.normal_force',
               '--between', '1900:2300')
    line = r'^from rest      between [\d.]+ and [\d.]+ N, undecided: no stick-slip below, stick-slip above$'
    assert re.search(line, out, re.MULTILINE), out
    low, high = re.findall(r'between ([\d.]+) and ([\d.]+) N', out)[0]
    assert float(low) < 2098.9463 < 2098.9472 < float(high)
    assert max(len(low), len(high)) <= 10    # the stretch is 0.001 N wide
