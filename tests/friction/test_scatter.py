# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Static friction that scatters: the draws, what they do to a stick; all solvers and ways to run share them."""

import math
from dataclasses import replace
from random import Random
from typing import Any

import numpy as np
import pytest
from scipy import stats

from stickslip_sim.axis import Axis, Friction, InitialState
from stickslip_sim.axis.parameters import check_start
from stickslip_sim.core.errors import InputError
from stickslip_sim.core.input_profile import constant
from stickslip_sim.core.types import Event, EventKind, Mode
from stickslip_sim.friction import KineticTable, Scatter, StaticLaw, StaticLawKind
from stickslip_sim.inputs import load_scene
from stickslip_sim.proof.judges import Find
from stickslip_sim.reference import simulate as simulate_reference
from stickslip_sim.runs import simulate_events
from stickslip_sim.runs.batch import run_batch
from stickslip_sim.scene import Scene
from stickslip_sim.study import Study
from stickslip_sim.study.sample import Distribution, Saltelli
from tests.hostile.case import Case, Run, run
from tests.hostile.judges import JUDGES, brute, guards
from tests.support.axes import COMPLIANT, RIGID, Contact, paper_axis, run_events
from tests.support.scatter import factor_of, law_of_stick
from tests.support.scene_files import refusal
from tests.support.tool import Capture, answered, refused

SEEDS = 0, 1, 12345, 2 ** 32, 2 ** 52 - 48, 2 ** 63 - 1


def scene(name: str = 'paper_fig8', **more: Any) -> Scene:
    return load_scene(name, {'friction.static.scatter': 0.1, **more})


def sticks_of(events: list[Event]) -> list[tuple[int, Event]]:
    """Return the break-aways with the index of the stick that each ends."""
    found, stick = [], 0
    for event in events:
        if event.kind == EventKind.BREAKAWAY:
            found.append((stick, event))
        stick += event.kind == EventKind.REVERSE or event.mode == Mode.STICK
    return found


# The draws.

@pytest.mark.parametrize('seed', SEEDS)
def test_the_draws_are_those_of_whole_numbers(seed: int) -> None:
    for scatter in (Scatter(0.1, 0.0, seed), Scatter(0.5, 0.2, seed), Scatter(0.0, 0.3, seed)):
        for stick in (*range(50), 2 ** 26 - 1, 2 ** 26, 2 ** 40):
            assert scatter.factor(stick) == factor_of(scatter, stick)


def test_the_factors_are_normal_and_independent() -> None:
    count = 5_000
    for deviation in (0.05, 0.5):
        bound = 1.0 / deviation
        law = stats.truncnorm(-bound, bound, loc=1.0, scale=deviation)
        by_stick = np.array([Scatter(deviation, 0.0, 7).factor(k) for k in range(count)])
        by_seed = np.array([Scatter(deviation, 0.0, seed).factor(3) for seed in range(count)])
        by_run = np.array([Scatter(0.0, deviation, seed).factor(3) for seed in range(count)])
        for factors in (by_stick, by_seed, by_run):
            assert factors.min() > 0.0
            assert stats.kstest(factors, law.cdf).pvalue > 0.01
            for lag in (1, 2, 5, 64):
                assert abs(np.corrcoef(factors[lag:], factors[:-lag])[0, 1]) < 4.0 / math.sqrt(count)


def test_seeds_that_follow_each_other_share_no_draws() -> None:
    draws = [{Scatter(0.1, 0.0, seed).factor(stick) for stick in range(200)} for seed in range(20)]
    assert len(set.union(*draws)) == sum(map(len, draws)) == 4000


# What they do.

def plain_axis(mu: float, scatter: Scatter, kinetic: float) -> Axis:
    law = StaticLaw(StaticLawKind.CONSTANT, mu, mu, scatter=scatter)
    friction = Friction(law, KineticTable((0.0,), (kinetic,)), None)
    return replace(paper_axis(RIGID), drive_damping=0.0, friction=friction)


def test_a_stick_under_a_constant_feed_lasts_as_the_closed_form_says() -> None:
    """From an unstretched spring t = N mu f / (c v), then the spring has what the slip left in it: 2 mu_k − mu f."""
    scatter, mu, kinetic, feed = Scatter(0.1, 0.0, 5), 0.2, 0.15, 1e-5
    axis = plain_axis(mu, scatter, kinetic)
    events = run_events(axis, feed, 1000.0)
    sticks = sticks_of(events)
    assert len(sticks) > 10
    rate = axis.drive_stiffness * feed
    left, begin = 0.0, 0.0
    for stick, event in sticks:
        limit = axis.normal_force * mu * factor_of(scatter, stick)
        assert limit >= axis.normal_force * kinetic
        assert event.friction_force == pytest.approx(limit, rel=1e-14)
        assert event.time - begin == pytest.approx((limit - left) / rate, rel=1e-9)
        end = events[events.index(event) + 2]   # over a decelerate
        assert end.kind == EventKind.STICK
        left, begin = end.drive_force, end.time


def test_a_slip_leaves_mu_k_as_the_lowest_limit() -> None:
    """Factors below mu_k/mu_s give a stick that breaks away at mu_k: none holds less than the slip before it."""
    events = run_events(plain_axis(0.2, Scatter(0.4, 0.0, 2), 0.19), 1e-4, 200.0)
    lowest = [event for _, event in sticks_of(events) if event.static_coefficient == 0.19]
    assert len(lowest) > 10


def test_the_draw_of_a_run_is_on_all_its_sticks() -> None:
    loaded = load_scene('paper_fig7', {'friction.static.scatter_run': 0.1, 'friction.static.initial': 0.13, 'seed': 3})
    factor = Scatter(0.0, 0.1, 3).factor(0)
    law = loaded.axis.friction.static
    for event in simulate_events(loaded, 10.0).events:
        if event.kind == EventKind.BREAKAWAY:
            initial = max(0.13 * factor, 0.12)
            wanted = replace(law, initial=initial, limit=0.24 * factor).coefficient(event.rest_time)
            assert event.static_coefficient == pytest.approx(wanted, rel=1e-14)


@pytest.mark.parametrize(('name', 'changes'), [
    ('paper_fig8', {}), ('paper_fig7', {}), ('stribeck', {}),
    ('paper_fig8', {'solver.name': 'fixed_step', 'solver.step': 1e-4}), ('paper_fig7', {'solver.name': 'adaptive'}),
    ('paper_fig7', {'friction.static.backward.limit': 0.3, 'drive.velocity': -0.002})])
def test_every_solver_has_the_same_factors(name: str, changes: dict[str, Any]) -> None:
    loaded = scene(name, **changes)
    sticks = sticks_of(simulate_events(loaded, 6.0).events)
    assert len(sticks) > 4
    for stick, event in sticks:
        law = law_of_stick(loaded.axis.friction.along(event.friction_force), stick)
        assert event.static_coefficient == pytest.approx(law.coefficient(event.rest_time), rel=1e-13)


@pytest.mark.parametrize('contact', [RIGID, COMPLIANT])
def test_the_reference_agrees(contact: Contact) -> None:
    axis = paper_axis(contact)
    friction = axis.friction
    axis = replace(axis, friction=replace(friction, static=replace(friction.static, scatter=Scatter(0.2, 0.1, 9))))
    events = [event for event in run_events(axis, 0.002, 4.0) if event.kind != EventKind.KNOT]
    wanted = [event for event in simulate_reference(axis, InitialState(), constant(0.002), constant(0.0), 4.0).events
              if event.kind != EventKind.KNOT]
    assert len(events) > 12
    assert [event.kind for event in events] == [event.kind for event in wanted]
    for event, right in zip(events, wanted, strict=True):
        assert event.time == pytest.approx(right.time, abs=1e-12)
        assert event.static_coefficient == pytest.approx(right.static_coefficient, rel=1e-13)


# The same bits in every way to run, and judges that see a wrong draw.

LOAD = {'normal_load.course': 'sine', 'normal_load.amplitude': 500.0, 'normal_load.frequency': 3.0}


def judged(name: str = 'paper_fig8', **more: Any) -> Run:
    return run(Case(dict(scene(name, **more).values), 3.0).parts)


@pytest.mark.parametrize(('name', 'changes'), [('paper_fig8', {}), ('paper_fig7', {'seed': 4}), ('positioning', {}),
                                               ('paper_fig8', LOAD)])
def test_mirrored_in_parts_from_a_checkpoint_and_in_a_batch_it_is_the_same(name: str, changes: dict[str, Any]) -> None:
    done = judged(name, **changes)
    for judge in JUDGES.values():
        judge(done, Random(1))
    assert guards.judge([done]) == [[]]
    brute.judge(done)


def test_the_judges_see_another_draw() -> None:
    done = judged()
    static = done.parts.axis.friction.static
    friction = replace(done.parts.axis.friction, static=replace(static, scatter=Scatter(0.1, 0.0, 1)))
    wrong = done._replace(parts=done.parts._replace(axis=replace(done.parts.axis, friction=friction)))
    assert guards.judge([wrong])[0]
    with pytest.raises(Find):
        brute.judge(wrong)


def test_a_batch_has_the_figures_of_single_runs() -> None:
    loaded = scene('paper_fig7')
    limits = np.array([0.2, 0.24, 0.3])
    figures = run_batch(loaded.axis, 8.0, drive_velocity=0.002, static_limit=limits)
    for k, limit in enumerate(limits.tolist()):
        own = simulate_events(scene('paper_fig7', **{'friction.static.limit': limit}), 8.0)
        last = [event for event in own.events if event.kind == EventKind.BREAKAWAY][-1]
        assert figures.events[k] == len(own.events)
        assert figures.last_break_away[k] == last.time


def test_each_sample_of_uncertainty_has_a_seed_of_its_own() -> None:
    laws = (Distribution('axis.mass', 'uniform', (340.0, 360.0), 340.0, 360.0),)
    study = Study(scene('paper_fig7').values, Saltelli(laws, 16), 6.0)
    whole = study.figures(0, study.count)
    force = whole.break_away_force.reshape(16, 3)
    assert len({*force[:, 0].tolist()}) == 16
    parts = [study.figures(first, first + 4).break_away_force for first in range(0, study.count, 4)]   # cut pairs
    assert np.concatenate(parts).tolist() == whole.break_away_force.tolist()
    seeded = simulate_events(load_scene('paper_fig7', {'friction.static.scatter': 0.1, 'seed': 2,
                                                       'axis.mass': float(study.points(6, 7)[0, 0])}), 6.0)
    assert seeded.summary.last is not None
    assert force[2, 0] == seeded.summary.last.break_away_force


# The edge.

@pytest.mark.parametrize(('name', 'value'), [
    ('friction.static.scatter', -0.01), ('friction.static.scatter', 0.51), ('friction.static.scatter_run', math.nan),
    ('friction.static.backward.scatter', 0.1)])
def test_a_scatter_beyond_its_range_is_refused(name: str, value: float) -> None:
    error = refusal(load_scene, 'paper_fig8', {name: value})
    assert name in str(error)


def test_a_scatter_of_one_direction_alone_is_refused() -> None:
    friction = paper_axis(RIGID).friction
    other = replace(friction, static=replace(friction.static, scatter=Scatter(0.1)))
    with pytest.raises(InputError, match='as forwards'):
        replace(friction, backward=other)
    with pytest.raises(InputError, match='scatter'):
        Scatter(0.6)
    with pytest.raises(InputError, match='seed'):
        Scatter(0.1, 0.0, -1)


def test_a_contact_starts_with_no_more_than_its_first_stick_holds() -> None:
    """The limit without the factor counted: such a run yielded at once, with a slider at rest."""
    axis = paper_axis(COMPLIANT)
    seed = next(seed for seed in range(9) if factor_of(Scatter(0.1, 0.0, seed), 0) < 0.95)
    friction = replace(axis.friction, static=replace(axis.friction.static, scatter=Scatter(0.1, 0.0, seed)))
    axis, held = replace(axis, friction=friction), axis.normal_force * law_of_stick(friction, 0).limit
    start = InitialState(rest_time=math.inf, deflection=held / COMPLIANT.stiffness)
    check_start(axis, replace(start, deflection=0.999 * start.deflection))
    with pytest.raises(InputError, match='carries at most N mu_s'):
        check_start(axis, replace(start, deflection=1.001 * start.deflection))


def test_the_tool_takes_a_seed(capsys: Capture) -> None:
    given = ('simulate', 'paper_fig7', '--duration', '3', '--set', 'friction.static.scatter=0.1', '--events', '-')
    texts = [answered(capsys, *given, *more)[1] for more in ((), ('--seed', '0'), ('--seed', '1'),
                                                             ('--set', 'seed=1'))]
    assert texts[0] == texts[1] != texts[2] == texts[3]
    assert 'seed' in refused(capsys, *given, '--seed', '-1')
    assert 'must be omitted in a page' in refused(capsys, 'explore', 'paper_fig7', '--set',
                                                   'friction.static.scatter=0.1', '--out', 'page.html')
