# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Small errors, put into a copy of the package one by one: the test that is named for each has to fail.

    python3 -m dev.mutants              # all of mutants.yaml
    python3 -m dev.mutants linear/      # those with this in their file or name

A test that goes, or that becomes part of another one, is no loss while each mutant is still killed.  Nothing is
compiled: in a file of the hot path a mutant runs as plain Python, which is the same source, in others beside the
compiled unit.  Exit code 1 when a mutant survives or does not apply, or when a test fails without any.
"""

import os
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Iterable, Mapping
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import NamedTuple

import yaml

import stickslip_sim
from stickslip_sim.core.hot_path import UNIT

from .files import ROOT

PACKAGE = Path(stickslip_sim.__file__).parent   # as it is imported here: the installed one, or the source tree
_PASSED, _FAILED = 0, 1   # exit codes of pytest


class Mutant(NamedTuple):
    """A file of the package, by its path there, in which `new` stands instead of `old`, and the test that kills it."""

    file: str
    name: str
    old: str
    new: str
    test: str

    @property
    def is_plain(self) -> bool:
        """Whether it runs as plain Python."""
        return UNIT is None or self.file in UNIT.SOURCES

    @property
    def text(self) -> str | None:
        """The file with the error in it; None unless `old` is there exactly once."""
        path = PACKAGE / self.file
        text = path.read_text(encoding='utf-8') if path.is_file() else ''
        return text.replace(self.old, self.new) if text.count(self.old) == 1 else None


def mutants() -> list[Mutant]:
    """Return the mutants of `mutants.yaml`."""
    text = Path(__file__).with_suffix('.yaml').read_text(encoding='utf-8')
    found = [Mutant(file, name, **rest) for file, entries in yaml.safe_load(text).items()
             for name, rest in entries.items()]
    if len(found) != text.count('\n    old: '):
        raise ValueError('mutants.yaml names a file or a mutant twice, and the last one hides the others')
    return found


def fault(mutant: Mutant) -> str:
    """Return what is wrong with a mutant; nothing where its test kills it."""
    if mutant.text is None:
        return 'does not apply: its text is not there exactly once'
    code = exit_code([mutant.test], mutant.is_plain, {mutant.file: mutant.text})
    return '' if code == _FAILED else 'survives' if code == _PASSED else f'{mutant.test} does not run'


def exit_code(tests: Iterable[str], is_plain: bool, changed: Mapping[str, str]) -> int:
    """Return that of pytest, up to the first failure, with a copy of the package in which files are changed."""
    with tempfile.TemporaryDirectory() as folder:
        copy = shutil.copytree(PACKAGE, Path(folder) / PACKAGE.name)
        for file, text in changed.items():
            (copy / file).write_text(text, encoding='utf-8')
        environment = {**os.environ, 'PYTHONPATH': os.pathsep.join((folder, *filter(None, sys.path))),
                       'PYTHONDONTWRITEBYTECODE': '1', 'OPENBLAS_NUM_THREADS': '1',
                       'STICKSLIP_COMPILED': '0' if is_plain else '1'}
        return subprocess.run([sys.executable, '-m', 'pytest', '-qx', '-p', 'no:cacheprovider', *tests], cwd=ROOT,
                              env=environment, capture_output=True, check=False).returncode


def main() -> int:
    """Try the mutants and print what is wrong; return the exit code."""
    word = sys.argv[1] if len(sys.argv) > 1 else ''
    chosen = [mutant for mutant in mutants() if word in f'{mutant.file} {mutant.name}']
    groups = [(plain, {one.test for one in chosen if one.is_plain == plain}) for plain in (True, False)]
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        unchanged = pool.map(lambda group: exit_code(group[1], group[0], {}) if group[1] else _PASSED, groups)
        faults = list(pool.map(fault, chosen))
    wrong = [f'{one.file}: {one.name}: {said}' for one, said in zip(chosen, faults) if said]
    killed = len(chosen) - len(wrong)
    if any(code != _PASSED for code in unchanged):
        wrong.append('a test of these fails without a mutant: pytest says which')
    sys.stdout.write('\n'.join([*wrong, f'{killed} of {len(chosen)} mutants killed']) + '\n')
    return 1 if wrong else 0


if __name__ == '__main__':
    sys.exit(main())
