# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""A normal force that varies smoothly: closed forms where a slip has one, and a rest that it ends."""

import math
from collections.abc import Callable
from typing import Any

import pytest

from stickslip_sim.axis import Axis, Friction, InitialState, RigidContact
from stickslip_sim.core.input_profile import InputProfile, Sinusoid, constant, table
from stickslip_sim.core.types import EventKind
from stickslip_sim.friction import KineticTable, StaticLaw, StaticLawKind
from stickslip_sim.inputs import load_scene
from stickslip_sim.runs import simulate, simulate_events
from stickslip_sim.runs.error_estimate import error_estimate
from stickslip_sim.simulation.simulator import Simulator
from stickslip_sim.solvers import adaptive
from stickslip_sim.solvers.adaptive.engine import SAMPLED_AT, first_fall
from tests.support.axes import instant
from tests.support.tool import Capture, answered

SWAY = InputProfile((0.0,), (0.0,), (0.0,), math.inf, (Sinusoid(6.0, 1.5, 0.4),))
RISE = table('normal_load', (0.0, 0.4, 1.0), (-8.0, 10.0, 0.0))


def simulator(load: InputProfile, slope: float = 0.0, force: float = 0.0, velocity: float = 0.0) -> Simulator:
    """Return 2 kg under 16 N and a load, without a spring: mu_k = 0.25 + slope |ẋ|, mu_s = 0.3."""
    friction = Friction(StaticLaw(StaticLawKind.CONSTANT, 0.3, 0.3), KineticTable((0.0,), (0.25,), slope), None)
    axis = Axis(2.0, 0.0, 0.0, 16.0, RigidContact(), friction)
    return Simulator(axis, InitialState(velocity=velocity), constant(0.0), constant(force),
                     adaptive.solver(rtol=1e-11, atol=1e-13), load=load)


def pressed(load: InputProfile, time: float) -> float:
    """Return ∫ N dt from 0 on, N s."""
    if load is SWAY:
        omega = 2.0 * math.pi * 1.5
        return 16.0 * time + 6.0 * (math.cos(0.4) - math.cos(omega * time + 0.4)) / omega
    first, rest = min(time, 0.4), max(time - 0.4, 0.0)
    return 16.0 * time + (-8.0 + 22.5 * first) * first + (10.0 - 10.0 / 0.6 * 0.5 * rest) * rest


@pytest.mark.parametrize('load', [SWAY, RISE])
@pytest.mark.parametrize('slope', [0.0, 0.2])
def test_a_slip_is_the_closed_form(load: InputProfile, slope: float) -> None:
    """m u′ = −N (a + b u): u + a/b falls as exp(−(b/m) ∫N dt)."""
    sim = simulator(load, slope, velocity=8.0)
    for time in (0.2, 0.5, 0.9):
        assert sim.advance(instant(time)) == []
        impulse = pressed(load, time)
        wanted = 8.0 - 0.125 * impulse
        if slope:
            wanted = (8.0 + 0.25 / slope) * math.exp(-0.5 * slope * impulse) - 0.25 / slope
        assert sim.sample().velocity == pytest.approx(wanted, abs=1e-9)


def test_a_rest_ends_where_the_limit_comes_down_to_the_force() -> None:
    """0.3 N(t) = 3.6 N, N = 16 + 6 sin(ωt + 0.4): at N = 12, the first time behind its largest value."""
    sim = simulator(SWAY, force=3.6)
    first, *_ = sim.advance(instant(0.6))
    wanted = (math.pi + math.asin(4.0 / 6.0) - 0.4) / (2.0 * math.pi * 1.5)
    assert first.kind == EventKind.BREAKAWAY
    assert first.time == pytest.approx(wanted, abs=1e-10)
    assert first.friction_force == pytest.approx(3.6, rel=1e-9)


@pytest.mark.parametrize(('law', 'how'), [
    ({}, 'of the exact solver'),
    ({'friction.static.law': 'kato', 'friction.static.exponent': 0.5}, '0.001 of the tolerances')])
def test_the_error_is_estimated_and_holds(law: dict[str, object], how: str) -> None:
    """Against a run with tolerances near rounding; with Kato's law no exact run can be had."""
    changes = {**law, 'solver.name': 'adaptive', 'solver.rtol': 1e-6, 'solver.atol': 1e-9, 'normal_load.course': 'sine',
               'normal_load.amplitude': 800.0, 'normal_load.frequency': 3.0}
    run = simulate_events(load_scene('paper_fig7', changes), 1.5)
    estimate = error_estimate(run)
    fine = simulate_events(load_scene('paper_fig7', {**changes, 'solver.rtol': 1e-12, 'solver.atol': 1e-15}), 1.5)
    kinds = [EventKind.BREAKAWAY, EventKind.STICK]
    pairs = list(zip((e for e in run.events if e.kind in kinds), (e for e in fine.events if e.kind in kinds)))
    assert len(pairs) >= 4
    assert estimate.until_s == 1.5
    assert 0.0 < max(abs(a.time - b.time) for a, b in pairs) <= estimate.event_time_s < 1e-4
    assert how in estimate.how


@pytest.mark.parametrize(('scene', 'amplitude', 'frequency'), [
    ('paper_fig7', 1000.0, 7.0), ('paper_fig7', 1500.0, 0.9), ('paper_fig8', 343.0, 25.0), ('paper_fig8', 1000.0, 7.0)])
def test_events_are_the_same_with_and_without_samples(scene: str, amplitude: float, frequency: float) -> None:
    """A limit that is touched for less than a step is no longer passed over: 31 break-aways in 8 s of the first."""
    end = 2.0   # s
    changes = {'solver.name': 'adaptive', 'normal_load.course': 'sine', 'normal_load.constant': 0.0,
               'normal_load.amplitude': amplitude, 'normal_load.frequency': frequency}
    loaded = load_scene(scene, changes)
    whole = simulate_events(loaded, end).events
    assert all(simulate(loaded, end, period).events == whole for period in (0.0173, 0.6))
    split_run = Simulator(loaded.axis, loaded.initial, loaded.drive, loaded.force, loaded.solver.make,
                          load=loaded.normal_load)
    split = [event for time in (0.0, 0.31, 0.310001, 1.2, 1.9, end) for event in split_run.advance(instant(time))]
    assert split == [*whole]
    if frequency == 7.0 and scene == 'paper_fig7':
        breaks = [event.time for event in whole if event.kind == EventKind.BREAKAWAY]
        assert breaks[5] == pytest.approx(1.81893, abs=5e-6)   # the first that was missed


@pytest.mark.parametrize(('times', 'values', 'wanted'), [
    ((0.0, 1.0), (1.0, 1.0), None), ((0.0, 1.0), (1.0, -1.0), 0.5), ((0.0, 1.0), (0.0, -1.0), 0.0),
    ((0.0, 1.0), (0.0, 1.0), None)])
def test_a_straight_guard_falls_where_it_says(times: tuple[float, float], values: tuple[float, float],
                                              wanted: float | None) -> None:
    found = root_of(lambda t: values[0] + (values[1] - values[0]) * t, *times)
    assert found == (wanted if wanted is None else pytest.approx(wanted, abs=1e-15))


@pytest.mark.parametrize('depth', [1e-3, 1e-6, 1e-9, 1e-12])
@pytest.mark.parametrize('place', [0.003, 0.11, 0.4999, 0.7312, 0.9981])
def test_a_guard_that_comes_and_goes_is_found(place: float, depth: float) -> None:
    """A parabola that is below 0 for 6e-6 to 0.2 of the step, at any place of it."""
    assert root_of(lambda t: 3.0 * (t - place) ** 2 + depth, 0.0, 1.0) is None
    start = max(place - math.sqrt(depth / 3.0), 0.0)
    found = root_of(lambda t: 3.0 * (t - place) ** 2 - depth, 0.0, 1.0)
    if start > 0.0:
        assert found == pytest.approx(start, abs=1e-9)


def root_of(guard: Callable[[float], float], begin: float, end: float) -> float | None:
    samples = [guard(begin + (end - begin) * float(share)) for share in SAMPLED_AT]
    return first_fall(guard, begin, end, samples, 1e-15)


SINE = {'normal_load.course': 'sine', 'normal_load.constant': 0.0, 'normal_load.amplitude': 300.0,
        'normal_load.frequency': 7.0}
KATO = {'friction.static.law': 'kato', 'friction.static.exponent': 0.6}


@pytest.mark.parametrize(('changes', 'says'), [
    (SINE, 'solver.name: exact misses none'), (SINE | KATO, "no solver takes Kato's law there without"),
    (SINE | {'solver.name': 'exact'}, ''), ({}, ''),
    ({'normal_load.course': 'steps', 'normal_load.times': [0.0, 0.1], 'normal_load.forces': [0.0, 50.0]}, '')],
    ids=['adaptive', 'kato', 'exact', 'constant', 'steps'])
def test_a_run_says_that_it_may_miss_an_event(changes: dict[str, Any], says: str, capsys: Capture) -> None:
    """In its receipt, and in the summary of the tool."""
    values = {'solver.name': 'adaptive'} | changes
    note = simulate(load_scene('paper_fig7', values), 0.05).receipt['results'].get('note', '')
    assert (says in note, 'may miss an event' in note) == (True, says != '')
    settings = [word for name, value in values.items() for word in ('--set', f'{name}={value}')]
    code, said, _ = answered(capsys, 'simulate', 'paper_fig7', '--duration', '0.05', *settings)
    assert (code, 'may miss an event' in said) == (0, says != '')
