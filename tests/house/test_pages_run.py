# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The code and the commands of the pages that take seconds, run as they stand there, give what the pages say."""

import json
import re
import shlex
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import pytest

from benchmarks import worked_axis
from benchmarks.identification import COMMANDS, EXAMPLES, FAILS, TRUTH
from benchmarks.loops_page import PICTURES as LOOP_PICTURES
from benchmarks.loops_page import blocks, page_commands, write_inputs
from benchmarks.maps import CRITICAL, PICTURES, UNCERTAIN, picture_of, shortened
from benchmarks.page import excerpt, part_of, quoted
from stickslip_sim.closed_loop.report import tuning_report
from stickslip_sim.inputs import load_scene
from stickslip_sim.report.text import text_lines
from tests.support.repository import ROOT
from tests.support.tool import Capture, answered

pytestmark = pytest.mark.slow

README = (ROOT / 'README.md').read_text(encoding='utf-8')
MAPS, IDENTIFICATION, PYTHON, CLOSED_LOOP, WORKED = (
    (ROOT / 'docs' / f'{name}.md').read_text(encoding='utf-8')
    for name in ('maps', 'identification', 'python', 'closed_loop', 'worked_axis'))


@pytest.fixture(autouse=True)
def clone(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Return where the commands run: an empty folder with the examples."""
    (tmp_path / 'examples').symlink_to(ROOT / 'examples')
    monkeypatch.chdir(tmp_path)
    return tmp_path


def done(capsys: Capture, command: str) -> str:
    """Return what a command of the tool prints."""
    code, out, errors = answered(capsys, *shlex.split(command))
    assert code == 0, f'{command}\n{errors}'
    return out


def test_the_first_results_of_the_readme(clone: Path, capsys: Capture) -> None:
    """The commands of its ways in; those that need a node are in test_first_steps.py."""
    text = README.replace('\\\n', ' ')
    explore, *commands = re.findall(r'(?:^    |`)stickslip (?!call)([^`\n]+)', text, re.MULTILINE)
    assert [command.split()[0] for command in commands] == ['close-loop', 'friction', 'simulate', 'critical']
    said = [done(capsys, command) for command in (explore, *commands)]
    assert 'best: exponential' in said[2]
    assert 'stick-slip below' in said[4]
    assert (clone / 'runs/loop.png').read_bytes().startswith(b'\x89PNG')
    assert (clone / 'explore.html').stat().st_size > 100_000


def test_the_blocks_of_python(clone: Path, capsys: Capture) -> None:
    pytest.importorskip('pandas')
    names: dict[str, object] = {}
    printed = []
    for block in re.findall(r'^```python\n(.*?)^```$', PYTHON, re.MULTILINE | re.DOTALL):
        exec(block, names)
        printed.append(capsys.readouterr().out)
    assert len(printed) == 14
    assert printed[1].startswith('stick-slip\nBREAKAWAY 0.7625675504')
    assert 'axis.mass = -1.0 is refused' in printed[-1]
    assert {path.name for path in clone.iterdir()} == {'examples', 'run.png', 'runs'}
    for picture in ('run.png', 'runs/four.png'):
        assert (clone / picture).read_bytes().startswith(b'\x89PNG')


def test_the_closed_loop(clone: Path, monkeypatch: pytest.MonkeyPatch, capsys: Capture) -> None:
    """The class in a file, the run in Python, and the commands one after the other."""
    write_inputs(clone)
    monkeypatch.syspath_prepend(clone)
    _, loop, tuned, many, lanes = blocks('python')
    names: dict[str, Any] = {}
    for block in (loop, tuned, many):
        exec(block, names)
        assert capsys.readouterr().out in CLOSED_LOOP.replace('    ', '')
    report = text_lines(tuning_report(names['found']))    # what the command prints
    assert '\n'.join(f'    {line}'.rstrip() for line in report) in CLOSED_LOOP
    exec(lanes, names)
    assert names['loops'].pass_rate.passed == 64
    for picture in ('run.png', 'tune.png'):
        assert (clone / picture).read_bytes().startswith(b'\x89PNG')
    assert len(page_commands()) == 10
    for words in page_commands():
        if words[0] == 'tune':
            continue
        fewer = {'--samples': '8', '--workers': '1'}
        code, said, errors = answered(capsys, *[fewer.get(before, word) for before, word in zip(['', *words], words)])
        if '--samples' in words or '--controllers' in words:    # some of the axes, and one gain, do not keep the limits
            assert (code, '8 of 8 pass' in said) == (3, False)
        else:
            assert code == 0, f'{words}\n{errors}'
        if '--controllers' in words:
            assert quoted(said.rpartition('written')[0]) in CLOSED_LOOP
    for picture in ('shell.png', *LOOP_PICTURES):
        assert (clone / picture).read_bytes().startswith(b'\x89PNG')


class TestMaps:
    @staticmethod
    def faster(command: str) -> str:
        """Return a command of the page with few points, one picked motion, and a coarse critical value."""
        command = re.sub(r'--(samples|sobol) \d+', r'--\1 16', command)
        if '--sobol' not in command:
            command = re.sub(r'(--over \S+:)\d+(:log)?(?= |$)', r'\g<1>4\2', command)
        command = re.sub(r'(?:--pick \S+\s+)+(--pick)', r'\1', command)
        return f'{command} --accuracy 0.01' if command.startswith('critical') else command

    def test_the_commands_one_after_the_other(self, clone: Path, capsys: Capture) -> None:
        """What they write is below runs/, and nothing is overwritten."""
        found = re.findall(r'^    stickslip ((?:.*\\\n)*.*)$', MAPS, re.MULTILINE)
        commands = [command.replace('\\\n', ' ') for command in found if '...' not in command]
        assert len(commands) == 2 * len(PICTURES) + len(CRITICAL) + 2    # one of uncertainty, one with --sobol
        for command in commands:
            done(capsys, self.faster(command))
        drawn = {picture_of(command) for command in commands if '.png' in command}
        assert len(drawn) == len(PICTURES) + 1
        assert all(picture.is_file() for picture in drawn)
        assert {path.name for path in clone.iterdir()} == {'examples', 'runs'}

    def test_the_uncertainty(self, clone: Path, capsys: Capture) -> None:
        printed = quoted(shortened(done(capsys, UNCERTAIN)))
        assert (clone / 'runs/uncertainty.png').read_bytes().startswith(b'\x89PNG')
        assert part_of(MAPS, 'uncertainty').endswith(f'\n\n{printed}')


class TestIdentification:
    ROW = re.compile(r'^ *([a-z]\w*(?:\.\w+)+(?:\[\d\])?) +'                                 # name
                     r'([\d.e+-]+)(?: (?:N s|[^\d ]+))?(?:/m)? +([\d.e+-]+)', re.MULTILINE)   # start and found

    def found_in(self, text: str) -> Mapping[str, tuple[float, float]]:
        """Return start and found value of each parameter, in the unit that is printed."""
        return {row[1]: (float(row[2]), float(row[3])) for row in self.ROW.finditer(text)}

    @pytest.mark.usefixtures('blank_pictures')
    def test_the_commands_find_what_it_says(self, capsys: Capture) -> None:
        for name, commands in COMMANDS.items():
            said = [done(capsys, command.replace('--samples 64', '--samples 16'))
                    for command in commands if name != FAILS]    # that one takes a minute
            if name == 'synthetic':
                printed, here = self.found_in(part_of(IDENTIFICATION, name)), self.found_in(said[-1])
                assert set(printed) == set(here) == set(TRUTH)
                for parameter, numbers in here.items():
                    assert numbers == pytest.approx(printed[parameter], rel=2e-3), parameter

    def test_what_it_finds_is_the_truth(self) -> None:
        """In the unit that is printed: the ratio of what was found to the start."""
        start = load_scene(str(ROOT / EXAMPLES / 'start.yaml')).values
        for name, (begun, found) in self.found_in(part_of(IDENTIFICATION, 'synthetic')).items():
            before = start[name]
            assert isinstance(before, float)
            assert found / begun == pytest.approx(TRUTH[name] / before, rel=0.005), name


@pytest.mark.usefixtures('blank_pictures')
def test_the_worked_axis(clone: Path, capsys: Capture) -> None:
    """From the exports on: what is exact stands as it is printed; what is fitted is near it, and near the truth."""
    worked_axis.data()
    coarser = {'identify': ' --set friction.kinetic.tolerance=1e-3'}    # than the default of 1e-4: for half the time
    said = {name: done(capsys, command + coarser.get(name, '')) for name, command in worked_axis.steps()}
    for name in ('import', 'plot', 'friction'):
        assert quoted(excerpt(said[name], worked_axis.LEFT_OUT)) in part_of(WORKED, name), name
    printed = part_of(WORKED, 'identify')
    there, here = TestIdentification().found_in(printed), TestIdentification().found_in(said['identify'])
    report = json.loads((clone / worked_axis.RUNS / 'found/report.json').read_text(encoding='utf-8'))
    assert report['fits']
    found = {one['name']: one['value'] for one in report['estimates']}
    for name, value in worked_axis.TRUTH.items():
        assert found[name] == pytest.approx(value, rel=0.01), name
    assert set(here) == set(there) == set(found)
    assert found['sensor.drive_force.offset'] == pytest.approx(0.01 * worked_axis.OFFSET * worked_axis.RATED, rel=0.1)
    assert found['sensor.position.delay'] == pytest.approx(worked_axis.DELAY, rel=0.02)
    assert [run['own']['friction.scale'] for run in report['alone']] == pytest.approx(
        [worked_axis.DRIFT[1], worked_axis.DRIFT[2]], rel=2e-3)
    for name in ('predict', 'drifted'):
        rows = [re.findall(r'(?:position|spring)  .*', text) for text in (said[name], part_of(WORKED, name))]
        assert len(rows[0]) == 2, name
        numbers = [[float(number) for row in one for number in re.findall(r'[\d.]+', row)] for one in rows]
        assert numbers[0] == pytest.approx(numbers[1], rel=0.05), name
