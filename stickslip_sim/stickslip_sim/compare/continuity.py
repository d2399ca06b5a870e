# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Statement: with the contact, the friction force is continuous from stick to slip and back."""

import math
from collections.abc import Iterator

import numpy as np

from ..axis import CompliantContact
from ..core.types import Event, EventKind, Mode
from ..runs import Run
from .drawn import least_and_most, steady_inputs
from .ring_down import closed_form
from .statement import Finding, Statement, found, not_applicable

_JUMP = 0.01     # of the largest friction force: less is none
_SAMPLES = 3     # that the force just after an event is extrapolated from
_REACH = 0.15    # of a period of the contact's ring-down: how far they may reach


def judge(run: Run) -> Finding:
    """Compare the friction force just before and just after each break-away and each standstill."""
    axis = run.scene.axis
    there, back = (list(_jumps(run, kind)) for kind in (EventKind.BREAKAWAY, EventKind.STICK))
    if not there and not back:
        return not_applicable('no break-away and no standstill that is sampled finely enough')
    at_break_away, at_standstill = max(there, default=0.0), max(back, default=0.0)
    lowest, highest = least_and_most(run, lambda columns: columns['friction_force'])
    largest = max(abs(lowest), abs(highest))
    text = (f'largest jump at {len(there)} break-aways {at_break_away:.2g} N, at {len(back)} standstills '
            f'{at_standstill:.2g} N; the friction force reaches {largest:.4g} N')
    figures = {'jump_at_break_away': at_break_away, 'jump_at_standstill': at_standstill,
               'largest_friction_force': largest}
    if not isinstance(axis.contact, CompliantContact) or axis.friction.excess is None:
        return not_applicable(f'without a compliant contact and acceleration dependence: {text}', **figures)
    if steady_inputs(run) is None:
        return not_applicable(f'said of a constant drive; under another a break-away may come while the slider gets '
                              f'slower, and friction then drops to the driving forces: {text}', **figures)
    return found(max(at_break_away, at_standstill) <= _JUMP * largest, text, **figures)


def _jumps(run: Run, kind: EventKind) -> Iterator[float]:
    """Yield by how much the friction force jumps at each event of a kind, N."""
    times, ring = run.samples['time'], closed_form(run.scene.axis)
    reach = _REACH / ring.frequency if ring else math.inf
    ends = [*(event.time for event in run.events[1:]), run.end]
    for event, end in zip(run.events, ends):
        if event.kind != kind or (kind == EventKind.BREAKAWAY and event.mode == Mode.STICK):
            continue
        first = int(np.searchsorted(times, event.time))
        if first + _SAMPLES <= len(times) and times[first + _SAMPLES - 1] <= min(end, event.time + reach):
            yield abs(_just_after(run, event, first) - event.friction_force)


def _just_after(run: Run, event: Event, first: int) -> float:
    """Return the friction force after an event: of the parabola through the next samples (the first may be at it)."""
    rows = slice(first, first + _SAMPLES)
    offsets = run.samples['time'][rows] - event.time
    force = run.samples['friction_force'][rows]
    weights = [np.prod([b / (b - a) for b in offsets if b != a]) for a in offsets]
    return float(np.dot(weights, force))


CONTINUITY = Statement('continuous friction force',
                       'With the contact, the friction force is continuous from stick to slip and back.', judge)
