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
_MIDDLE = 0.25, 0.75     # of a rest: between these the slider stands still,
_FOLLOWS = 0.4           # or goes less than this share of the way of the drive, as a compliant contact lets it,
_UNUSUAL = 2.0           # and less than so many times its share in the median
_NOISES = 4.0            # standard deviations of a position


class _Rest(NamedTuple):
    """The rest after a motion; in its middle the slider has `gone` so far while the drive went `driven`, m."""

    motion: MeasuredMotion
    gone: float
    driven: float


def ends_in_rest(motions: Sequence[MeasuredMotion], track: Track, drive: InputProfile) -> tuple[MeasuredMotion, ...]:
    """Return the motions that end in a rest: not those that only slow down, or go on with the drive.

    How far a slider at rest goes with its drive is the same share in all rests of an axis, about.
    """
    rests = [_Rest(motion, *_gone(motion, after, track, drive)) for motion, after in zip(motions, [*motions[1:], None])
             if _rest_end(after, track) - motion.end >= _SHORT * (motion.end - motion.begin)]
    noise = _NOISES * track.position_noise
    rests = [rest for rest in rests if rest.gone <= _FOLLOWS * rest.driven + noise]
    shares = [rest.gone / rest.driven for rest in rests if rest.driven > 0.0]
    usual = _UNUSUAL * float(np.median(shares)) if shares else 0.0
    return tuple(rest.motion for rest in rests if rest.gone <= usual * rest.driven + noise)


def _rest_end(after: MeasuredMotion | None, track: Track) -> float:
    return float(track.times[-1]) if after is None else after.begin


def _gone(motion: MeasuredMotion, after: MeasuredMotion | None, track: Track, drive: InputProfile
          ) -> tuple[float, float]:
    """Return how far slider and drive go in the middle of the rest after a motion, m."""
    ends = motion.end + np.array(_MIDDLE) * (_rest_end(after, track) - motion.end)
    return (float(abs(np.diff(np.interp(ends, track.times, track.position))[0])),
            float(abs(np.diff(travelled(drive, ends))[0])))
