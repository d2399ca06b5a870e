# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Numbers of a simulator that were saved, checked before a solver goes on with them.

A solver takes some of its numbers as places in tables and does not look twice.
"""

from collections.abc import Iterable, Sequence
from typing import Any

from ..axis.layout import INPUT_WAVES, KNOTS, MODE, PIECE, STATE_SIZE, WAVE_INPUTS, WAVE_SIZE, WAVES
from ..core.types import Event, EventKind, Mode


def state_of(saved: Iterable[Any], size: int, parameters: Sequence[float]) -> list[float]:
    """Return a saved state of this size for an axis with these parameters; raises TypeError or ValueError."""
    state = [float(number) for number in saved]
    if len(state) != size:
        raise ValueError(f'a state of {len(state)} numbers where {size} are expected')
    sinusoids = (size - STATE_SIZE) // WAVE_SIZE
    for name, place, highest in (('mode', MODE, max(Mode)), ('piece', PIECE, int(parameters[KNOTS]) - 1),
                                 ('waves', WAVES, sinusoids), ('waves', INPUT_WAVES, sinusoids * WAVE_INPUTS)):
        if state[place] not in range(highest + 1):
            raise ValueError(f'{name} = {state[place]!r} is none of this scene')
    return state


def event_of(saved: Sequence[Any]) -> Event:
    """Return a saved event; raises TypeError or ValueError."""
    second, fraction, kind, mode, direction, *numbers = saved
    return Event(float(second), float(fraction), EventKind(kind), Mode(mode), int(direction), *map(float, numbers))
