# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Offline runs: samples at exact instants, receipts, limits."""

import json
import math
from fractions import Fraction

import numpy as np
import pytest

from stickslip_sim.core.errors import InputError
from stickslip_sim.core.types import EnergyBalance, Event, EventKind, Sample
from stickslip_sim.inputs import load_scene
from stickslip_sim.report.quantity import quantities, quantity
from stickslip_sim.runs import SimulatedRun, simulate, simulate_events
from stickslip_sim.runs.simulated import MAX_SAMPLES, check_run_times


@pytest.fixture(scope='module')
def run() -> SimulatedRun:
    return simulate(load_scene('paper_fig8'), 5.0, 0.001)


def test_samples_are_at_exact_instants(run: SimulatedRun) -> None:
    assert len(run.samples['time']) == 5001
    assert run.samples['time'].tolist() == [k / 1000 for k in range(5001)]
    for k, (second, fraction) in enumerate(zip(run.samples['second'], run.samples['fraction'])):
        whole, rest = divmod(Fraction(k, 1000), 1)
        assert (second, fraction) == (float(whole), float(rest))


def test_columns_are_those_of_a_sample(run: SimulatedRun) -> None:
    assert set(run.samples) == {*Sample._fields, 'time'}
    last = list(run.sample_rows())[-1]
    assert last.time == 5.0
    assert last.position == run.samples['position'][-1]
    assert last.mode.name == run.receipt['results']['final_state']['mode']


def test_events_do_not_depend_on_the_samples(run: SimulatedRun) -> None:
    other = simulate_events(load_scene('paper_fig8'), 5.0)
    _assert_same(other.events, run.events)
    assert len(other.samples['time']) == 0
    coarse = simulate(load_scene('paper_fig8'), 5.0, 0.5)
    _assert_same(coarse.events, run.events)
    np.testing.assert_allclose(coarse.samples['position'], run.samples['position'][::500], rtol=0, atol=1e-14)


def _assert_same(some: list[Event], others: list[Event]) -> None:
    assert [event.kind for event in some] == [event.kind for event in others]
    for event, other in zip(some, others):
        assert event.time == pytest.approx(other.time, rel=0, abs=1e-13)
        assert event.position == pytest.approx(other.position, rel=0, abs=1e-13)


def test_a_period_that_does_not_divide_the_duration_ends_before_it() -> None:
    run = simulate(load_scene('paper_fig7'), 1.0, Fraction(3, 10))
    assert run.samples['time'].tolist() == [0.0, 0.3, 0.6, 0.9]
    assert run.receipt['results']['final_state']['second'] == 1.0
    assert len(simulate(load_scene('paper_fig7'), 1.0, 7.0).samples['time']) == 1


def test_same_run_twice_is_bit_identical(run: SimulatedRun) -> None:
    again = simulate(load_scene('paper_fig8'), 5.0, 0.001)
    assert again.events == run.events
    assert all(np.array_equal(again.samples[name], run.samples[name]) for name in run.samples)
    assert again.receipt['results'] == run.receipt['results']


def test_a_receipt_has_the_settings_of_the_solver() -> None:
    for solver, settings in (('fixed_step', {'method': 'euler', 'step': 1e-3}),
                             ('adaptive', {'method': 'DOP853', 'rtol': 1e-8, 'atol': 1e-10})):
        receipt = simulate_events(load_scene('paper_fig7', {'solver.name': solver}), 0.7).receipt
        assert (receipt['solver'], receipt['solver_settings']) == (solver, settings)
        assert receipt['results']['events']['breakaway'] == 1


def test_receipt_says_what_ran_and_what_came_out(run: SimulatedRun) -> None:
    receipt = json.loads(json.dumps(run.receipt, allow_nan=False))
    assert receipt['scene'] == 'paper_fig8'
    assert receipt['scene_hash'] == run.scene.hash
    assert (receipt['solver'], receipt['solver_settings']) == ('exact', {})
    assert set(receipt['versions']) == {'stickslip', 'python', 'numpy', 'hot_path'}
    results = receipt['results']
    assert results['events']['breakaway'] == sum(event.kind == EventKind.BREAKAWAY for event in run.events)
    assert results['motion'] == 'stick-slip'
    assert results['root_iterations'] > 0
    assert results['mean']['rest_time'] == 'inf'
    assert set(receipt['cost']) == {'cpu_time_s', 'cpu_time_per_simulated_second', 'wall_time_s'}


def test_receipt_carries_the_energy_balance(run: SimulatedRun) -> None:
    energy = run.receipt['energy']
    assert set(energy) == {*EnergyBalance._fields, 'residual', 'relative_residual'}
    assert energy['relative_residual'] <= 1e-14
    assert energy['drive_work'] == pytest.approx(
        energy['friction_loss'] + energy['drive_damper_loss'] + energy['contact_damper_loss'] + energy['stored']
        - energy['contact_exchange'], rel=1e-14)
    assert 0.0 < energy['stored'] < energy['friction_loss'] < energy['drive_work'] < energy['throughput']


def test_smooth_sliding_gets_a_receipt_too() -> None:
    run = simulate_events(load_scene('fast_feed'), 3.0)
    assert run.receipt['results']['motion'] == 'smooth sliding'
    assert run.receipt['results']['last'] is None


def test_progress_reaches_the_end() -> None:
    seen: list[float] = []
    simulate(load_scene('paper_fig7'), 1.0, 0.01, seen.append)
    assert seen == sorted(seen)
    assert seen[-1] == 1.0


@pytest.mark.parametrize('duration', [0.0, -1.0, math.nan, math.inf, 1e12])
def test_refused_durations(duration: float) -> None:
    with pytest.raises(InputError, match='duration'):
        simulate_events(load_scene('paper_fig7'), duration)


@pytest.mark.parametrize('period', [0.0, -0.001, math.nan, math.inf])
def test_refused_sample_periods(period: float) -> None:
    with pytest.raises(InputError, match='sample period'):
        simulate(load_scene('paper_fig7'), 1.0, period)


def test_too_many_samples_are_refused_with_their_number() -> None:
    check_run_times(1.0, 1.0 / (MAX_SAMPLES - 2))
    with pytest.raises(InputError, match='60000000001 rows'):
        check_run_times(60.0, 1e-9)


def test_a_long_run_has_its_samples_in_blocks_and_refuses_to_hold_them(monkeypatch: pytest.MonkeyPatch) -> None:
    check_run_times(10 * 3600.0, 0.001)
    monkeypatch.setattr('stickslip_sim.runs.simulated.MOST_HELD', 10)
    monkeypatch.setattr('stickslip_sim.runs.samples.MOST_IN_MEMORY', 100)
    run = simulate(load_scene('paper_fig7'), 0.1, 0.001)
    assert sum(len(block['time']) for block in run.sample_blocks()) == 101
    with pytest.raises(InputError, match='samples = 101 is refused: must be at most 100 to be in memory at once'):
        _ = run.samples


def test_too_many_events_are_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr('stickslip_sim.runs.simulated.MAX_EVENTS', 10)
    with pytest.raises(InputError, match='at most 10 events'):
        simulate_events(load_scene('paper_fig8'), 60.0)


# The faults of a scene act offline as they do step by step.

FAULTS = {'faults.ids': ['dry', 'knock', 'stop'], 'faults.kinds': ['friction_scale', 'force_pulse', 'drive_freeze'],
          'faults.starts': [0.3, 0.7004, 1.2],
          'faults.durations': [0.5, 0.0125, 0.25], 'faults.values': [1.5, 900.0, 0.0]}


@pytest.mark.parametrize('name', ['paper_fig7', 'positioning', 'cutting_force'])
def test_a_run_from_event_to_event_is_that_of_the_steps(name: str) -> None:
    scene = load_scene(name, {**FAULTS, 'time.rate': 200.0})
    run = simulate(scene, 2.0, 0.005)
    rig = scene.make_rig()
    results = [rig.make_step() for _ in range(401)]
    assert run.events == [event for result in results for event in result.events]
    assert list(run.sample_rows()) == [result.sample for result in results]
    assert run.events != simulate_events(load_scene(name, {'time.rate': 200.0}), 2.0).events


# Figures in words: numbers that are read beside each other have one unit.

def test_a_quantity_has_the_prefix_that_suits_it() -> None:
    found = [quantity(value, 's', 4) for value in (0.9723, 1.137, 3600.0, 0.0)]
    assert found == ['972.3 ms', '1.137 s', '3600 s', '0 s']


def test_kilograms_have_a_prefix_already() -> None:
    assert [quantity(value, 'kg', 4) for value in (1553.2, 34.0, 0.25, 2e-6)] == ['1553 kg', '34 kg', '250 g', '2 mg']
    assert quantities([0.4, 0.5, 1.2], 'kg', 4) == ['400 g', '500 g', '1200 g']
    assert quantities([900.0, 1000.0, 1100.0], 'kg', 4) == ['900 kg', '1000 kg', '1100 kg']


def test_few_digits_are_no_power_of_ten() -> None:
    found = [quantity(value, 'N s/m', 2) for value in (4.6e-4, 985.0, 0.0312)]
    assert found == ['460 µN s/m', '980 N s/m', '31 mN s/m']


def test_quantities_have_that_of_the_one_in_the_middle() -> None:
    assert quantities([0.6631, 0.9723, 1.4991], 's', 4) == ['663.1 ms', '972.3 ms', '1499 ms']
    assert quantities([0.0, 0.2, 0.3], 'm', 4) == ['0 mm', '200 mm', '300 mm']
    assert quantities([0.1, 0.25], '', 4) == ['0.1', '0.25']


def test_quantities_too_far_apart_have_one_each() -> None:
    assert quantities([0.001, 0.5, 100.0], 's', 4) == ['1 ms', '500 ms', '100 s']
