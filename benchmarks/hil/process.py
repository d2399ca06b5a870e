# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""A node beside a controller, each in a process of its own: how they run, and one run in figures."""

import json
import os
import signal
import statistics
import subprocess
import sys
import tempfile
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

import numpy as np

from stickslip_sim.recording import open_bag

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


# One run in figures: from the controller, from the bag, from the node itself.

ANSWERS = 1000    # per second at most: what a servo drive takes
COUNTS = ('unheard', 'unrecorded', 'dropped')


def measure(case: str, rate: float, seconds: float, priority: int = 0) -> dict[str, float]:
    """Return the figures of a run of a case of COMMANDS; durations in s, `priority` of SCHED_FIFO, 0: none."""
    with tempfile.TemporaryDirectory() as parent:
        folder = Path(parent, 'run')
        with running(COMMANDS[case](rate, folder, priority)) as process:
            figures = control(process.pid, seconds, max(round(rate / ANSWERS), 1))
        out = process.stdout.read() if process.stdout else ''
        of_node = json.loads(out) if out else node_figures(folder)
        return {**figures, **of_node, **(bag_figures(folder) if folder.exists() else {})}


def node_figures(folder: Path) -> dict[str, float]:
    """Return what the node published on `timing`, without the second of its start and the one that was cut short.

    Of the quantiles the median over the seconds; `overruns` is their share of the steps.
    """
    run = open_bag(folder)
    table = {name: column[1:-1] for name, column in run.columns('/timing').items()}
    figures = {name: float(np.nanmedian(table[name])) for name in table if name.endswith(('_p50', '_p99'))}
    return {**figures, 'dropped': float(run.receipt['dropped_messages']),
            'lateness_max': float(table['lateness_max'].max()),
            'overruns': float(table['overruns'].sum() / table['steps'].sum())}


def bag_figures(folder: Path) -> dict[str, float]:
    """Return how many steps of the run are not in its bag."""
    steps = open_bag(folder).columns('/slider_state')['step']
    return {'unrecorded': int(steps[-1]) + 1 - len(np.unique(steps))}


def summary(runs: list[dict[str, float]]) -> dict[str, float]:
    """Return the figures of several runs as one: sums of counts, the worst of maxima, else medians."""
    return {name: _combine(name)([run[name] for run in runs]) for name in runs[0]}


def _combine(name: str) -> Callable[[list[float]], float]:
    if name in COUNTS:
        return sum
    return max if name.endswith('_max') else statistics.median
