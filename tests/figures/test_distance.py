# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Distances of two lists of events: what each of the meanings sees."""

from stickslip_sim.core.types import EventKind
from stickslip_sim.figures.cycles import cycle_figures
from stickslip_sim.figures.distance import (
    cycle_difference,
    event_difference,
    first_difference,
    first_mismatch,
    pair,
    seconds_between,
    shift_between,
)
from tests.support.axes import RIGID, paper_axis, run_events

DURATION = 3.0
EVENTS = run_events(paper_axis(RIGID), 0.002, DURATION)


def test_a_run_is_no_distance_from_itself() -> None:
    assert first_difference(EVENTS, EVENTS) is None
    assert first_mismatch(EVENTS, EVENTS) == len(EVENTS) > 8
    assert shift_between(EVENTS, EVENTS, DURATION) == (0.0, 0.0, DURATION)
    assert event_difference(EVENTS, EVENTS, DURATION) == 0.0
    assert cycle_difference(*cycle_figures(EVENTS)[:1] * 2) == 0.0


def test_an_event_that_is_late_differs_and_does_not_mismatch() -> None:
    late = [*EVENTS]
    late[3] = late[3]._replace(fraction=late[3].fraction + 1e-6)
    assert (first_difference(EVENTS, late), first_mismatch(EVENTS, late)) == (3, len(EVENTS))
    assert shift_between(EVENTS, late, DURATION).time == seconds_between(EVENTS[3], late[3]) > 0.9e-6


def test_a_missing_event_ends_the_common_part_and_leaves_the_other_pairs() -> None:
    short = [*EVENTS[:4], *EVENTS[5:]]
    assert first_difference(EVENTS, short) == first_mismatch(EVENTS, short) == 4
    assert shift_between(EVENTS, short, DURATION).until == EVENTS[4].time
    points = [(event.time, event.position) for event in EVENTS]
    assert pair(points, [*points[:4], *points[5:]], DURATION) == [(one, one) for one in points if one != points[4]]


def test_a_cycle_that_one_run_alone_has_ends_the_common_part() -> None:
    starts = [k for k, event in enumerate(EVENTS) if event.kind == EventKind.BREAKAWAY]
    without = [*EVENTS[:starts[1]], *EVENTS[starts[2]:]]
    assert [event.kind for event in without] == [event.kind for event in EVENTS[:len(without)]]
    assert first_mismatch(EVENTS, without) == len(without)
    assert shift_between(EVENTS, without, DURATION) == (0.0, 0.0, EVENTS[starts[1]].time)
