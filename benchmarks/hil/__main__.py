# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Measure the bench for controllers beside a bare node, and the highest rate that it holds; write the page.

    python3 -m benchmarks.hil [--seconds 10] [--repeats 5] [--out docs/hil_figures.md] [--json runs/bench/hil.json]
"""

import argparse
import json
import sys
from pathlib import Path

from stickslip_sim.inputs import load_scene

from ..loop import machine
from . import yardstick
from .measure import measure, summary
from .page import RATE, ROUNDS, page
from .process import COMMANDS, SCENE, SIMULATING

RATES = (1000, 2000, 4000, 6000, 8000, 10_000, 12_000)
TOLERANCE = 1e-3                                    # of the rate: two looks at a step and a clock, ms apart
Figures = dict[str, float]


def main() -> None:
    """Measure and write."""
    options = parse()
    runs: dict[str, list[Figures]] = {case: [] for case in COMMANDS}
    for _ in range(options.repeats):
        for case in COMMANDS:
            runs[case].append(print_figures(case, measure(case, RATE, options.seconds)))
    why_not = yardstick.missing()
    rates = {priority: search(options.seconds, priority) for priority in ((0,) if why_not else (0, yardstick.PRIORITY))}
    found = {'machine': machine(), 'seconds': options.seconds, 'repeats': options.repeats, 'runs': runs,
             'cases': {case: summary(figures) for case, figures in runs.items()}, 'rates': rates,
             'yardsticks': yardstick.compare(options.seconds, options.repeats, print_lateness),
             'no_priority': why_not,
             'troubles': {priority: {rate: (loss(float(rate), figures), lag(figures)) for rate, figures in row.items()}
                          for priority, row in rates.items()}}
    for file, text in ((options.json, json.dumps(found, indent=1) + '\n'), (options.out, page(found))):
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(text, encoding='utf-8')


def search(seconds: float, priority: int) -> dict[str, Figures]:
    """Return the figures of the node at higher and higher rates, up to the first at which steps are lost."""
    found: dict[str, Figures] = {}
    for rate in RATES:
        found[str(rate)] = summary([print_figures(f'{rate} 1/s', measure(SIMULATING, float(rate), seconds, priority))
                                    for _ in range(ROUNDS)])
        if loss(rate, found[str(rate)]):
            break
    return found


def loss(rate: float, figures: Figures) -> str:
    """Return which steps were not made on the clock, heard and recorded, or an empty text."""
    if abs(figures['rate'] / rate - 1.0) > TOLERANCE:
        return f'{figures["rate"]:.1f} steps a second'
    return ', '.join(f'{figures[name]:.0f} steps {name}' for name in ('unheard', 'unrecorded') if figures[name])


def lag(figures: Figures) -> str:
    """Return that more steps are late than the scene allows, or an empty text."""
    if figures['overruns'] <= load_scene(SCENE).timing.max_overruns:
        return ''
    return f'{figures["overruns"]:.1%} of the steps begin more than a period late'


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
    parser.add_argument('--out', type=Path, default=Path('docs/hil_figures.md'), help='[%(default)s]')
    parser.add_argument('--json', type=Path, default=Path('runs/bench/hil.json'), help='[%(default)s]')
    options = parser.parse_args()
    if not 4.0 <= options.seconds <= 3600.0 or options.repeats < 1:
        parser.error('give --seconds 4 to 3600 and --repeats of at least 1')
    return options


if __name__ == '__main__':
    main()
