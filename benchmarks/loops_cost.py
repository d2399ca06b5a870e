# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""What closed loops cost: one of 5 s, and a thousand axes (docs/closed_loop.md): `python3 -m benchmarks.loops_cost`.

The cascade of the page, with an encoder of 0.1 µm, at 1 kHz.  Processor time, of all processes; medians of five single
loops.
"""

import re
import time
from collections.abc import Callable, Mapping
from functools import partial
from pathlib import Path
from statistics import median
from tempfile import TemporaryDirectory
from typing import Any

import stickslip_sim as stickslip

PAGE = Path('docs/closed_loop.md')
DURATION, AXES = 5.0, 1000
OVER = {'friction.scale': (0.8, 1.2), 'axis.drive_stiffness': '3e5:1e6:log'}
LIMITS = 'limits:\n  following_error: {max: 2.0e-4}\n'
AXIS = {'encoder.resolution': 1e-7, 'drive.course': 'constant', 'drive.velocity': 0.0}
FAULTS = {'faults.ids': ['lost'], 'faults.kinds': ['encoder_dropout'], 'faults.starts': [1.0],
          'faults.durations': [1.0], 'faults.values': [0.5]}


def setpoint(at: float) -> float:
    """Return the position of a move of 2 mm, m."""
    return min(0.001 * at, 0.002)


def classes() -> Mapping[str, Any]:
    """Return the classes of the page, by name."""
    found: dict[str, Any] = {}
    for block in re.findall(r'^```python\n(.*?)^```$', PAGE.read_text(encoding='utf-8'), re.MULTILINE | re.DOTALL):
        if block.startswith(('class ', 'import numpy')):
            exec(block.partition('\nloops =')[0], found)
    return found


def cost(call: Callable[[], object]) -> tuple[float, float]:
    """Return processor time and wall time of a call, s."""
    begin, spent = time.perf_counter(), time.process_time()
    call()
    return time.process_time() - spent, time.perf_counter() - begin


def main() -> None:
    """Measure, and print a line each."""
    given = classes()
    scene = stickslip.load_scene('positioning', AXIS)
    faulty = stickslip.load_scene('positioning', {**AXIS, **FAULTS})
    with TemporaryDirectory() as folder:
        place = Path(folder)
        (place / 'limits.yaml').write_text(LIMITS)
        (place / 'own.py').write_text(re.findall(r'^```python\n(class Cascade.*?)^```$',
                                                 PAGE.read_text(encoding='utf-8'), re.MULTILINE | re.DOTALL)[0])

        def saved(number: int) -> None:
            stickslip.close_loop(given['Cascade'](), faulty, DURATION, setpoint=setpoint).save(place / str(number))

        alone = [cost(lambda: stickslip.close_loop(given['Cascade'](), faulty, DURATION, setpoint=setpoint))
                 for _ in range(6)]
        kept = [cost(partial(saved, number)) for number in range(6)]
        for name, found in (('one loop', alone), ('one loop and its bag', kept)):
            print(f'{name}: {1e3 * median(one[0] for one in found[1:]):.0f} ms')
        arrays = cost(lambda: stickslip.close_loops(given['Lanes'], scene, DURATION, OVER, samples=AXES,
                                                    setpoint=setpoint, vectorized=True))
        print(f'{AXES} axes on arrays: {arrays[0]:.1f} s')
        many = cost(lambda: stickslip.close_loops(f'{place / "own.py"}:Cascade', scene, DURATION, OVER, samples=AXES,
                                                  setpoint=setpoint, limits=str(place / 'limits.yaml'), workers=2))
        print(f'{AXES} axes with limits, two processes: {many[1]:.1f} s of wall time')


if __name__ == '__main__':
    main()
