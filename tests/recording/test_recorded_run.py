# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""One interface of a run: from a bag it reads like the simulation that was recorded."""

import shutil
import sys
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest

from stickslip_sim.cli.main import run as tool
from stickslip_sim.core.errors import InputError, RecordingWarning
from stickslip_sim.core.types import EventKind
from stickslip_sim.inputs import load_scene
from stickslip_sim.recording import mcap_records, read_run, topic_columns
from stickslip_sim.rig.marks import Mark
from stickslip_sim.runs import COLUMNS, Run, simulate, simulate_events
from tests.support.small_recordings import files


def test_a_recorded_run_reads_like_the_simulation(fig8_bag: Path) -> None:
    recorded, simulated = read_run(fig8_bag), simulate(load_scene('paper_fig8'), 3.0)
    assert (recorded.begin, recorded.end, recorded.duration) == (0.0, 3.0, 3.0)
    assert recorded.scene == simulated.scene
    assert recorded.name == 'eight'
    assert recorded.source == f'recorded in {fig8_bag}'
    assert (recorded.is_recorded, recorded.is_complete, recorded.notes, recorded.missing_steps) == (True, True, (), 0)
    assert set(COLUMNS) == set(recorded.samples)
    assert set(COLUMNS) < set(simulated.samples)
    np.testing.assert_allclose(recorded.samples['time'], simulated.samples['time'], rtol=1e-15, atol=0)
    for name in COLUMNS[1:]:
        assert np.array_equal(recorded.samples[name], simulated.samples[name]), name
    kept = [event for event in simulated.events if event.kind != EventKind.KNOT]
    assert [(event.kind, event.time, event.velocity) for event in recorded.events] == [
        (event.kind, event.time, event.velocity) for event in kept]
    for event, other in zip(recorded.events, kept):
        assert event.drive_position == pytest.approx(other.drive_position, rel=0, abs=1e-15)
    for cycle, again in zip(recorded.cycles(), simulated.cycles(), strict=True):
        assert tuple(cycle) == pytest.approx(tuple(again), rel=1e-12)
    assert recorded.summary.motion == simulated.summary.motion
    assert recorded.receipt['results'] == simulated.receipt['results']


def test_samples_and_events_take_one_pass_over_the_bag(fig8_bag: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    passes: list[Path] = []

    def counted(file: Path) -> Iterator[object]:
        passes.append(file)
        return mcap_records.contents(file)

    run = read_run(fig8_bag)
    monkeypatch.setattr(topic_columns, 'contents', counted)
    assert len(run.samples['time']) == len(run.states['time'])
    assert run.events
    assert run.missing_steps == 0
    assert len(passes) == 1


@pytest.mark.parametrize('changes', [{'force.constant': 30.0}, {}])
def test_the_external_force_is_that_of_the_balance(changes: dict[str, object], tmp_path: Path) -> None:
    settings = [f'{name}={value}' for name, value in changes.items()]
    assert tool(['simulate', 'paper_fig7', '--duration', '1', '--bag', str(tmp_path / 'bag'),
                 *(word for setting in settings for word in ('--set', setting))]) == 0
    force = read_run(tmp_path / 'bag').samples['external_force']
    assert force.tolist() == pytest.approx([changes.get('force.constant', 0.0)] * 1001, rel=1e-9, abs=0.0)


def test_a_run_that_was_cut_off_warns_and_is_read_as_far_as_it_goes(fig8_bag: Path, tmp_path: Path) -> None:
    shutil.copytree(fig8_bag, tmp_path / 'cut')
    (file,) = (tmp_path / 'cut').glob('*.mcap')
    data = file.read_bytes()
    file.write_bytes(data[:len(data) // 2])
    with pytest.warns(RecordingWarning, match='has no end'):
        run = read_run(tmp_path / 'cut')
    assert not run.is_complete
    assert 'has no end' in run.notes[0]
    assert 0.0 == run.begin < run.end < 3.0
    assert run.end == run.samples['time'][-1]


def test_nothing_is_read_before_it_is_asked_for(fig8_bag: Path) -> None:
    run = read_run(fig8_bag)
    assert not {'states', 'samples', 'events', 'scene', 'receipt', 'summary'} & set(vars(run))
    assert len(run.states['time']) == 3001
    assert 'samples' not in vars(run)


class TestViews:
    def test_frames_are_alike(self, fig8_bag: Path) -> None:
        pytest.importorskip('pandas')
        runs: list[Run] = [read_run(fig8_bag), simulate(load_scene('paper_fig8'), 3.0)]
        for run in runs:
            frame = run.frame()
            assert list(frame) == list(COLUMNS)
            assert len(frame) == 3001
            assert {str(frame[name].dtype) for name in ('mode', 'direction')} == {'int8'}

    def test_a_frame_takes_pandas(self, monkeypatch: pytest.MonkeyPatch) -> None:
        monkeypatch.setitem(sys.modules, 'pandas', None)
        with pytest.raises(InputError, match='pip install pandas'):
            simulate(load_scene('paper_fig7'), 0.1).frame()

    def test_pictures(self, fig8_bag: Path, tmp_path: Path) -> None:
        runs: dict[str, Run] = {'a.png': read_run(fig8_bag), 'b.svg': simulate(load_scene('paper_fig8'), 3.0)}
        for name, run in runs.items():
            run.plot(tmp_path / name)
            assert (tmp_path / name).stat().st_size > 10_000

    def test_a_run_without_samples_can_be_drawn(self, tmp_path: Path) -> None:
        simulate_events(load_scene('paper_fig7'), 1.0).plot(tmp_path / 'run.pdf')
        assert (tmp_path / 'run.pdf').read_bytes().startswith(b'%PDF')

    def test_refused_pictures(self, tmp_path: Path) -> None:
        run = simulate_events(load_scene('paper_fig7'), 0.1)
        with pytest.raises(InputError, match=r'ending in \.png, \.pdf or \.svg'):
            run.plot(tmp_path / 'run.jpg')
        with pytest.raises(InputError, match=r'0 <= A < B <= 0\.1 s'):
            run.plot(tmp_path / 'run.png', window=(0.05, 0.2))
        assert not list(tmp_path.iterdir())

    def test_what_is_found_is_kept(self, fig8_bag: Path) -> None:
        run = read_run(fig8_bag)
        assert run.cycles() is run.cycles()
        assert run.cycles() is not read_run(fig8_bag).cycles()


def test_the_marks_and_commands_of_a_node_are_read_from_its_bag(tmp_path: Path) -> None:
    """12 steps of 20 ms, then a command and a fault 40 ms later, for 100 ms."""
    files(tmp_path)
    run = read_run(tmp_path / 'node')
    assert [(mark.label, mark.number) for mark in run.marks] == [('friction_scale', 1)]
    assert (run.marks[0].begin, run.marks[0].end) == pytest.approx((0.26, 0.36))
    assert (run.commands['time'].tolist(), run.commands['velocity'].tolist()) == ([pytest.approx(0.22)], [0.03])


def test_the_marks_of_a_recorded_simulation_are_the_faults_of_its_scene(tmp_path: Path) -> None:
    faults = {'ids': '[dry]', 'kinds': '[friction_scale]', 'starts': '[0.5]', 'durations': '[.inf]', 'values': '[2.0]'}
    settings = [word for name, value in faults.items() for word in ('--set', f'faults.{name}={value}')]
    assert tool(['simulate', 'paper_fig7', '--duration', '1', *settings, '--bag', str(tmp_path / 'run')]) == 0
    run = read_run(tmp_path / 'run')
    assert run.marks == [Mark(0.5, 1.0, 'friction_scale')]
    assert not len(run.commands['time'])   # the scene decides
