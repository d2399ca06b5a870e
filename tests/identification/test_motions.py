# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The motions that are found in a measured position are the slips of the axis, no more and no less."""

from pathlib import Path

import numpy as np
import pytest

import stickslip_sim as stickslip
from benchmarks.identify.axes import DURATION, SyntheticAxis, axes
from benchmarks.identify.measuring import measure
from stickslip_sim.core.arrays import Numbers
from stickslip_sim.core.types import EventKind, Mode
from stickslip_sim.identification.motions import motions_of, track_of
from stickslip_sim.identification.readings import readings_of, travelled, velocity_within

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


# Measured inputs: the way of a drive within the resolution of its encoder.

MICROMETRE = 1e-6
TIMES: Numbers = np.arange(4000, dtype=np.float64) * 1e-3


def test_an_even_feed_that_was_counted_is_even() -> None:
    profile = velocity_within(TIMES, np.round(TIMES * 0.00263 / MICROMETRE) * MICROMETRE, 0.5 * MICROMETRE)
    assert len(profile.starts) <= 5
    assert profile.values_at(TIMES[:3900]) == pytest.approx(np.full(3900, 0.00263), rel=1e-4)


def test_the_way_of_a_drive_turns_where_it_must_and_is_near_the_true_one() -> None:
    """Two feeds, a rest, a sine; differences of the readings are off by 1e-3 m/s."""
    turning = np.where(TIMES > 2.5, 2e-4 * np.sin(3.0 * (TIMES - 2.5)), 0.0)
    true = np.interp(TIMES, [0.0, 1.0, 1.5], [0.0, 0.002, 0.0025]) + turning
    places = np.round(true / MICROMETRE) * MICROMETRE
    profile = velocity_within(TIMES, places, 0.5 * MICROMETRE)
    off = travelled(profile, TIMES) - true
    assert np.abs(off - off[0]).max() < 0.6 * MICROMETRE
    assert len(profile.starts) < 150
    velocity = profile.values_at(TIMES)
    for first, last, feed in ((50, 950, 0.002), (1050, 1450, 0.001), (1550, 2450, 0.0)):
        assert np.abs(velocity[first:last] - feed).max() < 2e-6
