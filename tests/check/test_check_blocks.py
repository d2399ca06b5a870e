# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""A check looks at a run block by block: the size of the blocks changes nothing, and no column is held whole."""

from pathlib import Path

import pytest

from stickslip_sim.check.limits import limits_of
from stickslip_sim.check.outcomes import outcomes_of
from stickslip_sim.config.ros_yaml import read_yaml
from stickslip_sim.inputs import load_scene
from stickslip_sim.recording import RunFacts, read_run, write_bag
from stickslip_sim.recording.reader import Bag
from stickslip_sim.runs import samples, simulate

LIMITS = limits_of(read_yaml('''
limits:
  following_error: {max: 1.0}
  error of a reference part: {check: following_error, max: 1.0, window: {begin: 0.7001, end: 0.7003}}
  end_position_error: {target: 1.0e-3, max: 1.0}
  overshoot: {target: 2.0e-3, max: 1.0}
  settling_time: {target: 2.0e-3, band: 8.0e-4, max: 9.0}
  settling at an event: {check: settling_time, target: 1.0e-3, band: 9.0e-4, max: 9.0, window: {begin: 0.6}}
  sticks: {max: 9}
  longest_stick: {max: 9.0, window: {begin: 0.9, end: 1.7}}
  limit_cycle_amplitude: {max: 1.0}
  peak_speed: {max: 1.0, window: {begin: 0.65}}
'''))


@pytest.fixture(scope='module')
def bag(tmp_path_factory: pytest.TempPathFactory) -> Path:
    scene = load_scene('paper_fig7', {'time.rate': 5000.0})
    done = simulate(scene, 2.5, scene.time.step)
    folder = tmp_path_factory.mktemp('blocks') / 'run'
    write_bag(folder, RunFacts.of(scene), done.sample_rows(), done.events, {})
    return folder


@pytest.mark.parametrize('rows', [1, 777])
def test_blocks_of_any_size_give_the_same_figures(bag: Path, monkeypatch: pytest.MonkeyPatch, rows: int) -> None:
    expected = outcomes_of(LIMITS, read_run(bag))
    assert expected[-2].value
    monkeypatch.setattr(samples, 'GATHERED', rows)
    assert outcomes_of(LIMITS, read_run(bag)) == expected


def test_no_column_of_a_recorded_run_is_held_whole(bag: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delattr(Bag, 'columns_of')
    assert outcomes_of(LIMITS, read_run(bag))
