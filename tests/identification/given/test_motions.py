# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The motions that are found in a measured position are the slips of the axis, no more and no less."""

from pathlib import Path

import numpy as np
import pytest

import stickslip_sim as stickslip
from benchmarks.identify.axes import SyntheticAxis, axes
from benchmarks.identify.machines import DURATION
from benchmarks.identify.measuring import measure
from stickslip_sim.core.types import EventKind, Mode
from stickslip_sim.identification.motions import motions_of, track_of
from stickslip_sim.identification.readings import readings_of

LEAST = 2e-5   # m: what a sensor of 1 µm shows as a slip
LATE = 0.02    # s


def true_slips(axis: SyntheticAxis) -> list[tuple[float, float, float]]:
    """Return begin, end (s) and way (m) of each slip of an axis that is to be seen."""
    found, begin = [], None
    for event in stickslip.simulate_events(axis.truth, DURATION).events:
        starts = event.kind in (EventKind.BREAKAWAY, EventKind.REVERSE)
        if begin is not None and (starts or event.mode == Mode.STICK):
            found.append((begin.time, event.time, event.position - begin.position))
            begin = None
        if starts:
            begin = event
    return [slip for slip in found if abs(slip[2]) > LEAST]


@pytest.mark.parametrize('index', [0, 7, 16], ids=['slips after a long way', 'rings after it', 'rings'])
def test_the_motions_of_a_run_are_its_slips(tmp_path: Path, index: int) -> None:
    axis = axes(index + 1)[index]
    run = measure(axis.truth, DURATION, np.random.default_rng(axis.seed)).as_run(tmp_path / 'run')
    measurement = readings_of(run, axis.start, {})
    motions = motions_of(track_of(measurement, axis.start.drive))
    slips = true_slips(axis)
    seen = [[motion for motion in motions if begin - LATE < motion.begin < end] for begin, end, _ in slips]
    assert all(seen)   # two where the feed, and with it what is a rest, changes in mid-slip
    assert sum(map(len, seen)) == len(motions)
    for (_, end, way), (motion, *others) in zip(slips, seen):
        if not others:
            assert motion.end == pytest.approx(end, abs=LATE)
            assert motion.stop - motion.start == pytest.approx(way, rel=0.02, abs=1e-5)   # it begins slowly
