# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The paper's statements, on the paper's scenes, on bags, and on runs that break them or have nothing to say."""

import math
from dataclasses import replace
from functools import cache
from pathlib import Path

import pytest

from stickslip_sim.cli.main import run
from stickslip_sim.compare.fresh import simulate_densely
from stickslip_sim.compare.statements import STATEMENTS, Finding, StatementOutcome, findings_on
from stickslip_sim.core.types import EventKind
from stickslip_sim.inputs import load_scene
from stickslip_sim.recording import read_run
from stickslip_sim.runs import Run, SimulatedRun

HOLDS, FAILS, NOT_APPLICABLE = StatementOutcome
BALANCE, CONTINUITY, TWO_VALUES, OSCILLATION, LIMIT_CYCLE, CONTACT, LONG_REST = (
    statement.name for statement in STATEMENTS)
NORMAL = 3432.3275   # N
KINETIC = 0.12 * NORMAL   # N, at rest


@cache
def densely(scene: str, duration: float = 10.0, **changes: object) -> SimulatedRun:
    """Simulate a scene; in the names of changes a double underscore stands for the dot."""
    given = {name.replace('__', '.'): value for name, value in changes.items()}
    return simulate_densely(load_scene(scene, given), duration)


def findings(run: Run) -> dict[str, Finding]:
    return {statement.name: finding for statement, finding in findings_on(run)}


def outcomes(run: Run) -> list[StatementOutcome]:
    return [finding.outcome for _, finding in findings_on(run)]


@pytest.mark.parametrize(('scene', 'expected'), [
    ('paper_fig4_constant', [HOLDS, NOT_APPLICABLE, NOT_APPLICABLE, HOLDS, HOLDS, NOT_APPLICABLE, HOLDS]),
    ('paper_fig4_falling', [HOLDS, NOT_APPLICABLE, NOT_APPLICABLE, HOLDS, HOLDS, NOT_APPLICABLE, HOLDS]),
    ('paper_fig7', [HOLDS, NOT_APPLICABLE, HOLDS, HOLDS, HOLDS, HOLDS, HOLDS]),
    ('paper_fig8', [HOLDS] * 7),
    ('stribeck', [HOLDS] * 7)])
def test_what_the_paper_says_holds_on_its_scenes(scene: str, expected: list[StatementOutcome]) -> None:
    assert outcomes(densely(scene)) == expected


def test_a_bag_is_compared_like_the_run_it_holds(tmp_path: Path) -> None:
    for scene in ('paper_fig7', 'paper_fig8'):
        assert run(['simulate', scene, '--duration', '5', '--bag', str(tmp_path / scene)]) == 0
        assert outcomes(read_run(tmp_path / scene)) == outcomes(densely(scene))


def test_a_run_whose_parameters_changed_is_not_compared(fig8_bag: Path) -> None:
    recorded = read_run(fig8_bag)
    assert NOT_APPLICABLE not in outcomes(recorded)
    recorded.is_changed = True
    assert outcomes(recorded) == [NOT_APPLICABLE] * 7


VARYING = {'normal_load.course': 'sine', 'normal_load.amplitude': 1000.0, 'normal_load.frequency': 25.0}


@pytest.mark.parametrize(('statement', 'expected', 'scene', 'duration', 'changes'), [
    (BALANCE, HOLDS, 'paper_fig7', 1.0, {'force.constant': -300.0}),    # a rigid contact holds it
    (BALANCE, NOT_APPLICABLE, 'paper_fig8', 1.0, {'initial.velocity': 0.02}),    # it begins in slip
    (TWO_VALUES, NOT_APPLICABLE, 'paper_fig8', 2.0, VARYING),    # under loads of other times
    (OSCILLATION, NOT_APPLICABLE, 'paper_fig8', 3.0, {'contact.damping': 0.0, 'axis.drive_damping': 1.0}),   # too brief
    (LIMIT_CYCLE, FAILS, 'paper_fig8', 10.0, {'drive.velocity': 0.01}),    # there are two, by where it starts
    (LIMIT_CYCLE, NOT_APPLICABLE, 'positioning', 5.0, {}),
    (LIMIT_CYCLE, NOT_APPLICABLE, 'fast_feed', 2.0, {}),
    (LIMIT_CYCLE, NOT_APPLICABLE, 'paper_fig8', 0.5, {}),
    (LONG_REST, NOT_APPLICABLE, 'paper_fig8', 2.0, {'initial.rest_time': 0.1}),
    (LONG_REST, NOT_APPLICABLE, 'paper_fig8', 2.0, {'friction.static.law': 'constant'}),
    (LONG_REST, NOT_APPLICABLE, 'paper_fig8', 2.0, {'drive.velocity': 0.0}),
])
def test_where_a_statement_holds_fails_or_says_nothing(statement: str, expected: StatementOutcome, scene: str,
                                                       duration: float, changes: dict[str, object]) -> None:
    assert findings(densely(scene, duration, **changes))[statement].outcome == expected


class TestBalanceAtTheStart:
    def test_a_force_that_nothing_holds_at_the_start_is_no_balance(self) -> None:
        finding = findings(densely('paper_fig8', 1.0, force__constant=-300.0))[BALANCE]
        assert finding.outcome == FAILS
        assert finding.figures == {'spring_force': 0.0, 'external_force': pytest.approx(-300.0), 'contact_force': 0.0,
                                   'limit': pytest.approx(0.24 * NORMAL)}


class TestContinuity:
    def test_forces_on_both_sides_of_stick(self) -> None:
        figures = findings(densely('paper_fig8'))[CONTINUITY].figures
        assert figures['jump_at_break_away'] < 1e-5
        assert figures['jump_at_standstill'] < 1e-9
        assert figures['largest_friction_force'] == pytest.approx(0.24 * NORMAL)

    def test_without_contact_it_jumps_back_to_the_drive_force(self) -> None:
        run = densely('paper_fig7')
        stop = next(event for event in run.events if event.kind == EventKind.STICK)
        figures = findings(run)[CONTINUITY].figures
        assert figures['jump_at_break_away'] < 1e-9
        assert figures['jump_at_standstill'] == pytest.approx(KINETIC - stop.drive_force, rel=1e-9)

    def test_conventional_characteristics_drop_at_the_break_away(self) -> None:
        figures = findings(densely('paper_fig4_constant'))[CONTINUITY].figures
        assert figures['jump_at_break_away'] == pytest.approx(KINETIC, rel=1e-9)   # from 0.24 N to 0.12 N

    def test_a_jump_is_found(self) -> None:
        """Also in a bag, where no sample is at the event itself."""
        run = densely('paper_fig8')
        event = next(event for event in run.events if event.kind == EventKind.STICK)
        events = [other._replace(friction_force=other.friction_force - 50.0) if other is event else other
                  for other in run.events]
        finding = findings(replace(run, events=events))[CONTINUITY]
        assert finding.outcome == FAILS
        assert finding.figures['jump_at_standstill'] == pytest.approx(50.0)

    def test_extrapolated_from_the_samples_of_a_bag(self, tmp_path: Path) -> None:
        assert run(['simulate', 'paper_fig7', '--duration', '3', '--bag', str(tmp_path / 'bag')]) == 0
        recorded, exact = read_run(tmp_path / 'bag'), densely('paper_fig7', 3.0)
        one, other = (findings(each)[CONTINUITY].figures for each in (recorded, exact))
        assert one['jump_at_standstill'] == pytest.approx(other['jump_at_standstill'], rel=1e-3)
        assert one['jump_at_break_away'] == pytest.approx(0.0, abs=0.1)

    def test_a_break_away_while_the_slider_gets_slower(self) -> None:
        """A periodic force brings it about; friction then drops to the driving forces."""
        finding = findings(densely('cutting_force', 2.0))[CONTINUITY]
        assert finding.outcome == NOT_APPLICABLE
        assert finding.figures['jump_at_break_away'] > 100.0


class TestTwoValues:
    def test_both_branches_at_half_way(self) -> None:
        run = densely('paper_fig7', 30.0)
        figures = findings(run)[TWO_VALUES].figures
        speed, broken = figures['speed'], run.cycles()[-1].static_coefficient
        assert speed == pytest.approx(0.5 * run.cycles()[-1].peak_speed, rel=1e-9)
        lower = 0.12 - 2.0 * speed              # mu_k falls by 0.07 over 35 mm/s
        upper = lower + (broken - 0.12) * (1.0 - speed / 0.035)
        assert figures['decelerating_force'] == pytest.approx(lower * NORMAL, rel=1e-6)
        assert figures['accelerating_force'] == pytest.approx(upper * NORMAL, rel=1e-6)

    def test_one_value_is_reported(self) -> None:
        """The conventional run, as if it were said to have two branches."""
        run = densely('paper_fig4_falling', 3.0)
        finding = findings(replace(run, scene=load_scene('paper_fig7')))[TWO_VALUES]
        assert finding.outcome == FAILS
        assert finding.figures['least_gap_ratio'] == pytest.approx(0.0, abs=1e-6)


class TestOscillation:
    def test_small_and_vanishing(self) -> None:
        figures = findings(densely('paper_fig8'))[OSCILLATION].figures
        assert figures['swings'] >= 8
        assert 0.01 < figures['amplitude_ratio'] < 0.05
        assert figures['remaining_ratio'] < 1e-4

    def test_none_without_contact(self) -> None:
        assert findings(densely('paper_fig7'))[OSCILLATION].figures['largest_speed'] == 0.0

    def test_a_soft_contact_swings_widely(self) -> None:
        """Where friction falls to nothing, too, so that the slider stops with the spring far from rest."""
        finding = findings(densely('paper_fig8', contact__stiffness=1e6,
                                   friction__kinetic__coefficients=(0.12, 0.0)))[OSCILLATION]
        assert finding.outcome == FAILS
        assert finding.figures['amplitude_ratio'] > 0.1

    def test_an_overdamped_contact_has_nothing_to_show(self) -> None:
        finding = findings(densely('paper_fig8', contact__damping=2e5))[OSCILLATION]
        assert (finding.outcome, 'overdamped' in finding.text) == (NOT_APPLICABLE, True)

    def test_a_run_too_coarse_to_see_it(self, tmp_path: Path) -> None:
        """At 100 Hz a swing of 20 Hz has five samples; a longer run is sampled finely towards its end."""
        bag = ['simulate', 'paper_fig8', '--duration', '5', '--set', 'time.rate=100.0', '--bag', str(tmp_path / 'bag')]
        assert run(bag) == 0
        found = findings(read_run(tmp_path / 'bag'))
        assert (found[OSCILLATION].outcome, found[CONTINUITY].outcome) == (NOT_APPLICABLE, NOT_APPLICABLE)
        assert (found[TWO_VALUES].outcome, found[LONG_REST].outcome) == (HOLDS, HOLDS)
        assert findings(densely('paper_fig8', 600.0))[OSCILLATION].outcome == HOLDS


class TestLimitCycle:
    @pytest.mark.parametrize(('scene', 'period'), [('paper_fig7', 0.619075168), ('paper_fig8', 0.659065697)])
    def test_from_several_starts(self, scene: str, period: float) -> None:
        figures = findings(densely(scene, 60.0))[LIMIT_CYCLE].figures
        assert figures['starts'] == 6
        assert figures['period'] == pytest.approx(period, abs=6e-10)
        assert figures['spread'] < 1e-12
        assert figures['own_difference'] < 1e-12

    def test_the_own_cycle_of_a_short_run_is_distinguished(self) -> None:
        assert findings(densely('paper_fig8', 2.0))[LIMIT_CYCLE].figures['own_difference'] > 1e-3

    def test_two_motions_side_by_side(self) -> None:
        """Where steady sliding is stable, too: who starts at the drive's speed slides on, who rests sticks."""
        finding = findings(densely('paper_fig8', drive__velocity=0.05, axis__drive_damping=1000.0))[LIMIT_CYCLE]
        assert finding.outcome == FAILS
        assert finding.figures['without_cycle'] == 1
        assert 'at 52 mm/s' in finding.text

    def test_a_limit_cycle_of_two_slips_is_one(self) -> None:
        other = densely('paper_fig8', 30.0, friction__static__law='logarithmic', initial__rest_time=0.0)
        assert other.cycles()[-1].period == pytest.approx(other.cycles()[-3].period, rel=1e-9)
        assert other.cycles()[-1].period != pytest.approx(other.cycles()[-2].period, rel=0.05)
        assert findings(other)[LIMIT_CYCLE].outcome == HOLDS

    def test_stick_slip_that_dies_out(self) -> None:
        finding = findings(densely('paper_fig4_constant', drive__velocity=0.005))[LIMIT_CYCLE]
        assert (finding.outcome, '2 complete cycles' in finding.text) == (NOT_APPLICABLE, True)


class TestContact:
    def test_by_how_much(self) -> None:
        """From the limit cycles of both figures of the paper, whichever of the two is given."""
        for scene in ('paper_fig7', 'paper_fig8'):
            figures = findings(densely(scene))[CONTACT].figures
            assert figures['period'] == pytest.approx(0.659065697 / 0.619075168 - 1.0, rel=1e-6)
            assert figures['peak_speed'] == pytest.approx(1.16642823367e-2 / 1.23285921663e-2 - 1.0, rel=1e-6)
            assert figures['added_compliance'] == pytest.approx(0.12)

    def test_a_soft_contact_is_essential(self) -> None:
        finding = findings(densely('paper_fig8', contact__stiffness=1e6))[CONTACT]
        assert finding.outcome == FAILS
        assert finding.figures['largest_change'] > 0.1


class TestLongRest:
    def test_first_break_away(self) -> None:
        figures = findings(densely('paper_fig8'))[LONG_REST].figures
        assert figures['first_force'] == pytest.approx(0.24 * NORMAL, rel=1e-12)
        assert figures['highest_later_force'] < 0.97 * figures['first_force']

    def test_a_lower_one_is_found(self) -> None:
        run = densely('paper_fig8', 2.0)
        first = next(event for event in run.events if event.kind == EventKind.BREAKAWAY)
        assert math.isinf(first.rest_time)
        events = [event._replace(friction_force=700.0) if event is first else event for event in run.events]
        assert findings(replace(run, events=events))[LONG_REST].outcome == FAILS
