# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Runs that are too long to be held: they read, draw and compare like short ones, and nobody holds all samples."""

import json
import shutil
import warnings
from pathlib import Path

import numpy as np
import pytest

from stickslip_sim.cli.main import run as tool
from stickslip_sim.compare import run_part
from stickslip_sim.compare.report_folder import write_report
from stickslip_sim.core.errors import RecordingError, RecordingWarning
from stickslip_sim.recording import RecordedRun, mcap_records, paired_steps, read_run, recorded_run, run_outline
from stickslip_sim.runs import reduced
from stickslip_sim.runs.samples import joined
from tests.support.rewritten_bags import rewritten
from tests.support.tool import Capture


@pytest.fixture
def _short_memory(monkeypatch: pytest.MonkeyPatch) -> None:
    """Let no run be held."""
    monkeypatch.setattr(recorded_run, 'MOST_HELD', 10)
    monkeypatch.setattr(run_part, 'MOST_HELD', 2500)
    monkeypatch.setattr(reduced, 'MOST_HELD', 2500)
    monkeypatch.setattr(mcap_records, 'GATHERED_BYTES', 1 << 14)
    for module in (paired_steps, run_outline):
        monkeypatch.setattr(module, 'GATHERED', 200)


def read(path: Path) -> RecordedRun:
    with warnings.catch_warnings():
        warnings.simplefilter('ignore', RecordingWarning)
        return read_run(path)


def facts(run: RecordedRun) -> tuple[object, ...]:
    return run.begin, run.end, run.missing_steps, run.summary, run.events, run.cycles()


def cut(bag: Path, folder: Path) -> Path:
    shutil.copytree(bag, folder)
    (file,) = folder.glob('*.mcap')
    data = file.read_bytes()
    file.write_bytes(data[:2 * len(data) // 3])
    return folder


def made(kind: str, bag: Path, folder: Path) -> Path:
    """Return a bag as it is, one that was cut off, or one that began later."""
    if kind == 'late':
        return rewritten(bag, folder, since=1.2345)
    return cut(bag, folder) if kind == 'cut off' else bag


@pytest.mark.parametrize('kind', ['whole', 'cut off', 'late'])
def test_a_long_run_reads_like_a_short_one(kind: str, fig8_bag: Path, tmp_path: Path,
                                           request: pytest.FixtureRequest) -> None:
    path = made(kind, fig8_bag, tmp_path / 'bag')
    short = read(path)
    known = facts(short)
    request.getfixturevalue('_short_memory')
    long = read(path)
    assert facts(long) == known
    blocks = list(long.sample_blocks())
    assert len(blocks) > 5
    assert 'samples' not in vars(long)
    again = joined(blocks)
    assert list(again) == list(short.samples)
    assert all(np.array_equal(again[name], short.samples[name]) for name in again)


def test_the_report_of_a_long_run_is_that_of_a_short_one(
        fig8_bag: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, request: pytest.FixtureRequest) -> None:
    monkeypatch.setattr('stickslip_sim.compare.pictures.PICTURE_KINDS', ('svg',))
    reports = []
    for name in ('short', 'long'):
        (tmp_path / name).mkdir()
        run = read(fig8_bag)
        write_report({'eight': run}, tmp_path / name)
        reports.append(json.loads((tmp_path / name / 'report.json').read_text()))
        assert ('samples' in vars(run)) == (name == 'short')
        request.getfixturevalue('_short_memory')
    assert reports[0] == reports[1]


@pytest.mark.usefixtures('_short_memory')
def test_a_picture_holds_no_samples(fig8_bag: Path, tmp_path: Path) -> None:
    run = read(fig8_bag)
    run.plot(tmp_path / 'run.png')
    assert 'samples' not in vars(run)
    assert (tmp_path / 'run.png').stat().st_size > 10_000


@pytest.mark.usefixtures('_short_memory')
def test_what_is_in_no_order_is_held(fig8_bag: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Steps that come twice are looked at as a whole, once each."""
    ordered = read(fig8_bag)
    run = read(fig8_bag)
    blocks = run.bag.blocks_of

    def twice(fields: object) -> object:
        return (pair for _ in range(2) for pair in blocks(fields))  # type: ignore[arg-type]

    monkeypatch.setattr(run.bag, 'blocks_of', twice)
    assert run.begin == ordered.begin
    assert len(list(run.sample_blocks())) == 1
    assert len(run.events) == len(ordered.events)


@pytest.mark.usefixtures('_short_memory')
@pytest.mark.parametrize(('topic', 'word'), [('/friction_force', 'FrictionForce'), ('/mode_event', 'ModeEvent')])
def test_a_missing_topic_is_named(topic: str, word: str, fig8_bag: Path, tmp_path: Path) -> None:
    run = read(rewritten(fig8_bag, tmp_path / 'bag', lambda name: None if name == topic else name))
    with pytest.raises(RecordingError, match=f'no topic of type .*{word}'):
        _ = run.events, run.begin


@pytest.mark.usefixtures('_short_memory')
def test_verify_what_if_of_a_long_run(fig8_bag: Path, tmp_path: Path, capsys: Capture,
                                      monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr('stickslip_sim.verify.what_if.MOST_HELD', 100)
    out = tmp_path / 'out'
    assert tool(['verify', str(fig8_bag), '--set', 'axis.mass=300', '--out', str(out)]) == 0
    assert (out / 'what_if.png').stat().st_size > 10_000
    assert capsys.readouterr().out.endswith(f'written: {out}\n')
