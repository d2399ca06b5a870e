# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""docs/identification.md: its commands run as they stand there, and find what it says."""

import re
import shlex
from collections.abc import Callable, Mapping
from pathlib import Path

import pytest
import yaml

from benchmarks.identification import COMMANDS, EXAMPLES, FAILS, PAGE, TRUTH, shown
from stickslip_sim.inputs import load_scene
from tests.support.repository import ROOT
from tests.support.tool import Capture, answered

pytestmark = pytest.mark.slow

ROW = re.compile(r'^ *([a-z]\w*(?:\.\w+)+(?:\[\d\])?) +'                                 # name
                 r'([\d.e+-]+)(?: (?:N s|[^\d ]+))?(?:/m)? +([\d.e+-]+)', re.MULTILINE)   # start and found
SLIPS = re.compile(r'(\d+) slips, fitted beside measured, apart in the median and at most: '
                   r'break-away force (\S+) and (\S+) %, time at rest before (\S+) and (\S+) %')

ROWS = 3001            # of the run of another model: three quarters of it
MOST_SIMULATIONS = 47_500    # then; with searches that go on without gain it takes 48,600
FREE = ('axis.drive_stiffness', 'friction.static.limit', 'friction.static.time_constant', 'friction.kinetic.limit')


@pytest.fixture(scope='module')
def page() -> str:
    return PAGE.read_text(encoding='utf-8')


def found_in(text: str) -> Mapping[str, tuple[float, float]]:
    """Return start and found value of each parameter, in the unit that is printed."""
    return {row[1]: (float(row[2]), float(row[3])) for row in ROW.finditer(text)}


def part(page: str, name: str) -> str:
    return page.partition(f'<!-- {name}: begin -->')[2].partition(f'<!-- {name}: end -->')[0]


@pytest.fixture
def answers(page: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: Capture) -> Callable[[str], str]:
    """Runs the commands of a part of the page, and returns what the last one printed."""
    (tmp_path / 'examples').symlink_to(ROOT / 'examples')
    monkeypatch.chdir(tmp_path)

    def of(name: str) -> str:
        quoted, said = part(page, name), ''
        for command in COMMANDS[name]:
            code, said, error = answered(capsys, *shlex.split(command))
            assert code == 0, error
            assert shown(command) in quoted
        return said

    return of


def test_its_commands_find_what_it_says(page: str, answers: Callable[[str], str]) -> None:
    for name in (name for name in COMMANDS if name != FAILS):
        said = answers(name)
        if name == 'synthetic':
            printed, here = found_in(part(page, name)), found_in(said)
            assert set(printed) == set(here) == set(TRUTH)
            for parameter, numbers in here.items():
                assert numbers == pytest.approx(printed[parameter], rel=2e-3), parameter


def test_a_model_that_is_not_that_of_the_axis_has_its_rests_and_break_aways(
        tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: Capture) -> None:
    """On three quarters of the run, with four of its numbers, as ten on all of it take a minute.

    And its search ends early: what only crawls far from the run, and what gains nothing, does not go on.
    """
    examples, (first, last) = tmp_path / EXAMPLES, COMMANDS[FAILS]
    examples.mkdir(parents=True)
    for name, lines in (('lugre.csv', ROWS + 1), ('lugre_start.yaml', None)):
        text = (ROOT / EXAMPLES / name).read_text(encoding='utf-8').splitlines(keepends=True)
        (examples / name).write_text(''.join(text[:lines]))
    free = yaml.safe_load((ROOT / EXAMPLES / 'lugre_free.yaml').read_text(encoding='utf-8'))['parameters']
    (examples / 'lugre_free.yaml').write_text(yaml.safe_dump({'parameters': {name: free[name] for name in FREE}}))
    monkeypatch.chdir(tmp_path)
    assert answered(capsys, *shlex.split(first))[0] == 0
    code, said, _ = answered(capsys, *shlex.split(last))
    assert code == 3
    assert 'THE MODEL DOES NOT FIT' in said
    apart = SLIPS.search(said)
    assert apart
    assert int(apart[1]) >= 8
    assert max(float(number) for number in apart.groups()[1:]) < 10.0, apart[0]   # %
    simulations = re.search(r'(\d+) simulations', said)
    assert simulations
    assert int(simulations[1]) < MOST_SIMULATIONS


def test_the_page_shows_what_the_command_of_a_wrong_model_prints(page: str) -> None:
    quoted = part(page, FAILS)
    assert 'THE MODEL DOES NOT FIT' in quoted
    assert all(shown(command) in quoted for command in COMMANDS[FAILS])


def test_the_file_of_what_is_free_is_the_one_of_the_page(page: str) -> None:
    assert f'```yaml\n{(ROOT / EXAMPLES / "free.yaml").read_text(encoding="utf-8")}```\n' in page


def test_what_it_finds_is_the_truth(page: str) -> None:
    """In the unit that is printed: the ratio of what was found to the start."""
    start = load_scene(str(ROOT / EXAMPLES / 'start.yaml')).values
    for name, (begun, found) in found_in(part(page, 'synthetic')).items():
        before = start[name]
        assert isinstance(before, float)
        assert found / begun == pytest.approx(TRUTH[name] / before, rel=0.005), name
