# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Write the stored reference: python -m tests.reference.make_data [--only NAME ...].

The file holds, for each scene, the exact parameters (doubles, by their repr), the duration, the events with 25
digits, and the state at some instants.  ``time_sensitivity`` of an event is |Δt| per relative change of mass,
stiffness and normal force (by +ε, -ε, +ε): the error in seconds that data with a relative error of 1 would
cause, were it linear; times 1e-16 it is what no double-precision engine can be blamed for.
"""

from __future__ import annotations

import argparse
import json
import sys
import time
from collections.abc import Iterator
from dataclasses import replace
from typing import Any

import mpmath
from mpmath import mpf

from stickslip_sim.core.input_profile import constant
from stickslip_sim.reference import automaton
from stickslip_sim.reference.exact_run import Run
from stickslip_sim.reference.problem import problem
from tests.support.stored_objects import exact_run, inputs_of
from tests.support.stored_runs import FILE

from .scenes import Scene, named_scenes, random_scenes, shipped_scenes

DIGITS = 25
MORE_DIGITS = 32  # of the paper's and the benchmark's runs
SAMPLES = 12
EPSILON = mpf(10) ** -20
NUMBERS = ('time', 'position', 'velocity', 'drive_force', 'friction_force', 'static_coefficient', 'rest_time')


def chosen_scenes() -> list[Scene]:
    """Return the named, the shipped and the random scenes."""
    return named_scenes() + shipped_scenes() + random_scenes()


def record(scene: Scene) -> dict[str, Any] | None:
    """Simulate a scene and return what is stored; None if unsuitable."""
    run = exact_run(scene.parameters, scene.duration)
    if run.disputed:
        return None
    sensitivity = _sensitivity(scene, run)
    if sensitivity is None:
        return None
    digits = DIGITS if scene.name.startswith('random') else MORE_DIGITS
    return {
        'duration': scene.duration,
        'parameters': scene.parameters,
        'events': events_table(run, digits) | {'time_sensitivity': sensitivity},
        'samples': samples_table(run, scene.duration),
    }


def events_table(run: Run, digits: int) -> dict[str, list[Any]]:
    """Return the events column by column, numbers as strings."""
    columns: dict[str, list[Any]] = {'kind': [e.kind for e in run], 'direction': [e.direction for e in run]}
    for name in NUMBERS:
        columns[name] = [mpmath.nstr(getattr(e, name), digits) for e in run]
    return columns


def samples_table(run: Run, duration: float) -> dict[str, list[Any]]:
    """Return the state at instants spread over the run."""
    times = [float(f'{duration * (k + 0.37) / SAMPLES:.6g}') for k in range(SAMPLES)]
    samples = run.state_at(times)
    columns: dict[str, list[Any]] = {'time': times}
    for name in ('position', 'velocity', 'drive_force', 'friction_force'):
        columns[name] = [mpmath.nstr(getattr(s, name), DIGITS) for s in samples]
    return columns


def _sensitivity(scene: Scene, run: Run) -> list[float] | None:
    """Return |Δt|/ε of every event, or None when the order of events depends on the last digits."""
    with mpmath.workdps(60):
        exact = problem(*inputs_of(scene.parameters))
        shifted = replace(
            exact,
            mass=exact.mass * (1 + EPSILON),
            stiffness=exact.stiffness * (1 - EPSILON),
            normal=constant(mpf(exact.normal.values[0]) * (1 + EPSILON)),
        )
    other = automaton.run(shifted, scene.duration, 40)
    if [(e.kind, e.direction) for e in other] != [(e.kind, e.direction) for e in run]:
        return None
    return [float(f'{float(abs(a.time - b.time) / EPSILON):.2g}') for a, b in zip(run, other)]


def records(only: list[str] | None) -> Iterator[tuple[str, dict[str, Any]]]:
    """Yield the stored scenes one by one."""
    for scene in chosen_scenes():
        if only is None or scene.name in only:
            begin = time.process_time()
            data = record(scene)
            count = len(data['events']['kind']) if data else 'left out'
            sys.stderr.write(f'{scene.name:22} events {count}  {time.process_time() - begin:.1f} s\n')
            if data:
                yield scene.name, data


def text(scenes: dict[str, dict[str, Any]]) -> str:
    """Return JSON with one column to a line."""
    return '{\n' + ',\n'.join(f'{json.dumps(n)}: {_block(d)}' for n, d in scenes.items()) + '\n}\n'


def _block(data: dict[str, Any]) -> str:
    parts = []
    for key, content in data.items():
        if isinstance(content, dict):
            rows = ',\n'.join(f'  {json.dumps(k)}: {json.dumps(v, separators=(",", ":"))}' for k, v in content.items())
            parts.append(f' {json.dumps(key)}: {{\n{rows}\n }}')
        else:
            parts.append(f' {json.dumps(key)}: {json.dumps(content)}')
    return '{\n' + ',\n'.join(parts) + '\n}'


def main() -> None:
    """Simulate and write."""
    parser = argparse.ArgumentParser(description='write the stored reference events')
    parser.add_argument('--only', nargs='+', metavar='NAME', help='simulate these anew and keep the others as stored')
    only = parser.parse_args().only
    scenes = json.loads(FILE.read_text(encoding='utf-8')) if only else {}
    scenes |= dict(records(only))
    FILE.write_text(text(scenes), encoding='utf-8')


if __name__ == '__main__':
    main()
