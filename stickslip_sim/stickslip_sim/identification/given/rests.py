# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The rests of a slider: after which of its measured motions it stands still, but for what its contact yields."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from ...core.input_profile import InputProfile
from .measured_inputs import travelled
from .motions import MeasuredMotion, Track

_SHORT = 0.2             # of a motion: what is shorter is no rest
_FIRST_HALF = 0.0, 0.5
_MIDDLE = 0.25, 0.75     # of a rest: between these the slider stands still,
_FOLLOWS = 0.4           # or goes less than this share of the way of the drive, as a compliant contact lets it,
_UNUSUAL = 2.0           # and less than so many times its share in the median
_NOISES = 4.0            # standard deviations of a position
_FEWEST = 10             # readings: after a shorter rest no break-away is seen


class _Rest(NamedTuple):
    """The rest after a motion; in its middle the slider has `gone` so far while the drive went `driven`, m."""

    motion: MeasuredMotion
    gone: float
    driven: float


def ends_in_rest(motions: Sequence[MeasuredMotion], track: Track, drive: InputProfile) -> tuple[MeasuredMotion, ...]:
    """Return the motions that end in a rest: not those that only slow down, or go on with the drive.

    How far a slider at rest goes with its drive is the same share in all rests of an axis, about.
    """
    ends = [*(motion.begin for motion in motions[1:]), float(track.times[-1])]
    rests = [_Rest(motion, *_gone(motion.end, end, track, drive)) for motion, end in zip(motions, ends)
             if end - motion.end >= _SHORT * (motion.end - motion.begin)]
    noise = _NOISES * track.position_noise
    rests = [rest for rest in rests if rest.gone <= _FOLLOWS * rest.driven + noise]
    shares = [rest.gone / rest.driven for rest in rests if rest.driven > 0.0]
    usual = _UNUSUAL * float(np.median(shares)) if shares else 0.0
    return tuple(rest.motion for rest in rests if rest.gone <= usual * rest.driven + noise)


def has_break_away(motions: Sequence[MeasuredMotion], track: Track, drive: InputProfile) -> bool:
    """Return whether one of the motions begins from a rest that was measured, so that it shows static friction.

    The slider stands still in the middle of it, or in its first half: where a slow motion begins is found too late.
    """
    shortest = _FEWEST * float(track.times[1] - track.times[0])
    ends = [float(track.times[0]), *(motion.end for motion in motions)]
    gaps = [(end, motion.begin) for end, motion in zip(ends, motions) if motion.begin - end >= shortest]
    gone = [_gone(*gap, track, drive, part) for gap in gaps for part in (_MIDDLE, _FIRST_HALF)]
    return any(own <= _FOLLOWS * driven + _NOISES * track.position_noise for own, driven in gone)


def _gone(begin: float, end: float, track: Track, drive: InputProfile, part: tuple[float, float] = _MIDDLE
          ) -> tuple[float, float]:
    """Return how far slider and drive go in a part of a rest, m."""
    ends = begin + np.array(part) * (end - begin)
    return (float(abs(np.diff(np.interp(ends, track.times, track.position))[0])),
            float(abs(np.diff(travelled(drive, ends))[0])))
