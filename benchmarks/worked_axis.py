# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Make the exports of docs/worked_axis.md, and quote its commands: a belt axis whose truth is known.

    python3 -m benchmarks.worked_axis data     # runs/worked/run1.csv to run3.csv
    python3 -m benchmarks.worked_axis          # the page and its picture, too
"""

import pathlib
import shutil
import sys
from collections.abc import Mapping

import numpy as np

from stickslip_sim.identification.prediction import predict
from stickslip_sim.identification.report import draw_prediction
from stickslip_sim.inputs import load_scene
from stickslip_sim.runs import simulate
from stickslip_sim.scene.load import changed

from .page import excerpt, quoted, replace_generated, said, shown

PAGE, PICTURE = pathlib.Path('docs/worked_axis.md'), pathlib.Path('docs/images/worked_prediction.png')
EXAMPLES, RUNS = 'examples/worked_axis', pathlib.Path('runs/worked')
TRUTH = {                  # where it is not as in start.yaml
    'axis.drive_stiffness': 4.2e5, 'axis.drive_damping': 2500.0, 'friction.kinetic.initial': 0.115,
    'friction.kinetic.limit': 0.06, 'friction.kinetic.stribeck_velocity': 0.008, 'friction.kinetic.viscous': 0.2,
}
FEEDS = {                  # of each run: s, m/s
    1: ((0.3, 0.0), (1.6, 0.002), (0.4, 0.03), (0.4, 0.08), (1.4, -0.003)),
    2: ((0.3, 0.0), (1.6, -0.0015), (0.4, -0.05), (0.4, 0.0), (1.4, 0.004)),
    3: ((0.3, 0.0), (1.4, 0.0025), (0.4, 0.0), (0.4, -0.02), (1.6, -0.002)),
}
DRIFT = {1: 1.0, 2: 0.985, 3: 0.99}    # of friction, from run to run
RATED = 15.0 * 2.0 * np.pi / 0.12      # N: 15 N m, 120 mm a turn
OFFSET, NOISE = 0.8, 0.3               # of the torque, % of rated
ENCODER = 1e-6                         # m
PERIOD, DELAY, STEP = 0.004, 0.001, 0.0005    # s: of the trace; of its position; of the simulation
DISABLED = 0.1                         # s at the beginning: the drive is not yet enabled, and shows no torque
COMMANDS: Mapping[str, str] = {        # by the name of the part of the page
    'import': f'import {RUNS}/run1.csv --columns'
              ' "time=Time,position=Pos. actual,drive_position=Pos. command,drive_force=Torque"'
              f' --lead "120 mm" --rated "15 N m" --from {DISABLED} --stick-velocity 0.004 --out {RUNS}/m1',
    'plot': f'plot {RUNS}/m1 --out {RUNS}/m1.png',
    'friction': f'friction {RUNS}/m1 --scene {EXAMPLES}/start.yaml --slowest 0.001 --direction forward'
                f' --csv {RUNS}/curve.csv',
    'identify': f'identify {RUNS}/m1 {RUNS}/m2 --scene {EXAMPLES}/start.yaml --free {EXAMPLES}/free.yaml'
                f' --each friction.scale --out {RUNS}/found',
    'predict': f'predict {RUNS}/found/identified.yaml {RUNS}/m3 --out {RUNS}/prediction',
    'drifted': f'predict {RUNS}/found/identified.yaml {RUNS}/m3 --set friction.scale=0.9925',
    'compare': f'compare {RUNS}/m3 {RUNS}/found/identified.yaml --set friction.scale=0.9925 --out {RUNS}/beside',
}

LEFT_OUT = r'(?:note|m3): | +(?:velocity and acc|87 readings|note: (?:2 runs|the drive))|not best|fewer than'


def main() -> None:
    """Make the exports; without `data`, write the page and draw its picture, too."""
    data()
    if sys.argv[1:] != ['data']:
        page()


def data() -> None:
    """Write what the controller exports of each run."""
    RUNS.mkdir(parents=True, exist_ok=True)
    for k, feed in FEEDS.items():
        (RUNS / f'run{k}.csv').write_text(export(k, feed), encoding='latin-1', newline='')
        print(f'written: {RUNS}/run{k}.csv')


def export(k: int, feed: tuple[tuple[float, float], ...]) -> str:
    """Return the trace of a run as a drive controller exports it, all its sensors with their errors."""
    durations, velocities = zip(*feed, strict=True)
    begins = np.cumsum((0.0, *durations[:-1])).round(3)
    scene = changed(load_scene(f'{EXAMPLES}/start.yaml'), TRUTH | {
        'friction.scale': DRIFT[k], 'drive.course': 'steps', 'drive.times': tuple(begins.tolist()),
        'drive.velocities': velocities})
    samples = simulate(scene, round(sum(durations), 3), STEP).samples
    rows = np.arange(0, len(samples['time']), round(PERIOD / STEP))
    late = np.maximum(rows - round(DELAY / STEP), 0)
    noise = NOISE * np.random.default_rng(k).standard_normal(len(rows))
    times = samples['time'][rows]
    torque = np.where(times < DISABLED, 0.0, 100.0 * samples['drive_force'][rows] / RATED + OFFSET + noise)
    position = ENCODER * np.round(samples['position'][late] / ENCODER)
    columns = 1e3 * times, 1e3 * samples['drive_position'][rows], 1e3 * position, torque
    lines = [f'Trace;Axis X;Run {k}', f'Sampling;{1e3 * PERIOD:.0f} ms', '', 'Time;Pos. command;Pos. actual;Torque',
             'ms;mm;mm;% rated']
    lines += [f'{time:.0f};{command:.4f};{actual:.3f};{force:.1f}'.replace('.', ',')
              for time, command, actual, force in zip(*columns, strict=True)]
    return '\r\n'.join([*lines, 'EOF', ''])


def steps() -> list[tuple[str, str]]:
    """Return the commands in their order, the imports of all runs among them, with the part that shows each."""
    first = COMMANDS['import']
    more = [('', first.replace('run1', f'run{k}').replace('m1', f'm{k}')) for k in (2, 3)]
    return [('import', first), *more, *((name, command) for name, command in COMMANDS.items() if name != 'import')]


def page() -> None:
    """Run the commands of the page, quote them with what they print, and draw the prediction."""
    for made in ('m1', 'm2', 'm3', 'found', 'prediction', 'beside'):
        shutil.rmtree(RUNS / made, ignore_errors=True)
    head = (RUNS / 'run1.csv').read_text(encoding='latin-1').splitlines()[:7]
    replace_generated(PAGE, quoted('\n'.join(head)), 'export')
    replace_generated(PAGE, f'```yaml\n{pathlib.Path(EXAMPLES, "free.yaml").read_text(encoding="utf-8")}```\n', 'free')
    for name, command in steps():
        printed = excerpt(said(command), LEFT_OUT)
        if name:
            replace_generated(PAGE, f'{shown(command)}\n\n{quoted(printed)}', name)
    drifted = changed(load_scene(str(RUNS / 'found/identified.yaml')), {'friction.scale': 0.9925})
    draw_prediction(predict(drifted, RUNS / 'm3'), PICTURE)


if __name__ == '__main__':
    main()
