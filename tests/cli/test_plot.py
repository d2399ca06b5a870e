# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""`stickslip plot`: the picture of any run, in the format that its name says, or one line with what is wrong."""

import csv
import json
import re
from collections.abc import Iterator
from functools import partial
from pathlib import Path

import numpy as np
import pytest

from stickslip_sim import close_loop, plot_runs
from stickslip_sim.controllers.own_controller import Measurement
from stickslip_sim.core.errors import InputError
from stickslip_sim.core.types import EventKind, Mode
from stickslip_sim.inputs import load_scene
from stickslip_sim.plots.run import TimeWindow
from stickslip_sim.recording import read_run
from stickslip_sim.runs import Run, SimulatedRun, simulate, simulate_events
from stickslip_sim.runs.picture import sampled, windows_of
from tests.support.check_files import cut, verified
from tests.support.tool import Capture, answered, refused

BEGINNINGS = {'.png': b'\x89PNG', '.pdf': b'%PDF', '.svg': b'<?xml'}


@pytest.fixture(scope='module')
def hour() -> SimulatedRun:
    return simulate_events(load_scene('paper_fig8'), 3600.0)


@pytest.mark.parametrize('ending', BEGINNINGS)
def test_the_ending_decides_the_format(ending: str, tmp_path: Path, capsys: Capture) -> None:
    out = tmp_path / f'run{ending}'
    code, said, err = answered(capsys, 'plot', 'paper_fig7', '--duration', '2', '--out', out)
    assert (code, said, err) == (0, f'written: {out}\n', '')
    assert out.read_bytes().startswith(BEGINNINGS[ending])


def test_a_recorded_run_is_drawn_under_its_name(fig8_bag: Path, tmp_path: Path, capsys: Capture,
                                                monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    assert answered(capsys, 'plot', fig8_bag, '--window', '1:2.5') == (0, 'written: eight.png\n', '')
    assert [path.name for path in tmp_path.iterdir()] == ['eight.png']


def test_a_run_that_was_cut_off_says_so(fig8_bag: Path, tmp_path: Path, capsys: Capture) -> None:
    out = tmp_path / 'cut.svg'
    code, said, _ = answered(capsys, 'plot', cut(fig8_bag, tmp_path / 'cut', 0.5), '--out', out)
    assert (code, 'has no end' in said) == (0, True)
    assert '<!-- no end: cut off, or still being written -->' in out.read_text()    # in a line of its own: it has room


def test_an_hour_is_an_overview_and_its_last_cycles(hour: SimulatedRun, tmp_path: Path, capsys: Capture) -> None:
    whole, last = windows_of(hour, None)
    assert whole == (0.0, 3600.0)
    assert (last.begin, last.end) == pytest.approx((3600.0 - 5.5 * 0.659, 3600.0), abs=1.0)
    out = tmp_path / 'hour.svg'
    assert answered(capsys, 'plot', 'paper_fig8', '--duration', '3600', '--out', out)[0] == 0
    assert out.stat().st_size < 500_000    # drawn from events: one of each sample has a hundred times as much
    assert 'time / %' in out.read_text()


def test_a_long_run_takes_few_samples_and_shows_its_extremes(hour: SimulatedRun) -> None:
    windows = windows_of(hour, None)
    samples = sampled(hour.scene, hour.events, windows)
    assert len(samples['time']) < 60_000
    known = simulate(hour.scene, 60.0, 0.0005).samples
    for name in ('velocity', 'friction_force', 'drive_force'):
        span = np.ptp(known[name])
        assert samples[name].max() == pytest.approx(known[name].max(), abs=0.02 * span), name
        assert samples[name].min() == pytest.approx(known[name].min(), abs=0.02 * span), name


def test_a_short_run_is_one_window_and_a_long_rest_after_cycles_two() -> None:
    assert windows_of(simulate_events(load_scene('paper_fig8'), 10.0), None) == [(0.0, 10.0)]
    assert windows_of(simulate_events(load_scene('fast_feed'), 100.0), None) == [(0.0, 100.0)]
    assert len(windows_of(simulate_events(load_scene('positioning'), 60.0), None)) == 2


def test_a_window_as_long_as_the_run_is_the_run(hour: SimulatedRun) -> None:
    assert windows_of(hour, (0.0, 3600.0)) == [(0.0, 3600.0)]
    assert windows_of(hour, (5.0, 6.0)) == [(0.0, 3600.0), (5.0, 6.0)]


def test_a_run_that_was_commanded_late_is_shown_from_its_first_command_on(hour: SimulatedRun) -> None:
    run = simulate_events(load_scene('paper_fig8'), 20.0)
    assert windows_of(run, None, TimeWindow(8.0, 13.0)) == [(0.0, 20.0), (8.0, 13.0)]
    assert windows_of(run, None, TimeWindow(0.5, 20.0)) == [(0.0, 20.0)]
    _, part = windows_of(hour, None, TimeWindow(10.0, 1000.0))
    assert part.begin == 10.0
    assert part.end == pytest.approx(10.0 + 40 * 0.659, abs=0.1)    # as many cycles as can be read


class TestRefusals:
    def test_a_first_command_that_there_is_none_of(self, fig8_bag: Path, tmp_path: Path, capsys: Capture) -> None:
        line = refused(capsys, 'plot', fig8_bag, '--window', 'first_command:+1', '--out', tmp_path / 'a.png')
        assert 'must be A:B in a run without commands' in line

    def test_what_is_for_scenes_only(self, fig8_bag: Path, capsys: Capture) -> None:
        assert '--duration and --set apply to scenes' in refused(capsys, 'plot', fig8_bag, '--duration', '1')
        assert 'A scene needs --duration' in refused(capsys, 'plot', 'paper_fig8')


# Several runs, over each other or in columns.

NAMES = 'sweep_1.0', 'sweep_1.2'
SIDE_LIMITS = """limits:
  following_error: {max: 6.0e-4}
  at rest: {check: following_error, max: 1.0e-3, window: {begin: 0.9}}
  peak_speed: {max: 9.0}
"""
OWN = """
class Soft:
    def __init__(self, gain=2.0):
        self.gain = gain

    def __call__(self, t, measured):
        return self.gain * (measured.setpoint.position - measured.slider_position)

stiff = Soft(8.0)
"""


def proportional(gain: float, _: float, measured: Measurement) -> float:
    assert measured.setpoint is not None
    return gain * (measured.setpoint.position - measured.slider_position)


class Sides:
    """Two runs of one controller in a working directory: 0.5 mm in 0.2 to 0.6 s, 1 s in all."""

    def __init__(self, folder: Path) -> None:
        still = {'drive.course': 'constant', 'drive.velocity': 0.0}
        for name, gain in zip(NAMES, (30.0, 6.0)):
            run = close_loop(partial(proportional, gain), load_scene('positioning', still), 1.0,
                             setpoint=([0.0, 0.2, 0.6, 1.0], [0.0, 0.0, 5e-4, 5e-4]))
            run.save(folder / name)
        (folder / 'limits.yaml').write_text(SIDE_LIMITS)
        self.runs = {name: read_run(folder / name) for name in NAMES}

    def largest_error(self, name: str, begin: float, end: float) -> float:
        run = self.runs[name]
        time = run.samples['time']
        error = np.abs(run.setpoint['position'] - run.samples['position'])
        return float(error[(time >= begin) & (time <= end)].max())


@pytest.fixture(scope='module')
def sides(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Sides]:
    folder = tmp_path_factory.mktemp('sides')
    with pytest.MonkeyPatch.context() as patch:
        patch.chdir(folder)
        yield Sides(folder)


def words_in(path: Path) -> set[str]:
    return set(re.findall('<!-- (.*?) -->', path.read_text()))


def test_several_runs_over_each_other_by_their_whole_names(sides: Sides, tmp_path: Path, capsys: Capture) -> None:
    out = tmp_path / 'both.svg'
    assert answered(capsys, 'plot', *NAMES, '--limits', 'limits.yaml', '--out', out) == (0, f'written: {out}\n', '')
    words = words_in(out)
    assert {*NAMES, 'setpoint', 'limit following_error', 'setpoint less slider / µm'} <= words
    assert 'limit peak_speed, beyond the panel' in words
    assert 'limit at rest' not in words          # the move is shown, with a tenth of it on either side
    assert answered(capsys, 'plot', *NAMES, '--limits', 'limits.yaml', '--window', '0:1', '--out', out)[0] == 0
    assert 'limit at rest' in words_in(out)
    assert sides.runs[NAMES[0]].end == 1.0


def test_the_window_is_that_of_the_move(sides: Sides, tmp_path: Path) -> None:
    assert plot_runs(sides.runs, tmp_path / 'a.png') == pytest.approx((0.161, 0.64), abs=0.002)
    assert plot_runs(sides.runs, tmp_path / 'a.png', window=(0.1, 0.3), columns=True) == (0.1, 0.3)
    scenes: dict[str, Run] = {'a': simulate(load_scene('paper_fig8'), 2.0), **sides.runs}
    assert plot_runs(scenes, tmp_path / 'a.png') == (0.0, 2.0)    # one has no setpoint: the error is that to the drive
    with pytest.raises(InputError, match='1 to 8 at once'):
        plot_runs({str(k): sides.runs[NAMES[0]] for k in range(9)}, tmp_path / 'a.png')


def test_controllers_in_columns_with_their_figures(sides: Sides, tmp_path: Path, capsys: Capture) -> None:
    out = tmp_path / 'out'
    code, said, err = answered(capsys, 'compare', '--controllers', *NAMES, '--limits', 'limits.yaml', '--out', out)
    worst = {name: sides.largest_error(name, 0.0, 1.0) for name in NAMES}
    failing = [name for name in NAMES if worst[name] > 6e-4]
    assert code == (3 if failing else 0)
    assert failing == [NAMES[0]]
    assert err.startswith(f'stickslip: {NAMES[0]} does not keep limits.yaml: following_error')
    report = json.loads((out / 'report.json').read_text())
    begin, end = report['window']
    for name in NAMES:
        assert report['figures'][name]['following_error'] == pytest.approx(sides.largest_error(name, begin, end))
        assert name in said
    assert {*NAMES, 'stick', 'setpoint', 'limit following_error'} <= words_in(out / 'controllers.svg')
    assert 'data:image/svg+xml' in (out / 'report.html').read_text()


def test_controllers_of_a_file_beside_a_recorded_run(sides: Sides, tmp_path: Path, capsys: Capture) -> None:
    """Each drives the axis of the scene as close-loop has it, and is compared as its recorded run would be."""
    (tmp_path / 'own.py').write_text(OWN)
    (tmp_path / 'move.csv').write_text('time,position\n0,0\n1,0.002\n')
    own, out = [f'{tmp_path}/own.py:{name}' for name in ('Soft', 'stiff')], tmp_path / 'out'
    loop = ['--scene', 'positioning', '--duration', '1', '--rate', '500', '--setpoint', f'{tmp_path}/move.csv']
    changes = ['--set', 'encoder.resolution=1e-6']
    code, said, err = answered(capsys, 'compare', '--controllers', *own, NAMES[0], *loop, *changes, '--window', '0:1',
                               '--out', out)
    assert (code, err) == (0, '')
    figures = json.loads((out / 'report.json').read_text())['figures']
    assert [*figures] == [*own, NAMES[0]]
    assert all(name in said for name in figures)
    for place in own:
        folder = tmp_path / place.rpartition(':')[2]
        assert answered(capsys, 'close-loop', place, *loop, *changes, '--out', folder)[0] == 0
        run = read_run(folder)
        error = np.abs(run.setpoint['position'] - run.samples['position'])
        assert figures[place]['following_error'] == error.max()
    assert figures[own[0]]['following_error'] > 1.1 * figures[own[1]]['following_error']


@pytest.mark.usefixtures('sides')
@pytest.mark.parametrize(('arguments', 'said'), [
    (['compare', '--controllers', 'own.py:Soft', '--out', 'o'], 'A controller needs --scene SCENE and --duration'),
    (['compare', '--controllers', *NAMES, '--rate', '500', '--out', 'o'], '--rate needs --controllers FILE.py:NAME'),
    (['compare', 'own.py:Soft', '--out', 'o'], "RUN_OR_SCENE = 'own.py:Soft' is refused"),
    (['compare', '--controllers', 'own.py:Soft', '--scene', 'positioning', '--duration', '1', '--out', 'o'],
     'must be FILE.py:NAME, an existing file'),
    (['plot', *NAMES, NAMES[0]], 'Give each RUN_OR_SCENE only once'),
    (['plot', *NAMES, '--window', '0:3'], 'must be A:B with 0 <= A < B <= 1 s'),
    (['plot', *NAMES, '--limits', 'none.yaml'], "limits file = 'none.yaml' is refused"),
    (['compare', *NAMES, '--limits', 'limits.yaml', '--out', 'o'], '--limits and --window need --controllers'),
    (['compare', '--controllers', 'paper_fig8', '--out', 'o'], 'this is a scene: record it'),
    (['compare', '--controllers', *NAMES, NAMES[0], '--out', 'o'], 'only once'),
    (['compare', '--controllers', *NAMES, '--window', '0.5:7', '--out', 'o'], 'must be A:B with 0 <= A < B <= 1 s'),
])
def test_several_refused(arguments: list[str], said: str, capsys: Capture) -> None:
    assert said in refused(capsys, *arguments)
    assert not [path for path in Path().iterdir() if path.name not in (*NAMES, 'limits.yaml')]


# A run whose contact yields, through all that takes a run: tables, bag, pictures, verification, comparison.

LOAD = {'normal_load.course': 'sine', 'normal_load.amplitude': 1000.0, 'normal_load.frequency': 25.0}
SECONDS = 2.0


@pytest.mark.usefixtures('blank_pictures')
def test_its_tables_bag_and_pictures(tmp_path: Path, capsys: Capture) -> None:
    run = simulate(load_scene('paper_fig8', LOAD), SECONDS, 0.001)
    changes = [word for name, value in LOAD.items() for word in ('--set', f'{name}={value}')]
    files = [tmp_path / name for name in ('events.csv', 'samples.csv', 'bag', 'run.png')]
    options = [word for option, file in zip(('--events', '--samples', '--bag', '--plot'), files)
               for word in (option, file)]
    code, out, _ = answered(capsys, 'simulate', 'paper_fig8', '--duration', str(SECONDS), *changes, *options)
    yields = sum(event.kind == EventKind.YIELD for event in run.events)
    assert (code, yields > 5, f'{yields} yield' in out) == (0, True, True)
    words = [[row[name] for row in csv.DictReader(file.read_text().splitlines())]
             for file, name in zip(files, ('kind', 'mode'))]
    assert (words[0].count('yield'), 'YIELDING' in words[1]) == (yields, True)
    assert verified(capsys, tmp_path / 'bag')[0] == 0
    recorded = read_run(tmp_path / 'bag')
    assert [(event.time, event.kind, event.mode) for event in recorded.events] == [
        (event.time, event.kind, event.mode) for event in run.events]
    assert set(recorded.samples['mode']) == set(Mode)
    for command, *given in (('export', '--topic', 'mode_event', '--csv', '-'), ('plot', '--out', tmp_path / 'bag.svg'),
                            ('compare', '--out', tmp_path / 'cmp')):
        assert answered(capsys, command, tmp_path / 'bag', *given)[0] == 0, command
