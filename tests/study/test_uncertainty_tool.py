# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""`stickslip uncertainty` as a user meets it: what it says and writes, resumed, misused."""

import json
import os
import re
import shutil
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from stickslip_sim.cli.main import run
from stickslip_sim.study.folder import LONGEST_SIDECAR, PARTIAL, POINTS_TABLE, SIDECAR, Folder
from stickslip_sim.study.study import study_of
from tests.support.tool import Capture, answered, done, refused

KNOWN = """parameters:
  friction.static.limit: {distribution: normal, mean: 0.24, standard_deviation: 0.02, between: [0.18, 0.3]}
  friction.static.time_constant: {distribution: lognormal, median: 0.2, geometric_standard_deviation: 1.5,
                                  between: [0.05, 0.8]}
"""


@pytest.fixture
def file(tmp_path: Path) -> str:
    path = tmp_path / 'friction.yaml'
    path.write_text(KNOWN)
    return str(path)


def test_a_distribution_in_the_wrong_unit_is_asked_back(tmp_path: Path, capsys: Capture) -> None:
    known = tmp_path / 'feeds.yaml'
    known.write_text('parameters:\n  drive.velocity: {distribution: uniform, low: 5.0, high: 20.0}\n')
    given = ('uncertainty', 'paper_fig7', '--with', known, '--samples', '16', '--out', tmp_path / 'out')
    said = refused(capsys, *given)
    assert f'{known}: drive.velocity = 5.0 is refused: must be plausible for a feed axis' in said
    assert 'add --allow-implausible drive.velocity' in said
    code, out, _ = answered(capsys, *given, '--meant', 'drive.velocity')
    assert (code, '16 samples of 1 parameter, ' in out) == (0, True)


def test_it_prints_percentiles_and_indices_writes_and_draws_them(tmp_path: Path, file: str, capsys: Capture) -> None:
    out, pictures = tmp_path / 'out', [tmp_path / 'one.svg', tmp_path / 'two.svg']
    common = 'uncertainty', 'paper_fig7', '--with', file, '--samples', '32', '--out', out, '--plot'
    said = done(capsys, *common, pictures[0])
    figures = json.loads((out / 'uncertainty.json').read_text())
    assert '32 samples of 2 parameters, 128 points, 128 run now' in said
    assert 'cut to 0.18 .. 0.3 (0.0027 off)' in said
    assert figures['stick_slip'] == 1.0
    assert list(figures['percentiles']['period']) == ['5', '25', '50', '75', '95']
    index = figures['indices']['period']['friction.static.time_constant']
    assert f'{index["first_order"]:6.3f} ± {index["error"]:.3f}' in said
    assert study_of(Folder(out).described()).count == 128
    assert answered(capsys, *common, pictures[1], '--resume')[0] == 0
    text, again = (picture.read_text() for picture in pictures)
    for words in ('100 % of 64 points stick and slip', 'amplitude / mm', 'points / %', '5 and 95 %',
                  'with its interactions', 'friction static time constant'):
        assert words in text
    assert text == again


def test_correlated_parameters_have_percentiles_and_no_indices(tmp_path: Path, capsys: Capture) -> None:
    file, out, picture = tmp_path / 'friction.yaml', tmp_path / 'out', tmp_path / 'spread.svg'
    file.write_text(f'{KNOWN}correlations:\n  friction.static.limit: {{friction.static.time_constant: 0.9}}\n')
    common = ('uncertainty', 'paper_fig7', '--with', file, '--samples', '32', '--out', out, '--plot', picture)
    said = done(capsys, *common)
    assert '32 samples of 2 parameters, 64 points, 64 run now' in said
    assert 'correlated: most of all friction.static.time_constant with friction.static.limit, +0.9' in said
    assert 'none of correlated ones, which vary together' in said
    figures = json.loads((out / 'uncertainty.json').read_text())
    assert figures['indices']['period'] is None
    assert figures['percentiles']['period'] is not None
    assert answered(capsys, *common, '--resume')[0] == 0
    file.write_text(KNOWN)
    assert 'its points is another' in refused(capsys, *common, '--resume')


def test_elements_of_a_table_name_their_speed_and_times_are_read_in_one_unit(tmp_path: Path, capsys: Capture) -> None:
    file, picture = tmp_path / 'two.yaml', tmp_path / 'two.svg'
    file.write_text('parameters:\n' + ''.join(
        f'  friction.kinetic.coefficients[{k}]: {{distribution: uniform, low: {low}, high: {low + 0.01}}}\n'
        for k, low in ((0, 0.1), (1, 0.05))))
    assert run(['uncertainty', 'paper_fig7', '--with', str(file), '--samples', '16', '--out', str(tmp_path / 'out'),
                '--plot', str(picture)]) == 0
    said, text = capsys.readouterr().out, picture.read_text()
    for place in ('0 m/s', '35 mm/s'):
        assert said.count(f'(at {place})') >= 3   # the distribution, and each figure that has indices
        assert f'] at {place}' in text
    (period,) = (line for line in said.splitlines() if line.startswith('period '))
    assert period.count(' ms') == 5
    assert 'period / ms' in text


def test_a_picture_where_nothing_sticks_and_slips(tmp_path: Path, file: str) -> None:
    picture = tmp_path / 'none.svg'
    assert run(['uncertainty', 'paper_fig7', '--with', file, '--samples', '16', '--set', 'drive.velocity=0.0', '--out',
                str(tmp_path / 'out'), '--plot', str(picture)]) == 0
    assert '0 % of 32 points stick and slip' in picture.read_text()
    assert 'with its interactions' not in picture.read_text()


def test_resumed_it_gives_the_same_files(tmp_path: Path, file: str) -> None:
    common = ['uncertainty', 'paper_fig7', '--with', file, '--samples', '1024', '--duration', '4']   # three chunks
    whole, cut = tmp_path / 'whole', tmp_path / 'cut'
    assert run([*common, '--out', str(whole)]) == 0
    assert run([*common, '--out', str(cut)]) == 0
    lines = (cut / POINTS_TABLE).read_bytes().splitlines(keepends=True)
    (cut / POINTS_TABLE).unlink()
    (cut / 'uncertainty.json').unlink()
    (cut / PARTIAL).write_bytes(b''.join(lines[:2500]))   # as a kill would leave it
    assert run([*common, '--out', str(cut), '--resume']) == 0
    for name in (POINTS_TABLE, 'uncertainty.json'):
        assert (cut / name).read_bytes() == (whole / name).read_bytes()


@pytest.mark.parametrize(('arguments', 'words'), [
    (['--samples', '100'], ('--samples', '100', 'power of two')),
    (['--set', 'friction.static.limit=-1.0'], ('friction.static.limit',)),
    (['--set', 'friction.static.initial=0.2'], ('at friction.static.limit=0.18', 'friction.static.limit')),
    (['--workers', '0'], ('--workers', '0')),
    (['--plot', 'picture.jpg'], ('--plot', '.pdf or .svg')),
    (['--plot', '/dev/null/where.png'], ('--plot', '/dev/null')),
    (['--resume'], ('sweep',))])
def test_misuse_gets_one_line_and_writes_nothing(arguments: list[str], words: tuple[str, ...], tmp_path: Path,
                                                 file: str, capsys: Capture) -> None:
    out = tmp_path / 'out'
    refused(capsys, 'uncertainty', 'paper_fig7', '--with', file, '--out', out, *arguments, words=words)
    assert not out.exists()


def test_a_wrong_file_is_named(tmp_path: Path, capsys: Capture) -> None:
    path = tmp_path / 'friction.yaml'
    path.write_text(KNOWN.replace('mean', 'meen'))
    refused(capsys, 'uncertainty', 'paper_fig7', '--with', path, '--out', tmp_path / 'out',
            words=('friction.yaml: friction.static.limit.meen', 'did you mean mean?'))


def test_where_nothing_was_solved_that_is_what_it_prints(tmp_path: Path, file: str, capsys: Capture) -> None:
    command = ['uncertainty', 'paper_fig7', '--with', file, '--samples', '16', '--duration', '2', '--out',
               str(tmp_path / 'out')]
    assert run(command) == 0
    titles, *lines = (tmp_path / 'out' / POINTS_TABLE).read_text().splitlines()
    failed = [','.join([*line.split(',')[:2], 'failed', *[''] * 10]) for line in lines]
    (tmp_path / 'out' / POINTS_TABLE).write_text('\n'.join((titles, *failed, '')))
    capsys.readouterr()
    out = done(capsys, *command, '--resume')
    assert 'a share that is not known of those 0 of 32 independent points where it is known, 32 failed\n' in out
    assert '64 of 64 points failed: the exact engine gave up; see column motion\n' in out
    assert json.loads((tmp_path / 'out' / 'uncertainty.json').read_text())['stick_slip'] is None


# Folders of sweeps that someone else made: refused in one line, and not read to their end first.

SWEEP = ['sweep', 'paper_fig8', '--over', 'drive.velocity=1e-3:0.02:3', '--over', 'axis.drive_stiffness=1e5:1e6:2']


@pytest.fixture(scope='module')
def swept(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp('swept') / 'out'
    assert run([*SWEEP, '--out', str(folder)]) == 0
    return folder


@pytest.fixture
def folder(swept: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: Capture) -> Path:
    """Return a copy below the working directory: messages shorten long paths."""
    capsys.readouterr()
    monkeypatch.chdir(tmp_path)
    return Path(shutil.copytree(swept, 'other'))


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
    with_value('scene_text', 5), with_value('duration', '1'), with_value('points', 4), with_value('over', None),
    with_value('over', False), with_value('over', 5), with_value('over', [{}]), with_value('sobol', []),
    with_value('sobol', 5), with_value('uncertain', 5), with_value('sobol', {'points': 10**12, 'seed': 0}),
    with_value('sobol', {'points': 4}), with_first('name', ['a']), with_first('name', None), with_first('low', 'x'),
    with_first('low', 10**400), with_first('count', 'x'), with_first('count', '7'), with_first('count', 3.0),
    with_first('count', -3), with_first('log', 5),
])
def test_a_description_that_is_none(change: Callable[[Any], None], folder: Path,
                                    capsys: Capture) -> None:
    sidecar = json.loads((folder / SIDECAR).read_text())
    change(sidecar)
    (folder / SIDECAR).write_text(json.dumps(sidecar))
    assert re.search('it was changed|--sobol = 1000000000000 is refused|N >= 2', refused(capsys, *mapped(folder)))


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
                            capsys: Capture) -> None:
    make(folder / name)
    assert name in refused(capsys, *mapped(folder))


def test_a_line_without_end(folder: Path, capsys: Capture) -> None:
    """The description says that there are so many points that a file of any size may be their table."""
    sidecar = json.loads((folder / SIDECAR).read_text())
    sidecar['over'][0]['count'] *= 10**10
    sidecar['points'] *= 10**10
    (folder / SIDECAR).write_text(json.dumps(sidecar))
    (folder / POINTS_TABLE).write_bytes((folder / POINTS_TABLE).read_bytes().splitlines(keepends=True)[0])
    sparse(folder / POINTS_TABLE)
    assert POINTS_TABLE in refused(capsys, *mapped(folder))


@pytest.mark.parametrize('make', [endless, sparse])
def test_nobody_goes_on_with_what_has_no_end(make: Callable[[Path], None], folder: Path,
                                             capsys: Capture) -> None:
    (folder / POINTS_TABLE).rename(folder / PARTIAL)
    make(folder / PARTIAL)
    assert 'it was changed' in refused(capsys, *SWEEP, '--out', str(folder), '--resume')


def test_nothing_that_a_link_leads_to_is_changed(folder: Path, capsys: Capture) -> None:
    diary = folder.parent.absolute() / 'diary'
    diary.write_text('dear diary\n')
    (folder / POINTS_TABLE).unlink()
    (folder / PARTIAL).symlink_to(diary)
    assert 'it was changed' in refused(capsys, *SWEEP, '--out', str(folder), '--resume')
    assert diary.read_text() == 'dear diary\n'


def test_the_longest_scene_has_room_in_a_description(folder: Path) -> None:
    from stickslip_sim.scene.ros_yaml import SIZE_LIMIT

    assert LONGEST_SIDECAR > 4 * SIZE_LIMIT > (folder / SIDECAR).stat().st_size
