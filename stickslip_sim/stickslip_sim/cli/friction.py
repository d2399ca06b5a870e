# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""`stickslip friction`: the friction curve of a run or a file, the laws that fit it, and the scene with the best."""

from typing import TYPE_CHECKING, Any

import click

from ..core.errors import ALLOW
from . import completion
from .arguments import SceneChanges, allow_implausible, check_usage, recorded_run, verb
from .files import FILE, PICTURE, SCENE_FILE, draw, say_written, show, write_text

if TYPE_CHECKING:
    from ..identification.curve.measured_curve import FrictionCurve, Units
    from ..scene import Scene

_LAWS = ('best', 'table', 'gaussian', 'stribeck', 'exponential', 'hyperbolic', 'points')
_OF_A_FILE, _OF_A_RUN = ('speed_unit', 'force_unit', 'lead', 'rated', 'meant'), ('mass', 'slowest', 'csv')


@verb(short_help='Fit friction laws to a measured run or curve.')
@click.argument('source', metavar='RUN|CURVE.csv', shell_complete=completion.complete_folders)
@click.option('--mass', type=float, metavar='KG',
              help='For a run: mass that the force accelerates [default: as --scene].')
@click.option('--slowest', type=float, metavar='SPEED',
              help='For a run: lowest speed in m/s that counts as motion [default: as imported].')
@click.option('--csv', type=FILE, metavar='FILE.csv', help='For a run: write the curve with quartiles and counts.')
@click.option('--speed-unit', metavar='UNIT', help='Unit of the first column: m/s, mm/s, um/s, m/min, ...; rpm, rad/s.')
@click.option('--force-unit', metavar='UNIT',
              help='Unit of the second column if it is a force: N, kN, mN, lbf, N m or %.')
@click.option('--lead', metavar='LENGTH', help='Travel per turn, such as "10 mm", to convert rpm, rad/s and N m.')
@click.option('--rated', metavar='FORCE', help='Rated force or torque, such as "2.4 N m", to convert %.')
@click.option('--normal-force', type=float, metavar='NEWTONS',
              help='Normal force of the measurement [default: that of --scene, or friction in N].')
@click.option('--direction', type=click.Choice(('both', 'forward', 'backward', 'each')), default='both',
              show_default=True, help='Points to fit; backward ones have negative speed, each fits both separately.')
@click.option('--backward', is_flag=True,
              help='Write the result as the backward friction of --scene, keeping its forward friction.')
@click.option('--law', type=click.Choice(_LAWS), default=_LAWS[0], show_default=True,
              help='Law to write; points writes the measured points as a table.')
@click.option('--scene', metavar='SCENE', help="Axis that receives this friction [default: the paper's].")
@click.option('--set', 'changes', multiple=True, metavar='A.B=VALUE', help='Change a parameter of the scene.')
@click.option('--out', type=SCENE_FILE, metavar='SCENE.yaml', help='Write the scene.')
@click.option('--plot', type=PICTURE, metavar='FILE.png', help='Plot points, laws and residuals (.png, .pdf or .svg).')
@allow_implausible('Accept an implausible speed or friction.', type=click.Choice(('speed', 'friction')))
def friction(source: str, normal_force: float | None, direction: str, backward: bool, law: str, scene: str | None,
             changes: tuple[str, ...], out: str | None, plot: str | None, **given: Any) -> None:
    """Fit the engine's friction laws to a run, or to a measured curve with a speed and a coefficient or force per line.

    For a run, friction is the drive force minus inertia, binned by velocity.  The best law has the lowest AICc.  See
    docs/friction_curve.md.
    """
    from ..inputs.sources import names_recording

    is_run = names_recording(source)
    others = sorted({'meant': ALLOW}.get(name, '--' + name.replace('_', '-'))
                    for name in (_OF_A_FILE if is_run else _OF_A_RUN) if given[name])
    check_usage(
        (others, f'{", ".join(others)}: not for a {"run" if is_run else "file"}.'),
        (out is None and (changes or scene is not None) and not is_run and not given['force_unit'],
         '--scene and --set need --out SCENE.yaml.'),
        (backward and (scene is None or direction not in ('both', 'backward')),
         '--backward needs --scene and does not take --direction.'),
        (plot and direction == 'each', '--plot draws one curve: choose --direction both, forward or backward.'),
        (not is_run and given['speed_unit'] is None,
         'A file needs --speed-unit UNIT, the unit of its first column, such as mm/s.'))
    from ..identification.curve.report import fitted_curves, scene_of_curves, scene_text_of
    from ..inputs import load_scene

    overrides = {**({'axis.mass': given['mass']} if scene is None and given['mass'] is not None else {}),
                 **SceneChanges(changes, ()).given()}
    base, changed = (None, None) if scene is None else (load_scene(scene), load_scene(scene, overrides))
    if normal_force is None and changed is not None and (is_run or given['force_unit']):
        normal_force = changed.axis.normal_force
    curve, units, notes = (_of_run if is_run else _of_file)(source, normal_force, changed, **given)
    found = fitted_curves(source, curve, units, 'backward' if backward else direction, law, notes,
                          base if backward else None)
    made = None if out is None else scene_of_curves(found, base, overrides, backward)
    print('\n\n'.join('\n'.join(one.lines()) for one in found))
    draw(plot, found[0].draw)
    write_text(out, [] if made is None else [scene_text_of(found, made, scene)])
    say_written(given['csv'], out, plot)
    show([] if made is None else found[0].next_lines(str(out), made, scene, changes))


def _of_run(source: str, normal_force: float | None, scene: 'Scene | None', mass: float | None, slowest: float | None,
            csv: str | None, **_: object) -> 'tuple[FrictionCurve, Units, tuple[str, ...]]':
    from ..identification.run_friction import friction_curve
    from .csv_tables import csv_lines

    found = friction_curve(recorded_run(source), mass, scene, slowest)
    write_text(csv, csv_lines([found.columns]))
    return found.curve(normal_force), found.units(normal_force), found.notes


def _of_file(path: str, load: float | None, _: object, **given: Any) -> 'tuple[FrictionCurve, Units, tuple[str, ...]]':
    from ..identification.curve.measured_curve import load_curve, units_of
    from ..inputs.units import drive_units

    units = units_of(given['speed_unit'], given['force_unit'], load, drive_units(given['lead'], given['rated']))
    return load_curve(path, units, given['meant']), units, ()
