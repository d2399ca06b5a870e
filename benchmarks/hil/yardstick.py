# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The node under SCHED_FIFO beside what could be expected of it: a bare node, a bare loop, and the kernel itself.

All beside two busy processes, in turns, in one run.
"""

import json
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

import numpy as np

from stickslip_sim.realtime.scheduling import Scheduling, StepThread

from .process import RECORDING_BARE, SIMULATING, measure, summary

# What the kernel itself gives: cyclictest of rt-tests.

_LONGEST = 20_000    # µs in the histogram; what is later counts there


def has_cyclictest() -> bool:
    """Return whether cyclictest can be run."""
    return shutil.which('cyclictest') is not None


def cyclictest(rate: float, seconds: float, priority: int) -> dict[str, float]:
    """Return the lateness of the wake-ups of cyclictest at a rate, s; raises CalledProcessError."""
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder, 'found.json')
        subprocess.run(['cyclictest', '--mlockall', f'--priority={priority}', f'--interval={round(1e6 / rate)}',
                        f'--duration={max(round(seconds), 1)}', '--quiet', f'--histogram={_LONGEST}',
                        f'--json={file}'], check=True, capture_output=True)
        return kernel_figures(json.loads(file.read_text())['thread']['0'], 1.0 / rate)


def kernel_figures(thread: dict[str, object], period: float) -> dict[str, float]:
    """Return the figures of a thread of cyclictest, s; a wake-up later than the histogram reaches is at its end."""
    histogram = thread['histogram']
    assert isinstance(histogram, dict)
    late = np.array(list(map(int, histogram))) * 1e-6
    counts = np.array(list(histogram.values()))
    cycles = int(str(thread['cycles']))
    beyond = cycles - int(counts.sum())
    late, counts = np.append(late, float(str(thread['max'])) * 1e-6), np.append(counts, beyond)
    reached = np.cumsum(counts) / cycles
    return {'lateness_p50': float(late[np.searchsorted(reached, 0.5)]),
            'lateness_p99': float(late[np.searchsorted(reached, 0.99)]), 'lateness_max': float(late[-1]),
            'overruns': float(counts[late > period].sum() / cycles)}


# The cases.

PRIORITY = 80
RATES = (1000.0, 4000.0)
BUSY = 2
LOOP, KERNEL = 'bare loop in Python, no ROS', 'cyclictest'   # of rt-tests (Debian: apt install rt-tests)
Figures = dict[str, float]


def missing() -> str:
    """Return why this machine has no SCHED_FIFO to give, or an empty text."""
    return '; '.join(StepThread(Scheduling(thread_priority=PRIORITY)).missing)


def compare(seconds: float, repeats: int, show: Callable[[str, Figures], object]) -> dict[float, dict[str, Figures]]:
    """Return the figures of each case by rate and name; without SCHED_FIFO all run as any process does."""
    priority = 0 if missing() else PRIORITY
    cases = dict(_cases(seconds, priority))
    found: dict[float, dict[str, list[Figures]]] = {rate: {name: [] for name in cases} for rate in RATES}
    with busy():
        for rate in RATES:
            for _ in range(repeats):
                for name, case in cases.items():
                    found[rate][name].append(figures := case(rate))
                    show(f'{name}, {rate:g} 1/s', figures)
    return {rate: {name: summary(runs) for name, runs in by_name.items()} for rate, by_name in found.items()}


@contextmanager
def busy() -> Iterator[None]:
    """Keep the cores busy meanwhile."""
    processes = [subprocess.Popen([sys.executable, '-c', 'while True: pass']) for _ in range(BUSY)]
    try:
        yield
    finally:
        for process in processes:
            process.kill()
            process.wait()


def _cases(seconds: float, priority: int) -> Iterator[tuple[str, Callable[[float], Figures]]]:
    """Yield what to run at a rate, by its name."""
    for name in (SIMULATING, RECORDING_BARE):
        yield name, lambda rate, name=name: measure(name, rate, seconds, priority)  # type: ignore[misc]
    yield LOOP, lambda rate: _bare_loop(rate, seconds, priority)
    if has_cyclictest() and priority:
        yield KERNEL, lambda rate: cyclictest(rate, seconds, priority)


def _bare_loop(rate: float, seconds: float, priority: int) -> Figures:
    done = subprocess.run([sys.executable, '-m', 'benchmarks.hil.bare_loop', '--rate', str(rate), '--seconds',
                           str(seconds), '--priority', str(priority)], check=True, stdout=subprocess.PIPE, text=True)
    figures: Figures = json.loads(done.stdout)
    return figures
