# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The tool `stickslip`: in this process, and in one of its own."""

import ctypes
import os
import signal
import subprocess
import sys
from collections.abc import Iterable
from pathlib import Path

import pytest

from stickslip_sim.cli.main import run

_PARENT_DEATH_SIGNAL = 1    # PR_SET_PDEATHSIG of linux/prctl.h

Capture = pytest.CaptureFixture[str]


def restore_interrupt() -> None:
    """Undo, in a new process, what a shell or nohup does to signals: it hears them.  It ends with its parent."""
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    signal.signal(signal.SIGHUP, signal.SIG_DFL)
    ctypes.CDLL(None).prctl(_PARENT_DEATH_SIGNAL, signal.SIGKILL)


def answered(capsys: Capture, *arguments: str | Path) -> tuple[int, str, str]:
    """Run the tool in this process; return its exit code, standard output and standard error."""
    capsys.readouterr()
    return run([*map(str, arguments)]), *capsys.readouterr()


def done(capsys: Capture, *arguments: str | Path) -> str:
    """Run the tool in this process, which succeeds and complains of nothing; return its standard output."""
    code, out, err = answered(capsys, *arguments)
    assert (code, err) == (0, '')
    return out


def refused(capsys: Capture, *arguments: str | Path, code: int = 2, words: Iterable[str] = ()) -> str:
    """Run the tool in this process; return the one line that it says on standard error, with these words in it."""
    found, out, err = answered(capsys, *arguments)
    assert (found, out, err.count('\n')) == (code, '', 1)
    assert err.startswith('stickslip: ')
    assert [word for word in words if word not in err] == [], err
    return err


def refusals(file: Path) -> list[list[str]]:
    """Return the rows of a table of what is refused: a command line, and words of the line that refuses it."""
    rows = file.read_text(encoding='utf-8').splitlines()
    return [row.split(' | ') for row in rows if row and not row.startswith('#')]


def tool(*arguments: str | Path, **environment: str) -> subprocess.CompletedProcess[str]:
    """Run the tool in a process of its own."""
    return subprocess.run([sys.executable, '-m', 'stickslip_sim', *map(str, arguments)], capture_output=True, text=True,
                          timeout=180, check=False, env={**os.environ, **environment})
