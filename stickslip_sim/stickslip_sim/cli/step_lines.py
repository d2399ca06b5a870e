# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""What came of steps, as lines for people."""

from collections.abc import Iterator
from typing import Any

from ..core.types import EventKind, Mode
from ..runs.wording import quantity


def step_lines(answer: Any) -> Iterator[str]:
    """Yield the message of an answer to ~/step, the events of the steps and the state at their end."""
    yield answer.message
    for event in answer.events:
        yield f't = {event.time:.9g} s: {EventKind(event.kind).name.lower()} at {quantity(event.position, "m")}'
    state = answer.state
    yield (f't = {state.time:.9g} s: {Mode(state.mode).name.lower()}, position {quantity(state.position, "m")}, '
           f'velocity {quantity(state.velocity, "m/s")}, drive {quantity(state.drive_velocity, "m/s")}, '
           f'friction {quantity(answer.friction.force, "N")}')
