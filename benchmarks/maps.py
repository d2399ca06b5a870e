# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Run the study of docs/maps.md and put its figures and pictures there: `python3 -m benchmarks.maps` (two minutes).

`python3 -m benchmarks.maps throughput` measures again only what a point costs, here and by scipy; other parts are
`pictures`, `critical` and `uncertainty`.
"""

import math
import pathlib
import shlex
import shutil
import statistics
import sys
import time
from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from stickslip_sim.bench.peers import scipy_ivp
from stickslip_sim.bench.problem import Outcome, Problem, Setting
from stickslip_sim.core.types import EventKind
from stickslip_sim.inputs import load_scene
from stickslip_sim.scene import Scene
from stickslip_sim.study import EvenGrid, Motion, Saltelli, Study, variation
from stickslip_sim.study.table import lines, rows_of
from stickslip_sim.study.uncertainty import load_uncertain

from . import page
from .page import quoted, replace_generated, said

PAGE = pathlib.Path('docs/maps.md')
RUNS, IMAGES = pathlib.Path('runs/maps'), pathlib.Path('docs/images')
CONSTANT = ('--set friction.static.law=constant --set friction.static.initial=0.24 '
            '--set friction.kinetic.velocities=[0.0] --set friction.kinetic.coefficients=[0.12]')
PICTURES = {   # by the name of the part of the page: the commands, the last of which draws
    'stiffness': (
        'sweep paper_fig7 --over drive.velocity=1e-4:0.1:160:log --over axis.drive_stiffness=1e5:1e7:100:log'
        ' --out runs/maps/stiffness',
        'map runs/maps/stiffness --out runs/maps/map_stiffness.png --pick 0.002,6e5 --pick 0.02,6e5'
        ' --pick 0.033,6e5 --pick 0.06,6e5'),
    'damping': (
        f'sweep paper_fig4_constant {CONSTANT} --over drive.velocity=1e-3:0.2:160:log'
        ' --over axis.drive_damping=50:8000:100:log --out runs/maps/damping',
        'map runs/maps/damping --out runs/maps/map_damping.png --pick 0.005,1000 --pick 0.03,1000'
        ' --pick 0.05,1000 --pick 0.04,6000'),
    'load': (
        'sweep paper_fig8 --over drive.velocity=1e-3:0.06:160 --over axis.normal_force=200:5000:100'
        ' --out runs/maps/load',
        'map runs/maps/load --out runs/maps/map_load.png --show stick_share --pick 0.005,3432'
        ' --pick 0.02,3432 --pick 0.025,2300 --pick 0.04,4800'),
    'bifurcation': (
        'sweep paper_fig8 --over drive.velocity=1e-4:0.06:400:log --out runs/maps/feed',
        'map runs/maps/feed --out runs/maps/bifurcation.png'),
    'groups': (
        'sweep paper_fig8 --over axis.drive_stiffness=5e5:6e6:600 --out runs/maps/groups',
        'map runs/maps/groups --out runs/maps/bifurcation_stiffness.png'),
}
CRITICAL = (
    'critical paper_fig7 --of drive.velocity',
    'critical paper_fig8 --of drive.velocity --set axis.normal_force=4500.0',
    'critical paper_fig8 --of axis.normal_force --set drive.velocity=0.01 --between 200:5000',
    f'critical paper_fig4_constant {CONSTANT} --of drive.velocity',
    'critical stribeck --of drive.velocity',
)
UNCERTAIN = ('uncertainty paper_fig7 --with examples/friction.yaml --set drive.velocity=0.025 --samples 512'
             ' --out runs/maps/uncertainty --plot runs/uncertainty.png')
SETTING = Setting(1e-8, 'tolerance')
MACHINES, CORES = (1, 4, 16), 16   # of a cluster, and of each machine
MILLION, CHUNKS = 1_000_000, 500   # points, and the pieces that are handed out
_ROUNDS, _BY_SCIPY = 3, 12   # sweeps that are timed; points that scipy runs


class Cost(NamedTuple):
    """Of a point of a grid: s of processor time by us and by scipy.

    `difference` is how far the last periods are apart, relative, at most, where scipy finds all break-aways; in
    `flawed` of `by_scipy` points it does not.
    """

    name: str
    points: int
    ours: float
    scipy: float
    difference: float
    flawed: int
    by_scipy: int


def main() -> None:
    """Write the parts of the page that are asked for, or all."""
    for name in sys.argv[1:] or PARTS:
        PARTS[name]()


def pictures() -> None:
    """Sweep and draw."""
    shutil.rmtree(RUNS, ignore_errors=True)
    for name, commands in PICTURES.items():
        replace_generated(PAGE, '\n'.join(map(shown, commands)) + '\n', name)
        for command in commands:
            said(command)
        _keep_picture(commands[-1])


def critical() -> None:
    """Find the critical values."""
    parts = [f'{shown(command)}\n\n{quoted(said(command))}' for command in CRITICAL]
    replace_generated(PAGE, '\n'.join(parts), 'critical')


def uncertainty() -> None:
    """Run an axis whose friction is known only roughly."""
    shutil.rmtree(RUNS / 'uncertainty', ignore_errors=True)
    replace_generated(PAGE, f'{shown(UNCERTAIN)}\n\n{quoted(said(UNCERTAIN))}', 'uncertainty')
    _keep_picture(UNCERTAIN)


def throughput() -> None:
    """Measure what a point costs, here and by scipy, and reckon what a million do."""
    costs = [measured(name) for name in ('paper_fig7', 'paper_fig8')]
    replace_generated(PAGE, throughput_table(costs), 'throughput')
    known = [(f'{cost.name}: feed and stiffness', cost.ours) for cost in costs]
    known.append(('paper_fig7: examples/friction.yaml', of_the_uncertain()))
    replace_generated(PAGE, million_table(known), 'million')


PARTS = {'pictures': pictures, 'critical': critical, 'uncertainty': uncertainty, 'throughput': throughput}


def measured(name: str) -> Cost:
    """Sweep a grid of feeds and stiffnesses in this process, and some of its points by scipy, for as long each."""
    scene = load_scene(name)
    study = Study(scene.values, EvenGrid((variation('drive.velocity=5e-4:0.03:50:log'),
                                      variation('axis.drive_stiffness=3e5:3e6:40:log'))))
    ours = statistics.median(_seconds(study) for _ in range(_ROUNDS)) / study.count
    chosen = np.linspace(0, study.count - 1, _BY_SCIPY).astype(int)
    figures, points = study.figures(0, study.count), study.points(0, study.count)
    seconds, differences, flawed = [], [], 0
    _run_of_scipy(study.scene, 1.0)()   # what it compiles is not in the times
    for k in chosen:
        run = _run_of_scipy(study.scene_at(points[k]), float(figures.duration[k]))
        begin = time.process_time()
        events = run().events
        seconds.append(time.process_time() - begin)
        breaks = events[events[:, 1] == EventKind.BREAKAWAY, 0]
        if len(breaks) != figures.cycles[k] + 1:
            flawed += 1
        elif figures.motion[k] == Motion.STICK_SLIP:
            differences.append(abs((breaks[-1] - breaks[-2]) / figures.period[k] - 1.0))
    return Cost(name, study.count, ours, statistics.mean(seconds), max(differences), flawed, len(chosen))


def _run_of_scipy(scene: Scene, duration: float) -> Callable[[], Outcome]:
    """Return what runs a scene with scipy."""
    problem = Problem(scene.name, '', scene.axis, scene.initial, scene.drive, scene.force, duration)
    return scipy_ivp.SCIPY_PEERS[0].prepare(problem, SETTING)


def throughput_table(costs: list[Cost]) -> str:
    """Return what a point costs as a table."""
    rows = [f'| {c.name} | {c.points} | {1e6 * c.ours:.0f} µs | {1e3 * c.scipy:.0f} ms | {c.scipy / c.ours:,.0f} × '
            f'| {c.difference:.0e} | {c.flawed} of {c.by_scipy} |\n' for c in costs]
    return ('| scene | points | ours, a point | scipy, a point | ratio | periods differ by '
            '| scipy misses break-aways |\n|---|---|---|---|---|---|---|\n' + ''.join(rows))


def million_table(costs: list[tuple[str, float]]) -> str:
    """Return what a million points take on so many cores, each as fast as this one, by the s that one point costs."""
    heads = ('study', 'a point', 'one core', *(f'{n} machine{"s" if n > 1 else ""}' for n in MACHINES))
    rows = []
    for name, cost in costs:
        turns = (math.ceil(CHUNKS / cores) for cores in (1, *(CORES * n for n in MACHINES)))
        times = ' | '.join(_duration(turn * MILLION / CHUNKS * cost) for turn in turns)
        rows.append(f'| {name} | {1e6 * cost:.0f} µs | {times} |\n')
    return f'| {" | ".join(heads)} |\n|{"---|" * len(heads)}\n' + ''.join(rows)


def of_the_uncertain() -> float:
    """Return what a point of examples/friction.yaml costs: each takes a scene of its own."""
    known = load_uncertain('examples/friction.yaml')
    study = Study(load_scene('paper_fig7').values, Saltelli(known.distributions, 128, known.seed))
    return statistics.median(_seconds(study) for _ in range(_ROUNDS)) / study.count


def _duration(seconds: float) -> str:
    return f'{seconds:.2g} s' if seconds < 60.0 else f'{seconds / 60.0:.2g} min'


def _seconds(study: Study) -> float:
    """Return what all lines of the table of a study cost, s of processor time."""
    begin = time.process_time()
    lines(study, rows_of(study.points(0, study.count), study.figures(0, study.count)))
    return time.process_time() - begin


def picture_of(command: str) -> pathlib.Path:
    """Return the picture that a command draws."""
    return next(pathlib.Path(word) for word in shlex.split(command) if word.endswith('.png'))


def _keep_picture(command: str) -> None:
    """Make the picture of a command that of the page."""
    picture = picture_of(command)
    shutil.copyfile(picture, IMAGES / picture.name)


def shown(command: str) -> str:
    """Return a command as the page shows it."""
    return page.shown(command, 'python3 -m stickslip_sim')


if __name__ == '__main__':
    main()
