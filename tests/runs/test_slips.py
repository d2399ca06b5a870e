# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Slips by the speed alone: where they begin and end between two samples, and what is none."""

import numpy as np
import pytest

from stickslip_sim.core.types import EventKind
from stickslip_sim.figures.slips import events_of_slips

THRESHOLD = 0.5   # m/s


@pytest.mark.parametrize('direction', [1, -1])
def test_a_slip_begins_and_ends_where_its_speed_passes_the_threshold(direction: int) -> None:
    """One slip of 4 m/s between two samples of 1 s; before it a swing of less than five times the threshold."""
    speed = np.array([0.0, 2.0, 0.0, 0.0, 4.0, 4.0, 0.0, 0.0], dtype=np.float64)
    still = dict.fromkeys(('position', 'drive_position', 'drive_force', 'friction_force'), np.zeros(len(speed)))
    time = np.arange(8, dtype=np.float64)
    events = events_of_slips({'time': time, 'velocity': direction * speed, **still}, THRESHOLD)
    assert [(event.kind, event.direction, event.time) for event in events] == [
        (EventKind.BREAKAWAY, direction, 3.125), (EventKind.DECELERATE, direction, 4.0),
        (EventKind.STICK, direction, 5.875)]
    assert [event.rest_time for event in events[:1]] == [3.125]
