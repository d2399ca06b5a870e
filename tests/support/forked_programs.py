# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Programs of `stickslip_sim.ros`, forked from a process that has imported what they need: a quarter of the cost.

What is left out is the start of the interpreter and of the installed script, unless that is asked for.
"""

import ctypes
import multiprocessing
import os
import subprocess
import sys
from collections.abc import Callable
from contextlib import suppress
from functools import cache
from multiprocessing.forkserver import ensure_running
from pathlib import Path
from tempfile import TemporaryFile
from typing import NamedTuple

import pytest

from tests.support.repository import ROOT
from tests.support.tool import restore_interrupt
from tests.support.waiting import DEADLINE

pytest.importorskip('rclpy')

_FORKS = multiprocessing.get_context('forkserver')
_FORKS.set_forkserver_preload(['tests.support.exit_of_forks', 'pytest', __name__, 'tests.support.preloaded'])


@cache
def _start_server() -> None:
    """Start the process that programs are forked from, where it finds what it is to import."""
    folder = Path.cwd()
    os.chdir(ROOT)
    try:
        ensure_running()
    finally:
        os.chdir(folder)


class _Start(NamedTuple):
    """All that a program starts with."""

    program: str
    path: str
    arguments: tuple[str, ...]
    folder: Path
    environment: dict[str, str]
    errors: str
    prepare: Callable[[], None]

    def run(self) -> None:
        """Be the program, or the file at the path, until its end."""
        os.setsid()
        os.chdir(self.folder)
        os.environ.clear()
        os.environ.update(self.environment)
        os.dup2(os.open(self.errors, os.O_WRONLY | os.O_APPEND), 2)
        sys.stderr = os.fdopen(2, 'w', buffering=1, encoding='utf-8', closefd=False)
        self.prepare()
        if self.path:
            os.execve(self.path, [self.path, *self.arguments], self.environment)
        from stickslip_sim.ros import executables

        code = getattr(executables, self.program)([*self.arguments])
        ctypes.pythonapi.Py_Exit(code)    # all that an interpreter does at its end; multiprocessing leaves it out


class ForkedProgram:
    """A program in a session of its own, with what of `subprocess.Popen` is asked of one; standard error is kept.

    In a file: into a pipe that nobody empties a program that lives long writes 64 kB, and then stands still.  With a
    `path` it becomes the program in that file, as it is installed.
    """

    def __init__(self, program: str, *arguments: str, folder: Path | None = None,
                 prepare: Callable[[], None] = restore_interrupt, path: str = '') -> None:
        self._errors = TemporaryFile('w+', encoding='utf-8')    # noqa: SIM115  # closed when it was read
        start = _Start(program, path, arguments, folder or Path.cwd(), dict(os.environ),
                       f'/proc/{os.getpid()}/fd/{self._errors.fileno()}', prepare)
        _start_server()
        self._process = _FORKS.Process(target=start.run, daemon=True)
        self._process.start()
        self._said = ''
        assert self._process.pid is not None
        self.pid = self._process.pid

    def poll(self) -> int | None:
        """Return the exit code, once there is one."""
        return self._process.exitcode

    def send_signal(self, number: int) -> None:
        with suppress(ProcessLookupError):    # it has ended
            os.kill(self.pid, number)

    def kill(self) -> None:
        self._process.kill()

    def communicate(self, timeout: float | None = None) -> tuple[None, str]:
        """Wait for its end; return nothing for standard output, and standard error; it can be asked again."""
        self._process.join(timeout)
        if self.poll() is None:
            raise subprocess.TimeoutExpired(str(self._process), timeout or 0.0)
        if not self._errors.closed:
            with self._errors as errors:
                errors.seek(0)
                self._said = errors.read()
        return None, self._said


def ros_args(*words: str | Path) -> list[str]:
    """Return words behind --ros-args, with a -p before each NAME:=VALUE that has no option before it."""
    texts = ['--ros-args', *map(str, words)]
    return [part for before, word in zip(['', *texts], texts)
            for part in (['-p', word] if ':=' in word and before not in ('-p', '-r') else [word])]


def ended_at_once(program: str, *words: str | Path) -> tuple[int, str]:
    """Return the exit code of a program that is to end at once, and what it wrote on standard error."""
    process = ForkedProgram(program, *ros_args(*words))
    try:
        _, errors = process.communicate(DEADLINE)
    except subprocess.TimeoutExpired:    # it goes on
        process.kill()
        _, errors = process.communicate()
    code = process.poll()
    assert code is not None
    return code, errors


def refusal_of(program: str, *words: str | Path) -> str:
    """Return the one line in which a program refuses to start."""
    code, errors = ended_at_once(program, *words)
    assert code == 2, errors
    line, = errors.splitlines()
    assert line.startswith(f'{program}: '), line
    return line
