# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The same run in parts, and from a checkpoint in its midst: the same bits."""

import json
import random

from stickslip_sim.core.types import Event, Instant

from ..case import Find, Run, instant, simulator

_MOST = 60   # of the events at whose own times a run is split


def judge(run: Run, rng: random.Random) -> None:
    """Run with stops at random instants, at events, and through a checkpoint; raises Find."""
    parts, wanted = run.parts, run.events
    end = run.stretches[-1][1]
    times = [instant(rng.random() * parts.duration) for _ in range(10)]
    times += [event.instant for event in wanted[:_MOST]]
    split = simulator(parts)
    seen = [event for time in sorted(times) if time <= end.instant for event in split.advance(time)]
    seen += split.advance(end.instant)
    if seen != wanted:
        raise Find(f'in parts: {_difference(seen, wanted)}')
    if split.sample() != end:
        raise Find(f'in parts: the end is {split.sample()} and not {end}')
    _from_checkpoint(run, rng.choice(times))


def _from_checkpoint(run: Run, at: Instant) -> None:
    parts, end = run.parts, run.stretches[-1][1]
    first, second = simulator(parts), simulator(parts)
    seen = first.advance(min(at, end.instant))
    second.restore(json.loads(json.dumps(first.checkpoint())), parts.axis, parts.drive, parts.force)
    seen += second.advance(end.instant)
    if seen != run.events:
        raise Find(f'from a checkpoint at {at.seconds!r} s: {_difference(seen, run.events)}')
    if second.sample() != end:
        raise Find(f'from a checkpoint at {at.seconds!r} s: the end is {second.sample()} and not {end}')


def _difference(seen: list[Event], wanted: list[Event]) -> str:
    for i, (a, b) in enumerate(zip(seen, wanted)):
        if a != b:
            return f'event {i} is {tuple(a)} and not {tuple(b)}'
    return f'{len(seen)} events and not {len(wanted)}'
