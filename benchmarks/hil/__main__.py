# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Measure the bench for controllers beside a bare node, and the highest rate that it holds: docs/data/hil.json.

    python3 -m benchmarks.hil [--seconds 10] [--repeats 5] [--out docs/data/hil.json]
"""

import argparse
import sys
from collections.abc import Iterator
from pathlib import Path

from stickslip_sim.inputs import load_scene

from ..loop import machine
from ..measured import DATA, keep
from . import yardstick
from .process import COMMANDS, SCENE, SIMULATING, measure, summary

RATE = 1000.0                                       # 1/s, of the comparison
RATES = (1000, 2000, 4000, 6000, 8000, 10_000, 12_000)
ROUNDS = 3                                          # at each of them: the machine stalls now and then, for some 30 ms
TOLERANCE = 1e-3                                    # of the rate: two looks at a step and a clock, ms apart
Figures = dict[str, float]


def main() -> None:
    """Measure, and keep the figures."""
    options = parse()
    runs: dict[str, list[Figures]] = {case: [] for case in COMMANDS}
    for _ in range(options.repeats):
        for case in COMMANDS:
            runs[case].append(print_figures(case, measure(case, RATE, options.seconds)))
    why_not = yardstick.missing()
    rates = [row for priority in ((0,) if why_not else (0, yardstick.PRIORITY))
             for row in search(options.seconds, priority)]
    keep(options.out, command=f'python3 -m benchmarks.hil --seconds {options.seconds:g} --repeats {options.repeats}',
         machine=machine(), no_priority=why_not, beside=[{'node': case, **summary(of)} for case, of in runs.items()],
         rates=rates, busy=[{'target_rate': rate, 'keeper': keeper, **figures} for rate, by_name in yardstick.compare(
             options.seconds, options.repeats, print_lateness).items() for keeper, figures in by_name.items()])


def search(seconds: float, priority: int) -> Iterator[dict[str, object]]:
    """Yield the figures of the node at higher and higher rates, up to the first at which steps are lost."""
    for rate in RATES:
        figures = summary([print_figures(f'{rate} 1/s', measure(SIMULATING, float(rate), seconds, priority))
                           for _ in range(ROUNDS)])
        is_lossy = bool(abs(figures['rate'] / rate - 1.0) > TOLERANCE or figures['unheard'] or figures['unrecorded'])
        is_late = figures['overruns'] > load_scene(SCENE).timing.max_overruns
        yield {'priority': priority, 'target_rate': rate, 'is_lossy': is_lossy, 'is_late': is_late, **figures}
        if is_lossy:
            break


def print_figures(name: str, figures: Figures) -> Figures:
    """Show that a run is over."""
    sys.stderr.write(f'{name}: {figures["cpu"] * 1e6:.0f} µs a step, {figures["rate"]:.1f} steps a second\n')
    return figures


def print_lateness(name: str, figures: Figures) -> None:
    """Show that a run is over."""
    sys.stderr.write(f'{name}: {figures["overruns"]:.3%} late, worst {figures["lateness_max"] * 1e3:.2f} ms\n')


def parse() -> argparse.Namespace:
    """Return the options."""
    parser = argparse.ArgumentParser(prog='python3 -m benchmarks.hil', description=__doc__.splitlines()[0])
    parser.add_argument('--seconds', type=float, default=10.0, help='of each run [%(default)g]')
    parser.add_argument('--repeats', type=int, default=5, help='[%(default)s]')
    parser.add_argument('--out', type=Path, default=DATA / 'hil.json', help='[%(default)s]')
    options = parser.parse_args()
    if not 4.0 <= options.seconds <= 3600.0 or options.repeats < 1:
        parser.error('give --seconds 4 to 3600 and --repeats of at least 1')
    return options


if __name__ == '__main__':
    main()
