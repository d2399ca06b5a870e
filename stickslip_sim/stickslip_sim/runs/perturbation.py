# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""A scene whose every number is off by one rounding unit: what the digits of the data decide shows in the difference.

Numbers that are equal move alike, since an equality is part of the model: mu_s(0) = mu_k(0), a reversal to the same
speed.  Zeros, infinities and the ends 1 and 0 of psi stay.
"""

import dataclasses
import math
import random
from typing import Any

from ..core.input_profile import Sinusoid
from ..friction import ExcessTable
from ..scene import Scene

ROUNDING_UNIT = 2.0 ** -52


def perturbed(scene: Scene, seed: str) -> Scene:
    """Return the scene with every number of axis, start and input profiles times 1 ± 2⁻⁵², signs drawn from the seed.

    Raises InputError in the rare case that breakpoints of a table or a profile change places by that.
    """
    move = _Mover(seed)
    return dataclasses.replace(scene, axis=move.moved(scene.axis), initial=move.moved(scene.initial),
                               drive=move.moved(scene.drive), force=move.moved(scene.force),
                               normal_load=move.moved(scene.normal_load))


class _Mover:
    """Moves numbers, equal ones alike; walks through the frozen types that a scene is made of."""

    def __init__(self, seed: str) -> None:
        self._random = random.Random(seed)
        self._factors: dict[float, float] = {0.0: 1.0, math.inf: 1.0}

    def moved(self, value: Any) -> Any:
        """Return a value with all its numbers moved."""
        if isinstance(value, float):
            return value * self._factor(abs(value))
        if isinstance(value, ExcessTable):
            inner = tuple(self.moved(fraction) for fraction in value.fractions[1:-1])
            return ExcessTable(self.moved(value.velocities), (1.0, *inner, 0.0))
        if isinstance(value, Sinusoid):
            return Sinusoid(*map(self.moved, value))
        if type(value) is tuple:
            return tuple(map(self.moved, value))
        if dataclasses.is_dataclass(value) and not isinstance(value, type):
            changes = {field.name: self.moved(getattr(value, field.name)) for field in dataclasses.fields(value)}
            return dataclasses.replace(value, **changes)
        return value

    def _factor(self, size: float) -> float:
        return self._factors.setdefault(size, 1.0 + self._random.choice((-1.0, 1.0)) * ROUNDING_UNIT)
