# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Numbers of a simulator that were saved, checked before a solver goes on with them.

A solver takes some of its numbers as places in tables and does not look twice.
"""

from collections.abc import Iterable, Sequence
from typing import Any

from ..core.types import Event, EventKind, Mode


def numbers_of(saved: Iterable[Any], state: Any) -> list[float]:
    """Return saved numbers for a state of this size; raises TypeError or ValueError."""
    numbers, size = [float(number) for number in saved], len(state.numbers())
    if len(numbers) != size:
        raise ValueError(f'a state of {len(numbers)} numbers where {size} are expected')
    return numbers


def check_state(state: Any, sinusoids: int, parameters: Any) -> None:
    """Raise ValueError when a state is none of an axis with these parameters and so many sinusoids."""
    for name, number, highest in (('mode', state.mode, max(Mode)),
                                  ('segment', state.segment, int(parameters.segment_count) - 1),
                                  ('sinusoids', state.sinusoid_count, sinusoids),
                                  ('sinusoids', state.given_sinusoids, sinusoids)):
        if number not in range(highest + 1):
            raise ValueError(f'{name} = {number!r} is none of this scene')


def event_of(saved: Sequence[Any]) -> Event:
    """Return a saved event; raises TypeError or ValueError."""
    second, fraction, kind, mode, direction, *numbers = saved
    return Event(float(second), float(fraction), EventKind(kind), Mode(mode), int(direction), *map(float, numbers))
