# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The node under SCHED_FIFO beside what could be expected of it: a bare node, a bare loop, and the kernel itself.

All beside two busy processes, in turns, in one run.
"""

import json
import subprocess
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager

from stickslip_sim.realtime.scheduling import Scheduling, StepThread

from . import kernel
from .measure import measure, summary
from .process import RECORDING_BARE, SIMULATING

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
    if kernel.is_there() and priority:
        yield KERNEL, lambda rate: kernel.measure(rate, seconds, priority)


def _bare_loop(rate: float, seconds: float, priority: int) -> Figures:
    done = subprocess.run([sys.executable, '-m', 'benchmarks.hil.bare_loop', '--rate', str(rate), '--seconds',
                           str(seconds), '--priority', str(priority)], check=True, stdout=subprocess.PIPE, text=True)
    figures: Figures = json.loads(done.stdout)
    return figures
