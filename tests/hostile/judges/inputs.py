# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The inputs of a run, and the axis under its load, from an instant on and in extended precision."""

import math
from typing import Any, NamedTuple

import numpy as np

from stickslip_sim.axis import Axis
from stickslip_sim.core.input_profile import InputProfile, Piece, Sinusoid
from stickslip_sim.core.types import Instant

from ..case import Parts, instant
from .extended import PI, Long


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
