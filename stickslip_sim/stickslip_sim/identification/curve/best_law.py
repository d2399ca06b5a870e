# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""All laws fitted to a measured friction curve, the best first, and what speaks against the best."""

from collections.abc import Collection, Mapping
from typing import NamedTuple

import numpy as np
from scipy import special

from ...core.errors import InputError
from ...scene import Scene, scene_from_values, scene_names
from ...scene.load import values_in_file
from ...scene.schema import BACKWARD, BY_NAME
from ...scene.values import overridden, scene_text
from .law_fit import MISSED, SMOOTH_FORMS, SPARE, Fit, enough_points, fit_smooth, fit_table
from .measured_curve import FrictionCurve

AS_GOOD = 2.0       # of the criterion: nearer than that, two laws are as good (Burnham and Anderson)
FEWEST = 5          # points, at FEWEST_SPEEDS speeds or more: for Coulomb's law with a viscous slope
_FEWEST_SPEEDS = 2


class Fits(NamedTuple):
    """The fitted laws, the best first, and the names of those that the curve has too few points for.

    They rank by rising criterion; but a law that misses the points comes after those that do not.  With few points the
    last term of the criterion is larger than what even a perfect fit gains, and a constant would win over any shape.
    """

    by_rank: tuple[Fit, ...]
    left_out: tuple[str, ...]

    @property
    def as_good(self) -> list[str]:
        """The names of the laws that are as good by these points."""
        best, *others = self.by_rank
        return [fit.name for fit in others
                if fit.criterion - best.criterion < AS_GOOD and fit.name not in self.passed_over]

    @property
    def passed_over(self) -> list[str]:
        """The names of the laws with a lower criterion than the best, which miss the points."""
        best, *others = self.by_rank
        return [fit.name for fit in others if fit.criterion < best.criterion]

    def of(self, law: str) -> Fit:
        """Return the fit of a law by its name; raises InputError where the points are too few for it."""
        if law in self.left_out:
            curve = self.by_rank[0].curve
            most = min(len(curve.speeds) - SPARE, len(np.unique(curve.speeds)))
            raise InputError('--law', law, f'one with at most {most} parameters for these points: AICc wants {SPARE} '
                             'points more than that, and as many speeds',
                             'measure more of them, or take --law points for the points themselves')
        return next(fit for fit in self.by_rank if fit.name == law)


def fit_laws(curve: FrictionCurve) -> Fits:
    """Return the fits of every law; raises InputError when the points are too few for any."""
    speeds = len(np.unique(curve.speeds))
    if len(curve.speeds) < FEWEST or speeds < _FEWEST_SPEEDS:
        raise InputError('friction curve', f'{len(curve.speeds)} points at {speeds} speeds',
                         f'at least {FEWEST} points, at {_FEWEST_SPEEDS} speeds or more', 'measure more of them')
    fits = [fit_table(curve)]
    fits += [fit_smooth(form, curve) for form in SMOOTH_FORMS if enough_points(len(form.names), curve)]
    left_out = [form.name for form in SMOOTH_FORMS if not enough_points(len(form.names), curve)]
    return Fits(tuple(sorted(fits, key=lambda fit: (fit.miss > MISSED, fit.criterion))), tuple(left_out))


class SignChanges(NamedTuple):
    """How often the residuals change their sign along the speed, and the `chance` of as few if they were noise.

    `least` is the chance of a single change: where it is not small, no residuals can show a pattern.
    """

    changes: int
    chance: float
    least: float


def sign_changes(fit: Fit) -> SignChanges:
    """Return the test of runs (Wald and Wolfowitz 1940), exactly: few changes mean that the law misses a shape.

    Of each direction the mean is taken off, and the backward points go before the forward ones, by rising velocity.
    """
    left, forward = fit.residuals.copy(), fit.curve.forward
    for side in (forward, ~forward):
        if side.any() and not side.all():
            left[side] -= left[side].mean()
    above = np.concatenate([left[~forward][::-1], left[forward]]) > 0.0
    changes = int(np.sum(above[1:] != above[:-1]))
    first, second = int(above.sum()), int((~above).sum())
    if not first or not second:
        return SignChanges(0, 1.0, 1.0)
    total = _log_choices(first + second, first)
    chances = [float(np.exp(_log_arrangements(first, second, runs) - total)) for runs in range(2, changes + 2)]
    return SignChanges(changes, min(sum(chances), 1.0), chances[0])


def _log_arrangements(first: int, second: int, runs: int) -> float:
    """Return the logarithm of how many sequences of `first` and `second` signs have so many runs."""
    half, odd = divmod(runs, 2)
    if not odd:
        return float(np.log(2.0) + _log_choices(first - 1, half - 1) + _log_choices(second - 1, half - 1))
    return float(np.logaddexp(_log_choices(first - 1, half) + _log_choices(second - 1, half - 1),
                              _log_choices(first - 1, half - 1) + _log_choices(second - 1, half)))


def _log_choices(n: int, k: int) -> float:
    """Return the logarithm of the number of choices of k among n; −infinity where there is none."""
    return float(special.gammaln(n + 1) - special.gammaln(k + 1) - special.gammaln(n - k + 1)) if k <= n else -np.inf


class CurveSide(NamedTuple):
    """A direction of motion beside the curve of both: mean of measured over fitted, and its standard error."""

    name: str
    points: int
    ratio: float
    error: float


def sides(fit: Fit) -> list[CurveSide]:
    """Return both directions of a curve beside the fit; none when all points are of one."""
    forward = fit.curve.forward
    if forward.all() or not forward.any():
        return []
    ratios = fit.curve.coefficients / fit.at(fit.curve.speeds)
    return [CurveSide(name, int(chosen.sum()), float(ratios[chosen].mean()),
                 float(ratios[chosen].std() / np.sqrt(chosen.sum())))
            for name, chosen in (('forward', forward), ('backward', ~forward))]


# A fitted friction law in a scene: an axis of its own, or another scene with this friction in place of its own.

_DIGITS = 6       # far finer than any measured curve
_FEED, _LOAD = 'drive.velocity', 'axis.normal_force'
_ALWAYS = ('scene', 'axis.', 'friction.static.', 'friction.kinetic.', _FEED)


class Origin(NamedTuple):
    """What a scene without another one to begin with takes from the measurement: a name, a feed, and the load if known.

    `feed` is in m/s; `normal_force`, in N, is that under which a friction force was measured.
    """

    name: str
    feed: float
    normal_force: float | None = None


def origin_of(curve: FrictionCurve, name: str, normal_force: float | None) -> Origin:
    """Return the origin of a scene: its feed is the geometric mean of slowest and fastest point, to one digit."""
    moving = curve.speeds[curve.speeds > 0.0]
    return Origin(name, float(f'{np.sqrt(moving.min() * moving.max()):.1g}'), normal_force)


def scene_with_friction_backwards(kinetic: Mapping[str, object], base: Scene, changes: Mapping[str, object],
                                  origin: Origin) -> Scene:
    """Return a scene with this section friction.kinetic of motion along -x, as `scene_with_friction` rounds it.

    Raises InputError, also on another law than that of the scene, which is for both directions.
    """
    law, own = kinetic['law'], base.values['friction.kinetic.law']
    if law != own:
        raise InputError('--law', law, f'the law that the scene has forwards, {own}',
                         'fit the same law both ways, or --law points and a table')
    _check_load(base, changes, origin.normal_force)
    section = f'friction.kinetic.{BACKWARD}'
    friction = {f'{section}.{key}': _rounded(value) for key, value in kinetic.items() if key != 'law'}
    return scene_from_values(overridden(overridden(base.values, friction), changes))


def scene_with_friction(kinetic: Mapping[str, object], base: Scene | None, changes: Mapping[str, object],
                        origin: Origin) -> Scene:
    """Return a scene with this section friction.kinetic, rounded to six digits; raises InputError.

    Without a `base` the axis is the paper's with the normal force of the measurement, it has the name and the feed of
    the `origin`, and static friction is that of the curve at rest: a curve of kinetic friction says nothing of its
    growth.
    """
    friction = {f'friction.kinetic.{key}': _rounded(value) for key, value in kinetic.items()}
    at_rest = friction.get('friction.kinetic.initial') or _first(friction['friction.kinetic.coefficients'])
    if base is None:
        given: dict[str, object] = {} if origin.normal_force is None else {_LOAD: origin.normal_force}
        if not any(change.startswith('drive.') for change in changes):
            given[_FEED] = origin.feed
        return scene_from_values(overridden({'scene': origin.name, 'friction.static.initial': at_rest, **friction,
                                             **given}, changes))
    _check_load(base, changes, origin.normal_force)
    values = overridden(overridden(base.values, friction), changes)
    static = values['friction.static.initial']
    if isinstance(static, float) and isinstance(at_rest, float) and static < at_rest:
        raise InputError('friction.static.initial', static,
                         f'not below the fitted kinetic coefficient at rest, {at_rest}',
                         f'add --set friction.static.initial={at_rest}, if that is what the axis has')
    return scene_from_values(values)


def _check_load(base: Scene, changes: Mapping[str, object], measured: float | None) -> None:
    """Raise InputError when an axis has another normal force than the measurement had, unless it is a change."""
    own = base.values[_LOAD]
    if measured not in (None, own) and _LOAD not in changes:
        raise InputError('--normal-force', measured, f'that of the axis of --scene, {_LOAD} = {own}',
                         f'a coefficient may change with the load: add --set {_LOAD}={measured} for the load of the '
                         f'measurement, or --set {_LOAD}={own} if the coefficient holds there too')


def short_text(scene: Scene, remarks: Mapping[str, str] | None = None, files: Mapping[str, str] | None = None,
               left_out: Collection[str] = ()) -> str:
    """Return a scene as a file without what it leaves at the default, but with its whole axis and friction.

    Under the name of a shipped scene, which the file changes, all is given.
    `remarks` are put behind parameters, by their names, as comments.  Profiles in `files` (by `SECTION.file`) take the
    place of points that are `left_out`.
    """
    is_shipped = scene.name in scene_names()
    shown = {name: value for name, value in values_in_file(scene).items()
             if name not in left_out and (is_shipped or name.startswith(_ALWAYS) or value != BY_NAME[name].default)}
    return scene_text({**shown, **(files or {})}, remarks)


def _rounded(value: object) -> object:
    if isinstance(value, float):
        return float(f'{value:.{_DIGITS}g}')
    return tuple(map(_rounded, value)) if isinstance(value, tuple) else value


def _first(values: object) -> object:
    assert isinstance(values, tuple)
    return values[0]
