# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Events and samples as CSV: a line of names, then numbers with 17 digits, which give the same floats back."""

from collections.abc import Iterable, Iterator

from ..core.types import Event, EventKind, Mode
from ..runs import Columns

EVENT_COLUMNS = ('time', 'kind', 'direction', 'position', 'velocity', 'drive_force', 'friction_force',
                 'static_coefficient', 'rest_time')
SAMPLE_COLUMNS = ('time', 'position', 'velocity', 'acceleration', 'drive_position', 'drive_force', 'friction_force',
                  'mode')
_BLOCK = 10_000   # rows


def event_lines(events: Iterable[Event], knots: bool = False) -> Iterator[str]:
    """Yield the lines of an event table; `knots` lists those of kind `knot` too."""
    yield ','.join(EVENT_COLUMNS) + '\n'
    for event in events:
        if knots or event.kind != EventKind.KNOT:
            numbers = (getattr(event, name) for name in EVENT_COLUMNS[3:])
            yield f'{event.time:.17g},{event.kind.name.lower()},{event.direction:d},' \
                + ','.join(f'{number:.17g}' for number in numbers) + '\n'


def sample_lines(samples: Columns) -> Iterator[str]:
    """Yield the lines of a table of samples."""
    yield ','.join(SAMPLE_COLUMNS) + '\n'
    layout = '%.17g,' * (len(SAMPLE_COLUMNS) - 1) + '%s\n'
    names = {float(mode): mode.name for mode in Mode}
    for begin in range(0, len(samples['time']), _BLOCK):
        columns = [samples[name][begin:begin + _BLOCK].tolist() for name in SAMPLE_COLUMNS]
        for *numbers, mode in zip(*columns, strict=True):
            yield layout % (*numbers, names[mode])
