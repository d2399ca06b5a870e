# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Installed programs, as real nodes in processes of their own, in a ROS domain of this session."""

import os
import resource
import signal
import subprocess
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path

import pytest

from tests.support.busy_machine import CoreWaits
from tests.support.forked_programs import ForkedProgram, ros_args
from tests.support.tool import restore_interrupt
from tests.support.waiting import DEADLINE

pytest.importorskip('rclpy')

# Without `make test` every session still keeps to itself.
os.environ.setdefault('ROS_DOMAIN_ID', str(1 + os.getpid() % 100))
os.environ.setdefault('ROS_AUTOMATIC_DISCOVERY_RANGE', 'LOCALHOST')


def executable(name: str) -> str:
    """Return an installed program, as `ros2 run` finds it."""
    for prefix in os.environ['AMENT_PREFIX_PATH'].split(os.pathsep):
        path = Path(prefix, 'lib', 'stickslip_sim', name)
        if path.is_file():
            return str(path)
    raise AssertionError(f'{name} is not installed: run `make build`')


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
    """A program with default signal handling, in a process group of its own, as a terminal starts it.

    It is forked, which costs a quarter as much, unless it is to start `afresh`, as a user starts the installed script.
    Once it was waited for, `code` and `errors` are its exit code and standard error.
    """

    def __init__(self, *words: str, folder: Path | None = None, prepare: Callable[[], None] = restore_interrupt,
                 program: str = 'sim_node', afresh: bool = False, options: Sequence[str] = ()) -> None:
        self.code: int | None = None
        self.errors = ''
        self._process = ForkedProgram(program, *options, *ros_args(*words), folder=folder, prepare=prepare,
                                      path=executable(program) if afresh else '')
        self.pid = self._process.pid
        self.waits = CoreWaits(self.pid)

    def send(self, number: int) -> None:
        self.waits.look()    # it may end
        self._process.send_signal(number)

    def wait(self) -> tuple[int, str]:
        """Return the exit code and standard error."""
        try:
            _, self.errors = self._process.communicate(timeout=DEADLINE)
        except subprocess.TimeoutExpired:
            self._process.kill()
            raise
        self.code = self._process.poll()
        assert self.code is not None
        return self.code, self.errors

    def end(self, number: int = signal.SIGINT) -> tuple[int, str]:
        self.send(number)
        return self.wait()

    def kill(self) -> None:
        if self._process.poll() is None:
            self.waits.look()
            self._process.kill()
            print(self._process.communicate()[1])    # what it had to say, for the report of a test that failed
            self.code = self._process.poll()


def assert_clean(code: int, errors: str) -> None:
    """Check how a process ended."""
    assert code == 0, errors
    assert 'Traceback' not in errors
    assert 'Exception' not in errors


@contextmanager
def running(*words: str, folder: Path | None = None, prepare: Callable[[], None] = restore_interrupt,
            program: str = 'sim_node', afresh: bool = False, options: Sequence[str] = ()) -> Iterator[NodeProcess]:
    process = NodeProcess(*words, folder=folder, prepare=prepare, program=program, afresh=afresh, options=options)
    try:
        yield process
    finally:
        process.kill()
