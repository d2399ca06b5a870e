# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""`stickslip friction`: a measured friction curve, the laws that fit it, and the scene with the best."""

from pathlib import Path
from typing import TYPE_CHECKING

import click

from .files import check_distinct, check_file, check_picture, whole, write_text

if TYPE_CHECKING:
    from ..identify.curve_fit import Fit
    from ..identify.curve_laws import Fits
    from ..identify.friction_curve import FrictionCurve, Units

_BEST, _POINTS = 'best', 'points'
_LAWS = ('table', 'gaussian', 'stribeck', 'exponential', 'hyperbolic')
_PATTERN = 0.05   # a chance below it is called a pattern
_DIFFER = 3.0     # standard errors
_ENOUGH = 12      # points for a law of four parameters


@click.command(short_help='Fit friction laws to a measured curve; write the scene.')
@click.argument('curve', metavar='CURVE.csv')
@click.option('--speed-unit', required=True, metavar='UNIT', help='Of the first column: m/s, mm/s, um/s, m/min, ...')
@click.option('--force-unit', metavar='UNIT', help='The second column is a force: N, kN, mN or lbf.')
@click.option('--normal-force', type=float, metavar='N', help='The normal force under which it was measured, N.')
@click.option('--direction', type=click.Choice(('both', 'forward', 'backward')), default='both', show_default=True,
              help='Which points to fit; backward ones have a negative speed.')
@click.option('--law', type=click.Choice((_BEST, *_LAWS, _POINTS)), default=_BEST, show_default=True,
              help='Which to write; points: the measured points as a table.')
@click.option('--scene', metavar='SCENE', help="The axis that gets this friction [default: the paper's].")
@click.option('--set', 'changes', multiple=True, metavar='A.B=VALUE', help='Change a parameter of the scene.')
@click.option('--out', metavar='SCENE.yaml', help='Write the scene.')
@click.option('--plot', metavar='FILE.png', help='Draw points, laws and residuals (.png, .pdf or .svg).')
@click.option('--meant', multiple=True, type=click.Choice(('speed', 'friction')),
              help='Its highest value is meant, however unusual.')
def friction(curve: str, speed_unit: str, force_unit: str | None, normal_force: float | None, direction: str, law: str,
             scene: str | None, changes: tuple[str, ...], out: str | None, plot: str | None,
             meant: tuple[str, ...]) -> None:
    """Fit the friction laws of the engine to a measured curve: speed, then coefficient or force, in each line.

    The best is the one with the lowest AICc.  docs/friction_curve.md says more.
    """
    _check(out, plot, scene, changes)
    from ..identify.curve_laws import fit_laws
    from ..identify.friction_curve import load_curve, units_of

    units = units_of(speed_unit, force_unit, normal_force)
    measured = load_curve(curve, units, direction, meant)
    fits = fit_laws(measured)
    chosen = _chosen(law, fits)
    written = None if out is None else _scene_lines(curve, law, chosen, scene, changes)
    print('\n'.join([*_curve_lines(curve, measured, units), '', *_fit_lines(fits), '', *_law_lines(chosen)]))
    if plot is not None:
        _draw(fits, chosen, curve, plot)
    if out is not None and written is not None:
        write_text(out, written)
        print(f'written: {out}')


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

    if law in (_BEST, _POINTS):
        return fits.by_rank[0]
    if law in fits.left_out:
        raise InputError('--law', law, 'a law with fewer parameters than the curve has points and speeds',
                         'measure more of them, or leave it out for the best')
    return next(fit for fit in fits.by_rank if fit.name == law)


def _scene_lines(curve: str, law: str, chosen: 'Fit', scene: str | None, changes: tuple[str, ...]) -> list[str]:
    """Return the lines of the scene with the law; raises InputError."""
    from ..identify.curve_scene import scene_with_friction, short_text
    from ..identify.table_fit import points_table
    from ..inputs import load_scene
    from ..scene import parse_override

    file = Path(curve)
    kinetic = points_table(chosen.curve) if law == _POINTS else chosen.scene
    made = scene_with_friction(kinetic, None if scene is None else load_scene(scene),
                               dict(parse_override(change) for change in changes), file.stem)
    what = 'its points' if law == _POINTS else f'the law {chosen.name}, rms of the residuals {chosen.rms:.2g}'
    whose = "the paper's axis" if scene is None else f'the axis of {Path(scene).name}'
    return [f'# Kinetic friction from {" ".join(file.name.split())}: {what}; {whose}.\n', short_text(made)]


def _curve_lines(curve: str, measured: 'FrictionCurve', units: 'Units') -> list[str]:
    """Return what was read, in SI, so that a wrong unit is seen."""
    speeds, coefficients = measured.speeds, measured.coefficients
    forward = int(measured.forward.sum())
    count = len(speeds)
    where = {count: '', 0: ', all backward'}.get(forward, f', {forward} forward and {count - forward} backward')
    read = 'a coefficient' if units.force is None else f'{units.force}, over {units.normal_force:g} N'
    lines = [f'{curve}: {count} points{where}',
             f'{"read as":22} {units.speed} and {read}',
             f'{"speed":22} {speeds.min():g} to {speeds.max():g} m/s',
             f'{"coefficient":22} {coefficients.min():.4g} to {coefficients.max():.4g}']
    return lines + ([f'{"not read":22} {measured.unread} more columns'] if measured.unread else [])


def _fit_lines(fits: 'Fits') -> list[str]:
    """Return a table of the laws by rank, and what the rank means."""
    best = fits.by_rank[0]
    lines = [f'{"law":12}{"parameters":>11}{"rms residual":>15}{"largest":>11}{"AICc":>10}{"above best":>12}']
    for fit in fits.by_rank:
        lines.append(f'{fit.name:12}{fit.count:11}{fit.rms:15.3g}{abs(fit.residuals).max():11.3g}'
                     f'{fit.criterion:10.1f}{fit.criterion - best.criterion:12.1f}')
    lines += [f'{name:12}{"":11} not fitted: it has too many parameters for these points' for name in fits.left_out]
    lines.append(f'best: {best.name}, by the lowest AICc, n ln(SSE/n) + 2k + 2k(k+1)/(n-k-1)')
    if len(best.curve.speeds) < _ENOUGH:
        lines.append(f'fewer than {_ENOUGH} points: the criterion then favours laws of few parameters; --law takes '
                     'another')
    if fits.as_good:
        lines.append(f'as good, within 2 of it: {", ".join(fits.as_good)}; these points do not decide between them')
    return lines


def _law_lines(fit: 'Fit') -> list[str]:
    """Return the parameters of a law with their intervals, and what the residuals say."""
    from ..identify.curve_laws import sides, sign_changes
    from ..scene.schema import BY_NAME

    lines = [f'{fit.name:22} {"value":>12}   95 % interval']
    intervals = fit.intervals()
    for name, value in _values(fit).items():
        unit = BY_NAME[f'friction.kinetic.{name.partition("[")[0]}'].unit
        lines.append(f'{name:22} {value:12.5g}   {_interval(name, fit, intervals)} {unit}'.rstrip())
    signs = sign_changes(fit)
    verdict = 'a pattern that this law misses' if signs.chance < _PATTERN else 'no pattern'
    lines.append(f'{"residuals":22} {signs.changes} changes of sign along the speed; noise has as few in '
                 f'{100.0 * signs.chance:.3g} % of cases: {verdict}')
    both = sides(fit)
    lines += [f'{side.name:22} {side.ratio:.4f} ± {side.error:.4f} of the curve, mean of {side.points} points'
              for side in both]
    if any(abs(side.ratio - 1.0) > _DIFFER * side.error for side in both):
        lines.append('the directions differ, and a scene has one curve for both: --direction fits one of them')
    return lines


def _values(fit: 'Fit') -> dict[str, float]:
    """Return the numbers of a law by name, the breakpoints of a table among them."""
    values: dict[str, float] = {}
    for name, value in fit.scene.items():
        if isinstance(value, tuple):
            values.update({f'{name}[{k}]': number for k, number in enumerate(value)})
        elif isinstance(value, float):
            values[name] = value
    return values


def _interval(name: str, fit: 'Fit', intervals: dict[str, tuple[float, float] | None]) -> str:
    if name in fit.held:
        return 'at an end of its range'
    if name not in intervals:
        return 'chosen' if name.startswith('velocities') else 'given'
    found = intervals[name]
    return 'not determined by these points' if found is None else f'{found[0]:.5g} to {found[1]:.5g}'


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
