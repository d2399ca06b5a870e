# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The package as a whole: public names, what importing it costs, names in docstrings, and the rooms of the tests."""

import ast
import builtins
import re
from functools import cache
from pathlib import Path

import pytest

import stickslip_sim
from tests.conftest import Program
from tests.support.repository import ROOT

PACKAGE, TESTS = Path(stickslip_sim.__file__).parent, ROOT / 'tests'
SPLIT = 'ros', 'solvers'    # rooms that have rooms within, which their tests follow
OF_NO_ROOM = {'data', 'fuzz', 'hostile', 'house', 'support'}


class TestPublicNames:
    def test_each_is_there_and_says_what_it_is(self) -> None:
        """Which they are is compared with docs/api.md."""
        assert dir(stickslip_sim) == sorted(stickslip_sim.__all__)
        assert all(getattr(stickslip_sim, name).__doc__ for name in stickslip_sim.__all__)

    def test_an_unknown_one_is_refused(self) -> None:
        with pytest.raises(AttributeError, match="module 'stickslip_sim' has no attribute 'simulat'"):
            getattr(stickslip_sim, 'simulat')  # noqa: B009

    def test_importing_costs_nothing_and_a_simulation_needs_neither_pictures_nor_ros(
            self, in_a_process: Program) -> None:
        """No other room of the package, and none of the libraries that they need."""
        program = '''
import sys
before = set(sys.modules)
import stickslip_sim
print(*sorted(name for name in set(sys.modules) - before if name.partition('.')[0] not in sys.stdlib_module_names))
run = stickslip_sim.simulate(stickslip_sim.load_scene('paper_fig7'), 0.1)
print(len(run.samples['time']), {'matplotlib', 'rclpy', 'mcap', 'pandas', 'click'} & set(sys.modules))
import stickslip_sim.plots
print('matplotlib.pyplot' in sys.modules)    # the global state of matplotlib
'''
        assert in_a_process(program, compiled=False).splitlines() == [
            'stickslip_sim stickslip_sim.core stickslip_sim.core.version', '101 set()', 'False']

    def test_an_installed_package_starts_without_a_compiler(self, in_a_process: Program) -> None:
        """Its hot path was compiled while it was built, from these very sources."""
        if 'site-packages' not in stickslip_sim.__file__:
            pytest.skip('the source tree, which may have no compiled code; `make test` tests the installed copy')
        program = '''
import sys
from stickslip_sim import simulate_events
from stickslip_sim.core.hot_path import hot_path
from stickslip_sim.inputs import load_scene
simulate_events(load_scene('paper_fig8'), 1.0)
print(hot_path(), {'Cython', 'numba'} & set(sys.modules))
'''
        assert in_a_process(program, compiled=True).strip() == 'compiled set()'


class TestDocstrings:
    """A name in backticks is one of the code, so that no docstring names what has another name by now."""

    @staticmethod
    @cache
    def sources() -> tuple[list[str], set[str]]:
        """Return all docstrings, and the names and words of all code."""
        docstrings: list[str] = []
        words = {*dir(builtins), PACKAGE.name}
        for path in PACKAGE.rglob('*.py'):
            tree = ast.parse(path.read_text(encoding='utf-8'))
            for node in ast.walk(tree):
                if isinstance(node, ast.Module | ast.ClassDef | ast.FunctionDef):
                    docstring = ast.get_docstring(node)
                    if docstring is not None:
                        docstrings.append(docstring)
                        vars(node.body[0])['value'] = ast.Pass()
                words.update(*(re.findall(r'\w+', text) for text in vars(node).values() if isinstance(text, str)))
            words.update(path.relative_to(PACKAGE).with_suffix('').parts)
        return docstrings, words

    def unknown(self, *texts: str) -> list[str]:
        """Return the names in backticks that are none; capitals in one with dots, SECTION.file, stand for others."""
        _, words = self.sources()
        return [name for text in texts for name in re.findall(r'`([A-Za-z_]\w*(?:\.[A-Za-z_]\w*)*)(?:\(\))?`', text)
                if not words.issuperset(part for part in name.split('.') if '.' not in name or not part.isupper())]

    def test_names_in_backticks_exist(self) -> None:
        docstrings, _ = self.sources()
        assert len(docstrings) > 1000
        assert self.unknown(*docstrings) == []

    def test_a_name_that_is_gone_is_found(self) -> None:
        text = '`simulate_gone()` `runs.simulate_gone` `simulate_events` `SECTION.file` `drive.velocity` `str`'
        assert self.unknown(text) == ['simulate_gone', 'runs.simulate_gone']


class TestRoomsOfTests:
    def test_they_are_the_rooms_of_the_package(self) -> None:
        rooms = {path.parent.relative_to(PACKAGE).as_posix() for split in ('', *SPLIT)
                 for path in (PACKAGE / split).glob('*/__init__.py') if len([*path.parent.rglob('*.py')]) > 1}
        folders = {path.parent.relative_to(TESTS).as_posix() for split in ('', *SPLIT)
                   for path in (TESTS / split).glob('*/*') if path.suffix in ('.py', '.json')}
        assert {room for room in rooms if not any((TESTS / room).rglob('test_*.py'))} == set()
        assert folders - rooms == OF_NO_ROOM

    @pytest.mark.parametrize('pattern', [
        r'^ *(from|import) tests\.[\w.]*\btest_\w+',                      # what two of them use is for tests/support
        r'''setattr\([^,]+, ['"]_[a-zA-Z]|['"]stickslip_sim[\w.]*\._[a-zA-Z]\w*['"],''',   # an argument, a public name
    ], ids=['imports a test', 'patches a private name'])
    def test_no_test_ties_itself_to_the_inside_of_another(self, pattern: str) -> None:
        assert [f'{path.relative_to(TESTS)}: {line.strip()}' for path in sorted(TESTS.rglob('*.py'))
                for line in path.read_text(encoding='utf-8').splitlines() if re.search(pattern, line)] == []
