# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Run the examples of docs/identification.md: `python3 -m benchmarks.identification` puts there what they print.

`python3 -m benchmarks.identification data` makes examples/identify/axis.csv anew; the measured axes stand in the
repository, so that the page needs no more than the tool.
"""

import csv
import pathlib
import shutil
import sys
from collections.abc import Mapping

import numpy as np

from stickslip_sim.core.arrays import Numbers
from stickslip_sim.identification.identify import identify
from stickslip_sim.identification.measured_friction import known_friction, slip_share, usual_cycles
from stickslip_sim.identification.report import fitted_channels
from stickslip_sim.inputs import load_scene
from stickslip_sim.plots.characteristics import plot_known_friction
from stickslip_sim.plots.identified_motion import plot_fit, plot_residuals
from stickslip_sim.recording import read_run
from stickslip_sim.runs import simulate
from stickslip_sim.scene.load import changed

from .page import excerpt, quoted, replace_generated, said, shown

PAGE = pathlib.Path('docs/identification.md')
EXAMPLES, RUNS, IMAGES = pathlib.Path('examples/identify'), pathlib.Path('runs/identify'), pathlib.Path('docs/images')
COMMANDS: Mapping[str, tuple[str, ...]] = {   # by the name of the part of the page
    'synthetic': (
        'import examples/identify/axis.csv --columns time=time,position=position,drive_force=drive_force'
        ' --out runs/identify/axis',
        'identify runs/identify/axis --scene examples/identify/start.yaml --free examples/identify/free.yaml'
        ' --out runs/identify/axis_found'),
    'posterior': (
        'uncertainty runs/identify/axis_found/identified.yaml --with runs/identify/axis_found/posterior.yaml'
        ' --of drive.velocity --set drive.course=constant --set drive.velocity=0.002 --samples 64'
        ' --out runs/identify/axis_spread',),
    'lugre': (
        'import examples/identify/lugre.csv --columns time=time,position=position,drive_force=drive_force'
        ' --out runs/identify/lugre',
        'identify runs/identify/lugre --scene examples/identify/lugre_start.yaml'
        ' --free examples/identify/lugre_free.yaml --out runs/identify/lugre_found'),
}
LEFT_OUT = {               # lines of the output that the page shows as "..."
    'synthetic': '  note: ', 'posterior': '  (?:axis|friction)[.]|share of',
    'lugre': 'lugre: 4001|  last cycle|  note: (?:modes|the velocity)|contact|friction[.](?:kinetic|static[.]time)'
             '|not separated|[0-9]+ of [0-9]+ starts|stickslip: ',
}
FAILS = 'lugre'            # the part whose last command ends with exit code 3
TRUTH = {                  # of examples/identify/axis.csv, where it is not as in start.yaml
    'axis.drive_stiffness': 4.2e5, 'axis.drive_damping': 2500.0, 'friction.static.limit': 0.2,
    'friction.static.time_constant': 0.15, 'friction.kinetic.initial': 0.115, 'friction.kinetic.limit': 0.06,
    'friction.kinetic.stribeck_velocity': 0.008, 'friction.kinetic.viscous': 0.2,
}
DURATION, RATE = 8.0, 500.0              # s, Hz
ENCODER, FORCE_NOISE = 1e-6, 0.01        # m; of the root mean square


def main() -> None:
    """Write the parts that are asked for, or those of the page."""
    for part in sys.argv[1:] or ('commands', 'pictures'):
        {'data': data, 'commands': commands, 'pictures': pictures}[part]()


def data() -> None:
    """Make the measured axis whose truth is known; that of LuGre was integrated by SciPy, with the same sensors."""
    truth = changed(load_scene(str(EXAMPLES / 'start.yaml')), TRUTH)
    _write(EXAMPLES / 'axis.csv', simulate(truth, DURATION, 1.0 / RATE).samples)


def commands() -> None:
    """Run the commands of the page, and quote them with what they print."""
    shutil.rmtree(RUNS, ignore_errors=True)
    for name, given in COMMANDS.items():
        texts = [said(command, 3 if name == FAILS and k else 0) for k, command in enumerate(given)]
        parts = [f'{shown(command)}\n\n{quoted(excerpt(text, LEFT_OUT[name]))}'
                 for command, text in zip(given, texts, strict=True)]
        replace_generated(PAGE, '\n'.join(parts), name)
    replace_generated(PAGE, f'```yaml\n{(EXAMPLES / "free.yaml").read_text(encoding="utf-8")}```\n', 'free')


def pictures() -> None:
    """Draw pictures of the reports."""
    for name, start, free in (('axis', 'start', 'free'), ('lugre', 'lugre_start', 'lugre_free')):
        run = read_run(RUNS / name)
        found = identify(run, load_scene(str(EXAMPLES / f'{start}.yaml')), EXAMPLES / f'{free}.yaml')
        channels = fitted_channels(found)
        if name == 'lugre':
            plot_residuals(channels, slip_share(found), IMAGES / 'identified_lugre.png')
        else:
            plot_fit(channels, usual_cycles(found), found.restarts, IMAGES / 'identified_fit.png')
            plot_known_friction(known_friction(run, found), IMAGES / 'identified_friction.png')


def _write(path: pathlib.Path, samples: Mapping[str, Numbers]) -> None:
    """Write what the sensors show of a motion."""
    force = samples['drive_force']
    noise = FORCE_NOISE * np.sqrt(np.mean(force**2)) * np.random.default_rng(0).standard_normal(len(force))
    counts = np.round(samples['position'] / ENCODER)
    with path.open('w', encoding='utf-8', newline='') as file:
        rows = csv.writer(file, lineterminator='\n')
        rows.writerow(('time', 'position', 'drive_force'))
        for time, count, measured in zip(samples['time'], counts, force + noise, strict=True):
            rows.writerow((f'{time:.3f}', f'{count * ENCODER:.6f}', f'{measured:.2f}'))


if __name__ == '__main__':
    main()
