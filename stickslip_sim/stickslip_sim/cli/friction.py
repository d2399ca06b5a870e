# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""`stickslip friction`: a measured friction curve, the laws that fit it, and the scene with the best."""

from pathlib import Path

import click

from .files import check_distinct, check_file, check_picture, draw, say_written, write_text

_LAWS = ('best', 'table', 'gaussian', 'stribeck', 'exponential', 'hyperbolic', 'points')


@click.command(short_help='Fit friction laws to a measured curve; write the scene.')
@click.argument('curve', metavar='CURVE.csv')
@click.option('--speed-unit', required=True, metavar='UNIT', help='Of the first column: m/s, mm/s, um/s, m/min, ...')
@click.option('--force-unit', metavar='UNIT', help='The second column is a force: N, kN, mN or lbf.')
@click.option('--normal-force', type=float, metavar='N', help='The normal force under which it was measured, N.')
@click.option('--direction', type=click.Choice(('both', 'forward', 'backward')), default='both', show_default=True,
              help='Which points to fit; backward ones have a negative speed.')
@click.option('--backward', is_flag=True,
              help='Write it as the friction of motion backwards of --scene, which keeps its own forwards.')
@click.option('--law', type=click.Choice(_LAWS), default=_LAWS[0], show_default=True,
              help='Which to write; points: the measured points as a table.')
@click.option('--scene', metavar='SCENE', help="The axis that gets this friction [default: the paper's].")
@click.option('--set', 'changes', multiple=True, metavar='A.B=VALUE', help='Change a parameter of the scene.')
@click.option('--out', metavar='SCENE.yaml', help='Write the scene.')
@click.option('--plot', metavar='FILE.png', help='Draw points, laws and residuals (.png, .pdf or .svg).')
@click.option('--meant', multiple=True, type=click.Choice(('speed', 'friction')),
              help='Its highest value is meant, however unusual.')
def friction(curve: str, speed_unit: str, force_unit: str | None, normal_force: float | None, direction: str,
             backward: bool, law: str, scene: str | None, changes: tuple[str, ...], out: str | None, plot: str | None,
             meant: tuple[str, ...]) -> None:
    """Fit the friction laws of the engine to a measured curve: speed, then coefficient or force, in each line.

    The best is the one with the lowest AICc.  docs/friction_curve.md says more.
    """
    _check(out, plot, scene, changes)
    if backward and (scene is None or direction == 'forward'):
        raise click.UsageError('--backward writes backward points into a scene: give --scene, no --direction forward.')
    from ..identification.curve.measured_curve import load_curve, units_of
    from ..identification.curve.report import fitted_curve
    from ..inputs import load_scene
    from ..scene import parse_override

    units = units_of(speed_unit, force_unit, normal_force)
    measured = load_curve(curve, units, 'backward' if backward else direction, meant)
    found = fitted_curve(curve, measured, units, law)
    made = None if out is None else found.scene(None if scene is None else load_scene(scene),
                                                dict(map(parse_override, changes)), backward)
    print('\n'.join(found.lines()))
    draw(plot, found.draw)
    if out is not None and made is not None:
        write_text(out, [found.text(made, scene)])
    say_written(out, plot)
    if out is not None and made is not None:
        print('\n'.join(found.next_lines(out, made, scene, changes)))


def _check(out: str | None, plot: str | None, scene: str | None, changes: tuple[str, ...]) -> None:
    """Raise before the work begins when an output cannot be written or an option has no effect."""
    from ..core.errors import InputError

    if out is None and (scene is not None or changes):
        raise click.UsageError('--scene and --set are for the scene: give --out SCENE.yaml too.')
    if plot is not None:
        check_picture('--plot', plot)
    if out is not None:
        if Path(out).suffix not in ('.yaml', '.yml'):
            raise InputError('--out', out, 'a file ending in .yaml or .yml', 'name it so')
        check_file('--out', out)
    check_distinct([(option, path) for option, path in (('--out', out), ('--plot', plot)) if path is not None])
