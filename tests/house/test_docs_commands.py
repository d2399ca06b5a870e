# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The commands of the pages can be given one after the other in a clone, whichever is first; git sees none of it."""

import re
import shlex
import subprocess
from collections import Counter
from collections.abc import Iterator
from contextlib import suppress
from itertools import pairwise
from pathlib import Path

import pytest

from tests.support.repository import ROOT

PAGES = [ROOT / 'README.md', *sorted((ROOT / 'docs').glob('*.md'))]
COMMAND = re.compile(r'(?:stickslip|python3 -m stickslip_sim|python3 -m venv) [^`|#]*')
FOLDERS = '--out', '--bag'
FILES = ('--out', '--plot', '--csv', '--parquet', '--events', '--samples', '--receipt', '--junit', '--json',
         '--scene-out')
OTHERS = re.compile(r"record\.folder:=(\w\S*)|open\('([^']+)', 'w|create_keystore (\S+)")


def commands() -> Iterator[list[str]]:
    """Yield the words of each command of the pages: of a line, or within one in backticks."""
    for page in PAGES:
        text = page.read_text(encoding='utf-8').replace('\\\n', ' ')
        for found in COMMAND.finditer(text):
            line = found[0].partition('\n')[0]
            with suppress(ValueError):      # prose with an apostrophe
                yield shlex.split(line)


def outputs(words: list[str], options: tuple[str, ...]) -> list[str]:
    """Return what a command writes by these options, but for names in capitals and numbers of samples."""
    given = [word for option, word in pairwise(words) if option in options]
    return [word for word in given if re.fullmatch(r'[\w./-]*[a-z][\w./-]*', word) and not Path(word).stem.isupper()]


def written() -> set[str]:
    """Return all that the pages have their readers write, with the picture that `plot` names itself."""
    found = {name for page in PAGES for match in OTHERS.finditer(page.read_text(encoding='utf-8'))
             for name in match.groups() if name}
    for words in commands():
        found.update(outputs(words, (*FOLDERS, *FILES)))
        match words:
            case [_, 'plot', run, *options] if '--out' not in options and not run.startswith('-'):
                found.add(f'{Path(run).name}.png')
            case [_, '-m', 'venv', folder, *_]:
                found.add(folder)
    return found


def test_no_two_commands_make_the_same_folder() -> None:
    """What is there is never overwritten: the second one would be refused."""
    found = Counter(name for words in commands() for name in outputs(words, FOLDERS) if not Path(name).suffix)
    assert {'runs/my_axis_map', 'runs/my_run_figures', 'runs/slippery', 'runs/maps/load', 'runs/measured',
            'runs/eight'} <= set(found)
    assert [name for name, count in found.items() if count > 1] == []


def test_what_the_commands_write_is_ignored_by_git() -> None:
    """Else `git status` shows runs and pictures where a page was followed.  Pages are written anew on purpose."""
    if not (ROOT / '.git').exists():
        pytest.skip('not a clone')
    found = {name for name in written() if not name.endswith('.md')}
    assert {'runs/eight', 'runs/receipt.json', 'eight.png', '.venv', 'runs/again', 'runs/scene.yaml'} <= found
    done = subprocess.run(['git', 'check-ignore', '--stdin'], input='\n'.join(sorted(found)), cwd=ROOT, text=True,
                          capture_output=True, check=False)
    assert sorted(found - set(done.stdout.splitlines())) == []
