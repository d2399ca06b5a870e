# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""A fitted friction law in a scene: an axis of its own, or another scene with this friction in place of its own."""

from collections.abc import Collection, Mapping
from typing import NamedTuple

import numpy as np

from ...core.errors import InputError
from ...scene import Scene, scene_from_values, scene_names
from ...scene.friction_schema import BACKWARD
from ...scene.load import values_in_file
from ...scene.schema import BY_NAME
from ...scene.values import overridden, scene_text
from .measured_curve import FrictionCurve

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
