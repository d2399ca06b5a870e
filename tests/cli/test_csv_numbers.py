# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Numbers as lines of CSV: the digits of Python."""

import csv
import io

import numpy as np
import pytest

from stickslip_sim.cli import csv_numbers

RANDOM = np.random.default_rng(8)
FLOATS = np.concatenate([
    RANDOM.integers(0, 2 ** 64, 20_000, dtype=np.uint64).view(np.float64), RANDOM.random(5_000),
    np.arange(5_000) / 1000,
    [0.0, -0.0, np.inf, -np.inf, np.nan, -np.nan, 5e-324, 1e16, 1e17, 0.1 + 0.2, 1234567890123456.75, 2.0 ** -1074]])


@pytest.mark.parametrize('is_compiled', [True, False], ids=['compiled', 'python'])
def test_floats_have_the_17_digits_of_python(monkeypatch: pytest.MonkeyPatch, is_compiled: bool) -> None:
    """Of all sizes, in all notations; a NaN has no sign."""
    if not is_compiled:
        monkeypatch.setattr(csv_numbers, 'COMPILED', None)
    elif csv_numbers.COMPILED is None:
        pytest.skip('the writer of numbers is not compiled here')
    assert csv_numbers.rows_text([FLOATS]).splitlines() == [f'{value:.17g}' for value in FLOATS.tolist()]


@pytest.mark.parametrize('is_compiled', [True, False], ids=['compiled', 'python'])
def test_all_kinds_of_numbers_are_written_as_python_does(monkeypatch: pytest.MonkeyPatch, is_compiled: bool) -> None:
    """Integers, truth values, small floats and words, also from every second row."""
    if not is_compiled:
        monkeypatch.setattr(csv_numbers, 'COMPILED', None)
    columns = [np.array([-2 ** 63, 2 ** 63 - 1, 0, 7]), np.array([True, False, True, True]),
               np.array([1, 2, 3, 2 ** 63 - 1], np.uint64), np.array([0.1, 2.5, -1.0, 0.0], np.float32),
               np.arange(8.0)[::2], np.array([1.0, 0.0, 0.0, 1.0])]
    assert csv_numbers.are_numbers(columns)
    expected = io.StringIO()
    written = [column.tolist() for column in columns[:3]] + [[f'{value:.17g}' for value in column.tolist()]
                                                          for column in columns[3:5]] + [['b', 'a', 'a', 'b']]
    csv.writer(expected, lineterminator='\n').writerows(zip(*written, strict=True))
    assert csv_numbers.rows_text(columns, [None] * 5 + [['a', 'b']]) == expected.getvalue()


def test_texts_and_integers_beyond_64_bits_are_for_others() -> None:
    """They go through the csv module."""
    assert not csv_numbers.are_numbers([np.array(['a'], object)])
    assert not csv_numbers.are_numbers([np.array([2 ** 63], np.uint64)])
