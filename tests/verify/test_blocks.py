# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The quick comparison, byte by byte: it says what the one step by step says, or leaves it to that one."""

from pathlib import Path

import numpy as np
import pytest

from stickslip_sim import load_scene, read_run, simulate
from stickslip_sim.core.errors import RecordingWarning
from stickslip_sim.recording import RunFacts
from stickslip_sim.recording.offline_bag import write_blocks
from stickslip_sim.verify import verification
from stickslip_sim.verify.blocks import same_bytes
from stickslip_sim.verify.verification import Verdict, verify
from tests.support.check_files import cut

DURATION = 4.0


@pytest.fixture(scope='module', params=['cutting_force', 'paper_fig8', 'positioning'])
def bag(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return the folder of an offline run."""
    scene = load_scene(request.param)
    folder = tmp_path_factory.mktemp('runs') / 'run'
    run = simulate(scene, DURATION)
    write_blocks(folder, RunFacts.of(scene, DURATION, scene.time.step), run.sample_blocks(), run.events, {})
    return folder


def of_both(folder: Path, monkeypatch: pytest.MonkeyPatch) -> tuple[Verdict, Verdict]:
    """Return what verify says as it is, and without the quick comparison."""
    run = read_run(folder)
    quick = verify(run)
    monkeypatch.setattr(verification, 'same_bytes', lambda *_: None)
    return quick, verify(run)


def test_a_whole_run(bag: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The quick comparison finds it the same, with the same figures as step by step."""
    scene = load_scene(read_run(bag).scene.name)
    assert same_bytes(read_run(bag), simulate(scene, DURATION)) is not None
    quick, slow = of_both(bag, monkeypatch)
    assert quick == slow


@pytest.mark.parametrize('share', [0.3, 0.5, 0.8])
def test_a_run_that_was_cut_off(bag: Path, share: float, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """As far as it goes, up to its last whole step."""
    with pytest.warns(RecordingWarning, match='no end'):
        quick, slow = of_both(cut(bag, tmp_path / 'cut', share), monkeypatch)
    assert quick == slow


@pytest.mark.parametrize('name', ['position', 'friction_force', 'drive_velocity', 'direction'])
def test_a_changed_bit_is_found_step_by_step(name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The quick comparison does not decide on it."""
    scene = load_scene('paper_fig8')
    run = simulate(scene, DURATION)
    column = run.samples[name].copy()
    column[2500] = np.nextafter(column[2500], 9.0) if name != 'direction' else -1.0
    write_blocks(tmp_path / 'run', RunFacts.of(scene, DURATION, scene.time.step), [{**run.samples, name: column}],
                 run.events, {})
    assert same_bytes(read_run(tmp_path / 'run'), run) is None
    quick, slow = of_both(tmp_path / 'run', monkeypatch)
    assert quick == slow
    assert quick.difference is not None
    assert quick.difference.step == 2500


def test_a_missing_transition_is_found_step_by_step(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """As any other message."""
    scene = load_scene('paper_fig8')
    run = simulate(scene, DURATION)
    write_blocks(tmp_path / 'run', RunFacts.of(scene, DURATION, scene.time.step), run.sample_blocks(), run.events[:-1],
                 {})
    assert same_bytes(read_run(tmp_path / 'run'), run) is None
    quick, slow = of_both(tmp_path / 'run', monkeypatch)
    assert quick == slow
    assert quick.difference is not None


def test_a_shorter_run_is_not_a_longer_one(bag: Path) -> None:
    """Steps beyond the end of the run made again are not the same as nothing."""
    run = read_run(bag)
    assert same_bytes(run, simulate(run.scene, DURATION / 2)) is None
