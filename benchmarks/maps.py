# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Run the study of docs/maps.md and put its figures and pictures there: `python3 -m benchmarks.maps` (two minutes).

`python3 -m benchmarks.maps throughput` measures again only what a point costs, here and by scipy; other parts are
`pictures`, `critical` and `uncertainty`.
"""

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
from stickslip_sim.report.text import markdown_table
from stickslip_sim.scene import Scene
from stickslip_sim.study import EvenGrid, Saltelli, Study, variation
from stickslip_sim.study.table import lines, rows_of
from stickslip_sim.study.uncertainty import load_uncertain

from .page import quoted, replace_generated, said, shown

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
    f'critical paper_fig4_constant {CONSTANT} --of drive.velocity',
)
UNCERTAIN = ('uncertainty paper_fig7 --with examples/friction.yaml --set drive.velocity=0.025 --samples 512'
             ' --out runs/maps/uncertainty --plot runs/uncertainty.png')
UNTIL = 'amplitude\n  '   # what the page leaves out of its output: the shares of other figures than stick-slip
SETTING = Setting(1e-8, 'tolerance')
MILLION = 1_000_000   # points
_ROUNDS, _BY_SCIPY = 3, 12   # sweeps that are timed; points that scipy runs


class Cost(NamedTuple):
    """Of a point, s of processor time: ours and that of scipy, which misses break-aways in `flawed` of its points."""

    name: str
    ours: float
    scipy: float
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
    replace_generated(PAGE, f'{shown(UNCERTAIN)}\n\n{quoted(shortened(said(UNCERTAIN)))}', 'uncertainty')
    _keep_picture(UNCERTAIN)


def shortened(text: str) -> str:
    """Return what `uncertainty` prints up to the shares of its first figure."""
    head, found, _ = text.partition(UNTIL)
    if not found:
        raise ValueError(f'the output lacks {UNTIL!r}')
    return f'{head}...\n'


def throughput() -> None:
    """Measure what a point costs, here and by scipy, and calculate what a million do."""
    costs = [measured(name) for name in ('paper_fig7', 'paper_fig8')]
    replace_generated(PAGE, throughput_table(costs, of_the_uncertain()), 'throughput')


PARTS = {'pictures': pictures, 'critical': critical, 'uncertainty': uncertainty, 'throughput': throughput}


def measured(name: str) -> Cost:
    """Sweep a grid of feeds and stiffnesses in this process, and some of its points by scipy, for as long each."""
    scene = load_scene(name)
    study = Study(scene.values, EvenGrid((variation('drive.velocity=5e-4:0.03:50:log'),
                                      variation('axis.drive_stiffness=3e5:3e6:40:log'))))
    ours = statistics.median(_seconds(study) for _ in range(_ROUNDS)) / study.count
    chosen = np.linspace(0, study.count - 1, _BY_SCIPY).astype(int)
    figures, points = study.figures(0, study.count), study.points(0, study.count)
    seconds, flawed = [], 0
    _run_of_scipy(study.scene, 1.0)()   # what it compiles is not in the times
    for k in chosen:
        run = _run_of_scipy(study.scene_at(points[k]), float(figures.duration[k]))
        begin = time.process_time()
        events = run().events
        seconds.append(time.process_time() - begin)
        breaks = events[events[:, 1] == EventKind.BREAKAWAY, 0]
        flawed += len(breaks) != figures.cycles[k] + 1
    return Cost(name, ours, statistics.mean(seconds), flawed, len(chosen))


def _run_of_scipy(scene: Scene, duration: float) -> Callable[[], Outcome]:
    """Return what runs a scene with scipy."""
    problem = Problem(scene.name, '', scene.axis, scene.initial, scene.drive, scene.force, duration)
    return scipy_ivp.SCIPY_PEERS[0].prepare(problem, SETTING)


def throughput_table(costs: list[Cost], of_the_uncertain: float) -> str:
    """Return what a point costs (s), here and by scipy, and what a million take."""
    heads = ('study', 'stickslip, a point', 'scipy, a point', 'ratio', 'scipy misses break-aways',
             'a million points')
    rows = [(f'{c.name}: feed and stiffness', c.ours, f'{1e3 * c.scipy:.0f} ms', f'{c.scipy / c.ours:,.0f}',
             f'{c.flawed} of {c.by_scipy}') for c in costs]
    rows.append(('paper_fig7: examples/friction.yaml', of_the_uncertain, '', '', ''))
    return '\n'.join(markdown_table(heads, [
        (name, f'{1e6 * cost:.0f} µs', *by_scipy, _duration(MILLION * cost)) for name, cost, *by_scipy in rows])) + '\n'


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


if __name__ == '__main__':
    main()
