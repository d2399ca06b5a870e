# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""What holds for every run of the engine, with any axis and any input profiles."""

import math
from collections.abc import Sequence
from itertools import pairwise

from stickslip_sim.core.errors import SolverError
from stickslip_sim.core.types import Event, EventKind, Mode, Sample
from stickslip_sim.extremes.shared_axes import instant, scaled_profile
from stickslip_sim.simulation.simulator import Simulator

from .made_up_axes import Case

_SLIPS = (Mode.ACCELERATING, Mode.COASTING, Mode.DECELERATING)
_BEFORE = {EventKind.BREAKAWAY: (Mode.STICK,), EventKind.COAST: (Mode.ACCELERATING, Mode.DECELERATING),
           EventKind.ACCELERATE: (Mode.COASTING, Mode.DECELERATING),
           EventKind.DECELERATE: (Mode.ACCELERATING, Mode.COASTING), EventKind.STICK: _SLIPS,
           EventKind.REVERSE: _SLIPS, EventKind.KNOT: _SLIPS}
_AFTER = {EventKind.BREAKAWAY: (*_SLIPS, Mode.STICK), EventKind.COAST: (Mode.COASTING,),
          EventKind.ACCELERATE: (Mode.ACCELERATING,), EventKind.DECELERATE: (Mode.DECELERATING,),
          EventKind.STICK: (Mode.STICK,), EventKind.REVERSE: (*_SLIPS, Mode.STICK), EventKind.KNOT: _SLIPS}
_MOST_EVENTS = 3000     # a run with more of them is not made in parts
_UNBALANCED = 1e-11     # of the throughput


def holds(case: Case) -> None:
    """Run a case whole, in parts and mirrored; raises AssertionError when anything does not fit."""
    whole = simulator(case)
    begin = whole.sample()
    try:
        events = whole.advance(instant(case.duration))
        end = whole.sample()
    except SolverError:
        return
    _are_legal(begin, events, end)
    if len(events) < _MOST_EVENTS:
        _is_the_same_in_parts(case, events, end)
        _is_the_same_mirrored(case, events, end)
    energy = whole.energy
    assert energy is not None
    assert energy.relative_residual <= _UNBALANCED, energy


def simulator(case: Case) -> Simulator:
    """Return the simulator of a case, with its account of energy."""
    return Simulator(case.axis, case.initial, case.drive, case.force, accounting=True)


def _are_legal(begin: Sample, events: Sequence[Event], end: Sample) -> None:
    """Check that each event fits the mode before it, that all numbers are finite, and that time never goes back."""
    mode, direction = begin.mode, begin.direction
    for event in events:
        assert all(map(math.isfinite, event[5:11])), event
        if event.kind == EventKind.BREAKAWAY:
            direction = event.direction
        assert mode in _BEFORE[event.kind] or (event.second, event.fraction) == (0.0, 0.0), (mode, event)
        assert event.mode in _AFTER[event.kind], event
        if event.kind == EventKind.REVERSE:
            direction = -direction
        assert event.direction == direction, event
        assert event.velocity * event.direction >= 0.0, event
        mode = event.mode
    assert mode == end.mode, (mode, end)
    assert all(a.instant <= b.instant for a, b in pairwise(events))
    assert all(0.0 <= event.fraction < 1.0 for event in events)
    assert not events or events[-1].instant <= end.instant


def _is_the_same_in_parts(case: Case, events: Sequence[Event], end: Sample) -> None:
    count = 101
    for times in ((instant(case.duration * k / count) for k in range(1, count)),
                  (event.instant for event in events[:count])):
        parts = simulator(case)
        seen = [event for time in times for event in parts.advance(time)]
        seen += parts.advance(instant(case.duration))
        assert seen == list(events), _first_difference(seen, events)
        assert parts.sample() == end


def _is_the_same_mirrored(case: Case, events: Sequence[Event], end: Sample) -> None:
    image = simulator(case._replace(
        initial=case.initial.__class__(-case.initial.position, -case.initial.velocity, case.initial.rest_time),
        drive=scaled_profile(case.drive, -1.0), force=scaled_profile(case.force, -1.0)))
    seen = [_mirrored(event) for event in image.advance(instant(case.duration))]
    assert seen == list(events), _first_difference(seen, events)
    assert image.sample().position == -end.position


def _mirrored(event: Event) -> Event:
    return event._replace(direction=-event.direction, position=-event.position, velocity=-event.velocity,
                          drive_position=-event.drive_position, drive_force=-event.drive_force,
                          friction_force=-event.friction_force)


def _first_difference(seen: Sequence[Event], wanted: Sequence[Event]) -> object:
    return next(((k, a, b) for k, (a, b) in enumerate(zip(seen, wanted)) if a != b), (len(seen), len(wanted)))
