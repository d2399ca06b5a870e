# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The tool `stickslip` as a user meets it: what a run says and writes."""

import csv
import io
import json
import shutil
import subprocess
import sys
from fractions import Fraction
from importlib import import_module
from pathlib import Path

import click
import pytest

from stickslip_sim import __version__, cli
from stickslip_sim.cli.main import run, stickslip
from stickslip_sim.core.types import EventKind, Mode
from stickslip_sim.inputs import load_scene
from stickslip_sim.runs import simulate, simulate_events
from stickslip_sim.runs.error_estimate import error_estimate
from stickslip_sim.scene import scene_names
from tests.support.repository import ROOT
from tests.support.tool import Capture, answered, done

EVENT_HEADER = 'time,kind,direction,position,velocity,drive_force,friction_force,static_coefficient,rest_time'
SAMPLE_HEADER = 'time,position,velocity,acceleration,drive_position,drive_force,friction_force,mode'


def test_version_and_help(capsys: Capture) -> None:
    assert answered(capsys, '--version') == (0, f'stickslip {__version__}\n', '')
    _, _, verbs = answered(capsys, '--help')[1].partition('\nRun:\n')
    assert 'simulate' in verbs
    assert '...' not in verbs    # each line is whole
    assert '--sample-period' in answered(capsys, 'simulate', '--help')[1]


def test_every_verb_stands_in_one_section_of_the_help(capsys: Capture) -> None:
    """A new verb is a file in cli/; without a section nobody would find it."""
    rooms = [import_module(f'{cli.__name__}.{file.stem}') for file in Path(cli.__path__[0]).glob('*.py')]
    commands = {value for room in rooms for value in vars(room).values() if isinstance(value, click.Command)}
    groups = {command for command in commands if isinstance(command, click.Group)} - {stickslip}
    inner = {each for group in groups for each in group.commands.values()}
    written = {str(verb.name) for verb in commands - inner - {stickslip}}
    listed = [str(verb.name) for verbs in stickslip.sections.values() for verb in verbs]
    assert sorted(listed) == sorted(written)
    assert {section: [line.split()[0] for line in lines]
            for section, lines in sections(answered(capsys, '--help')[1])} == {
        section: [verb.name for verb in verbs] for section, verbs in stickslip.sections.items()}


def sections(text: str) -> list[tuple[str, list[str]]]:
    """Return the titles of a help with the lines below each."""
    parts = [part.splitlines() for part in text.split('\n\n')]
    return [(lines[0][:-1], lines[1:]) for lines in parts if lines[0].endswith(':') and lines[0] != 'Options:']


def test_the_installed_tool_has_a_bare_name(tmp_path: Path, capsys: Capture) -> None:
    program = shutil.which('stickslip')
    assert program, 'the workspace is not sourced'
    done = subprocess.run(['stickslip', 'scenes'], capture_output=True, text=True, timeout=60, check=True, cwd=tmp_path)
    assert done.stdout == answered(capsys, 'scenes')[1]


def test_scenes_are_listed_with_a_line_each(capsys: Capture) -> None:
    assert run(['scenes']) == 0
    lines = capsys.readouterr().out.splitlines()
    assert [line.split()[0] for line in lines] == scene_names()
    assert all(len(line.split()) > 2 for line in lines)


def test_summary_for_people(capsys: Capture) -> None:
    out = done(capsys, 'simulate', 'paper_fig8', '--duration', '60')
    for words in ('paper_fig8', '90 breakaway', 'stick-slip', 'settled', '659.07 ms', '1.3181 mm', '11.664 mm/s'):
        assert words in out


def test_events_to_standard_output_are_exact(capsys: Capture) -> None:
    out = done(capsys, 'simulate', 'paper_fig8', '--duration', '3', '--events', '-')
    assert out.splitlines()[0] == EVENT_HEADER
    rows = list(csv.DictReader(io.StringIO(out)))
    events = [e for e in simulate_events(load_scene('paper_fig8'), 3.0).events if e.kind != EventKind.KNOT]
    assert len(rows) == len(events) > 10
    for row, event in zip(rows, events):
        assert row['kind'] == event.kind.name.lower()
        assert int(row['direction']) == event.direction
        for name in ('time', *EVENT_HEADER.split(',')[3:]):
            assert float(row[name]) == getattr(event, name)
    assert rows[0]['rest_time'] == 'inf'


def test_crossings_of_breakpoints_are_listed_on_request(capsys: Capture) -> None:
    arguments = ['simulate', 'paper_fig4_falling', '--duration', '3', '--events', '-']
    assert run(arguments) == 0
    assert 'knot' not in capsys.readouterr().out
    assert run([*arguments, '--knots']) == 0
    assert ',' in capsys.readouterr().out.partition('knot')[2]


def test_samples(tmp_path: Path) -> None:
    path = tmp_path / 's.csv'
    assert run(['simulate', 'paper_fig7', '--duration', '2', '--samples', str(path), '--sample-period', '0.01']) == 0
    assert path.read_text().splitlines()[0] == SAMPLE_HEADER
    rows = list(csv.DictReader(path.read_text().splitlines()))
    expected = simulate(load_scene('paper_fig7'), 2.0, 0.01).samples
    assert len(rows) == 201
    for k, row in enumerate(rows):
        assert float(row['time']) == k / 100
        assert Mode[row['mode']] == expected['mode'][k]
        for name in SAMPLE_HEADER.split(',')[1:-1]:
            assert float(row[name]) == expected[name][k]


def test_samples_are_every_step_of_the_scene_by_default(tmp_path: Path) -> None:
    assert run(['simulate', 'paper_fig7', '--duration', '0.1', '--samples', str(tmp_path / 's.csv'),
                '--set', 'time.rate=500']) == 0
    assert len((tmp_path / 's.csv').read_text().splitlines()) == 1 + 51


def test_receipt_and_settings(tmp_path: Path) -> None:
    for number, mass in enumerate(('350.0', '700.0')):
        assert run(['simulate', 'paper_fig7', '--duration', '5', '--set', f'axis.mass={mass}', '--set',
                    'drive.velocity=0.003', '--receipt', str(tmp_path / f'{number}.json')]) == 0
    first, second = (json.loads((tmp_path / f'{number}.json').read_text()) for number in range(2))
    assert first['duration'] == 5.0
    assert first['scene_hash'] != second['scene_hash']
    assert first['results']['last']['peak_speed'] != second['results']['last']['peak_speed']
    assert first['energy']['relative_residual'] <= 1e-14
    assert 0.0 < first['error_estimate']['event_time_s'] <= 1e-12
    assert first['error_estimate']['until_s'] == 5.0


def test_the_receipt_in_the_documentation_is_that_of_its_command(tmp_path: Path) -> None:
    text = (ROOT / 'docs' / 'receipt.md').read_text()
    assert run(['simulate', 'paper_fig8', '--duration', '10', '--receipt', str(tmp_path / 'r.json')]) == 0
    receipt = json.loads((tmp_path / 'r.json').read_text())
    shown = json.loads('{' + text.split('```json')[1].split('```')[0] + '}')
    assert shown['error_estimate']['how'] == receipt['error_estimate']['how']
    assert shown['energy'].keys() == receipt['energy'].keys()
    for name, value in shown['energy'].items():
        assert value == pytest.approx(receipt['energy'][name], rel=1e-9, abs=1e-12), name


def test_existing_files_are_replaced(tmp_path: Path) -> None:
    path = tmp_path / 'e.csv'
    path.write_text('old')
    assert run(['simulate', 'paper_fig7', '--duration', '1', '--events', str(path)]) == 0
    assert path.read_text().startswith(EVENT_HEADER)
    assert list(tmp_path.iterdir()) == [path]


def test_the_summary_gives_way_to_what_is_written_to_standard_output(tmp_path: Path, capsys: Capture) -> None:
    simulate = ['simulate', 'paper_fig7', '--duration', '1']
    out = done(capsys, *simulate, '--events', tmp_path / 'e.csv', '--plot', tmp_path / 'p.png')
    assert out.startswith('paper_fig7: 1 s')
    assert 'events' in out
    assert run([*simulate, '--events', '-', '--plot', str(tmp_path / 'p.png')]) == 0
    out, err = capsys.readouterr()
    assert out.startswith(EVENT_HEADER)
    assert ('exact solver' in out, err) == (False, '')


def test_what_was_written_is_said_last(tmp_path: Path, capsys: Capture) -> None:
    """On standard output, where no result is."""
    files = [str(tmp_path / name) for name in ('events.csv', 'samples.csv', 'bag', 'receipt.json', 'run.png')]
    options = [word for name, path in zip(('events', 'samples', 'bag', 'receipt', 'plot'), files)
               for word in (f'--{name}', path)]
    assert run(['simulate', 'paper_fig7', '--duration', '0.2', *options]) == 0
    assert capsys.readouterr().out.splitlines()[-1] == f'written: {", ".join(files)}'
    table = str(tmp_path / 'states.csv')
    assert run(['export', files[2], '--csv', table]) == 0
    assert capsys.readouterr() == (f'written: {table}\n', '')
    assert run(['export', files[2], '--csv', '-']) == 0
    assert 'written' not in capsys.readouterr().out


def test_special_files_are_written_to_and_stay(capsys: Capture) -> None:
    assert run(['simulate', 'paper_fig7', '--duration', '1', '--events', '/dev/null', '--receipt', '/dev/null']) == 0
    assert Path('/dev/null').is_char_device()


@pytest.mark.ros
def test_bag(tmp_path: Path) -> None:
    from stickslip_sim.recording import open_bag

    assert run(['simulate', 'paper_fig8', '--duration', '2', '--bag', str(tmp_path / 'bag'), '--samples',
                str(tmp_path / 's.csv'), '--sample-period', '0.5']) == 0
    assert len((tmp_path / 's.csv').read_text().splitlines()) == 1 + 5
    recorded = open_bag(tmp_path / 'bag')
    assert recorded.is_complete
    assert recorded.counts['/slider_state'] == 2001
    assert recorded.counts['/mode_event'] == len(simulate_events(load_scene('paper_fig8'), 2.0).events)
    assert recorded.receipt['scene'] == 'paper_fig8'
    assert recorded.receipt['sample_period'] == 0.001
    assert recorded.receipt['energy']['drive_work'] > 0.0
    assert recorded.receipt['error_estimate']['until_s'] == 2.0
    assert 'paper_fig8' in recorded.attachments['scene.yaml'].decode()


@pytest.mark.ros
def test_the_estimate_in_a_bag_is_of_the_run_in_the_bag(tmp_path: Path) -> None:
    """Samples are others in the bag than those asked for, and events the same."""
    from stickslip_sim.recording import open_bag

    adaptive = {'solver.name': 'adaptive', 'solver.rtol': 1e-4, 'time.rate': 300.0}
    changes = [word for name, value in adaptive.items() for word in ('--set', f'{name}={value}')]
    assert run(['simulate', 'paper_fig7', '--duration', '1', *changes, '--bag', str(tmp_path / 'bag'), '--samples',
                str(tmp_path / 's.csv'), '--sample-period', '0.5']) == 0
    in_bag = simulate(load_scene('paper_fig7', adaptive), 1.0, Fraction(1, 300))
    assert open_bag(tmp_path / 'bag').receipt['error_estimate'] == error_estimate(in_bag)._asdict()


def test_nothing_is_loaded_unless_asked_for() -> None:
    """No numbers for the help, no ROS and no plots for a run."""
    program = ('import sys; from stickslip_sim.cli.main import run; assert run(["--help"]) == 0; '
               'assert not {"numba", "numpy", "yaml"} & set(sys.modules); '
               'assert run(["simulate", "paper_fig8", "--duration", "1"]) == 0; '
               'found = {"rclpy", "stickslip_msgs", "matplotlib", "mcap", "rosbags"} & set(sys.modules); '
               'assert not found, found')
    subprocess.run([sys.executable, '-c', program], check=True, timeout=60, stdout=subprocess.DEVNULL)
