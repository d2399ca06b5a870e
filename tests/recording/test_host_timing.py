# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Late steps and gaps between commands as marks of a run, from what the node recorded."""

from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from stickslip_sim.recording.host_timing import gap_marks, late_marks
from stickslip_sim.runs import Columns

RATE, LIMIT = 1000.0, 0.01   # Hz, s


def blocks(times: NDArray[Any], size: int = 7) -> list[Columns]:
    return [{'time': np.empty(0)}, *({'time': times[k:k + size]} for k in range(0, len(times), size))]


def test_windows_with_a_step_later_than_the_limit() -> None:
    timing = {'step': np.array([1000, 2000, 2500]), 'steps': np.array([1000, 1000, 500]),
              'lateness_max': np.array([0.002, 0.16, np.nan]), 'overruns': np.array([3, 12, 0])}
    (mark,) = late_marks(timing, RATE, LIMIT)
    assert (mark.begin, mark.end, mark.number, mark.is_of_host) == (1.0, 2.0, 12, True)
    assert mark.label == 'late ≤ 160 ms'
    assert late_marks(timing, RATE, 0.2) == []


@pytest.mark.parametrize('usual', [0.001, 0.01])
def test_commands_that_stay_away(usual: float) -> None:
    """For 65 ms and 240 ms, where they come every 1 or 10 ms; some that come a little late are none."""
    times = np.arange(300) * usual + 2.0
    times[100:] += 0.065 - usual
    times[200:] += 0.24 - usual
    times[50:] += 0.5 * usual
    found = gap_marks(blocks(times), RATE, LIMIT)
    assert [mark.end - mark.begin for mark in found] == pytest.approx([0.065, 0.24])
    assert found[0].end == pytest.approx(times[100])
    assert {mark.label for mark in found} == {'gaps ≤ 240 ms'}


def test_commands_without_a_usual_interval_have_no_gaps() -> None:
    assert gap_marks(blocks(np.array([1.0, 2.0, 9.0, 9.5])), RATE, LIMIT) == []
    assert gap_marks(blocks(np.arange(200) * 1.0), RATE, LIMIT) == []   # every second, as it is meant
    assert gap_marks(blocks(np.empty(0)), RATE, LIMIT) == []
