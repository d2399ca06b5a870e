# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""What a single slip shows, measured or simulated: after how long a rest it came, how long and far it went, its forces.

These figures change smoothly and almost in proportion with the parameters, however far off these are; the positions
at given times do not: a slip that comes a little later than measured has nothing in common with it.
"""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from ..core.arrays import Numbers
from ..core.types import Event, EventKind, Mode, Sample
from ..scene.build import Dynamics
from .axis_model import AxisModel
from .motions import SHARES, MeasuredMotion, Track, slope_of
from .readings import SensorReadings, instants_of

# When a slip begins, and at which drive force: by one rule for what was measured and for what is simulated.
#
# A slip begins without any speed, which no sensor sees, and where bristles bend first it has no beginning at all.  So
# it is taken to begin where it is faster than a slider at rest may be, or than a tenth of its peak if that is less.

_PEAK_SHARE = 0.1        # of the peak of the speed
_REST_END = 0.15   # of the rest: so much of its end says what the force is in the end
_FEWEST = 6         # readings for that


def begin_of_slip(times: Numbers, speeds: Numbers, still: float) -> float:
    """Return when a slip begins, s: the last of times (n,) before its peak at which it is as slow as at rest."""
    peak = int(speeds.argmax())
    limit = min(still, _PEAK_SHARE * float(speeds[peak]))
    below = np.flatnonzero(speeds[:peak] < limit)
    if not len(below):
        return float(times[0])
    row = int(below[-1])
    low, high = speeds[row:row + 2].tolist()
    return float(times[row] + (limit - low) / (high - low) * (times[row + 1] - times[row]))


def force_of_slip(times: Numbers, forces: Numbers, begin: float, since: float) -> float:
    """Return the force when a slip begins, after a rest `since` a time (s), by a parabola through those before."""
    last = int(np.searchsorted(times, begin, 'right'))
    first = min(int(np.searchsorted(times, begin - _REST_END * (begin - since))), last - _FEWEST)
    first = max(first, int(np.searchsorted(times, since)))
    if last - first < _FEWEST:
        return float(np.interp(begin, times, forces))
    at = times[first:last] - begin
    return float(np.polyfit(at / at[0], forces[first:last], 2)[2])


N_FIGURES = 9  # of a slip, see `slip_distance`
N_TELLING = 10  # see `telling_distance`
_TIME, _WIDTH, _SHAPE, _JUMP, _FORCE = 0.01, 0.02, 0.02, 0.01, 0.01   # relative: as well as a coarse fit has to do
_SAMPLED = 0.3         # of a period: so well the start of a slip is known
_MINOR = 0.1           # weight of figures that tell little where the model is another than the axis
_LONGER = 1.3, 4.0     # of the measured time: so far a simulation looks for the slip, first and again
_PART = 0.2            # of a measured slip: one that goes less far is passed over for a longer one
_REST_PART = 0.15      # of a rest: over so much of it, before and after, a line is laid through its force
_POSITION = Sample._fields.index('position')
_VELOCITY = Sample._fields.index('velocity')
_FORCE_PLACE = Sample._fields.index('drive_force')
_AT_REST = 0.5, 0.85   # of a rest: there forces are taken, when the contact rings no more
_POINTS = np.linspace(0.0, 1.0, 33)


class SlipFigures(NamedTuple):
    """A slip: `middle` (s after the rest began) at half its way, `begin` and `passed` relative to it (s)."""

    middle: float
    begin: float
    passed: Numbers
    way: float         # m
    forces: Numbers    # N, at shares _AT_REST of the measured rest; NaN where not known
    rest: float        # s, until the slip begins by the rule of `break_away`
    break_away: float  # N, the drive force then; NaN where not known


class MeasuredSlip(NamedTuple):
    """A measured slip, the motion before it (None: the run begins), and since when the slider rests, s."""

    slip: SlipFigures
    motion: MeasuredMotion
    before: MeasuredMotion | None
    rest_begin: float
    still: float       # m/s: a slower slider rests
    overtakes: float   # its peak speed over that of the drive when it begins; inf over one that stands still


def measured_slips(motions: Sequence[MeasuredMotion], measurement: SensorReadings, track: Track) -> list[MeasuredSlip]:
    """Return the slips of a measurement, in the order of time."""
    found = []
    channel = measurement.channel('drive_force')
    before: MeasuredMotion | None = None
    for motion in motions:
        begin = 0.0 if before is None else before.end
        passed = np.array(motion.passed)
        middle = passed[len(SHARES) // 2]
        forces = np.array([rest_force(measurement, begin + share * (motion.begin - begin), begin, motion.begin)
                           for share in _AT_REST])
        rows = slice(*np.searchsorted(track.times, [begin, motion.end]))
        still, driven = (float(np.interp(motion.begin, track.times, of)) for of in (track.still, track.driven))
        peak = float((motion.direction * track.velocity[rows]).max())
        at = begin_of_slip(track.times[rows], motion.direction * track.velocity[rows], still)
        force = float('nan') if channel is None else force_of_slip(measurement.times, channel.values, at, begin)
        slip = SlipFigures(middle - begin, motion.begin - middle, passed - middle, motion.stop - motion.start, forces,
                           at - begin, force)
        found.append(MeasuredSlip(slip, motion, before, begin, still, peak / driven if driven else np.inf))
        before = motion
    return found


def simulated_slip(model: AxisModel, dynamics: Dynamics, values: Numbers, measured: MeasuredSlip) -> SlipFigures | None:
    """Return the first slip, of some length, that the model does from the same rest on; None where it does none."""
    initial = model.state_after(measured.before, dynamics, values)
    length = measured.motion.end - measured.rest_begin
    least = _PART * abs(measured.slip.way)
    for longer in _LONGER:
        motion = model.motion(dynamics, measured.rest_begin, initial, longer * length)
        if motion is None:
            return None
        ends = _ends(motion.events, least)
        if ends is not None and (longer == _LONGER[-1] or abs(ends[1].position - ends[0].position) >= least):
            rest = measured.motion.begin - measured.rest_begin
            at_rest = [min(share * rest, ends[0].time) for share in _AT_REST]
            times = np.append(at_rest, ends[0].time + _POINTS * (ends[1].time - ends[0].time))
            rows = motion.samples(instants_of(times))
            return None if rows is None else _measured(_slip(*ends, rows, measured.still), model, values)
    return None


def _measured(slip: SlipFigures, model: AxisModel, values: Numbers) -> SlipFigures:
    """Return a slip as the sensors measure it."""
    offset, scale = model.gain(values, 'drive_force')
    _, length_scale = model.gain(values, 'position')
    return slip._replace(way=length_scale * slip.way, forces=offset + scale * slip.forces,
                         break_away=offset + scale * slip.break_away)


def slip_distance(found: SlipFigures | None, measured: MeasuredSlip, measurement: SensorReadings) -> Numbers:
    """Return how far a simulated slip is from the measured one, in units of what a coarse fit should reach (9,)."""
    slip = measured.slip
    width = float(slip.passed[-1] - slip.passed[0])
    forces = measurement.channel('drive_force')
    span = 1.0 if forces is None else float(np.ptp(forces.values)) * _FORCE + forces.resolution
    if found is None:
        longest = _LONGER[-1] * (measured.motion.end - measured.rest_begin)
        found = slip._replace(middle=longest, way=_PART * slip.way)
    blur = measurement.period
    time = np.log(found.middle / slip.middle) / max(_TIME, blur / slip.middle)
    own = max(float(found.passed[-1] - found.passed[0]), 1e-9)
    wide = np.log(own / width) / max(_WIDTH, blur / width)
    shape = (found.passed / own - slip.passed / width)[[0, 1, 3, 4]] / max(_SHAPE, blur / width)
    way = np.log(max(found.way / slip.way, 1e-3)) / _JUMP
    force = np.nan_to_num((found.forces - slip.forces) / span)
    return np.concatenate([[time, wide, way], shape, force])


def telling_distance(found: SlipFigures | None, measured: MeasuredSlip, measurement: SensorReadings) -> Numbers:
    """Return how far a simulated slip is from the measured one where the model is another than the axis (10,).

    Break-away force, time at rest and the way of the slip, which says when the next comes, are first: the rest of the
    motion is as near as it can be.
    """
    slip = measured.slip
    other = slip_distance(found, measured, measurement)
    other[1], other[3:] = _MINOR * other[1], _MINOR * other[3:]
    if found is None:
        return np.concatenate([[np.log(_LONGER[-1]) / _TIME], other])
    known = max(slip.rest, measurement.period)
    other[0] = np.log(max(found.rest, 1e-9) / known) / max(_TIME, _SAMPLED * measurement.period / known)
    force = (found.break_away - slip.break_away) / (_FORCE * abs(slip.break_away))
    return np.concatenate([[np.nan_to_num(force)], other])


def _ends(events: Sequence[Event], least: float) -> tuple[Event, Event] | None:
    """Return begin and end of the first slip that goes at least so far, until rest or reversal; else of the longest."""
    first: Event | None = None
    longest: tuple[Event, Event] | None = None
    for event in events:
        starts = event.kind == EventKind.REVERSE or (first is None and event.kind == EventKind.BREAKAWAY)
        if first is not None and (starts or event.mode == Mode.STICK):
            way = abs(event.position - first.position)
            if way >= least:
                return first, event
            if way > 0.0 and (longest is None or way > abs(longest[1].position - longest[0].position)):
                longest = first, event
            first = None
        if starts:
            first = event
    return longest


def _slip(begin: Event, end: Event, rows: Numbers, still: float) -> SlipFigures:
    """Return a slip by its ends, and samples between them."""
    way = end.position - begin.position
    slip = rows[2:]
    shares = np.maximum.accumulate((slip[:, _POSITION] - begin.position) / way)
    passed = np.interp(SHARES, shares, slip[:, 0] + slip[:, 1])
    middle = float(passed[len(SHARES) // 2])
    times = slip[:, 0] + slip[:, 1]
    at = begin_of_slip(times, np.sign(way) * slip[:, _VELOCITY], still)
    return SlipFigures(max(middle, 1e-9), begin.time - middle, passed - middle, way,
                       np.array([*rows[:2, _FORCE_PLACE]]), at, float(np.interp(at, times, slip[:, _FORCE_PLACE])))


class ShownBreakAway(NamedTuple):
    """A simulated break-away as sensors would show it: `rest` before it, s, the `force`, N, and how `late` it is, s."""

    rest: float
    force: float
    late: float


def shown_break_away(model: AxisModel, dynamics: Dynamics, values: Numbers, measured: MeasuredSlip, track: Track
                     ) -> ShownBreakAway:
    """Return the break-away of the simulated slip as sensors would show it; NaN where the model does no such slip.

    Its samples go through the filter of the measured ones.
    """
    initial = model.state_after(measured.before, dynamics, values)
    length = measured.motion.end - measured.rest_begin
    motion = model.motion(dynamics, measured.rest_begin, initial, _LONGER[-1] * length)
    ends = None if motion is None else _ends(motion.events, _PART * abs(measured.slip.way))
    if motion is None or ends is None:
        return ShownBreakAway(*[float('nan')] * 3)
    period = float(track.times[1] - track.times[0])
    times = np.arange(int(ends[1].time / period) + track.smoothing + 2).astype(np.float64) * period
    rows = model.samples(dynamics, measured.rest_begin, initial, instants_of(times))
    if rows is None:
        return ShownBreakAway(*[float('nan')] * 3)
    velocity = rows[:, _VELOCITY] if track.smoothing == 1 else slope_of(rows[:, _POSITION], period, track.smoothing)
    in_slip = times <= ends[1].time + period
    at = begin_of_slip(times[in_slip], np.sign(ends[1].position - ends[0].position) * velocity[in_slip], measured.still)
    offset, scale = model.gain(values, 'drive_force')
    return ShownBreakAway(at, offset + scale * force_of_slip(times, rows[:, _FORCE_PLACE], at, 0.0), at - ends[0].time)


def rest_force(measurement: SensorReadings, time: float, begin: float, end: float) -> float:
    """Return the drive force at a time in a rest, by a line through it near there; NaN without a measurement."""
    channel = measurement.channel('drive_force')
    if channel is None:
        return float('nan')
    part = _REST_PART * (end - begin)
    low, high = max(time - part, begin), min(time + part, end)
    rows = np.flatnonzero((measurement.times >= low) & (measurement.times <= high))
    if len(rows) < 3:
        return float(np.interp(time, measurement.times, channel.values))
    _, offset = np.polyfit(measurement.times[rows] - time, channel.values[rows], 1)
    return float(offset)
