# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The figures that limits are set for, as control engineering and ISO 230 have them; formulas in docs/check.md.

The slider is known at the samples and, exactly, at the transitions: extremes of its motion in slip are transitions
themselves.  The drive is known at the samples.
"""

import math
from typing import NamedTuple

import numpy as np
from scipy.interpolate import CubicHermiteSpline

from ..core.errors import InputError
from ..core.types import EventKind, Mode
from ..simulation.cycles import cycle_figures, mode_spans
from .observed_motion import ObservedMotion, Points


class MeasuredFigure(NamedTuple):
    """A figure, inf when its event never came; `remark` says what it was taken from."""

    value: float
    remark: str = ''


def following_error(motion: ObservedMotion) -> MeasuredFigure:
    """Return the largest |commanded − actual position|, m."""
    errors = np.abs(motion.following_error)
    return MeasuredFigure(float(errors.max()), f'at t = {motion.time[errors.argmax()]:.6g} s')


def end_position_error(motion: ObservedMotion, target: float) -> MeasuredFigure:
    """Return |actual position − target| at the end, m: the positional deviation of ISO 230-2."""
    return MeasuredFigure(abs(float(motion.points.position[-1]) - target))


def overshoot(motion: ObservedMotion, target: float) -> MeasuredFigure:
    """Return how far the slider goes beyond the target in the sense of its motion, m; 0 when it does not.

    Raises InputError when it begins on the target: there is no sense then.
    """
    move = target - motion.position[0]
    if move == 0.0:
        raise InputError('target', target, f'another place than that of the slider at t = {motion.begin:g} s',
                         'let the window begin before the move')
    beyond = math.copysign(1.0, move) * (motion.points.position - target)
    return MeasuredFigure(max(0.0, float(beyond.max())), f'at t = {motion.points.time[beyond.argmax()]:.6g} s'
                          if beyond.max() > 0.0 else 'the target is not passed')


def settling_time(motion: ObservedMotion, target: float, band: float) -> MeasuredFigure:
    """Return how long after the start the slider comes within ± `band` of the target to stay, s; inf if it does not."""
    points = motion.points
    outside = np.flatnonzero(np.abs(points.position - target) > band)
    if not outside.size:
        return MeasuredFigure(0.0, 'never outside the band')
    last = int(outside[-1])
    if last + 1 == len(points.time):
        return MeasuredFigure(math.inf, 'outside the band at the end')
    edge = target + math.copysign(band, points.position[last] - target)
    return MeasuredFigure(_crossing(points, last, edge) - motion.begin)


def sticks(motion: ObservedMotion) -> MeasuredFigure:
    """Return how often the slider came to stick."""
    return MeasuredFigure(sum(event.kind == EventKind.STICK for event in motion.events))


def longest_stick(motion: ObservedMotion) -> MeasuredFigure:
    """Return the longest time without slip, s; only what lies within the window counts."""
    spans = [span for span in mode_spans(motion.events, motion.begin, motion.end, motion.mode)
             if span.mode == Mode.STICK]
    if not spans:
        return MeasuredFigure(0.0, 'no stick')
    longest = max(spans, key=lambda span: span.end - span.begin)
    return MeasuredFigure(longest.end - longest.begin, f'from t = {longest.begin:.6g} s')


def limit_cycle_amplitude(motion: ObservedMotion, cycles: int) -> MeasuredFigure:
    """Return the peak-to-peak following error over the last cycles (break-away to break-away), m; 0 without a cycle."""
    last = cycle_figures(motion.events)[-cycles:]
    if not last:
        return MeasuredFigure(0.0, 'no complete cycle')
    part = motion.cut(last[0].begin, last[-1].begin + last[-1].period)
    return MeasuredFigure(float(np.ptp(part.following_error)), f'over {len(last)} cycle{"s" if len(last) > 1 else ""}')


def peak_speed(motion: ObservedMotion) -> MeasuredFigure:
    """Return the largest |velocity| of the slider, m/s."""
    speeds = np.abs(motion.points.velocity)
    return MeasuredFigure(float(speeds.max()), f'at t = {motion.points.time[speeds.argmax()]:.6g} s')


def _crossing(points: Points, k: int, level: float) -> float:
    """Return when the slider crosses a level for the last time between point k and the next.

    In between it moves on the cubic with the positions and velocities at both.
    """
    time = points.time[k:k + 2]
    cubic = CubicHermiteSpline(time, points.position[k:k + 2], points.velocity[k:k + 2])
    return float(max(cubic.solve(level, extrapolate=False), default=time[1]))
