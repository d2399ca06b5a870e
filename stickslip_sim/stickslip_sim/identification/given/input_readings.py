# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The readings of an input, and what they would have been had its sensor read it once more."""

from typing import NamedTuple

import numpy as np

from ...core.arrays import Numbers
from ...core.input_profile import InputProfile
from .measured_inputs import profile_through, travelled, velocity_within
from .sensor_noise import noise_of, quantum_of

LINE, HELD, PLACES = 'line', 'held', 'places'
_WITHIN = 2.0   # standard deviations: so near to its measured position a drive is taken to move


class InputReadings(NamedTuple):
    """Readings (n,) of an input at times (n,), s: values on a LINE or HELD in between, or PLACES of a drive (m)."""

    times: Numbers
    values: Numbers
    kind: str

    def profile(self) -> InputProfile:
        """Return the input; of places, the velocity."""
        return self._through(self.values)

    def read_again(self, random: np.random.Generator) -> InputProfile:
        """Return the input as it would have been found from other readings of it, with noise of its own."""
        quantum = quantum_of(self.values)
        noise = noise_of(self.values, quantum)
        if self.kind != PLACES:
            return self._through(self.values + random.normal(0.0, noise, len(self.values)))
        way = self.values[0] + travelled(self.profile(), self.times)
        if quantum == 0.0:
            return self._through(way + random.normal(0.0, noise, len(way)))
        phase = random.uniform(0.0, quantum)   # where its steps begin
        return self._through(np.round((way + phase) / quantum) * quantum)

    def _through(self, values: Numbers) -> InputProfile:
        if self.kind != PLACES:
            return profile_through(self.times, values, self.kind == HELD)
        quantum = quantum_of(self.values)
        return velocity_within(self.times, values, max(0.5 * quantum, _WITHIN * noise_of(self.values, quantum)))
