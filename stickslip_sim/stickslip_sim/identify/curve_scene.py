# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""A fitted friction law in a scene: an axis of its own, or another scene with this friction in place of its own."""

from collections.abc import Mapping

from ..core.errors import InputError
from ..scene import Scene, scene_from_values
from ..scene.schema import BY_NAME
from ..scene.text import scene_text
from ..scene.values import overridden

_DIGITS = 6       # far finer than any measured curve
_ALWAYS = ('scene', 'axis.', 'friction.static.', 'friction.kinetic.', 'drive.velocity')


def scene_with_friction(kinetic: Mapping[str, object], base: Scene | None, changes: Mapping[str, object],
                        name: str) -> Scene:
    """Return a scene with this section friction.kinetic, rounded to six digits; raises InputError.

    Without a `base` the axis is the paper's, called `name`, and static friction is that of the curve at rest: a curve
    of kinetic friction says nothing of its growth.
    """
    friction = {f'friction.kinetic.{key}': _rounded(value) for key, value in kinetic.items()}
    at_rest = friction.get('friction.kinetic.initial') or _first(friction['friction.kinetic.coefficients'])
    if base is None:
        return scene_from_values(overridden({'scene': name, 'friction.static.initial': at_rest, **friction}, changes))
    values = overridden(overridden(base.values, friction), changes)
    static = values['friction.static.initial']
    if isinstance(static, float) and isinstance(at_rest, float) and static < at_rest:
        raise InputError('friction.static.initial', static,
                         f'not below the fitted kinetic coefficient at rest, {at_rest}',
                         f'add --set friction.static.initial={at_rest}, if that is what the axis has')
    return scene_from_values(values)


def short_text(scene: Scene) -> str:
    """Return a scene as a file without what it leaves at the default, but with its whole axis and friction."""
    return scene_text({name: value for name, value in scene.values.items()
                       if name.startswith(_ALWAYS) or value != BY_NAME[name].default})


def _rounded(value: object) -> object:
    if isinstance(value, float):
        return float(f'{value:.{_DIGITS}g}')
    return tuple(map(_rounded, value)) if isinstance(value, tuple) else value


def _first(values: object) -> object:
    assert isinstance(values, tuple)
    return values[0]
