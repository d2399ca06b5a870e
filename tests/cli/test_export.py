# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Runs as tables: `stickslip export`, and reading in Python."""

import csv
import importlib.util
import io
import json
import re
from pathlib import Path

import numpy as np
import pytest

from stickslip_sim.cli import csv_tables
from stickslip_sim.cli.main import run
from stickslip_sim.core.errors import RecordingError
from stickslip_sim.core.types import EventKind
from stickslip_sim.inputs import load_scene
from stickslip_sim.recording import open_bag
from stickslip_sim.runs import simulate_events
from tests.support.repository import ROOT
from tests.support.rewritten_bags import rewritten
from tests.support.tool import Capture, refused


class TestCsv:
    def test_the_same_floats_come_back(self, fig8_bag: Path, tmp_path: Path) -> None:
        file = tmp_path / 'new' / 'states.csv'    # its folder is made
        assert run(['export', str(fig8_bag), '--csv', str(file)]) == 0
        columns = open_bag(fig8_bag).columns('slider_state')
        with file.open(newline='') as lines:
            rows = list(csv.DictReader(lines))
        assert len(rows) == 3001
        for name, column in columns.items():
            assert [column.dtype.type(row[name]) for row in rows] == column.tolist(), name

    def test_texts_are_quoted(self, fig8_bag: Path, tmp_path: Path, capsys: Capture) -> None:
        capsys.readouterr()
        assert run(['export', str(fig8_bag), '--csv', '-', '--topic', '/run_info']) == 0
        (row,) = csv.DictReader(capsys.readouterr().out.splitlines())
        assert (row['scene'], row['bag_path'], row['rate']) == ('paper_fig8', str(fig8_bag), '1000')

    def test_a_topic_without_messages(self, fig8_bag: Path, capsys: Capture) -> None:
        capsys.readouterr()
        assert run(['export', str(fig8_bag), '--csv', '-', '--topic', 'timing']) == 0
        assert capsys.readouterr().out.count('\n') == 1

    def test_a_run_that_was_cut_off(self, fig8_bag: Path, tmp_path: Path, capsys: Capture) -> None:
        data = next(fig8_bag.glob('*.mcap')).read_bytes()
        (tmp_path / 'cut.mcap').write_bytes(data[:len(data) // 2])
        capsys.readouterr()
        assert run(['export', str(tmp_path / 'cut.mcap'), '--csv', '-']) == 0
        out, err = capsys.readouterr()
        assert 500 < out.count('\n') < 3000
        assert err.startswith('note: ')
        assert 'has no end' in err

    def test_refused(self, fig8_bag: Path, tmp_path: Path, capsys: Capture) -> None:
        assert 'Give --csv FILE.csv or --parquet' in refused(capsys, 'export', fig8_bag)
        found = refused(capsys, 'export', fig8_bag, '--csv', '-', '--topic', 'state')
        assert 'no topic state; there are /slider_state, ' in found
        assert 'no recorded run there' in refused(capsys, 'export', tmp_path, '--csv', '-')
        assert 'in a folder; ' in refused(capsys, 'export', fig8_bag, '--csv', Path(__file__) / 'x.csv')
        place = tmp_path / 'x'
        assert 'a different file' in refused(capsys, 'export', fig8_bag, '--csv', place, '--parquet', place)
        assert list(tmp_path.iterdir()) == []


class TestParquet:
    def test_the_same_table_comes_back(self, fig8_bag: Path, tmp_path: Path) -> None:
        pandas = pytest.importorskip('pandas')
        pytest.importorskip('fastparquet')
        for topic in ('slider_state', 'mode_event', 'run_info', 'rig_event'):
            file = tmp_path / f'{topic}.parquet'
            assert run(['export', str(fig8_bag), '--parquet', str(file), '--topic', topic]) == 0
            found, columns = pandas.read_parquet(file), open_bag(fig8_bag).columns(topic)
            assert list(found) == list(columns)
            for name, column in columns.items():
                assert found[name].tolist() == column.tolist(), name

    def test_what_it_takes(self, fig8_bag: Path, tmp_path: Path, capsys: Capture) -> None:
        if importlib.util.find_spec('pandas'):
            pytest.skip('pandas is installed')
        reported = refused(capsys, 'export', fig8_bag, '--parquet', tmp_path / 'x.parquet')
        assert 'pip install pandas fastparquet' in reported
        assert list(tmp_path.iterdir()) == []
        with pytest.raises(RecordingError, match='pip install pandas'):
            open_bag(fig8_bag).frame('slider_state')


class TestInPython:
    def test_names_without_a_slash(self, fig8_bag: Path, tmp_path: Path) -> None:
        recorded = open_bag(fig8_bag)
        assert (recorded.columns('slider_state')['time'] == recorded.columns('/slider_state')['time']).all()
        cell = open_bag(rewritten(fig8_bag, tmp_path / 'cell', lambda name: f'/cell/press{name}'))
        assert len(cell.columns('slider_state')['time']) == len(cell.columns('press/slider_state')['time']) == 3001
        two = open_bag(rewritten(fig8_bag, tmp_path / 'two', lambda name: (
            '/b/slider_state' if name == '/friction_force' else f'/a{name}')))
        with pytest.raises(RecordingError, match='2 topics slider_state; there are '):
            two.columns('slider_state')
        with pytest.raises(RecordingError, match='no topic state; there are '):
            two.columns('state')

    def test_scene_and_events(self, fig8_bag: Path) -> None:
        recorded, scene = open_bag(fig8_bag), load_scene('paper_fig8')
        assert recorded.scene == scene
        expected = [event for event in simulate_events(scene, 3.0).events if event.kind != EventKind.KNOT]
        assert [(event.kind, event.time, event.position) for event in recorded.events] == [
            (event.kind, event.time, event.position) for event in expected]

    def test_no_scene(self, fig8_bag: Path, tmp_path: Path) -> None:
        bare = open_bag(rewritten(fig8_bag, tmp_path / 'bare', attachment=lambda name: None))
        with pytest.raises(RecordingError, match=r'it has no scene\.yaml'):
            _ = bare.scene

    def test_frame(self, fig8_bag: Path) -> None:
        pytest.importorskip('pandas')
        frame = open_bag(fig8_bag).frame('slider_state')
        assert frame['velocity'].max() == np.max(open_bag(fig8_bag).columns('slider_state')['velocity'])
        assert json.loads(frame.dtypes.astype(str).to_json())['mode'] == 'uint8'


def test_the_examples_of_the_documentation(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: Capture) -> None:
    """Every command and every line of Python of docs/runs.md, in their order; what is shown is what is printed."""
    text = (ROOT / 'docs' / 'runs.md').read_text()
    monkeypatch.chdir(tmp_path)
    blocks = re.findall(r'^```(\w*)\n(.*?)^```$', text, re.MULTILINE | re.DOTALL)
    names: dict[str, object] = {}
    for kind, block in blocks:
        if kind == 'sh':
            capsys.readouterr()
            assert [run(line.split()[1:]) for line in block.splitlines()] == [0] * len(block.splitlines())
        elif kind == 'python':
            exec(block, names)
        else:
            assert capsys.readouterr().out == block
    assert len(blocks) == 9
    assert 'states' in names
    assert Path('runs', 'arrays').is_dir()


# Numbers as lines of CSV: the digits of Python.

RANDOM = np.random.default_rng(8)
FLOATS = np.concatenate([
    RANDOM.integers(0, 2 ** 64, 20_000, dtype=np.uint64).view(np.float64), RANDOM.random(5_000),
    np.arange(5_000) / 1000,
    [0.0, -0.0, np.inf, -np.inf, np.nan, -np.nan, 5e-324, 1e16, 1e17, 0.1 + 0.2, 1234567890123456.75, 2.0 ** -1074]])


@pytest.mark.parametrize('is_compiled', [True, False], ids=['compiled', 'python'])
def test_floats_have_the_17_digits_of_python(monkeypatch: pytest.MonkeyPatch, is_compiled: bool) -> None:
    """Of all sizes, in all notations; a NaN has no sign."""
    if not is_compiled:
        monkeypatch.setattr(csv_tables, 'COMPILED', None)
    elif csv_tables.COMPILED is None:
        pytest.skip('the writer of numbers is not compiled here')
    assert csv_tables.rows_text([FLOATS]).splitlines() == [f'{value:.17g}' for value in FLOATS.tolist()]


@pytest.mark.parametrize('is_compiled', [True, False], ids=['compiled', 'python'])
def test_all_kinds_of_numbers_are_written_as_python_does(monkeypatch: pytest.MonkeyPatch, is_compiled: bool) -> None:
    """Integers, truth values, small floats and words, also from every second row."""
    if not is_compiled:
        monkeypatch.setattr(csv_tables, 'COMPILED', None)
    columns = [np.array([-2 ** 63, 2 ** 63 - 1, 0, 7]), np.array([True, False, True, True]),
               np.array([1, 2, 3, 2 ** 63 - 1], np.uint64), np.array([0.1, 2.5, -1.0, 0.0], np.float32),
               np.arange(8.0)[::2], np.array([1.0, 0.0, 0.0, 1.0])]
    assert csv_tables.are_numbers(columns)
    expected = io.StringIO()
    written = [column.tolist() for column in columns[:3]] + [[f'{value:.17g}' for value in column.tolist()]
                                                          for column in columns[3:5]] + [['b', 'a', 'a', 'b']]
    csv.writer(expected, lineterminator='\n').writerows(zip(*written, strict=True))
    assert csv_tables.rows_text(columns, [None] * 5 + [['a', 'b']]) == expected.getvalue()


def test_texts_and_integers_beyond_64_bits_are_for_others() -> None:
    """They go through the csv module."""
    assert not csv_tables.are_numbers([np.array(['a'], object)])
    assert not csv_tables.are_numbers([np.array([2 ** 63], np.uint64)])
