# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Statement: after a slip the slider oscillates a little, and soon no more, with the contact only."""

from collections.abc import Sequence
from itertools import chain
from typing import NamedTuple

import numpy as np

from ..axis import CompliantContact
from ..core.arrays import Numbers
from ..core.types import Event, EventKind
from ..runs import Run
from .drawn import complete_slips, complete_sticks, steady_inputs
from .ring_down import RingDown, closed_form
from .run_part import RunPart
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


def _finding(run: Run, seen: Sequence[_SticksSeen]) -> Finding:
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
                        _finding, sticks_in)
