# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The progress bar on a terminal, which a pseudo-terminal is."""

import os
import pty
import threading
from collections.abc import Iterator
from types import SimpleNamespace

import pytest

from stickslip_sim.cli import progress
from stickslip_sim.cli.progress import progress_bar
from tests.support.waiting import wait_for

SOON = {'patience': 0.01, 'every': 0.01}


class Terminal:
    """Standard error of this process, and what was written to it."""

    def __init__(self) -> None:
        self._there, here = pty.openpty()
        self.stream = os.fdopen(here, 'w')
        self.text = ''
        threading.Thread(target=self._read, daemon=True).start()

    def _read(self) -> None:
        try:
            while part := os.read(self._there, 4096):
                self.text += part.decode()
        except OSError:   # closed
            pass


@pytest.fixture
def terminal(monkeypatch: pytest.MonkeyPatch) -> Iterator[Terminal]:
    found = Terminal()
    monkeypatch.setattr(progress, 'sys', SimpleNamespace(stderr=found.stream))   # pytest sets that of sys once more
    yield found
    found.stream.close()


def test_work_that_says_nothing_shows_how_long_it_takes(terminal: Terminal) -> None:
    with progress_bar('waiting', **SOON):
        wait_for(lambda: 'waiting  0 s' in terminal.text, 'the bar')
    wait_for(lambda: terminal.text.endswith('\x1b[?25h\r\n'), 'its end, with a cursor')


def test_work_shows_its_share(terminal: Terminal) -> None:
    with progress_bar('working', **SOON) as take:
        assert take is not None
        take(0.5)
        wait_for(lambda: '#' * 15 + '-' * 15 in terminal.text, 'half of the bar')


def test_there_is_one_bar_at_a_time(terminal: Terminal) -> None:
    with progress_bar('outer', **SOON):
        with progress_bar('inner', **SOON) as take:
            assert take is None
        wait_for(lambda: 'outer' in terminal.text, 'the bar')
    assert 'inner' not in terminal.text
    with progress_bar('later') as take:
        assert take is not None


def test_short_work_shows_nothing(terminal: Terminal) -> None:
    with progress_bar('short', patience=60.0):
        pass
    assert not terminal.text


def test_nobody_looks_where_there_is_no_terminal() -> None:
    with progress_bar('unseen') as take:
        assert take is None
