# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The pictures of docs/closed_loop.md, by the commands there: `python3 -m benchmarks.loops_page` (minutes).

With `cost` behind it: what the loops of the page cost, one of 5 s, and a thousand axes; the cascade, with an encoder of
0.1 µm, at 1 kHz.  Processor time, of all processes; medians of five single loops.
"""

import os
import re
import shlex
import shutil
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from functools import partial
from pathlib import Path
from statistics import median
from typing import Any

import stickslip_sim as stickslip

PAGE = Path('docs/closed_loop.md').read_text(encoding='utf-8')
PICTURES = {'gains.png': 'loop_gains.png', 'tune.png': 'loop_tune.png', 'runs/thousand/map.png': 'loop_map.png'}


def blocks(language: str) -> list[str]:
    """Return the blocks of the page in a language."""
    return re.findall(rf'^```{language}\n(.*?)^```$', PAGE, re.MULTILINE | re.DOTALL)


def page_commands() -> list[list[str]]:
    """Return the words of the commands of the page behind `stickslip`."""
    found = re.findall(r'^    stickslip ((?:.*\\\n)*.*)$', PAGE, re.MULTILINE)
    return [shlex.split(command.replace('\\\n', ' ')) for command in found]


def write_inputs(folder: Path) -> None:
    """Write the controller, the setpoint and the limits of the page into a folder."""
    for name, language in (('my_controller.py', 'python'), ('move.csv', 'csv'), ('limits.yaml', 'yaml')):
        (folder / name).write_text(blocks(language)[0], encoding='utf-8')


DURATION, AXES = 5.0, 1000
OVER = {'friction.scale': (0.8, 1.2), 'axis.drive_stiffness': '3e5:1e6:log'}
LIMITS = 'limits:\n  following_error: {max: 2.0e-4}\n'
AXIS = {'encoder.resolution': 1e-7, 'drive.course': 'constant', 'drive.velocity': 0.0}
FAULTS = {'faults.ids': ['lost'], 'faults.kinds': ['encoder_dropout'], 'faults.starts': [1.0],
          'faults.durations': [1.0], 'faults.values': [0.5]}


def setpoint(at: float) -> float:
    """Return the position of a move of 2 mm, m."""
    return min(0.001 * at, 0.002)


def spent(call: Callable[[], object]) -> tuple[float, float]:
    """Return processor time and wall time of a call, s."""
    begin, before = time.perf_counter(), time.process_time()
    call()
    return time.process_time() - before, time.perf_counter() - begin


def print_costs() -> None:
    """Measure, and print a line each."""
    given: dict[str, Any] = {}
    for block in blocks('python'):
        if block.startswith(('class ', 'import numpy')):
            exec(block.partition('\nloops =')[0], given)
    faulty = stickslip.load_scene('positioning', AXIS | FAULTS)

    def loop() -> Any:
        return stickslip.close_loop(given['Cascade'](), faulty, DURATION, setpoint=setpoint)

    with tempfile.TemporaryDirectory() as folder:
        place = Path(folder)
        (place / 'limits.yaml').write_text(LIMITS)
        (place / 'own.py').write_text(next(block for block in blocks('python') if block.startswith('class Cascade')))
        alone = [spent(loop) for _ in range(6)]
        kept = [spent(lambda number=number: loop().save(place / str(number)))  # type: ignore[misc]
                for number in range(6)]
        for name, found in (('one loop', alone), ('one loop and its bag', kept)):
            print(f'{name}: {1e3 * median(one[0] for one in found[1:]):.0f} ms')
        many = partial(stickslip.close_loops, scene=stickslip.load_scene('positioning', AXIS), duration=DURATION,
                       over=OVER, samples=AXES, setpoint=setpoint)
        print(f'{AXES} axes on arrays: {spent(lambda: many(given["Lanes"], vectorized=True))[0]:.1f} s')
        wall = spent(lambda: many(f'{place / "own.py"}:Cascade', limits=str(place / 'limits.yaml'), workers=2))[1]
        print(f'{AXES} axes with limits, two processes: {wall:.1f} s of wall time')


def main() -> None:
    """Run all in a folder that vanishes."""
    images = Path('docs/images').resolve()
    with tempfile.TemporaryDirectory() as name:
        write_inputs(Path(name))
        paths = os.pathsep.join(filter(None, map(os.path.abspath, sys.path)))
        for words in page_commands():
            subprocess.run([sys.executable, '-m', 'stickslip_sim', *words], cwd=name, check=False,
                           env={**os.environ, 'PYTHONPATH': paths})
        for made, picture in PICTURES.items():
            shutil.copy(Path(name) / made, images / picture)
            print(f'written: docs/images/{picture}')


if __name__ == '__main__':
    print_costs() if sys.argv[1:] == ['cost'] else main()
