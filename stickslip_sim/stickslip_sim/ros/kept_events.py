# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The latest events of a run, for its figures, in memory that does not grow."""

import numpy as np

from ..words import Event, EventKind, Mode

MOST = 20_000   # an hour of stick-slip at 5 events a second


class KeptEvents:
    """The latest events, at most `MOST`."""

    def __init__(self) -> None:
        self._rows = np.ones((MOST, len(Event._fields)))   # not zeros: their pages would come one by one
        self._count = 0

    def append(self, event: Event) -> None:
        """Keep an event; the oldest makes room."""
        self._rows[self._count % MOST] = event
        self._count += 1

    def clear(self) -> None:
        """Forget all."""
        self._count = 0

    @property
    def latest_time(self) -> float | None:
        """When the latest one happened, s; None without any."""
        if not self._count:
            return None
        second, fraction = self._rows[(self._count - 1) % MOST, :2].tolist()
        return float(second + fraction)

    def all(self) -> list[Event]:
        """Return those kept, in the order in which they came."""
        order = range(max(self._count - MOST, 0), self._count)
        return [_event(*self._rows[i % MOST].tolist()) for i in order]


def _event(second: float, fraction: float, kind: float, mode: float, direction: float, *rest: float) -> Event:
    return Event(second, fraction, EventKind(int(kind)), Mode(int(mode)), int(direction), *rest)
