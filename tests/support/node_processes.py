# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Programs of `stickslip_sim.ros` as real nodes in processes of their own, in a ROS domain of this session.

They are forked from a process that has imported what they need, which costs a quarter as much: what is left out is the
start of the interpreter and of the installed script, unless that is asked for.
"""

import ctypes
import multiprocessing
import os
import resource
import runpy
import signal
import sys
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager, suppress
from functools import cache
from multiprocessing.forkserver import ensure_running
from pathlib import Path
from tempfile import TemporaryFile
from typing import NamedTuple

import pytest

from tests.support.busy_machine import CoreWaits
from tests.support.repository import ROOT
from tests.support.tool import restore_interrupt
from tests.support.waiting import DEADLINE

pytest.importorskip('rclpy')

# Without `make test` every session still keeps to itself.
os.environ.setdefault('ROS_DOMAIN_ID', str(1 + os.getpid() % 100))
os.environ.setdefault('ROS_AUTOMATIC_DISCOVERY_RANGE', 'LOCALHOST')

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
    arguments: Sequence[str]
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
        if self.program.endswith('.py'):
            sys.stdout, sys.argv = sys.stderr, [self.program, *self.arguments]
            runpy.run_path(self.program, run_name='__main__')
            raise SystemExit(0)
        if self.path:
            os.execve(self.path, [self.path, *self.arguments], self.environment)
        from stickslip_sim.ros import executables

        code = getattr(executables, self.program)([*self.arguments])
        ctypes.pythonapi.Py_Exit(code)    # all that an interpreter does at its end; multiprocessing leaves it out


def executable(name: str) -> str:
    """Return an installed program, as `ros2 run` finds it."""
    for prefix in os.environ['AMENT_PREFIX_PATH'].split(os.pathsep):
        path = Path(prefix, 'lib', 'stickslip_sim', name)
        if path.is_file():
            return str(path)
    raise AssertionError(f'{name} is not installed: run `make build`')


def ros_args(*words: str | Path) -> list[str]:
    """Return words behind --ros-args, with a -p before each NAME:=VALUE that has no option before it."""
    texts = ['--ros-args', *map(str, words)]
    return [part for before, word in zip(['', *texts], texts)
            for part in (['-p', word] if ':=' in word and before not in ('-p', '-r') else [word])]


def recording_into(folder: Path) -> list[str]:
    """Return the arguments of a node that records from the start."""
    return ['record.enabled:=true', f'record.folder:={folder}']


def attentive() -> None:
    """Let a node that is forked look around and report five times a second, not once: for `prepare`."""
    from stickslip_sim.ros.node import reports

    restore_interrupt()
    reports.PERIOD = 0.2


def with_small_files() -> None:
    """Let an attentive node write no file of more than 200 kB: for `prepare`."""
    attentive()
    resource.setrlimit(resource.RLIMIT_FSIZE, (200_000, 200_000))


class NodeProcess:
    """A program with default signal handling, in a session of its own, as a terminal starts it.

    It is forked, unless it is to start `afresh`, as a user starts the installed script.  Once it was waited for, `code`
    and `errors` are its exit code and standard error, which is kept in a file: into a pipe that nobody empties a
    program that lives long writes 64 kB, and then stands still.  Of a `program` that is a Python file both streams are
    kept.
    """

    def __init__(self, *words: str | Path, folder: Path | None = None, prepare: Callable[[], None] = restore_interrupt,
                 program: str = 'sim_node', afresh: bool = False, options: Sequence[str] = ()) -> None:
        self.code: int | None = None
        self.errors = ''
        self._errors = TemporaryFile('w+', encoding='utf-8')    # noqa: SIM115  # closed when it was read
        start = _Start(program, executable(program) if afresh else '', [*options, *(ros_args(*words) if words else ())],
                       folder or Path.cwd(), dict(os.environ), f'/proc/{os.getpid()}/fd/{self._errors.fileno()}',
                       prepare)
        _start_server()
        self._process = _FORKS.Process(target=start.run, daemon=True)
        self._process.start()
        assert self._process.pid is not None
        self.pid = self._process.pid
        self.waits = CoreWaits(self.pid)

    @property
    def said(self) -> str:
        """What it has written on standard error so far."""
        if not self._errors.closed:
            self._errors.seek(0)
            self.errors = self._errors.read()
        return self.errors

    def send(self, number: int) -> None:
        self.waits.look()    # it may end
        with suppress(ProcessLookupError):    # it has ended
            os.kill(self.pid, number)

    def wait(self) -> tuple[int, str]:
        """Return the exit code and standard error."""
        self._process.join(DEADLINE)
        if self._process.exitcode is None:
            self._process.kill()
            raise TimeoutError(f'{self._process} goes on')
        return self._ended()

    def end(self, number: int = signal.SIGINT) -> tuple[int, str]:
        self.send(number)
        return self.wait()

    def kill(self) -> None:
        if self._process.exitcode is None:
            self.waits.look()
            self._process.kill()
            self._process.join()
            print(self._ended()[1])    # what it had to say, for the report of a test that failed

    def _ended(self) -> tuple[int, str]:
        self.code = self._process.exitcode
        assert self.code is not None
        self.errors = self.said
        self._errors.close()
        return self.code, self.errors


def assert_clean(code: int, errors: str) -> None:
    """Check how a process ended."""
    assert code == 0, errors
    assert 'Traceback' not in errors
    assert 'Exception' not in errors


@contextmanager
def running(*words: str | Path, folder: Path | None = None, prepare: Callable[[], None] = restore_interrupt,
            program: str = 'sim_node', afresh: bool = False, options: Sequence[str] = ()) -> Iterator[NodeProcess]:
    process = NodeProcess(*words, folder=folder, prepare=prepare, program=program, afresh=afresh, options=options)
    try:
        yield process
    finally:
        process.kill()


def ended_at_once(program: str, *words: str | Path, options: Sequence[str] = ()) -> tuple[int, str]:
    """Return the exit code of a program that is to end at once, and what it wrote on standard error."""
    with running(*words, program=program, options=options) as process:
        return process.wait()


def refusal_of(program: str, *words: str | Path, options: Sequence[str] = ()) -> str:
    """Return the one line in which a program refuses to start."""
    code, errors = ended_at_once(program, *words, options=options)
    assert code == 2, errors
    line, = errors.splitlines()
    assert line.startswith(f'{program}: '), line
    return line
