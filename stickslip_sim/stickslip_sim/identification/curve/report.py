# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""What `stickslip friction` says of a curve: how it was read, the laws by rank, the chosen one with its doubts.

It also writes the scene with that law, and draws it.
"""

import shlex
from collections.abc import Mapping, Sequence
from html import escape
from pathlib import Path
from typing import NamedTuple

import numpy as np

from ...core.errors import InputError
from ...report.quantity import counted
from ...scene import Scene
from ...scene.schema import BY_NAME
from .best_law import (
    Fits,
    fit_laws,
    origin_of,
    scene_with_friction,
    scene_with_friction_backwards,
    short_text,
    sides,
    sign_changes,
)
from .law_fit import MISSED, SPARE, Fit, points_table
from .measured_curve import FrictionCurve, Units

BEST, POINTS, EACH = 'best', 'points', 'each'
LAWS = 'table', 'stribeck', 'exponential', 'hyperbolic'
_PATTERN = 0.05   # a chance below it is called a pattern
_DIFFER = 3.0     # standard errors
_ENOUGH = 12      # points for a law of four parameters
_OF_FORCES = {('initial', ''): 'N', ('limit', ''): 'N', ('coefficients', ''): 'N', ('viscous', 's/m'): 'N s/m',
              ('end_slope', 's/m'): 'N s/m'}


class FittedCurve(NamedTuple):
    """The laws that were fitted to the curve of a file, and the one that is `chosen`, or the points themselves.

    `kinetic` is the section friction.kinetic of a scene.
    """

    path: str
    measured: FrictionCurve
    units: Units
    fits: Fits
    chosen: Fit
    kinetic: Mapping[str, object]
    is_points: bool
    notes: tuple[str, ...] = ()   # how the points were found, of a run

    def __repr__(self) -> str:
        return f'<FittedCurve of {self.path}: the law {self.chosen.name} of {len(self.fits.by_rank)}>'

    def _repr_html_(self) -> str:
        return f'<pre>{escape(chr(10).join(self.lines()))}</pre>'

    def lines(self) -> list[str]:
        """Return what the tool prints."""
        chosen = (_points_lines(self.kinetic, self.measured) if self.is_points else
                  _fitted_law_lines(self.chosen, self.units.are_forces))
        return [*curve_lines(self.path, self.measured, self.units, self.notes), '', *_fit_lines(self.fits), '', *chosen]

    def scene(self, base: Scene | None, changes: Mapping[str, object], backward: bool) -> Scene:
        """Return the scene with the law, of motion `backward` or of both directions; raises InputError."""
        if self.units.are_forces:
            raise InputError('--normal-force', None, 'given in N for a scene, or by --scene',
                             'the laws of a scene are those of a coefficient')
        origin = origin_of(self.measured, Path(self.path).stem, self.units.normal_force)
        if backward and base is not None:
            return scene_with_friction_backwards(self.kinetic, base, changes, origin)
        return scene_with_friction(self.kinetic, base, changes, origin)

    def origin(self, base: str | None) -> str:
        """Return a comment that says from where the law is, and how far that is from the points.

        `base` is the path of the scene that it was put into.
        """
        chosen = self.chosen
        missed = f', {100.0 * chosen.miss:.0f} % of the range of the points' if chosen.miss > MISSED else ''
        fitted = f'the law {chosen.name}, rms of the residuals {chosen.rms:.2g}{missed}'
        what = 'its points' if self.is_points else fitted
        whose = "the paper's axis" if base is None else f'the axis of {Path(base).name}'
        name = ' '.join(Path(self.path).name.split())
        return f'# Kinetic friction from {name}: {what}; {whose}.\n'

    def next_lines(self, out: str, made: Scene, base: str | None, changes: Sequence[str]) -> list[str]:
        """Return what no measurement gave and the file `out` has all the same, and the command that goes on."""
        feed, load = (made.values.get(name) for name in ('drive.velocity', 'axis.normal_force'))
        lines = []
        if base is None and not any(change.startswith('drive.') for change in changes):
            lines.append(f"{'its axis':22} the paper's under {load:g} N, the drive at {feed:g} m/s, in the middle of "
                         'the measured speeds: --scene and --set give yours')
        go_on = f'stickslip critical {shlex.quote(out)} --of drive.velocity'
        return [*lines, f'{"next":22} {go_on}' + ('' if feed else ' --between LOW:HIGH, as its drive.velocity is 0')]

    def draw(self, path: Path) -> None:
        """Draw points, laws and residuals."""
        from ...plots.friction_fits import FittedLine, MeasuredPoints, plot_friction_fits, plot_speeds

        chosen = self.chosen
        points = MeasuredPoints(*chosen.curve[:3], chosen.curve.spread, self.units.are_forces)
        speeds = plot_speeds(points)
        lines = []
        for fit in [chosen, *(fit for fit in self.fits.by_rank if fit is not chosen)]:
            band = fit.band(speeds) if fit is chosen else np.array([])
            lines.append(FittedLine(f'{fit.name} (AICc {fit.criterion:.1f})', fit.at(speeds),
                                    band if np.isfinite(band).all() else np.array([]), fit.at(points.speeds)))
        plot_friction_fits(points, lines, Path(self.path).name, path)


def fitted_curves(path: str, measured: FrictionCurve, units: Units, direction: str, law: str,
                  notes: tuple[str, ...] = (), base: Scene | None = None) -> list[FittedCurve]:
    """Return the fits to the points of a direction, or to EACH; the BEST law of all is the same one for each.

    A `base` has the law to begin with.  Raises InputError.
    """
    if base is not None and law == BEST:
        law = next((one for one in LAWS if one == base.values['friction.kinetic.law']), law)
    curves = [measured.chosen(one) for one in (('forward', 'backward') if direction == EACH else (direction,))]
    found = [fitted_curve(path, curve, units, law, notes) for curve in curves]
    if law != BEST or len(found) == 1:
        return found
    names = [fit.name for fit in found[0].fits.by_rank if fit.name not in found[1].fits.left_out]
    pairs = [[one.fits.of(name) for one in found] for name in names]   # ranked as those of one curve
    best = min(pairs, key=lambda fits: (any(fit.miss > MISSED for fit in fits), sum(fit.criterion for fit in fits)))
    return [one._replace(chosen=fit, kinetic=fit.scene) for one, fit in zip(found, best, strict=True)]


def scene_of_curves(found: Sequence[FittedCurve], base: Scene | None, changes: Mapping[str, object], backward: bool
                    ) -> Scene:
    """Return the scene with one law, of motion `backward` or of both directions, or with one for each of them.

    Without a `base` static friction is that of each at rest.  Raises InputError.
    """
    made = found[0].scene(base, changes, backward)
    if len(found) == 1:
        return made
    at_rest = {} if base is not None else {'friction.static.backward.initial': float(f'{found[1].chosen.at_rest:.6g}')}
    return found[1].scene(made, {**at_rest, **changes}, True)


def scene_text_of(found: Sequence[FittedCurve], made: Scene, base: str | None) -> str:
    """Return the scene as a file that says from where its laws are; `base` is the path of the scene it was put into."""
    return ''.join(one.origin(base) for one in found) + short_text(made)


def fitted_curve(path: str, measured: FrictionCurve, units: Units, law: str, notes: tuple[str, ...] = ()
                 ) -> FittedCurve:
    """Return the fits to a curve, of which a `law`, the BEST, or its POINTS are chosen; raises InputError."""
    fits = fit_laws(measured)
    chosen = fits.by_rank[0] if law in (BEST, POINTS) else fits.of(law)
    kinetic = points_table(measured) if law == POINTS else chosen.scene
    return FittedCurve(path, measured, units, fits, chosen, kinetic, law == POINTS, notes)


def curve_lines(curve: str, measured: FrictionCurve, units: Units, notes: Sequence[str] = ()) -> list[str]:
    """Return what was read, in SI, so that a wrong unit is seen; or how it was found."""
    speeds, coefficients = measured.speeds, measured.coefficients
    forward = int(measured.forward.sum())
    count = len(speeds)
    where = {count: '', 0: ', all backward'}.get(forward, f', {forward} forward and {count - forward} backward')
    over = '' if units.normal_force is None else f', over {units.normal_force:g} N'
    read = 'a coefficient' if units.force is None else f'{units.force}{over}'
    name, unit = ('friction', ' N') if units.are_forces else ('coefficient', '')
    lines = [f'{curve}: {count} points{where}',
             *([f'{"" if k else "found by":22} {note}' for k, note in enumerate(notes)]
               or [f'{"read as":22} {units.speed} and {read}']),
             f'{"speed":22} {speeds.min():g} to {speeds.max():g} m/s',
             f'{name:22} {coefficients.min():.4g} to {coefficients.max():.4g}{unit}']
    return lines + ([f'{"not read":22} {counted(measured.unread, "more column")}'] if measured.unread else [])


def _fit_lines(fits: Fits) -> list[str]:
    """Return a table of the laws by rank, and what the rank means."""
    best = fits.by_rank[0]
    lines = [f'{"law":12}{"parameters":>11}{"rms residual":>15}{"largest":>11}{"AICc":>10}{"above best":>12}']
    for fit in fits.by_rank:
        lines.append(f'{fit.name:12}{fit.count:11}{fit.rms:15.3g}{abs(fit.residuals).max():11.3g}'
                     f'{fit.criterion:10.1f}{fit.criterion - best.criterion:12.1f}')
    lines += [f'{name:12}{"":11} not fitted: AICc wants {SPARE} points more than a law has parameters, and as many '
              'speeds' for name in fits.left_out]
    among = ' of those that follow the points' if fits.passed_over else ''
    lines += [f'best: {best.name}, by the lowest AICc{among}, n ln(SSE/n) + 2k + 2k(k+1)/(n-k-1); k counts the '
              'parameters and the variance']
    if fits.passed_over:
        whose, left = ('its', 'residual is') if len(fits.passed_over) == 1 else ('their', 'residuals are')
        lines.append(f'not best, for all {whose} lower AICc: {", ".join(fits.passed_over)}; {whose} rms {left} above '
                     f'{100.0 * MISSED:.0f} % of the range of the points')
    if len(best.curve.speeds) < _ENOUGH:
        lines.append(f'fewer than {_ENOUGH} points: the criterion then favours laws of few parameters'
                     + ('; --law takes another' if len(fits.by_rank) > 1 else ''))
    if fits.as_good:
        lines.append(f'as good, within 2 of it: {", ".join(fits.as_good)}; these points do not decide between them')
    return lines


def _fitted_law_lines(fit: Fit, are_forces: bool) -> list[str]:
    """Return the parameters of a law with their intervals, and what the residuals say."""
    lines = [f'{fit.name:22} {"value":>12}   95 % interval']
    intervals = fit.intervals()
    for name, value in _values(fit).items():
        unit = BY_NAME[f'friction.kinetic.{name.partition("[")[0]}'].unit
        unit = _OF_FORCES.get((name.partition('[')[0], unit), unit) if are_forces else unit
        lines.append(f'{name:22} {value:12.5g}   {_interval(name, fit, intervals)} {unit}'.rstrip())
    signs = sign_changes(fit)
    few = f'{counted(signs.changes, "change")} of sign along the speed'
    if signs.least >= _PATTERN:
        lines.append(f'{"residuals":22} {few}: too few points to tell a pattern from noise')
    else:
        verdict = 'a pattern that this law misses' if signs.chance < _PATTERN else 'no pattern'
        lines.append(f'{"residuals":22} {few}; noise has as few in {100.0 * signs.chance:.3g} % of cases: {verdict}')
    both = sides(fit)
    lines += [f'{side.name:22} {side.ratio:.4f}' + (f' ± {side.error:.4f}' if side.points > 1 else '')
              + f' of the curve, mean of {counted(side.points, "point")}' for side in both]
    if any(side.points > 1 and abs(side.ratio - 1.0) > _DIFFER * side.error for side in both):
        lines.append('the directions differ: fit each by itself, --direction each')
    return lines + _rest_lines(fit) + _miss_lines(fit)


def _points_lines(scene: Mapping[str, object], measured: FrictionCurve) -> list[str]:
    """Return what `--law points` writes."""
    speeds, coefficients = scene['velocities'], scene['coefficients']
    assert isinstance(speeds, tuple)
    assert isinstance(coefficients, tuple)
    lines = [f'{"points":22} a table of {counted(len(speeds), "breakpoint")}, joined by straight segments: not fitted',
             f'{"end_slope":22} {scene["end_slope"]:12.5g} s/m, beyond the last speed']
    slowest = float(measured.speeds.min())
    return lines + ([] if slowest == 0.0 else [f'{"at rest":22} {coefficients[0]:12.5g} as at the slowest point, '
                                              f'{slowest:g} m/s: not measured'])


def _rest_lines(fit: Fit) -> list[str]:
    """Return a line that says from where a curve without a point at rest was extrapolated."""
    slowest = float(fit.curve.speeds.min())
    if slowest == 0.0:
        return []
    return [f'{"at rest":22} {fit.at_rest:.4g} is extrapolated: the slowest point is {slowest:g} m/s, the highest '
            f'measured coefficient {fit.curve.coefficients.max():.4g}']


def _miss_lines(fit: Fit) -> list[str]:
    """Return a warning when a law misses the points, unless enough of them show that it is noise."""
    if fit.miss <= MISSED or (len(fit.curve.speeds) >= _ENOUGH and sign_changes(fit).chance >= _PATTERN):
        return []
    return [f'WARNING: {fit.name} misses the points by {100.0 * fit.miss:.0f} % of their range (rms): they scatter as '
            'much, or it has not their shape; --law points writes the points themselves']


def _values(fit: Fit) -> dict[str, float]:
    """Return the numbers of a law by name, the breakpoints of a table among them."""
    values: dict[str, float] = {}
    for name, value in fit.scene.items():
        if isinstance(value, tuple):
            values.update({f'{name}[{k}]': number for k, number in enumerate(value)})
        elif isinstance(value, float):
            values[name] = value
    return values


def _interval(name: str, fit: Fit, intervals: dict[str, tuple[float, float] | None]) -> str:
    if name in ('initial', 'coefficients[0]') and fit.extrapolates:
        return f'none: extrapolated, no point below {fit.curve.speeds.min():g} m/s'
    if name in fit.held:
        return 'at an end of its range'
    if name not in intervals:
        return 'chosen' if name.startswith('velocities') else 'given'
    found = intervals[name]
    return 'not determined by these points' if found is None else f'{found[0]:.5g} to {found[1]:.5g}'
