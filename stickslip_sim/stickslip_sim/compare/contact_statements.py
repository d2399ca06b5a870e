# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Statement: after a slip the slider oscillates a little, and soon no more, with the contact only."""

import math
from collections.abc import Iterator, Sequence
from itertools import chain
from typing import NamedTuple

import numpy as np

from ..axis import CompliantContact
from ..core.arrays import Numbers
from ..core.types import Event, EventKind, Mode
from ..figures.slips import complete_slips, complete_sticks
from ..runs import Run
from .look import look_at
from .ring_down import RingDown, closed_form
from .run_part import RunPart, steady_inputs
from .statement import Finding, Statement, found, not_applicable

_SMALL = 0.1       # of the longest slip's travel
_VANISHED = 0.05   # of the largest acceleration is left in the last quarter of a stick
_LONG = 5.0        # time constants that a stick must last for the oscillation to have vanished
_SAMPLES = 8       # in the first period
_VISIBLE = 1e-3    # of the largest acceleration: what is smaller is no swing


class _Ringing(NamedTuple):
    """The motion in one stick, after a slip of `travel` m."""

    travel: float
    amplitude: float   # m, from where the slider stands to where it comes to rest
    swings: int        # changes of the sign of the acceleration
    rest: float        # share of the largest acceleration that is left in the last quarter


class _SticksSeen(NamedTuple):
    """The motion in the sticks of a part that are complete: how a contact rings there, the largest speeds (m/s)."""

    rings: list[_Ringing]
    speeds: list[float]


def sticks_in(part: RunPart) -> _SticksSeen:
    """Look at the motion in each stick: with a compliant contact in those after a complete slip that show it."""
    ring, sticks = closed_form(part.scene.axis), complete_sticks(part.events)
    if ring is None:
        return _SticksSeen([], [float(np.abs(_part(part, *stick, 'velocity')).max(initial=0.0)) for stick in sticks])
    begins = {stop: begin for begin, stop in complete_slips(part.events)} if ring.damped_frequency else {}
    return _SticksSeen([_ringing(part, begins[stop], stop, end) for stop, end in sticks
                        if stop in begins and _is_fit(part, ring, begins[stop], stop, end)], [])


def _oscillation_finding(run: Run, seen: Sequence[_SticksSeen]) -> Finding:
    """Return what comes of the motion in the sticks."""
    ring = closed_form(run.scene.axis)
    if not isinstance(run.scene.axis.contact, CompliantContact) or ring is None:
        return _without_contact(run, list(chain(*(part.speeds for part in seen))))
    if ring.damped_frequency == 0.0:
        return not_applicable(f'the contact is overdamped: damping ratio {ring.damping_ratio:.4g}')
    rings = list(chain(*(part.rings for part in seen)))
    if not rings:
        return not_applicable('no slip and stick with constant inputs, long enough for the oscillation to vanish and '
                              'sampled finely enough to show it')
    share = max(each.amplitude for each in rings) / max(each.travel for each in rings)
    rest, swings, last = max(each.rest for each in rings), min(each.swings for each in rings), rings[-1]
    text = (f'{len(rings)} sticks, each with at least {swings} swings of at most {100.0 * share:.2g} % of a slip '
            f'({last.amplitude * 1e3:.3g} mm in the last); at most {100.0 * rest:.1g} % left in the last quarter')
    return found(swings >= 2 and share <= _SMALL and rest <= _VANISHED, text, sticks=len(rings), swings=swings,
                 amplitude=last.amplitude, amplitude_ratio=share, remaining_ratio=rest)


def _without_contact(run: Run, speeds: Sequence[float]) -> Finding:
    """Return what comes of the largest speeds in the sticks of a rigid contact: there must be no motion."""
    if not any(event.kind == EventKind.STICK for event in run.events):
        return not_applicable('no slip ends in this run')
    moving = max(speeds, default=0.0)
    return found(moving == 0.0, f'rigid contact: none; the largest speed in {len(speeds)} sticks is {moving:g} m/s',
                 sticks=len(speeds), largest_speed=moving)


def _is_fit(part: RunPart, ring: RingDown, begin: Event, stop: Event, end: Event) -> bool:
    """Whether the stick lasts, under the inputs of the slip before, and is sampled finely enough to see it swing."""
    times = part.samples['time']
    first, last = np.searchsorted(times, (stop.time, stop.time + 1.0 / ring.damped_frequency))
    return ((end.time - stop.time) * ring.decay >= _LONG and last - first >= _SAMPLES
            and steady_inputs(part, begin.time, end.time) is not None)


def _ringing(part: RunPart, begin: Event, stop: Event, end: Event) -> _Ringing:
    time, position, velocity, acceleration = (
        _part(part, stop, end, name) for name in ('time', 'position', 'velocity', 'acceleration'))
    settled = position - position[-1] - velocity[-1] * (time - time[-1])   # from the line along which it drifts
    size = np.abs(acceleration)
    signs = np.sign(acceleration[size > _VISIBLE * size.max()])
    last_quarter = time > time[-1] - 0.25 * (time[-1] - time[0])
    return _Ringing(abs(stop.position - begin.position), float(np.abs(settled).max()),
                    int(np.count_nonzero(np.diff(signs))), float(size[last_quarter].max() / size.max()))


def _part(part: RunPart, begin: Event, end: Event, name: str) -> Numbers:
    first, last = np.searchsorted(part.samples['time'], (begin.time, end.time))
    return part.samples[name][first:last]


OSCILLATION = Statement('oscillation after a slip',
                        'After the end of a slip there is a small, vanishing oscillation, with the contact only.',
                        _oscillation_finding, sticks_in)


# Statement: with the contact, the friction force is continuous from stick to slip and back.

_JUMP = 0.01     # of the largest friction force: less is none
_EXTRAPOLATED = 3     # that the force just after an event is extrapolated from
_REACH = 0.15    # of a period of the contact's ring-down: how far they may reach


class _Jumps(NamedTuple):
    """By how much the friction force jumps at each break-away and at each standstill, N."""

    there: list[float]
    back: list[float]


def jumps_in(part: RunPart) -> _Jumps:
    """Compare the friction force just before and just after each break-away and each standstill."""
    return _Jumps(*(list(_jumps(part, kind)) for kind in (EventKind.BREAKAWAY, EventKind.STICK)))


def _continuity_finding(run: Run, jumps: Sequence[_Jumps]) -> Finding:
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
        if first + _EXTRAPOLATED <= len(times) and times[first + _EXTRAPOLATED - 1] <= min(end, event.time + reach):
            yield abs(_just_after(part, event, first) - event.friction_force)


def _just_after(part: RunPart, event: Event, first: int) -> float:
    """Return the friction force after an event: of the parabola through the next samples (the first may be at it)."""
    rows = slice(first, first + _EXTRAPOLATED)
    offsets = part.samples['time'][rows] - event.time
    force = part.samples['friction_force'][rows]
    weights = [np.prod([b / (b - a) for b in offsets if b != a]) for a in offsets]
    return float(np.dot(weights, force))


CONTINUITY = Statement('continuous friction force',
                       'With the contact, the friction force is continuous from stick to slip and back.',
                       _continuity_finding, jumps_in)
