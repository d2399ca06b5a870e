# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""A scene, simulated and sampled so densely that no sample rate shows: at every event, and finely in between."""

import math
from collections.abc import Iterator
from dataclasses import replace
from itertools import pairwise

import numpy as np

from ..core.arrays import Numbers
from ..core.errors import InputError
from ..core.input_profile import InputProfile
from ..core.time_grid import Instants
from ..core.types import Event, Sample
from ..runs import SimulatedRun, simulate_events
from ..runs.samples import HeldSamples
from ..runs.simulated import columns_of_rows
from ..scene import Scene
from .ring_down import closed_form

MAX_DRAWN_EVENTS = 50_000
_IN_SPAN = 8, 200          # samples between two events, at least and at most
_SPAN_BUDGET = 200_000     # samples of all spans
_PERIODS, _IN_PERIOD = 8, 32   # of the ring-down after each slip
_SINUSOID_BUDGET = 100_000     # samples for the sines of the inputs
_BEFORE = 1e-9             # s: where an input jumps it is sampled that much before, too


def simulate_densely(scene: Scene, duration: float) -> SimulatedRun:
    """Return the run of `duration` seconds of a scene; raises InputError on a time without a meaning."""
    return densely_sampled(simulate_events(scene, duration))


def densely_sampled(run: SimulatedRun, also: Numbers | None = None) -> SimulatedRun:
    """Return a run with samples so dense, `also` at some times (s); raises InputError on too many events."""
    scene, duration = run.scene, run.duration
    if len(run.events) > MAX_DRAWN_EVENTS:
        raise InputError('duration', duration, f'short enough for at most {MAX_DRAWN_EVENTS} events',
                         f'there are {len(run.events)}: simulate a shorter time')
    simulator = scene.make_simulator()
    instants = _instants(scene, duration, run.events, np.empty(0) if also is None else also)
    rows = np.empty((len(instants.seconds), len(Sample._fields)))
    simulator.take_samples(instants, rows)
    return replace(run, sampled=HeldSamples(columns_of_rows(rows)))


def _instants(scene: Scene, duration: float, events: list[Event], also: Numbers) -> Instants:
    """Return when to sample: at the events, before and after the jumps of an input, finely in between, and `also`."""
    jumps = sorted({border for profile in scene.inputs for border in _borders(profile, duration)})
    corners = np.array(sorted({0.0, duration, *jumps, *(event.time for event in events)}))
    count = min(max(_SPAN_BUDGET // len(corners), _IN_SPAN[0]), _IN_SPAN[1])
    between = np.linspace(corners[:-1], corners[1:], count)[1:-1].ravel()
    at_jumps = [0.0, duration, *jumps, *(max(time - _BEFORE, 0.0) for time in jumps)]
    times = np.concatenate([between, at_jumps, also, *_ring_downs(scene, corners), _of_sinusoids(scene, duration)])
    seconds = np.append(np.floor(times), [event.second for event in events])
    fractions = np.append(times - np.floor(times), [event.fraction for event in events])
    order = np.lexsort((fractions, seconds))
    seconds, fractions = seconds[order], fractions[order]
    is_new = np.append(True, (np.diff(seconds) != 0.0) | (np.diff(fractions) != 0.0))
    return Instants(seconds[is_new], fractions[is_new])


def _ring_downs(scene: Scene, corners: Numbers) -> Iterator[Numbers]:
    """Yield the times that show how a compliant contact rings after each event."""
    ring = closed_form(scene.axis)
    if ring is None:
        return
    offsets = np.arange(1, _PERIODS * _IN_PERIOD) / (_IN_PERIOD * ring.frequency)
    for a, b in pairwise(corners[-(_SPAN_BUDGET // len(offsets)):].tolist()):
        yield a + offsets[offsets < b - a]


def _of_sinusoids(scene: Scene, duration: float) -> Numbers:
    """Return the times that show the sines of the inputs."""
    fastest = max((sinusoid.frequency for profile in scene.inputs for sinusoid in profile.sinusoids), default=0.0)
    count = min(_IN_PERIOD * fastest * duration, _SINUSOID_BUDGET)
    return np.linspace(0.0, duration, math.ceil(count) + 1, dtype=np.float64)


def _borders(profile: InputProfile, duration: float) -> Iterator[float]:
    """Yield where an input profile goes on to its next segment, as many times as are worth a look."""
    time = profile.piece_at(0.0).end
    for _ in range(MAX_DRAWN_EVENTS):
        if not time < duration:
            return
        yield time
        time = profile.piece_at(time).end
