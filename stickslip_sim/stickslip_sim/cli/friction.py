# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""`stickslip friction`: a measured friction curve, the laws that fit it, and the scene with the best."""

import shlex
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING

import click

from ..identification.curve.report import curve_lines, fit_lines, fitted_law_lines, points_lines
from .files import check_distinct, check_file, check_picture, say_written, whole, write_text

if TYPE_CHECKING:
    from ..identification.curve.best_law import Fits
    from ..identification.curve.law_fit import Fit
    from ..identification.curve.law_in_scene import Origin
    from ..scene import Scene

_BEST, _POINTS = 'best', 'points'
_LAWS = ('table', 'gaussian', 'stribeck', 'exponential', 'hyperbolic')


@click.command(short_help='Fit friction laws to a measured curve; write the scene.')
@click.argument('curve', metavar='CURVE.csv')
@click.option('--speed-unit', required=True, metavar='UNIT', help='Of the first column: m/s, mm/s, um/s, m/min, ...')
@click.option('--force-unit', metavar='UNIT', help='The second column is a force: N, kN, mN or lbf.')
@click.option('--normal-force', type=float, metavar='N', help='The normal force under which it was measured, N.')
@click.option('--direction', type=click.Choice(('both', 'forward', 'backward')), default='both', show_default=True,
              help='Which points to fit; backward ones have a negative speed.')
@click.option('--backward', is_flag=True,
              help='Write it as the friction of motion backwards of --scene, which keeps its own forwards.')
@click.option('--law', type=click.Choice((_BEST, *_LAWS, _POINTS)), default=_BEST, show_default=True,
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
    from ..identification.curve.best_law import fit_laws
    from ..identification.curve.law_in_scene import origin_of, short_text
    from ..identification.curve.measured_curve import load_curve, units_of
    from ..identification.curve.table_fit import points_table

    units = units_of(speed_unit, force_unit, normal_force)
    measured = load_curve(curve, units, 'backward' if backward else direction, meant)
    fits = fit_laws(measured)
    chosen = _chosen(law, fits)
    kinetic = points_table(measured) if law == _POINTS else chosen.scene
    made = None if out is None else _scene(kinetic, scene, changes, backward,
                                           origin_of(measured, Path(curve).stem, normal_force))
    printed = points_lines(kinetic, measured) if law == _POINTS else fitted_law_lines(chosen)
    print('\n'.join([*curve_lines(curve, measured, units), '', *fit_lines(fits), '', *printed]))
    if plot is not None:
        _draw(fits, chosen, curve, plot)
    if out is not None and made is not None:
        write_text(out, [f'# {_summary(curve, law, chosen, scene)}\n', short_text(made)])
    say_written(out, plot)
    if out is not None and made is not None:
        print('\n'.join(_next_lines(out, made, scene, changes)))


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


def _chosen(law: str, fits: 'Fits') -> 'Fit':
    """Return the fit of a law, the best for the points themselves; raises InputError when they are too few for it."""
    from ..core.errors import InputError
    from ..identification.curve.law_fit import SPARE

    if law in (_BEST, _POINTS):
        return fits.by_rank[0]
    if law in fits.left_out:
        curve = fits.by_rank[0].curve
        most = min(len(curve.speeds) - SPARE, len(set(curve.speeds.tolist())))
        raise InputError('--law', law, f'one with at most {most} parameters for these points: AICc wants {SPARE} '
                         'points more than that, and as many speeds',
                         f'measure more of them, or take --law {_POINTS} for the points themselves')
    return next(fit for fit in fits.by_rank if fit.name == law)


def _scene(kinetic: Mapping[str, object], scene: str | None, changes: tuple[str, ...], backward: bool,
           origin: 'Origin') -> 'Scene':
    """Return the scene with a law; raises InputError."""
    from ..identification.curve.law_in_scene import scene_with_friction, scene_with_friction_backwards
    from ..inputs import load_scene
    from ..scene import parse_override

    given = dict(parse_override(change) for change in changes)
    if backward and scene is not None:
        return scene_with_friction_backwards(kinetic, load_scene(scene), given, origin)
    return scene_with_friction(kinetic, None if scene is None else load_scene(scene), given, origin)


def _summary(curve: str, law: str, chosen: 'Fit', scene: str | None) -> str:
    """Return the first line of the scene: from which file it is, and how far the law is from the points."""
    from ..identification.curve.law_fit import MISSED

    missed = f', {100.0 * chosen.miss:.0f} % of the range of the points' if chosen.miss > MISSED else ''
    what = 'its points' if law == _POINTS else f'the law {chosen.name}, rms of the residuals {chosen.rms:.2g}{missed}'
    whose = "the paper's axis" if scene is None else f'the axis of {Path(scene).name}'
    return f'Kinetic friction from {" ".join(Path(curve).name.split())}: {what}; {whose}.'


def _next_lines(out: str, made: 'Scene', scene: str | None, changes: tuple[str, ...]) -> list[str]:
    """Return what no measurement gave and the file has all the same, and the command that goes on."""
    feed, load = (made.values.get(name) for name in ('drive.velocity', 'axis.normal_force'))
    lines = []
    if scene is None and not any(change.startswith('drive.') for change in changes):
        lines.append(f"{'its axis':22} the paper's under {load:g} N, the drive at {feed:g} m/s, in the middle of the "
                     'measured speeds: --scene and --set give yours')
    go_on = f'stickslip critical {shlex.quote(out)} --of drive.velocity'
    return [*lines, f'{"next":22} {go_on}' + ('' if feed else ' --between LOW:HIGH, as its drive.velocity is 0')]


def _draw(fits: 'Fits', chosen: 'Fit', curve: str, path: str) -> None:
    import numpy as np

    from ..plots.friction_fits import FittedLine, MeasuredPoints, plot_friction_fits, plot_speeds

    points = MeasuredPoints(*chosen.curve[:3])
    speeds = plot_speeds(points)
    lines = []
    for fit in [chosen, *(fit for fit in fits.by_rank if fit is not chosen)]:
        band = fit.band(speeds) if fit is chosen else np.array([])
        lines.append(FittedLine(f'{fit.name} (AICc {fit.criterion:.1f})', fit.at(speeds),
                                band if np.isfinite(band).all() else np.array([]), fit.at(points.speeds)))
    with whole(path) as temporary:
        plot_friction_fits(points, lines, Path(curve).name, temporary)
