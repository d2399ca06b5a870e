# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""A node beside a controller, each in a process of its own, and what the kernel accounts to the node."""

import json
import os
import signal
import subprocess
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

from ..loop import executable

SCENE = 'paper_fig8'
PATIENCE = 60.0    # s for a process to end


def node_command(rate: float, folder: Path, priority: int = 0) -> list[str]:
    """Return how to start the installed node on the paper's scene, recording into a folder."""
    real_time = ['-p', f'thread_priority:={priority}', '-p', 'lock_memory:=true'] if priority else []
    return [executable('sim_node'), '--ros-args', '--log-level', 'error', '-p', f'scene:={SCENE}',
            '-p', f'time.rate:={rate}', '-p', 'record.enabled:=true', '-p', f'record.folder:={folder}',
            *real_time]


def bare_command(rate: float, _: Path, priority: int = 0) -> list[str]:
    """Return how to start the bare node."""
    return [sys.executable, '-m', 'benchmarks.hil.bare_node', '--rate', str(rate), '--priority', str(priority)]


def recording_bare_command(rate: float, folder: Path, priority: int = 0) -> list[str]:
    """Return how to start the bare node with a recording."""
    return [*bare_command(rate, folder, priority), '--bag', str(folder)]


# The nodes to measure, by what they are called, with how to start them at a rate (1/s) and with SCHED_FIFO.
COMMANDS: dict[str, Callable[[float, Path, int], list[str]]] = {
    'bare node': bare_command,
    'bare node, recording': recording_bare_command,
    '`sim_node`, recording': node_command,
}
_, RECORDING_BARE, SIMULATING = COMMANDS


@contextmanager
def running(command: list[str]) -> Iterator[subprocess.Popen[str]]:
    """Run a program and end it as Ctrl-C does; its standard output can then be read.  Fails unless it ends well."""
    process = subprocess.Popen(command, stdout=subprocess.PIPE, text=True, start_new_session=True)
    try:
        yield process
        if process.poll() is None:
            process.send_signal(signal.SIGINT)
        if process.wait(PATIENCE) != 0:
            raise SystemExit(f'{command[0]} ended with exit code {process.returncode}')
    finally:
        process.kill()
        process.wait()


def control(pid: int, seconds: float, stride: int = 1, priority: int = 0) -> dict[str, float]:
    """Run a controller beside a node, with a priority of SCHED_FIFO (0: none); return its figures."""
    done = subprocess.run([sys.executable, '-m', 'benchmarks.hil.controller', '--pid', str(pid), '--seconds',
                           str(seconds), '--stride', str(stride), '--priority', str(priority)],
                          check=False, stdout=subprocess.PIPE, text=True)
    if done.returncode != 0:
        raise SystemExit(f'the controller ended with exit code {done.returncode}')
    figures: dict[str, float] = json.loads(done.stdout)
    return figures


def resident(pid: int) -> int:
    """Return the memory of a process that is in RAM, bytes."""
    return int(Path(f'/proc/{pid}/statm').read_text().split()[1]) * os.sysconf('SC_PAGE_SIZE')


def waited_seconds(pid: int) -> float:
    """Return how long the threads of a process that could run have waited for a core so far."""
    return sum(int(file.read_text().split()[1]) for file in Path(f'/proc/{pid}/task').glob('*/schedstat')) * 1e-9
