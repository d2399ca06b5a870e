# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Folders of sweeps that someone else made: refused in one line, and not read to their end first."""

import json
import os
import shutil
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from stickslip_sim.cli.main import run
from stickslip_sim.study.folder import LONGEST_SIDECAR, PARTIAL, POINTS_TABLE, SIDECAR

SWEEP = ['sweep', 'paper_fig8', '--over', 'drive.velocity=1e-3:0.02:3', '--over', 'axis.drive_stiffness=1e5:1e6:2']


@pytest.fixture(scope='module')
def swept(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp('swept') / 'out'
    assert run([*SWEEP, '--out', str(folder)]) == 0
    return folder


@pytest.fixture
def folder(swept: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> Path:
    """Return a copy below the working directory: messages shorten long paths."""
    capsys.readouterr()
    monkeypatch.chdir(tmp_path)
    return Path(shutil.copytree(swept, 'other'))


def refusal(capsys: pytest.CaptureFixture[str], *arguments: str) -> str:
    assert run(list(arguments)) == 2
    out, errors = capsys.readouterr()
    assert (out, errors.count('\n')) == ('', 1)
    return errors


def mapped(folder: Path) -> list[str]:
    return ['map', str(folder), '--out', str(folder.parent / 'map.png')]


def without(name: str) -> Callable[[Any], None]:
    return lambda sidecar: sidecar.pop(name)


def with_value(name: str, value: object) -> Callable[[Any], None]:
    return lambda sidecar: sidecar.update({name: value})


def with_first(name: str, value: object) -> Callable[[Any], None]:
    return lambda sidecar: sidecar['over'][0].update({name: value})


@pytest.mark.parametrize('change', [
    *map(without, ('duration', 'over', 'sobol', 'uncertain', 'scene_text')),
    with_value('scene_text', 5), with_value('duration', 'x'), with_value('over', 5), with_value('over', [{}]),
    with_value('sobol', 5), with_value('uncertain', 5), with_value('sobol', {'points': 10**12, 'seed': 0}),
    with_first('name', ['a']), with_first('low', 'x'), with_first('low', 10**400), with_first('count', 'x'),
    with_first('count', -3), with_first('log', 5),
])
def test_a_description_that_is_none(change: Callable[[Any], None], folder: Path,
                                    capsys: pytest.CaptureFixture[str]) -> None:
    sidecar = json.loads((folder / SIDECAR).read_text())
    change(sidecar)
    (folder / SIDECAR).write_text(json.dumps(sidecar))
    refusal(capsys, *mapped(folder))


def nested(path: Path) -> None:
    path.write_text('[' * 100_000)


def endless(path: Path) -> None:
    path.unlink()
    path.symlink_to('/dev/zero')


def pipe(path: Path) -> None:
    path.unlink()
    os.mkfifo(path)


def sparse(path: Path) -> None:
    os.truncate(path, 1 << 40)


@pytest.mark.parametrize('make', [nested, endless, pipe, sparse])
@pytest.mark.parametrize('name', [SIDECAR, POINTS_TABLE])
def test_a_file_without_end(name: str, make: Callable[[Path], None], folder: Path,
                            capsys: pytest.CaptureFixture[str]) -> None:
    make(folder / name)
    assert name in refusal(capsys, *mapped(folder))


def test_a_line_without_end(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """The description says that there are so many points that a file of any size may be their table."""
    sidecar = json.loads((folder / SIDECAR).read_text())
    sidecar['over'][0]['count'] *= 10**10
    sidecar['points'] *= 10**10
    (folder / SIDECAR).write_text(json.dumps(sidecar))
    (folder / POINTS_TABLE).write_bytes((folder / POINTS_TABLE).read_bytes().splitlines(keepends=True)[0])
    sparse(folder / POINTS_TABLE)
    assert POINTS_TABLE in refusal(capsys, *mapped(folder))


@pytest.mark.parametrize('make', [endless, sparse])
def test_nobody_goes_on_with_what_has_no_end(make: Callable[[Path], None], folder: Path,
                                             capsys: pytest.CaptureFixture[str]) -> None:
    (folder / POINTS_TABLE).rename(folder / PARTIAL)
    make(folder / PARTIAL)
    assert 'it was changed' in refusal(capsys, *SWEEP, '--out', str(folder), '--resume')


def test_nothing_that_a_link_leads_to_is_changed(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    diary = folder.parent.absolute() / 'diary'
    diary.write_text('dear diary\n')
    (folder / POINTS_TABLE).unlink()
    (folder / PARTIAL).symlink_to(diary)
    assert 'it was changed' in refusal(capsys, *SWEEP, '--out', str(folder), '--resume')
    assert diary.read_text() == 'dear diary\n'


def test_the_longest_scene_has_room_in_a_description(folder: Path) -> None:
    from stickslip_sim.config.ros_yaml import SIZE_LIMIT

    assert LONGEST_SIDECAR > 4 * SIZE_LIMIT > (folder / SIDECAR).stat().st_size
