# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Runs that were cut out of a longer one, and begin within a cycle."""

from pathlib import Path

import numpy as np
import pytest

import stickslip_sim as stickslip
from stickslip_sim.recording import write_measured
from tests.support.measured_runs import between

OF_ALL = {'drive.velocity': 0.003, 'friction.acceleration_dependence': False}
SLIDER = stickslip.load_scene('paper_fig7', OF_ALL)


def cut(folder: Path, begin: float, end: float, force: bool, zero: float = 0.0) -> stickslip.Run:
    """Return what sensors show of a part of a run, whose clock and encoder begin anew there."""
    samples = stickslip.simulate(SLIDER, end, 1e-3).samples
    part = samples['time'] >= begin - 1e-9
    x, drive_force = samples['position'][part], samples['drive_force'][part]
    columns = {'position': np.round((x - x[0] + zero) * 1e6) * 1e-6}
    if force:
        noise = np.random.default_rng(3).normal(0.0, 0.01 * np.abs(drive_force).max(), len(x))
        columns['drive_force'] = drive_force + noise
    write_measured(folder, samples['time'][part] - samples['time'][part][0], columns, {})
    return stickslip.read_run(folder)


def test_a_run_that_begins_shortly_before_a_break_away(tmp_path: Path) -> None:
    """From the position alone: the spring cannot have been slack."""
    samples = stickslip.simulate(SLIDER, 4.0, 1e-3).samples
    slips = np.flatnonzero((samples['velocity'][1:] > 0.0) & (samples['velocity'][:-1] == 0.0))
    begin = float(samples['time'][slips[4]]) - 0.05
    run = cut(tmp_path / 'run', begin, begin + 5.0, False)
    start = stickslip.load_scene('paper_fig7', {**OF_ALL, 'friction.static.limit': 0.3})
    found = stickslip.identify(run, start, {'friction.static.limit': between(0.1, 0.5)})
    assert any('within a cycle' in note for note in found.notes)
    assert found.fits, found.misfits
    assert found.values['friction.static.limit'] == pytest.approx(0.24, rel=0.01)
    assert found.values['initial.stretch'] > 1e-4


def test_without_a_force_the_stretch_at_the_start_is_named(tmp_path: Path) -> None:
    run = cut(tmp_path / 'run', 0.0, 4.0, False)
    found = stickslip.identify(run, SLIDER, {'friction.static.limit': between(0.1, 0.5)})
    assert [note for note in found.notes if 'begins stretched by 0 m' in note]
    assert found.values['friction.static.limit'] == pytest.approx(0.24, rel=0.01)
