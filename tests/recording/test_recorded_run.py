# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""One interface of a run: from a bag, short or too long to be held, it reads like the simulation that was recorded."""

import json
import sys
import warnings
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from stickslip_sim.bags import bag_files, mcap_records
from stickslip_sim.cli.main import run as tool
from stickslip_sim.compare import look
from stickslip_sim.compare.report import write_report
from stickslip_sim.core.arrays import Columns
from stickslip_sim.core.errors import InputError, RecordingError, RecordingWarning
from stickslip_sim.core.types import EventKind
from stickslip_sim.inputs import load_scene
from stickslip_sim.recording import RecordedRun, read_run, recorded_run, run_outline
from stickslip_sim.recording.run_outline import gap_marks, late_marks
from stickslip_sim.runs import COLUMNS, Run, samples, simulate, simulate_events
from stickslip_sim.runs.samples import joined
from stickslip_sim.simulation.step_result import Mark
from tests.support.check_files import cut
from tests.support.rewritten_bags import rewritten
from tests.support.small_recordings import files
from tests.support.tool import Capture


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


def test_nothing_is_read_before_it_is_asked_for_and_all_in_one_pass(fig8_bag: Path, monkeypatch: pytest.MonkeyPatch
                                                                   ) -> None:
    passes: list[Path] = []

    def counted(file: Path) -> Iterator[object]:
        passes.append(file)
        return mcap_records.contents(file)

    run = read_run(fig8_bag)
    monkeypatch.setattr(bag_files, 'contents', counted)
    assert not {'states', 'samples', 'events', 'scene', 'receipt', 'summary'} & set(vars(run))
    assert len(run.samples['time']) == len(run.states['time']) == 3001
    assert run.events
    assert run.missing_steps == 0
    assert len(passes) == 1
    assert run.cycles() is run.cycles()
    other = read_run(fig8_bag)
    assert len(other.states['time']) == 3001
    assert 'samples' not in vars(other)


@pytest.mark.parametrize('changes', [{'force.constant': 30.0}, {}])
def test_the_external_force_is_that_of_the_balance(changes: dict[str, object], tmp_path: Path) -> None:
    settings = [f'{name}={value}' for name, value in changes.items()]
    assert tool(['simulate', 'paper_fig7', '--duration', '1', '--bag', str(tmp_path / 'bag'),
                 *(word for setting in settings for word in ('--set', setting))]) == 0
    force = read_run(tmp_path / 'bag').samples['external_force']
    assert force.tolist() == pytest.approx([changes.get('force.constant', 0.0)] * 1001, rel=1e-9, abs=0.0)


def test_a_run_that_was_cut_off_warns_and_is_read_as_far_as_it_goes(fig8_bag: Path, tmp_path: Path) -> None:
    with pytest.warns(RecordingWarning, match='has no end'):
        run = read_run(cut(fig8_bag, tmp_path / 'cut', 0.5))
    assert not run.is_complete
    assert 'has no end' in run.notes[0]
    assert 0.0 == run.begin < run.end < 3.0
    assert run.end == run.samples['time'][-1]


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
        runs: dict[str, Run] = {'a.png': read_run(fig8_bag), 'b.svg': simulate(load_scene('paper_fig8'), 3.0),
                                'c.pdf': simulate_events(load_scene('paper_fig7'), 1.0)}    # without samples
        for name, run in runs.items():
            run.plot(tmp_path / name)
            assert (tmp_path / name).stat().st_size > 10_000
        assert (tmp_path / 'c.pdf').read_bytes().startswith(b'%PDF')

    def test_refused_pictures(self, tmp_path: Path) -> None:
        run = simulate_events(load_scene('paper_fig7'), 0.1)
        with pytest.raises(InputError, match=r'ending in \.png, \.pdf or \.svg'):
            run.plot(tmp_path / 'run.jpg')
        with pytest.raises(InputError, match=r'0 <= A < B <= 0\.1 s'):
            run.plot(tmp_path / 'run.png', window=(0.05, 0.2))
        assert not list(tmp_path.iterdir())

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


# Runs that are too long to be held: nobody holds all samples.
@pytest.fixture
def _short_memory(monkeypatch: pytest.MonkeyPatch) -> None:
    """Let no run be held."""
    monkeypatch.setattr(recorded_run, 'MOST_HELD', 10)
    monkeypatch.setattr(look, 'MOST_HELD', 2500)
    monkeypatch.setattr(samples, 'MOST_HELD', 2500)
    monkeypatch.setattr(mcap_records, 'GATHERED_BYTES', 1 << 14)
    monkeypatch.setattr(run_outline, 'GATHERED', 200)


def read(path: Path) -> RecordedRun:
    with warnings.catch_warnings():
        warnings.simplefilter('ignore', RecordingWarning)
        return read_run(path)


def facts(run: RecordedRun) -> tuple[object, ...]:
    return run.begin, run.end, run.missing_steps, run.summary, run.events, run.cycles()


def made(kind: str, bag: Path, folder: Path) -> Path:
    """Return a bag as it is, one that was cut off, or one that began later."""
    if kind == 'late':
        return rewritten(bag, folder, since=1.2345)
    return cut(bag, folder, 2 / 3) if kind == 'cut off' else bag


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
    reports = []
    with monkeypatch.context() as quick:    # all but what matplotlib makes of the lines
        quick.setattr('matplotlib.figure.Figure.savefig', lambda _, path, **__: path.touch())
        for name in ('short', 'long'):
            (tmp_path / name).mkdir()
            run = read(fig8_bag)
            write_report({'eight': run}, tmp_path / name)
            reports.append(json.loads((tmp_path / name / 'report.json').read_text()))
            assert ('samples' in vars(run)) == (name == 'short')
            request.getfixturevalue('_short_memory')
    assert reports[0] == reports[1]
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
    monkeypatch.setattr('stickslip_sim.check.remake.MOST_HELD', 100)
    out = tmp_path / 'out'
    assert tool(['verify', str(fig8_bag), '--set', 'axis.mass=300', '--out', str(out)]) == 0
    assert (out / 'what_if.png').stat().st_size > 10_000
    assert capsys.readouterr().out.endswith(f'written: {out}\n')


RATE, LIMIT = 1000.0, 0.01   # Hz, s


def blocks(times: NDArray[Any], size: int = 7) -> list[Columns]:
    return [{'time': np.empty(0)}, *({'time': times[k:k + size]} for k in range(0, len(times), size))]


def test_windows_with_a_step_later_than_the_limit() -> None:
    timing = {'step': np.array([1000, 2000, 2500]), 'steps': np.array([1000, 1000, 500]),
              'lateness_max': np.array([0.002, 0.16, np.nan]), 'overruns': np.array([3, 12, 0])}
    (mark,) = late_marks(timing, RATE, LIMIT)
    assert (mark.begin, mark.end, mark.number, mark.is_of_host) == (1.0, 2.0, 12, True)
    assert mark.label == 'late ≤ 160 ms'
    assert late_marks(timing, RATE, 0.2) == []


@pytest.mark.parametrize('usual', [0.001, 0.01])
def test_commands_that_stay_away(usual: float) -> None:
    """For 65 ms and 240 ms, where they come every 1 or 10 ms; some that come a little late are none."""
    times = np.arange(300) * usual + 2.0
    times[100:] += 0.065 - usual
    times[200:] += 0.24 - usual
    times[50:] += 0.5 * usual
    found = gap_marks(blocks(times), RATE, LIMIT)
    assert [mark.end - mark.begin for mark in found] == pytest.approx([0.065, 0.24])
    assert found[0].end == pytest.approx(times[100])
    assert {mark.label for mark in found} == {'gaps ≤ 240 ms'}


def test_commands_without_a_usual_interval_have_no_gaps() -> None:
    assert gap_marks(blocks(np.array([1.0, 2.0, 9.0, 9.5])), RATE, LIMIT) == []
    assert gap_marks(blocks(np.arange(200) * 1.0), RATE, LIMIT) == []   # every second, as it is meant
    assert gap_marks(blocks(np.empty(0)), RATE, LIMIT) == []
