# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The position of a drive over time, s(t), as the input profile of its velocity.

The derivative of a piecewise linear s is piecewise constant, that of a piecewise quadratic one piecewise linear, so
that nothing is approximated.  A jump of s is refused: the drive's damper would answer it with an infinite force, and
take infinite energy.
"""

import math
from collections.abc import Sequence
from itertools import pairwise

from . import ranges
from .errors import InputError
from .input_profile import InputProfile, check_times

_SAME = 1e-12   # m, and relative: positions that differ by less are the same but for rounding


def positions(name: str, times: Sequence[float], places: Sequence[float], slopes: Sequence[float] | None = None,
              period: float = math.inf) -> InputProfile:
    """Return the velocity of a drive that is at places[i], m, at times[i], s.

    Between them s is linear, and the last place holds.  With `slopes`, m/s, it is quadratic: a piece begins with
    slopes[i], and the last slope holds.  With a period the last piece leads back to the first place.  Raises InputError
    on a jump, on times that do not start at 0 and rise, and on velocities and accelerations out of range.
    """
    for (begin, a), (end, b) in pairwise(zip(times, places, strict=False)):
        if begin == end and a != b:
            raise InputError(f'{name}.positions', (a, b), f'one position at {begin!r} s',
                             'a drive that jumps takes an infinite force: give the jump a time')
    check_times(name, times, places, period)
    if slopes is not None and len(slopes) != len(places):
        raise InputError(f'{name}.slopes', list(slopes), f'as many numbers as there are positions ({len(places)})',
                         'give one for every position, or leave all of them out')
    points = [*zip(times, places, strict=True), *([(period, places[0])] if period < math.inf else [])]
    lengths = [end - begin for (begin, _), (end, _) in pairwise(points)]
    means = [(b - a) / length for ((_, a), (_, b)), length in zip(pairwise(points), lengths, strict=True)]
    rest = [0.0] * (len(times) - len(means))   # the last piece, without a period
    if slopes is None:
        return _checked(name, InputProfile(tuple(times), (*means, *rest), (0.0,) * len(times), period))
    rates = [2.0 * (mean - slope) / length for mean, slope, length in zip(means, slopes, lengths, strict=False)]
    return _checked(name, InputProfile(tuple(times), tuple(slopes), (*rates, *rest), period))


def check_first_position(name: str, position: float, start: float) -> None:
    """Raise InputError unless the profile called `name` begins where the drive starts, m."""
    if not math.isclose(position, start, rel_tol=_SAME, abs_tol=_SAME):
        raise InputError(f'{name}.positions[0]', position, f'{start!r} m, where the drive starts (initial.position +'
                         ' initial.stretch)', f'set initial.position: {position!r}, or count the positions from there')


def _checked(name: str, profile: InputProfile) -> InputProfile:
    for what, numbers, within, unit in (('velocities', profile.values, ranges.VELOCITY, 'm/s'),
                                        ('accelerations', profile.rates, ranges.ACCELERATION, 'm/s²')):
        for start, number in zip(profile.starts, numbers, strict=True):
            if not abs(number) <= within.high:
                raise InputError(f'{name}.positions', number, f'positions that make {what} of at most {within.high:g}'
                                 f' {unit}', f'it is the one from {start!r} s on: give the motion more time')
    return profile
