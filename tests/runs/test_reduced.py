# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""As many samples as a picture can show: all of few, and of many no peak less."""

import math
from fractions import Fraction
from typing import Any

import numpy as np
import pytest

import stickslip_sim
from stickslip_sim import InputError, Instant, SolverError, load_scene, simulate
from stickslip_sim.core.arrays import Columns, Numbers
from stickslip_sim.core.time_grid import Instants, instants, multiples
from stickslip_sim.runs import samples, simulated
from stickslip_sim.runs.samples import ReducedWindow
from stickslip_sim.runs.samples import reduced as rows_for
from stickslip_sim.solvers import exact, with_advance

NAMES = 'position', 'drive_position', 'velocity'
WHOLE = (0.0, 1e9)
PARTS = 20


def motion(count: int) -> Columns:
    """Return noise with a time that rises unevenly."""
    numbers = np.random.default_rng(1)
    time = np.cumsum(numbers.uniform(0.5, 1.5, count))
    return {'time': time, **{name: numbers.normal(size=count) for name in (*NAMES, 'mode')}}


def error_of(columns: Columns) -> Numbers:
    return columns['drive_position'] - columns['position']


def blocks(columns: Columns, size: int) -> list[Columns]:
    return [{name: column[k:k + size] for name, column in columns.items()}
            for k in range(0, len(columns['time']), size)]


@pytest.fixture
def _few(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(samples, 'MOST_HELD', 200)


def test_few_rows_remain_as_they_are() -> None:
    columns = motion(1000)
    found = rows_for(blocks(columns, 70), [(0.0, columns['time'][-1]), (300.0, 400.0)], NAMES)
    assert list(found) == ['time', *NAMES]
    assert all(np.array_equal(found[name], columns[name]) for name in found)


@pytest.mark.parametrize('size', [1, 30, 199, 2000])
@pytest.mark.usefixtures('_few')
def test_the_extremes_of_each_part_remain(size: int) -> None:
    columns = motion(2000)
    begin, end = columns['time'][[0, -1]]
    found = rows_for(blocks(columns, size), [(begin, end)], NAMES, PARTS)
    assert len(found['time']) <= PARTS * 12
    assert (np.diff(found['time']) > 0.0).all()
    assert found['time'][[0, -1]].tolist() == [begin, end]
    parts, kept = ((PARTS * (each['time'] - begin) / (end - begin)).astype(int) for each in (columns, found))
    for values, shown in ((columns['velocity'], found['velocity']), (error_of(columns), error_of(found))):
        for part in range(PARTS):
            assert shown[kept == part].min() == values[parts == part].min()
            assert shown[kept == part].max() == values[parts == part].max()


@pytest.mark.usefixtures('_few')
def test_what_remains_does_not_grow_with_the_run() -> None:
    lengths = []
    for count in (20_000, 80_000):
        columns = motion(count)
        window = ReducedWindow(columns['time'][0], columns['time'][-1], NAMES, parts=PARTS)
        most = 0
        for block in blocks(columns, 100):
            window.take(block)
            most = max(most, len(window.columns['time']))
        lengths.append(most)
    assert max(lengths) <= 200 + PARTS * 12


@pytest.mark.usefixtures('_few')
def test_a_window_has_all_of_its_rows_and_a_neighbour_on_either_side() -> None:
    columns = motion(2000)
    first, last = 1000, 1100
    begin, end = columns['time'][first], columns['time'][last]
    for size in (1, 64, 2000):
        found = rows_for(blocks(columns, size), [(columns['time'][0], columns['time'][-1]), (begin, end)], NAMES, PARTS)
        inside = np.searchsorted(found['time'], columns['time'][first - 1:last + 2])
        assert np.array_equal(found['time'][inside], columns['time'][first - 1:last + 2])


@pytest.mark.usefixtures('_few')
def test_the_first_rows_may_all_remain() -> None:
    columns = motion(2000)
    window = ReducedWindow(columns['time'][0], columns['time'][-1], NAMES, is_whole_first=True, parts=PARTS)
    for block in blocks(columns, 50):
        window.take(block)
    assert np.array_equal(window.columns['velocity'][:200], columns['velocity'][:200])
    assert len(window.columns['velocity']) < 500


@pytest.mark.usefixtures('_few')
def test_what_was_not_measured_is_no_hindrance() -> None:
    columns = motion(1000)
    columns['velocity'][:] = np.nan
    columns['position'][::3] = np.nan
    found = rows_for(blocks(columns, 100), [tuple(columns['time'][[0, -1]])], NAMES, PARTS)
    assert np.isnan(found['velocity']).all()
    assert np.nanmax(found['position']) == np.nanmax(columns['position'])


def test_nothing_is_nothing() -> None:
    nothing: Columns = {'time': np.empty(0), 'velocity': np.empty(0)}
    assert {name: len(column) for name, column in rows_for([nothing], [WHOLE], ['velocity']).items()} == {
        'time': 0, 'velocity': 0}


def test_two_rows_of_one_time_remain() -> None:
    """Commands of one step."""
    columns = {'time': np.array([0.0, 1.0, 1.0, 2.0]), 'velocity': np.array([1.0, 2.0, 3.0, 4.0])}
    found = rows_for([columns], [(0.0, 2.0), (0.5, 1.5)], ['velocity'])
    assert found['velocity'].tolist() == [1.0, 2.0, 3.0, 4.0]


# Samples taken in blocks: the same bits as one by one, held or made again.

FAULTS: dict[str, object] = {
    'faults.ids': ['slippery', 'push'], 'faults.kinds': ['friction_scale', 'force_pulse'], 'faults.starts': [0.1, 0.25],
    'faults.durations': [0.2, 0.1], 'faults.values': [0.5, 30.0]}
STEPS: dict[str, object] = {'solver.name': 'fixed_step', 'solver.step': 1e-4}
SCENES = [*((name, {}) for name in stickslip_sim.scene_names()), ('paper_fig8', FAULTS), ('paper_fig8', STEPS)]


@pytest.mark.parametrize(('name', 'changes'), SCENES, ids=str)
def test_a_block_has_the_bits_of_its_samples_one_by_one(name: str, changes: dict[str, object]) -> None:
    """Through events, pieces of inputs, sinusoids and faults; the events are the same, too."""
    scene = load_scene(name, changes)
    at = instants(Fraction(1, 700), 0, 700)
    block, single = scene.make_rig(), scene.make_rig()
    rows = np.empty((len(at.seconds), len(stickslip_sim.Sample._fields)))
    events = [event for part in ((0, 1), (1, 333), (333, 700))
              for event in block.take_samples(at.part(*part), rows[part[0]:part[1]])]
    expected, samples = [], []
    for instant in map(Instant, at.seconds.tolist(), at.fractions.tolist()):
        expected += single.advance(instant)
        samples.append(single.simulator.sample())
    assert events == expected
    assert rows.tobytes() == np.array(samples).tobytes()
    assert block.simulator.event_counts == single.simulator.event_counts
    assert block.simulator.time == single.simulator.time


def test_a_table_of_events_may_fill_within_a_block() -> None:
    """More events than the table holds lie between two samples."""
    scene = load_scene('stribeck')
    at = Instants(np.array([0.0, 20.0, 20.0]), np.array([0.0, 0.0, 0.5]))
    rows = np.empty((3, len(stickslip_sim.Sample._fields)))
    rig, single = scene.make_rig(), scene.make_rig()
    assert (events := rig.take_samples(at, rows)) == single.advance(Instant(20.0, 0.5))
    assert len(events) > 64
    assert rows[2].tolist() == [*single.simulator.sample()]


def test_a_state_out_of_range_is_refused_at_its_time() -> None:
    """As `sample` refuses it; the rows before it are not to blame."""
    scene = load_scene('paper_fig8')

    def lose(p: Any, s: Any, second: float, fraction: float, *table: Any) -> tuple[int, int]:
        result = exact.advance(p, s, second, fraction, *table)
        if fraction >= 0.25:
            s.velocity = math.nan
        return result

    simulator = stickslip_sim.Simulator(scene.axis, scene.initial, scene.drive, scene.force,
                                        with_advance(exact.SOLVER, lose))
    at = instants(Fraction(1, 8), 0, 8)
    with pytest.raises(SolverError, match=r'overflows at t = 0\.25 s'):
        simulator.take_samples(at, np.empty((8, len(stickslip_sim.Sample._fields))))


def test_time_does_not_go_back() -> None:
    """A block begins at the present time, or later."""
    rig = load_scene('paper_fig8').make_rig()
    rig.advance(Instant(1.0, 0.0))
    with pytest.raises(InputError, match='time does not go backwards'):
        rig.take_samples(instants(Fraction(1, 10), 0, 3), np.empty((3, len(stickslip_sim.Sample._fields))))


PERIODS = [Fraction(1, 1000), Fraction(1, 3), Fraction(7, 3333), Fraction(10 ** 18 + 9, 10 ** 19)]


@pytest.mark.parametrize('period', PERIODS, ids=str)
def test_instants_are_rounded_once(period: Fraction) -> None:
    """Also where the integers leave those of the machine."""
    first, last = 10 ** 7, 10 ** 7 + 50
    at, times = instants(period, first, last), multiples(period, first, last)
    for k, second, fraction, time in zip(range(first, last), at.seconds, at.fractions, times):
        exact_time = k * period
        assert second == exact_time.numerator // exact_time.denominator
        assert fraction == float(exact_time - int(second))
        assert time == float(exact_time)


def test_a_long_run_makes_its_samples_again(monkeypatch: pytest.MonkeyPatch) -> None:
    """The same bits as one that holds them; events, figures and cost are not counted twice."""
    scene = load_scene('cutting_force')
    held = simulate(scene, 2.0)
    monkeypatch.setattr(simulated, 'MOST_HELD', 100)
    monkeypatch.setattr(simulated, 'GATHERED', 7)
    again = simulate(scene, 2.0)
    assert len(list(again.sample_blocks())) > 100
    assert all(np.array_equal(again.samples[name], column) for name, column in held.samples.items())
    assert list(again.sample_rows()) == list(held.sample_rows())
    assert (again.events, again.summary) == (held.events, held.summary)


def test_a_sample_a_rounding_before_a_second_is_at_that_second() -> None:
    """106 times this period is 4e-17 s less than a second, which no fraction of one can say."""
    at = instants(Fraction('0.009433962264150943'), 106, 107)
    assert (at.seconds.tolist(), at.fractions.tolist()) == ([1.0], [0.0])
    run = simulate('paper_fig7', 1.5, 0.009433962264150943)
    assert run.samples['second'][106] == 1.0
