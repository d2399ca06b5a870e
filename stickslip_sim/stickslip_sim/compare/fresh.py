# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""A scene, simulated and sampled so densely that no sample rate shows: at every event, and finely in between."""

import math
from collections.abc import Iterator, Mapping
from dataclasses import replace
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from ..core.arrays import Columns, Numbers
from ..core.errors import InputError
from ..core.input_profile import InputProfile
from ..core.time_grid import Instants
from ..core.types import Event
from ..identification.axis_model import AxisModel
from ..identification.free_parameters import FreeParameter
from ..identification.identified_scene import with_measured_inputs
from ..identification.motions import motions_of, track_of
from ..identification.prediction import DRIVE_COLUMNS, check_is_moved, known_sensors
from ..identification.readings import SensorReadings, drives_directly, readings_of
from ..identification.run_start import from_measured_start
from ..recording import MeasuredRun
from ..runs import SimulatedRun, simulate_events
from ..runs.samples import HeldSamples
from ..runs.simulated import columns_at
from ..scene import Scene, changed
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
    instants = _instants(scene, duration, run.events, np.empty(0) if also is None else also)
    return replace(run, sampled=HeldSamples(columns_at(scene.make_simulator(), instants)))


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


# A scene simulated beside a measured run: from where that starts, moved by what was measured of its drive and force.

_FORCE = 'sensor.external_force.'


class AsMeasured(NamedTuple):
    """A scene simulated as a run was measured: its time 0 is at `zero` s of that run.

    `position_rmse` (m) is the root mean square of measured less simulated position; None where none was measured.
    """

    run: SimulatedRun
    zero: float
    position_rmse: float | None


def as_measured(scene: Scene, source: str, measured: MeasuredRun, duration: float | None) -> AsMeasured:
    """Simulate a scene, named or in the file `source`, beside a measured run, for as long as that (None) or less (s).

    Raises InputError where the run has not measured what moves the scene.
    """
    errors, others = known_sensors(source)
    check_is_moved(scene, source, others, measured)
    readings = _corrected(readings_of(measured, scene, {}), errors)
    last = float(readings.times[-1])
    if duration is not None and not 0.0 < duration <= last:
        raise InputError('--duration', duration, f'> 0 and <= {last:g} s, as long as {measured.name}', 'drop it')
    motions = motions_of(track_of(readings, readings.drive or scene.drive))
    started, start, _ = from_measured_start(scene, (), readings, motions)
    started = changed(started, {one.name: one.start for one in start})
    driven, sections = _driven(started, readings, errors)
    run = simulate_events(driven, last if duration is None else duration)
    dense = densely_sampled(run, readings.times[readings.times <= run.end])
    samples = dense.samples
    if drives_directly(scene) and 'drive_force' in measured.measured:
        samples = {**samples, 'drive_force': _read(samples['external_force'], errors)}
    notes = tuple(_notes(measured, sections, errors, scene, started is not scene))
    return AsMeasured(replace(dense, sampled=HeldSamples(samples), notes=notes), readings.shift,
                      _position_rmse(samples, readings))


def _corrected(readings: SensorReadings, errors: Mapping[str, float]) -> SensorReadings:
    """Return readings without the errors of their sensors: (measured − offset) / scale."""
    return replace(readings, channels=tuple(
        replace(one, values=(one.values - errors.get(f'sensor.{one.name}.offset', 0.0))
                / errors.get(f'sensor.{one.name}.scale', 1.0)) for one in readings.channels))


def _driven(scene: Scene, readings: SensorReadings, errors: Mapping[str, float]) -> tuple[Scene, tuple[str, ...]]:
    """Return the scene with the measured inputs, less the errors of their sensor, and the sections that are."""
    of_force = {name: value for name, value in errors.items() if name.startswith(_FORCE)}
    model = AxisModel(scene, [FreeParameter(name, '', value, value, value) for name, value in of_force.items()],
                      readings)
    dynamics = model.dynamics(np.array(list(of_force.values()), dtype=np.float64))
    assert dynamics is not None   # of the scene itself
    driven, sections = with_measured_inputs(scene, readings, dynamics)
    known = {'drive': readings.drive, 'force': readings.force}
    if any(profile is not None and name not in sections for name, profile in known.items()):
        raise InputError('RUN', f'{len(readings.times)} readings of what moves the axis',
                         'fewer: a scene does not hold so many', 'import a part of it')
    return driven, sections


def _read(force: Numbers, errors: Mapping[str, float]) -> Numbers:
    """Return what the sensor shows of the force on the slider, N."""
    return errors.get(f'{_FORCE}offset', 0.0) + errors.get(f'{_FORCE}scale', 1.0) * force


def _notes(measured: MeasuredRun, sections: tuple[str, ...], errors: Mapping[str, float], scene: Scene, is_moved: bool
           ) -> Iterator[str]:
    """Yield what moves the scene, and from where."""
    for section in sections:
        words = f'its {section} is the one measured in {measured.name}'
        off = [f'{name.removeprefix(_FORCE)} {value:.6g}' for name, value in errors.items()
               if section == 'force' and name.startswith(_FORCE)]
        yield f'{words}, less the errors of its sensor: {", ".join(off)} (SI)' if off else f'{words}, as read'
    if not drives_directly(scene) and not set(DRIVE_COLUMNS) & set(measured.measured):
        yield f'its drive is that of its scene: {measured.name} has none that was measured'
    if is_moved:
        yield f'it starts where {measured.name} does'


def _position_rmse(samples: Columns, readings: SensorReadings) -> float | None:
    channel = readings.channel('position')
    if channel is None:
        return None
    inside = readings.times <= samples['time'][-1]
    simulated = np.interp(readings.times[inside], samples['time'], samples['position'])
    return float(np.sqrt(np.mean((channel.values[inside] - simulated)**2)))
