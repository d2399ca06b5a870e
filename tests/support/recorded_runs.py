# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Runs to record: made-up samples and events that differ in every field."""

import math
import os
from collections.abc import Iterator
from pathlib import Path

from mcap.reader import make_reader

from stickslip_sim.core.types import Event, EventKind, Mode, Sample
from stickslip_sim.recording.messages import Fields, header
from stickslip_sim.recording.run import RunFacts

FACTS = RunFacts('made_up', '/**:\n  ros__parameters:\n    scene: made_up\n', 'ab' * 32, 'exact', 7, 1000.0)


def samples(count: int, first: int = 0) -> Iterator[Sample]:
    for k in range(first, first + count):
        second, part = divmod(k, 1000)
        yield Sample(
            float(second), part / 1000, Mode(k % 4), k % 3 - 1, math.sin(k), math.cos(k), -k * 1e-3, k * 2e-6,
            0.002 if k < 50 else -0.001, 100.0 + k, 5.0 if 20 <= k < 30 else 0.0, 1e3 * math.sin(k / 7),
            0.1 + k * 1e-6, k * 1e-9, math.inf if k < 3 else k * 0.5,
        )


def events() -> list[Event]:
    times = (0.0, 0.0105, 0.011, 0.04, 0.0990000004)
    return [
        Event(0.0, time, EventKind(i), Mode(i % 4), 1 - 2 * (i % 2), i + 0.1, i + 0.2, i + 0.3, i + 0.4, i + 0.5,
              i + 0.6, i + 0.7)
        for i, time in enumerate(times)
    ] + [Event(0.0, 0.0995, EventKind.KNOT, Mode.ACCELERATING, 1, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)]


def slider_state(step: int, sample: Sample, stamp_ns: int) -> Fields:
    """Return the fields of SliderState at the end of a step."""
    names = ('time', 'position', 'velocity', 'acceleration', 'drive_position', 'drive_velocity', 'drive_force',
             'rest_time', 'mode', 'direction')
    return {'header': header(stamp_ns), 'step': step, **{name: getattr(sample, name) for name in names}}


def friction_force(step: int, sample: Sample, stamp_ns: int) -> Fields:
    """Return the fields of FrictionForce at the end of a step."""
    names = ('time', 'contact_deflection', 'mode', 'direction')
    return {'header': header(stamp_ns), 'step': step, 'force': sample.friction_force,
            'coefficient': sample.friction_coefficient, **{name: getattr(sample, name) for name in names}}


def mode_event(step: int, event: Event, stamp_ns: int) -> Fields:
    """Return the fields of ModeEvent."""
    names = ('time', 'kind', 'mode', 'direction', 'position', 'velocity', 'drive_force', 'friction_force',
             'static_coefficient', 'rest_time')
    return {'header': header(stamp_ns), 'step': step, **{name: getattr(event, name) for name in names}}


def damage(file: Path) -> None:
    """Turn a bit in the middle of the messages of a bag."""
    with file.open('r+b') as stream:
        summary = make_reader(stream).get_summary()
        assert summary is not None
        chunk = summary.chunk_indexes[len(summary.chunk_indexes) // 2]
        stream.seek(chunk.chunk_start_offset + chunk.chunk_length // 2)
        byte, = stream.read(1)
        stream.seek(-1, os.SEEK_CUR)
        stream.write(bytes([byte ^ 1]))
