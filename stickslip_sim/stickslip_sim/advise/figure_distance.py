# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The figures of a run that matter, and how far two runs are apart in them.

Every difference is relative, so that one tolerance fits all: cycle figures to themselves, the share of stick and the
times of events to the duration, the position at the end to the travel.
"""

import math
from collections.abc import Mapping, Sequence
from typing import NamedTuple

from ..core.types import Event, EventKind, Sample
from ..simulation.cycles import AVERAGED, Cycle, cycle_figures, summary

ANOTHER_MOTION = 'kind of motion'
_BOUNDARIES = (EventKind.BREAKAWAY, EventKind.STICK, EventKind.REVERSE)
_OF_CYCLES = {'period': 'period', 'jump': 'jump', 'peak speed': 'peak_speed', 'break-away force': 'break_away_force'}


class RunFigures(NamedTuple):
    """The compared figures of a run: `events` are where slips begin and end; positions in m, `duration` in s."""

    motion: str
    duration: float
    events: list[Event]
    cycles: list[Cycle]
    peak_speed: float          # m/s, of the whole run; 0 without a slip, even if the contact drifts
    break_away_force: float    # N, of the first break-away; 0 without one
    stick_share: float
    end_position: float
    travel: float              # of slider or drive, whichever goes further


class Distance(NamedTuple):
    """By how much runs differ: relative, by figure; those that do not exist in either run are left out."""

    by_figure: Mapping[str, float]

    @property
    def largest(self) -> float:
        """The largest relative difference; infinite when the motion is of another kind."""
        return max(self.by_figure.values())

    @property
    def figure(self) -> str:
        """The figure that differs most."""
        return max(self.by_figure, key=lambda name: self.by_figure[name])


def run_figures(events: Sequence[Event], duration: float, start: Sample, end: Sample) -> RunFigures:
    """Return the figures of a run of `duration` s from its events and its first and last sample."""
    outline = summary(events, duration, start.mode)
    boundaries = [event for event in events if event.kind in _BOUNDARIES]
    slips = [event for event in boundaries if event.kind == EventKind.BREAKAWAY]
    points: list[Event | Sample] = [start, *events, end]
    return RunFigures(
        outline.motion, duration, boundaries, cycle_figures(events),
        peak_speed=max(abs(point.velocity) for point in points) if outline.motion != 'at rest' else 0.0,
        break_away_force=abs(slips[0].friction_force) if slips else 0.0,
        stick_share=outline.stick_share,
        end_position=end.position,
        travel=max(_range([point.position for point in points]), _range([point.drive_position for point in points])))


def distance_between(reference: RunFigures, other: RunFigures) -> Distance:
    """Compare a run with the reference, of the same duration."""
    if other.motion != reference.motion:
        return Distance({ANOTHER_MOTION: math.inf})
    found = {'event times': event_difference(reference.events, other.events, reference.duration),
             'stick share': abs(other.stick_share - reference.stick_share)}
    if reference.travel > 0.0:
        found['end position'] = abs(other.end_position - reference.end_position) / reference.travel
    for name, (a, b) in _pairs(reference, other).items():
        if a != 0.0:
            found[name] = abs(b - a) / abs(a)
    return Distance(found)


def event_difference(events: Sequence[Event], others: Sequence[Event], duration: float) -> float:
    """Return the largest shift of an event, or the time that is left once the events differ, over the duration.

    They differ from the first pair on that is of another kind or direction, or from the first event without a partner.
    """
    shift = 0.0
    for a, b in zip(events, others):
        if (a.kind, a.direction) != (b.kind, b.direction):
            return max(shift, duration - min(a.time, b.time)) / duration
        shift = max(shift, abs((a.second - b.second) + (a.fraction - b.fraction)))
    common = min(len(events), len(others))
    alone = [*events[common:], *others[common:]]
    return max(shift, duration - alone[0].time if alone else 0.0) / duration


def _pairs(reference: RunFigures, other: RunFigures) -> dict[str, tuple[float, float]]:
    """Return figures of both; cycles by their means over the last ones that both runs have."""
    common = min(len(reference.cycles), len(other.cycles))
    if common == 0:
        return {'peak speed': (reference.peak_speed, other.peak_speed),
                'break-away force': (reference.break_away_force, other.break_away_force)}
    latest = slice(max(0, common - AVERAGED), common)
    return {name: (_mean(reference.cycles[latest], field), _mean(other.cycles[latest], field))
            for name, field in _OF_CYCLES.items()}


def _mean(cycles: Sequence[Cycle], field: str) -> float:
    return math.fsum(getattr(cycle, field) for cycle in cycles) / len(cycles)


def _range(values: Sequence[float]) -> float:
    return max(values) - min(values)
