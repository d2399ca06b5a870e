# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Input profiles v(t) and F(t): piecewise linear, with jumps, held after the last piece or repeated, plus sines."""

import math
from bisect import bisect_right
from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from . import ranges
from .errors import InputError

MAX_SINUSOIDS = 100
FREQUENCIES = 1e-9, 1e6   # Hz
_APART = 1e-11            # s; a rise in less is lost in the rounding of the time


class Piece(NamedTuple):
    """value + rate (t − start) from `start` on, until `end` (s)."""

    start: float
    end: float
    value: float
    rate: float


class Sinusoid(NamedTuple):
    """amplitude · sin(2π frequency t + phase), t being simulation time."""

    amplitude: float
    frequency: float   # Hz
    phase: float       # rad

    def at(self, time: float) -> float:
        """Return the value at a time."""
        return self.amplitude * math.sin(2.0 * math.pi * self.frequency * time + self.phase)


@dataclass(frozen=True, slots=True)
class InputProfile:
    """Pieces: `starts` (s, the first is 0), `values` there, `rates` (per s) from there; and `sinusoids` on top.

    With a finite `period` the pieces start anew every `period` seconds; the sinusoids go on.  Raises InputError on
    sinusoids out of range.
    """

    starts: tuple[float, ...]
    values: tuple[float, ...]
    rates: tuple[float, ...]
    period: float = math.inf
    sinusoids: tuple[Sinusoid, ...] = ()

    def __post_init__(self) -> None:
        if self.sinusoids:
            self._check_sinusoids()

    def __deepcopy__(self, _memo: object) -> 'InputProfile':
        """Return the profile itself, for nothing in it changes: a measured one has a hundred thousand numbers."""
        return self

    def _check_sinusoids(self) -> None:
        if len(self.sinusoids) > MAX_SINUSOIDS:
            raise InputError('sinusoids', len(self.sinusoids), f'at most {MAX_SINUSOIDS} in a profile',
                             'leave the weakest out')
        for sinusoid in self.sinusoids:
            if not all(map(math.isfinite, sinusoid)):
                raise InputError('sinusoids', sinusoid, 'of finite amplitude, frequency and phase', 'give numbers')
            if not FREQUENCIES[0] <= sinusoid.frequency <= FREQUENCIES[1]:
                raise InputError('sinusoids', sinusoid, 'of {:g} to {:g} Hz'.format(*FREQUENCIES),
                                 'use pieces for a constant')

    def check(self, name: str) -> None:
        """Raise InputError when a number of the profile called `name` is not finite."""
        if math.isfinite(sum(self.starts) + sum(self.values) + sum(self.rates)):   # one that is not finite makes it so
            return
        numbers = *self.starts, *self.values, *self.rates
        if not all(map(math.isfinite, numbers)):
            raise InputError(name, next(number for number in numbers if not math.isfinite(number)),
                             'a profile of finite times, values and rates', 'give numbers')

    def piece_at(self, time: float) -> Piece:
        """Return the piece that holds from `time` >= 0 s on (at a border: the one that begins)."""
        turns = 0.0
        if self.period < math.inf:
            turns = math.floor(time / self.period)
            turns += (time >= (turns + 1.0) * self.period) - (time < turns * self.period)
        turn = turns * self.period if turns else 0.0
        # sums are compared, so that the end of a piece is the start of the next to the last bit
        i = max(bisect_right(self.starts, time, key=lambda start: turn + start) - 1, 0)
        end = turn + self.starts[i + 1] if i + 1 < len(self.starts) else (turns + 1.0) * self.period
        return Piece(turn + self.starts[i], end, self.values[i], self.rates[i])

    def pieces_at(self, time: float) -> tuple[float, float, float]:
        """Return what the pieces make at `time` >= 0 s: the value, its rate, and until when."""
        if self.period == math.inf:
            starts = self.starts
            i = len(starts) - 1
            if i and time < starts[i]:
                i = max(bisect_right(starts, time) - 1, 0)
            end = starts[i + 1] if i + 1 < len(starts) else math.inf
            return self.values[i] + self.rates[i] * (time - starts[i]), self.rates[i], end
        piece = self.piece_at(time)
        return piece.value + piece.rate * (time - piece.start), piece.rate, piece.end

    def plus(self, value: float) -> 'InputProfile':
        """Return the profile with a constant added."""
        return replace(self, values=tuple(own + value for own in self.values))

    def value_at(self, time: float) -> float:
        """Return the value at `time` >= 0 s."""
        value = self.pieces_at(time)[0]
        return value + (sum(sinusoid.at(time) for sinusoid in self.sinusoids) if self.sinusoids else 0.0)

    def values_at(self, times: NDArray[np.float64]) -> NDArray[np.float64]:
        """Return the values at times >= 0 s, each as `value_at` does but for the last bit of a sinusoid."""
        turns: NDArray[np.float64] = np.zeros(len(times))
        if self.period < math.inf:
            turns = np.floor(times / self.period)
            turns += (times >= (turns + 1.0) * self.period).astype(float) - (times < turns * self.period)
        begin: NDArray[np.float64] = turns * self.period if self.period < math.inf else turns
        starts, last = np.array(self.starts), len(self.starts) - 1
        piece = np.clip(np.searchsorted(starts, times - begin, 'right') - 1, 0, last)
        piece -= (begin + starts[piece] > times) & (piece > 0)   # sums are compared, as `piece_at` does
        piece += (begin + starts[np.minimum(piece + 1, last)] <= times) & (piece < last)
        values = np.array(self.values)[piece] + np.array(self.rates)[piece] * (times - (begin + starts[piece]))
        for one in self.sinusoids:
            values += one.amplitude * np.sin(2.0 * math.pi * one.frequency * times + one.phase)
        return np.asarray(values, dtype=np.float64)

    @property
    def is_stepwise(self) -> bool:
        """Whether it is constant but for jumps."""
        return not any(self.rates) and not any(sinusoid.amplitude for sinusoid in self.sinusoids)

    def bounds(self) -> tuple[float, float]:
        """Return bounds of its values at all times: those of the pieces, and what the sinusoids add at the most."""
        ends = [value + rate * (end - start) if rate else value for start, end, value, rate in zip(
            self.starts, (*self.starts[1:], self.period), self.values, self.rates)]
        swing = sum(abs(sinusoid.amplitude) for sinusoid in self.sinusoids)
        return min(*self.values, *ends) - swing, max(*self.values, *ends) + swing


Input = InputProfile | float    # a profile, or a number that holds


def plain_of(given: Input) -> list[Any]:
    """Return an input as numbers in lists, for `profile_of`."""
    profile = given if isinstance(given, InputProfile) else constant(given)
    return [list(profile.starts), list(profile.values), list(profile.rates), profile.period,
            [list(sinusoid) for sinusoid in profile.sinusoids]]


def profile_of(plain: Sequence[Any]) -> InputProfile:
    """Return the profile that `plain_of` made these of; raises TypeError or ValueError on anything else."""
    starts, values, rates, period, sinusoids = plain
    if not starts or not len(starts) == len(values) == len(rates):
        raise ValueError('a profile needs as many values and rates as times')
    return InputProfile(_floats(starts), _floats(values), _floats(rates), float(period),
                  tuple(Sinusoid(*map(float, sinusoid)) for sinusoid in sinusoids))


def constant(value: float) -> InputProfile:
    """Return a profile that never changes."""
    return InputProfile((0.0,), (value,), (0.0,))


def ramp(start: float, rate: float, duration: float) -> InputProfile:
    """Return a profile that changes by `rate` per second for `duration` seconds, then holds."""
    if duration == math.inf:
        return InputProfile((0.0,), (start,), (rate,))
    return InputProfile((0.0, duration), (start, start + rate * duration), (rate, 0.0))


def steps(name: str, times: Sequence[float], values: Sequence[float], period: float = math.inf) -> InputProfile:
    """Return a profile that jumps to values[i] at times[i]; raises InputError unless the times start at 0 and rise."""
    check_times(name, times, values, period)
    return InputProfile(tuple(times), tuple(values), (0.0,) * len(values), period)


def table(name: str, times: Sequence[float], values: Sequence[float], period: float = math.inf) -> InputProfile:
    """Return a profile that is linear between (times[i], values[i]) and holds the last value.

    With a period it is linear from the last value back to the first.  Raises InputError like `steps`, and on times
    nearer than 1e-11 s.
    """
    check_times(name, times, values, period)
    for before, after in pairwise([*times, period]):
        if after - before < _APART:
            raise InputError(f'{name}.times', [before, after], f'at least {_APART:g} s apart in a table',
                             f'they are {after - before:.3g} s apart; drop one, or use course: steps for a jump')
    rates = [(b - a) / (t1 - t0) for (t0, t1), (a, b) in zip(pairwise(times), pairwise(values), strict=True)]
    rates.append((values[0] - values[-1]) / (period - times[-1]) if period < math.inf else 0.0)
    return InputProfile(tuple(times), tuple(values), tuple(rates), period)


def sinusoids(name: str, amplitudes: Sequence[float], frequencies: Sequence[float],
          phases: Sequence[float] | None = None) -> tuple[Sinusoid, ...]:
    """Return amplitudes[i] sin(2π frequencies[i] t + phases[i]), phases 0 when left out.

    Raises InputError on lengths that differ and on too many.
    """
    phases = [0.0] * len(amplitudes) if phases is None else phases
    for what, given in (('frequencies', frequencies), ('phases', phases)):
        if len(given) != len(amplitudes):
            raise InputError(f'{name}.{what}', list(given), f'as many as there are amplitudes ({len(amplitudes)})',
                             'give one for every sinusoid')
    if len(amplitudes) > MAX_SINUSOIDS:
        raise InputError(f'{name}.amplitudes', len(amplitudes), f'at most {MAX_SINUSOIDS} sinusoids',
                         'leave the weakest out')
    return tuple(map(Sinusoid, amplitudes, frequencies, phases))


def _floats(numbers: Sequence[Any]) -> tuple[float, ...]:
    return tuple(map(float, numbers))


def check_times(name: str, times: Sequence[float], values: Sequence[float], period: float) -> None:
    """Raise InputError unless there is a time for each value, from 0 on, rising, and below the period."""
    if not times or len(times) != len(values):
        raise InputError(f'{name}.times', list(times), f'as many numbers as there are values ({len(values)})',
                         'give one value for every time')
    if times[0] != 0.0:
        raise InputError(f'{name}.times', times[0], '0 s at the first value', 'a profile starts with the run')
    for before, after in pairwise([*times, period]):
        if not before < after:
            raise InputError(f'{name}.times', [*times], 'strictly increasing and below the period, in s',
                             f'{after!r} follows {before!r}')


# The position of a drive over time, s(t), as the input profile of its velocity.
#
# The derivative of a piecewise linear s is piecewise constant, that of a piecewise quadratic one piecewise linear, so
# that nothing is approximated.  A jump of s is refused: the drive's damper would answer it with an infinite force, and
# take infinite energy.

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
