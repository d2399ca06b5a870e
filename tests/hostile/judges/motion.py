# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""What the judges of linear motions calculate with, in extended precision; nothing here is taken from the engine.

* Motion by the matrix exponential, many at once: the series is summed for a step so short that nothing cancels, and
  squared up; the samples are powers of one step.  No root, no sine, no eigenvalue.
* The inputs of a run, and the axis under its load, from an instant on.
* The characteristics of friction, from the tables and laws as given.
"""

import math
from bisect import bisect_right
from typing import Any, NamedTuple

import numpy as np

from stickslip_sim.axis import Axis, Friction
from stickslip_sim.core.input_profile import InputProfile, Piece, Sinusoid
from stickslip_sim.core.types import Instant
from stickslip_sim.friction import StaticLaw, StaticLawKind
from stickslip_sim.proof.axes import Parts, instant

Long = np.longdouble
EPSILON = 2.0 ** -52    # of the numbers that are judged
MARGIN = 1024.0         # so much more than rounding is a find
PI = Long('3.14159265358979323846264338327950288')
TERMS = 22
EARLY = 24      # halvings of the interval towards its start


class Samples(NamedTuple):
    """States (n, K, d), their rates, and how far rounding of the start may have moved them, at times (n, K)."""

    times: Any
    states: Any
    rates: Any
    noise: Any


def grown(matrices: Any) -> Any:
    """Return exp − 1 of matrices (n, d, d) of norm 1/2 or less: what is small next to 1 keeps its digits."""
    eye = np.eye(matrices.shape[-1], dtype=Long)
    total = eye + matrices / Long(TERMS)
    for k in range(TERMS - 1, 1, -1):
        total = eye + np.matmul(matrices, total) / Long(k)
    return np.matmul(matrices, total)


def doubled(growth: Any) -> Any:
    """Return exp(2 a) − 1 from exp(a) − 1."""
    return 2 * growth + np.matmul(growth, growth)


def samples(rates: Any, start: Any, noise: Any, times: Any, scale: Any, count: int) -> Samples:
    """Return z on a grid of `count` steps up to `times` (n), and at halvings of it, for z′ = A z.

    `rates` (n, d, d), `start` and `noise` (n, d); `scale` (n) bounds the norms.
    """
    step = times / Long(count)
    with np.errstate(over='ignore', invalid='ignore', divide='ignore'):
        halvings = np.maximum(np.ceil(np.log2(np.maximum(4.0 * scale * step, Long(1e-300)))), 0).astype(int)
        most = int(halvings.max()) if len(halvings) else 0
        # all are halved as often as the one that needs it most, and then some: the early samples come from there
        deep = max(most, EARLY - int(np.log2(count)))
        eye = np.eye(rates.shape[1], dtype=Long)
        power = grown(rates * (step / Long(2.0) ** deep)[:, None, None])
        early, early_times = [], []
        for level in range(deep):
            if deep - level <= EARLY:
                early.append(eye + power)
                early_times.append(step / Long(2.0) ** (deep - level))
            power = doubled(power)
        grid = np.stack([np.broadcast_to(eye, power.shape), eye + power], axis=1)
        while grid.shape[1] <= count:
            power = doubled(power)
            grid = np.concatenate([grid, np.matmul((eye + power)[:, None], grid)], axis=1)[:, :count + 1]
        if early:
            grid = np.concatenate([grid[:, :1], np.stack(early, axis=1), grid[:, 1:]], axis=1)
        at = np.concatenate([np.zeros((len(step), 1), dtype=Long), *(t[:, None] for t in early_times),
                             step[:, None] * np.arange(1, count + 1, dtype=Long)], axis=1)
        states = np.matmul(grid, start[:, None, :, None])[..., 0]
        moved = np.matmul(np.abs(grid), noise[:, None, :, None])[..., 0]
        return Samples(at, states, np.matmul(rates[:, None], states[..., None])[..., 0], moved)


class Ramp(NamedTuple):
    """An input without its sinusoids at an instant, and its rate."""

    value: Any
    rate: Any


class Wave(NamedTuple):
    """A sinusoid of an input at an instant."""

    sinusoid: Sinusoid
    is_force: bool      # of the external force, or of the drive's velocity
    sine: Any
    cosine: Any

    @property
    def value(self) -> Any:
        """What it adds to its input."""
        return Long(self.sinusoid.amplitude) * self.sine


class Inputs(NamedTuple):
    """Both inputs from an instant on."""

    drive: Ramp
    force: Ramp
    waves: list[Wave]

    @property
    def velocity(self) -> Any:
        """The drive's velocity at the instant."""
        return self.drive.value + sum((wave.value for wave in self.waves if not wave.is_force), Long(0))

    @property
    def external_force(self) -> Any:
        """The external force at the instant."""
        return self.force.value + sum((wave.value for wave in self.waves if wave.is_force), Long(0))


def inputs_from(parts: Parts, at: Instant) -> Inputs:
    """Return the inputs from an instant on."""
    waves = [Wave(sinusoid, is_force, *_phase(sinusoid, at))
             for is_force, profile in ((False, parts.drive), (True, parts.force)) for sinusoid in profile.sinusoids]
    return Inputs(_ramp(_piece(parts.drive, at), at), _ramp(_piece(parts.force, at), at), waves)


def force_before(parts: Parts, begin: Instant, end: Instant, has_jumped: bool) -> Any:
    """Return the external force as a motion ends: by the piece in which it began, or behind what may have jumped."""
    total = _ramp(_piece(parts.force, end if has_jumped else begin), end).value
    return total + sum((Long(wave.amplitude) * _phase(wave, end)[0] for wave in parts.force.sinusoids), Long(0))


def axis_at(parts: Parts, at: Instant) -> Axis:
    """Return the axis with the normal force that holds at an instant, and from then on where it does not vary."""
    if parts.load is None:
        return parts.axis
    waves = sum((Long(wave.amplitude) * _phase(wave, at)[0] for wave in parts.load.sinusoids), Long(0))
    return parts.axis_under(float(_ramp(_piece(parts.load, at), at).value + waves))


def rounding_of(profile: InputProfile, time: float) -> Any:
    """Return a size of all values that a profile had so far: their rounding adds up from piece to piece."""
    return Long(max(abs(value) + abs(rate) * max(time - start, 0.0) for start, value, rate in zip(
        profile.starts, profile.values, profile.rates)))


def _piece(profile: InputProfile, at: Instant) -> Piece:
    """Return the piece at an instant, which as one double may be a jump that is still to come."""
    piece = profile.piece_at(at.seconds)
    return piece if instant(piece.start) <= at else profile.piece_at(math.nextafter(at.seconds, -math.inf))


def _ramp(piece: Piece, at: Instant) -> Ramp:
    time = Long(at.second) + Long(at.fraction)
    return Ramp(Long(piece.value) + Long(piece.rate) * (time - Long(piece.start)), Long(piece.rate))


def _phase(sinusoid: Sinusoid, at: Instant) -> tuple[Any, Any]:
    turns = np.fmod(Long(sinusoid.frequency) * Long(at.second), 1) + Long(sinusoid.frequency) * Long(at.fraction)
    angle = 2 * PI * (turns - np.floor(turns)) + Long(sinusoid.phase)
    return np.sin(angle), np.cos(angle)


class Line(NamedTuple):
    """value + slope (w − at)."""

    at: Any
    value: Any
    slope: Any

    def of(self, speed: Any) -> Any:
        """Return the value at a speed."""
        return self.value + self.slope * (speed - self.at)


class Table:
    """Breakpoints of mu_k and psi of one direction together, in extended precision."""

    def __init__(self, friction: Friction) -> None:
        kinetic, excess = friction.kinetic, friction.excess
        self.has_branches = excess is not None
        self.breakpoints = sorted({*kinetic.velocities, *(excess.velocities if excess else ())})
        self._kinetic = kinetic.velocities, kinetic.coefficients, kinetic.end_slope
        self._excess = (excess.velocities, excess.fractions, 0.0) if excess else ((0.0,), (0.0,), 0.0)

    def segment(self, speed: float, rising: bool) -> int:
        """Return the segment at a speed: at a breakpoint the one above it, or below it where the speed falls."""
        index = bisect_right(self.breakpoints, speed) - 1
        return index - 1 if not rising and index > 0 and self.breakpoints[index] == speed else index

    def kinetic(self, segment: int) -> Line:
        """Return mu_k on a segment."""
        return _line(*self._kinetic, self.breakpoints[segment])

    def psi(self, segment: int) -> Line:
        """Return psi on a segment."""
        return _line(*self._excess, self.breakpoints[segment])


class Tables:
    """The table of each direction."""

    def __init__(self, axis: Axis) -> None:
        self._ahead, self._back = (Table(axis.friction.along(direction)) for direction in (1.0, -1.0))

    def along(self, direction: float) -> Table:
        """Return the table of motion in a direction."""
        return self._back if direction < 0.0 else self._ahead


def _line(speeds: Any, values: Any, end_slope: float, speed: float) -> Line:
    i = bisect_right(speeds, speed) - 1
    if i + 1 == len(speeds):
        return Line(Long(speeds[i]), Long(values[i]), Long(end_slope))
    slope = (Long(values[i + 1]) - Long(values[i])) / (Long(speeds[i + 1]) - Long(speeds[i]))
    return Line(Long(speeds[i]), Long(values[i]), slope)


def static(law: StaticLaw, rest: Any) -> tuple[Any, Any]:
    """Return mu_s and its rate after rest times (an array)."""
    rest = np.asarray(rest, dtype=Long)
    values, growth = _grown(law, np.maximum(rest - Long(law.delay), 0))
    return values, np.where(rest < Long(law.delay), 0, growth)


def _grown(law: StaticLaw, rest: Any) -> tuple[Any, Any]:
    zero = np.zeros_like(rest)
    initial, rise = Long(law.initial), Long(law.limit) - Long(law.initial)
    if law.kind == StaticLawKind.CONSTANT:
        return zero + initial, zero
    if law.bounded and math.isinf(float(rest.flat[0])):
        return zero + Long(law.limit), zero
    tau = Long(law.time_constant)
    z = rest / tau
    with np.errstate(divide='ignore', invalid='ignore', over='ignore'):
        if law.kind == StaticLawKind.EXPONENTIAL:
            return initial - rise * np.expm1(-z), rise / tau * np.exp(-z)
        if law.kind == StaticLawKind.KATO:
            n = Long(law.exponent)
            power = z ** n
            rate = np.where(z > 0, rise * n * power / np.where(z > 0, rest, 1) * np.exp(-power), np.inf)
            return initial - rise * np.expm1(-power), rate
        if law.kind == StaticLawKind.HYPERBOLIC:
            return initial + rise * z / (1 + z), rise / tau / (1 + z) ** 2
        return initial + rise * np.log1p(z), rise / tau / (1 + z)
