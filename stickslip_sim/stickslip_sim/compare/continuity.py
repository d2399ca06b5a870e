# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Statement: with the contact, the friction force is continuous from stick to slip and back."""

import math
from collections.abc import Iterator, Sequence
from itertools import chain
from typing import NamedTuple

import numpy as np

from ..axis import CompliantContact
from ..core.types import Event, EventKind, Mode
from ..runs import Run
from .look import look_at
from .ring_down import closed_form
from .run_part import RunPart
from .statement import Finding, Statement, found, not_applicable

_JUMP = 0.01     # of the largest friction force: less is none
_SAMPLES = 3     # that the force just after an event is extrapolated from
_REACH = 0.15    # of a period of the contact's ring-down: how far they may reach


class _Jumps(NamedTuple):
    """By how much the friction force jumps at each break-away and at each standstill, N."""

    there: list[float]
    back: list[float]


def jumps_in(part: RunPart) -> _Jumps:
    """Compare the friction force just before and just after each break-away and each standstill."""
    return _Jumps(*(list(_jumps(part, kind)) for kind in (EventKind.BREAKAWAY, EventKind.STICK)))


def _finding(run: Run, jumps: Sequence[_Jumps]) -> Finding:
    """Return what comes of the jumps of the friction force."""
    axis, seen = run.scene.axis, look_at(run)
    there, back = (list(chain(*each)) for each in zip(*jumps))
    if not there and not back:
        return not_applicable('no break-away and no standstill that is sampled finely enough')
    at_break_away, at_standstill = max(there, default=0.0), max(back, default=0.0)
    lowest, highest = seen.ranges['friction_force']
    largest = max(abs(lowest), abs(highest))
    text = (f'largest jump at {len(there)} break-aways {at_break_away:.2g} N, at {len(back)} standstills '
            f'{at_standstill:.2g} N; the friction force reaches {largest:.4g} N')
    figures = {'jump_at_break_away': at_break_away, 'jump_at_standstill': at_standstill,
               'largest_friction_force': largest}
    if not isinstance(axis.contact, CompliantContact) or axis.friction.excess is None:
        return not_applicable(f'without a compliant contact and acceleration dependence: {text}', **figures)
    if seen.steady is None:
        return not_applicable(f'said of a constant drive; under another a break-away may come while the slider gets '
                              f'slower, and friction then drops to the driving forces: {text}', **figures)
    return found(max(at_break_away, at_standstill) <= _JUMP * largest, text, **figures)


def _jumps(part: RunPart, kind: EventKind) -> Iterator[float]:
    """Yield by how much the friction force jumps at each event of a kind, N; the next part has that of the last."""
    times, ring = part.samples['time'], closed_form(part.scene.axis)
    reach = _REACH / ring.frequency if ring else math.inf
    ends = [event.time for event in part.events[1:]]
    for event, end in zip(part.events, ends if part.is_closed else [*ends, part.end]):
        if event.kind != kind or (kind == EventKind.BREAKAWAY and event.mode == Mode.STICK):
            continue
        first = int(np.searchsorted(times, event.time))
        if first + _SAMPLES <= len(times) and times[first + _SAMPLES - 1] <= min(end, event.time + reach):
            yield abs(_just_after(part, event, first) - event.friction_force)


def _just_after(part: RunPart, event: Event, first: int) -> float:
    """Return the friction force after an event: of the parabola through the next samples (the first may be at it)."""
    rows = slice(first, first + _SAMPLES)
    offsets = part.samples['time'][rows] - event.time
    force = part.samples['friction_force'][rows]
    weights = [np.prod([b / (b - a) for b in offsets if b != a]) for a in offsets]
    return float(np.dot(weights, force))


CONTINUITY = Statement('continuous friction force',
                       'With the contact, the friction force is continuous from stick to slip and back.',
                       _finding, jumps_in)
