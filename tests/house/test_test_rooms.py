# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Tests stand as their code stands: each room has its folder of tests, and each folder of tests its room."""

import re
from collections.abc import Iterator
from pathlib import Path

import pytest

import stickslip_sim
from tests.support.repository import ROOT

PACKAGE, TESTS = Path(stickslip_sim.__file__).parent, ROOT / 'tests'

SPLIT = 'ros', 'solvers'    # rooms that have rooms within, which their tests follow
WITHOUT_TESTS: dict[str, str] = {}    # room: why it has none
OTHER_TESTS = {
    'fuzz': 'made-up files and runs, through all rooms', 'hostile': 'made-up scenes, through all rooms',
    'house': 'of the repository itself', 'support': 'helpers, no tests', 'data': 'stored runs of the reference'}


def rooms() -> set[str]:
    """Return the rooms that have code, and the rooms within those that are split."""
    return {room for folder in (PACKAGE, *(PACKAGE / room for room in SPLIT)) for room in _rooms_in(folder)}


def _rooms_in(folder: Path) -> Iterator[str]:
    for path in folder.glob('*/__init__.py'):
        if len([*path.parent.rglob('*.py')]) > 1:
            yield path.parent.relative_to(PACKAGE).as_posix()


def has_tests(folder: Path) -> bool:
    return any(folder.rglob('test_*.py'))


def test_each_room_has_its_tests() -> None:
    assert {room for room in rooms() if not has_tests(TESTS / room)} == set(WITHOUT_TESTS)


def test_each_folder_of_tests_has_its_room() -> None:
    folders = {path.parent.relative_to(TESTS).as_posix()
               for split in (TESTS, *(TESTS / room for room in SPLIT)) for path in split.glob('*/*')
               if path.suffix in ('.py', '.json')}
    assert folders - rooms() == set(OTHER_TESTS)


@pytest.mark.parametrize('pattern', [
    r'^ *(from|import) tests\.[\w.]*\btest_\w+',                      # what two of them use is for tests/support
    r'''setattr\([^,]+, ['"]_[a-zA-Z]|['"]stickslip_sim[\w.]*\._[a-zA-Z]\w*['"],''',   # an argument, or a public name
], ids=['imports a test', 'patches a private name'])
def test_no_test_does_what_ties_it_to_the_inside_of_another(pattern: str) -> None:
    found = [f'{path.relative_to(TESTS)}: {line.strip()}' for path in sorted(TESTS.rglob('*.py'))
             for line in path.read_text(encoding='utf-8').splitlines() if re.search(pattern, line)]
    assert found == []
