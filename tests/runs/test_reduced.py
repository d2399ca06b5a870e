# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""As many samples as a picture can show: all of few, and of many no peak less."""

import numpy as np
import pytest

from stickslip_sim.core.arrays import Numbers
from stickslip_sim.runs import Columns, reduced
from stickslip_sim.runs.reduced import ReducedWindow
from stickslip_sim.runs.reduced import reduced as rows_for

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
    monkeypatch.setattr(reduced, 'MOST_HELD', 200)


def test_few_rows_remain_as_they_are() -> None:
    columns = motion(1000)
    found = rows_for(blocks(columns, 70), [(0.0, columns['time'][-1]), (300.0, 400.0)], NAMES)
    assert list(found) == ['time', *NAMES]
    assert all(np.array_equal(found[name], columns[name]) for name in found)


@pytest.mark.parametrize('size', [1, 30, 199, 5000])
@pytest.mark.usefixtures('_few')
def test_the_extremes_of_each_part_remain(size: int) -> None:
    columns = motion(5000)
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
    columns = motion(5000)
    first, last = 1000, 1100
    begin, end = columns['time'][first], columns['time'][last]
    for size in (1, 64, 5000):
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
