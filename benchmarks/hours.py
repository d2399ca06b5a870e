# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Measure what the tool takes for runs of hours at 1 kHz: time and memory of each command, and print a table.

    python3 -m benchmarks.hours [--hours 1 2] [--only plot compare] [--folder FOLDER]

The commands run one after the other, each in a process of its own.  Needs 3 GB of disk for each hour, in --folder.
"""

import argparse
import os
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import NamedTuple

SCENE = 'paper_fig8'
LIMITS = 'limits: {peak_speed: {max: 1.0}, sticks: {max: 1000000}, following_error: {max: 1.0}}\n'
MIB = 1 << 20
MARKS = {'samples': (6, 150), 'bag': (30, 150), 'verify': (30, 200), 'export': (15, 200), 'check': (15, 200),
         'compare': (15, 300), 'plot': (15, 300)}   # s, MB of an hour


class Cost(NamedTuple):
    """What a process took."""

    wall: float     # s
    cpu: float      # s
    memory: float   # MiB, the most that was resident


def commands(seconds: float, folder: Path) -> Mapping[str, list[str]]:
    """Return the measured commands by name; those behind `bag` read what it wrote."""
    duration, bag = ['--duration', f'{seconds:g}'], str(folder / 'bag')
    limits = ['--limits', str(folder / 'limits.yaml')]
    return {
        'samples': ['simulate', SCENE, *duration, '--samples', str(folder / 'samples.csv')],
        'bag': ['simulate', SCENE, *duration, '--bag', bag],
        'verify': ['verify', bag],
        'export': ['export', bag, '--csv', str(folder / 'states.csv')],
        'check': ['check', bag, *limits],
        'compare': ['compare', bag, '--out', str(folder / 'report')],
        'plot': ['plot', bag, '--out', str(folder / 'run.png')],
        'what if': ['verify', bag, '--set', 'drive.velocity=0.002', '--out', str(folder / 'what_if')],
        'check of a scene': ['check', SCENE, *duration, *limits],
        'compare of a scene': ['compare', SCENE, *duration, '--out', str(folder / 'scene')],
        'plot of a scene': ['plot', SCENE, *duration, '--out', str(folder / 'scene.png')],
    }


def cost_of(arguments: Sequence[str]) -> Cost:
    """Run the tool; return what it took.  Raises SystemExit when it fails."""
    begin = time.monotonic()
    child = subprocess.Popen([sys.executable, '-m', 'stickslip_sim', *arguments], stdout=subprocess.DEVNULL)
    _, status, usage = os.wait4(child.pid, 0)
    child.returncode = os.waitstatus_to_exitcode(status)
    if child.returncode:
        raise SystemExit(f'stickslip {" ".join(arguments)} ended with {child.returncode}')
    return Cost(time.monotonic() - begin, usage.ru_utime + usage.ru_stime, usage.ru_maxrss * 1024 / MIB)


def measured(hours: Iterable[float], only: Sequence[str], folder: Path) -> dict[str, list[Cost]]:
    """Return the costs of commands by name, in the order of the durations."""
    costs: dict[str, list[Cost]] = {}
    for number in hours:
        with tempfile.TemporaryDirectory(dir=folder) as own:
            (Path(own) / 'limits.yaml').write_text(LIMITS)
            for name, arguments in commands(3600.0 * number, Path(own)).items():
                if only and name not in (*only, 'bag'):
                    continue
                cost = cost_of(arguments)
                costs.setdefault(name, []).append(cost)
                print(f'{number:g} h  {name:20} {cost.wall:6.1f} s  {cost.cpu:6.1f} s CPU  {cost.memory:6.0f} MiB',
                      flush=True)
    return costs


def table(hours: Sequence[float], costs: Mapping[str, Sequence[Cost]]) -> str:
    """Return processor time and memory as a table, a row for each command."""
    heads = ['command', *(f'{number:g} h: s | MiB' for number in hours), 'mark of an hour: s | MB']
    rows = ['| ' + ' | '.join(heads) + ' |', '|---' * (2 * len(hours) + 3) + '|']
    for name, each in costs.items():
        mark = ' | '.join(map(str, MARKS[name])) if name in MARKS else '– | –'
        rows.append(f'| {name} | ' + ' | '.join(f'{one.cpu:.1f} | {one.memory:.0f}' for one in each) + f' | {mark} |')
    return '\n'.join(rows) + '\n'


def main() -> None:
    """Measure, and print the table."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument('--hours', type=float, nargs='+', default=[1.0, 2.0], help='durations that are simulated, h')
    parser.add_argument('--only', nargs='+', default=[], metavar='COMMAND', help='these commands')
    parser.add_argument('--folder', type=Path, default=None, help='where there is room')
    options = parser.parse_args()
    print(table(options.hours, measured(options.hours, options.only, options.folder)))


if __name__ == '__main__':
    main()
