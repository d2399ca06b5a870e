# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Position encoders of slider and drive, and the velocity that a drive computes from them.

measured(n) = resolution · round((position(n − delay) + offset + noise) / resolution)
velocity(n) = (measured(n) − measured(n − k)) · rate / k, k = `velocity_steps`
"""

from collections import deque
from collections.abc import Iterator
from dataclasses import dataclass
from math import floor
from typing import NamedTuple

import numpy as np

from ..core.types import tuple_of
from .faults import NO_EFFECT, Effect
from .random_stream import Stream, stream

_BLOCK = 1024   # random numbers drawn at a time


@dataclass(frozen=True, slots=True)
class EncoderSettings:
    """`resolution`, `offset` and `noise` (standard deviation) in m, `delay` in s; all 0: the true values."""

    resolution: float = 0.0
    offset: float = 0.0
    noise: float = 0.0
    delay: float = 0.0
    velocity_steps: int = 1

    @property
    def is_ideal(self) -> bool:
        """Whether it measures the truth."""
        return not (self.resolution or self.offset or self.noise or self.delay)


class Measured(NamedTuple):
    """What the encoders say: m and m/s."""

    slider_position: float
    slider_velocity: float
    drive_position: float
    drive_velocity: float


class Encoder:
    """Measures both positions once a step; the faults in force befall the slider's encoder."""

    def __init__(self, settings: EncoderSettings, rate: float, delay_steps: int, seed: int) -> None:
        def channel(noise: Stream) -> _Ideal | _Sampled:
            if settings.is_ideal:
                return _Ideal()
            return _Sampled(settings, rate, delay_steps, stream(seed, noise))

        self._slider, self._drive = channel(Stream.SLIDER_NOISE), channel(Stream.DRIVE_NOISE)
        self._dropout = stream(seed, Stream.DROPOUT)

    def measure(self, position: float, velocity: float, drive_position: float, drive_velocity: float,
                effect: Effect = NO_EFFECT) -> Measured | None:
        """Return the measurement at the end of a step, None when it is lost."""
        of_drive = self._drive.read(drive_position, drive_velocity)
        if effect is NO_EFFECT:
            return tuple_of(Measured, self._slider.read(position, velocity) + of_drive)
        measured = self._slider.read(position, velocity, effect.encoder_step, effect.encoder_frozen) + of_drive
        if effect.encoder_kept < 1.0 and self._dropout.random_sample() >= effect.encoder_kept:
            return None
        return tuple_of(Measured, measured)


class _Ideal:
    """Reports the truth, unless a fault is in force."""

    def __init__(self) -> None:
        self._position = 0.0

    def read(self, position: float, velocity: float, shift: float = 0.0, is_frozen: bool = False
             ) -> tuple[float, float]:
        if is_frozen:
            return self._position, 0.0
        self._position = position + shift
        return self._position, velocity


class _Sampled:
    """Counts, and takes the velocity from the difference of counts, as a drive does."""

    def __init__(self, settings: EncoderSettings, rate: float, delay_steps: int, noise: np.random.RandomState) -> None:
        self._resolution, self._offset, self._scale = settings.resolution, settings.offset, settings.noise
        self._per_second = rate / settings.velocity_steps
        self._noise = noise
        self._waiting_noise: Iterator[float] = iter(())
        self._delayed = deque[float](maxlen=delay_steps + 1) if delay_steps else None
        self._readings: deque[float] = deque(maxlen=settings.velocity_steps + 1)

    def read(self, position: float, velocity: float, shift: float = 0.0, is_frozen: bool = False
             ) -> tuple[float, float]:
        """Return position and velocity; before the first reading all readings were as that."""
        readings = self._readings
        if self._delayed is not None:
            self._delayed.append(position)
            position = self._delayed[0]
        reading = position + self._offset + shift + (self._next_noise() if self._scale else 0.0)
        if resolution := self._resolution:
            reading = resolution * floor(reading / resolution + 0.5)
        if is_frozen and readings:
            reading = readings[-1]
        readings.append(reading)
        return reading, (reading - readings[0]) * self._per_second

    def _next_noise(self) -> float:
        for number in self._waiting_noise:
            return self._scale * number
        self._waiting_noise = iter(self._noise.standard_normal(_BLOCK).tolist())
        return self._scale * next(self._waiting_noise)
