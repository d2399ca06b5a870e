# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Fixtures that several test files share."""

import gc
import os
import subprocess
import sys
from collections import Counter
from collections.abc import Generator, Iterator
from pathlib import Path
from typing import Protocol

import pytest
from hypothesis import settings
from matplotlib.layout_engine import ConstrainedLayoutEngine

from stickslip_sim.cli.main import run
from stickslip_sim.plots.style import JOURNAL
from tests.support.whole_files import pytest_xdist_make_scheduler as pytest_xdist_make_scheduler

# The same examples each time, however slow a busy machine is; `make fuzz` looks for new ones.
settings.register_profile('always the same', derandomize=True, database=None, deadline=None)
settings.load_profile('always the same')

WORKER = os.environ.get('PYTEST_XDIST_WORKER', '')    # the name of this process among several


@pytest.hookimpl(hookwrapper=True)
def pytest_collection() -> Iterator[None]:
    """Keep the garbage collector from what stays to the end: four thousand tests, and all that they import.

    It would look through these 400,000 objects again and again, a sixth of the CPU of quick tests.
    """
    gc.disable()
    yield
    gc.freeze()
    gc.enable()


@pytest.hookimpl(wrapper=True)
def pytest_make_collect_report(collector: pytest.Collector
                               ) -> Generator[None, pytest.CollectReport, pytest.CollectReport]:
    """Let each of several processes collect from another room on: what it rewrites and keeps, the others only read.

    To rewrite three hundred files takes ten seconds of CPU, which each process would spend on all of them.
    """
    report = yield
    if WORKER and isinstance(collector, pytest.Directory):
        begin = int(WORKER.removeprefix('gw')) * len(report.result) // int(os.environ['PYTEST_XDIST_WORKER_COUNT'])
        report.result = [*report.result[begin:], *report.result[:begin]]
    return report


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Let several processes begin with the files that are slow, so that none of them runs alone at the end."""
    if WORKER:
        slow = {item.path for item in items if item.get_closest_marker('slow')}
        counts = Counter(item.path for item in items)
        items.sort(key=lambda item: (item.path not in slow, -counts[item.path], item.path))


class Program(Protocol):
    """Runs a program in a process of its own, with compiled code or as plain Python; returns what it printed."""

    def __call__(self, program: str, *, compiled: bool) -> str:
        """Run it."""


@pytest.fixture(scope='session')
def in_a_process() -> Program:

    def in_it(program: str, *, compiled: bool) -> str:
        environment = {**os.environ, 'STICKSLIP_COMPILED': '1' if compiled else '0',
                       'PYTHONPATH': os.pathsep.join([os.getcwd(), *filter(None, sys.path)])}
        done = subprocess.run([sys.executable, '-c', program], env=environment, capture_output=True, text=True,
                              timeout=300, check=False)
        assert done.returncode == 0, done.stderr
        return done.stdout

    return in_it


@pytest.fixture(scope='session')
def fig8_bag(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A run of paper_fig8, 3 s long, as the tool writes it; not to be changed."""
    folder = tmp_path_factory.mktemp('runs') / 'eight'
    assert run(['simulate', 'paper_fig8', '--duration', '3', '--bag', str(folder)]) == 0
    return folder


@pytest.fixture(autouse=True, scope='module')
def coarse_pictures(request: pytest.FixtureRequest) -> Iterator[None]:
    """Draw coarsely and without a layout, which is half of the cost, except where pictures are what is tested."""
    with pytest.MonkeyPatch.context() as patch:
        if request.path.parent.name != 'plots':
            patch.setattr(ConstrainedLayoutEngine, 'execute', lambda *_: None)
            patch.setitem(JOURNAL, 'savefig.dpi', 50)
        yield


@pytest.fixture
def blank_pictures(monkeypatch: pytest.MonkeyPatch) -> None:
    """Let pages of runs and of identified axes show blank pictures, for tests that look at none; to draw is slow."""
    def blank(*given: object) -> None:
        for path in given:
            if isinstance(path, Path):
                path.write_text('<svg xmlns="http://www.w3.org/2000/svg"/>')

    for module, names in {'compare.pictures': ('motion', 'characteristics', 'side_by_side'),
                          'identification.report': ('fit', 'residuals', 'known_friction', 'correlations')}.items():
        for name in names:
            monkeypatch.setattr(f'stickslip_sim.{module}.plot_{name}', blank)
