# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The parts of the friction characteristics."""

from collections.abc import Iterator

from ..scene import Scene
from ..scene.load import unscaled
from .part import Change, Changes, Part, SceneValues, Variant, number_part, switch

_KINETIC = 'friction.kinetic'
_EXCESS = 'friction.excess'
_STATIC = 'friction.static'
_COARSER = (10.0, 100.0)


def friction_parts(scene: Scene) -> Iterator[Part]:
    """Yield every part that the friction of a scene might have, present or not, and all its inner breakpoints."""
    values: SceneValues = scene.values
    yield switch('acceleration dependence', 'friction.acceleration_dependence', True, False)
    yield _excess_shape(scene)
    yield from _tables('psi', _EXCESS, 'fractions', values)
    yield _growth()
    yield _speed_dependence(scene)
    yield number_part('viscous friction', f'{_KINETIC}.viscous')
    yield number_part('rise of mu_k beyond its last breakpoint', f'{_KINETIC}.end_slope')
    yield from _tables('mu_k', _KINETIC, 'coefficients', values)


def _tables(what: str, section: str, ordinates: str, values: SceneValues) -> Iterator[Part]:
    """Yield the inner breakpoints of a table, or how fine the table of a smooth law is."""
    for speed in values.get(f'{section}.velocities', ())[1:-1]:
        without = Variant(_without_breakpoint(section, ordinates, speed))
        yield Part(f'breakpoint of {what} at {speed * 1e3:.6g} mm/s', (without,))
    for factor in _COARSER:
        yield Part(f'table of {what}: error {factor:g} times as large', (Variant(_coarser(section, factor, values)),))


def _without_breakpoint(section: str, ordinates: str, speed: float) -> Change:
    def changes(values: SceneValues) -> Changes:
        speeds = values.get(f'{section}.velocities', ())
        if speed not in speeds[1:-1]:
            return {}
        at = speeds.index(speed)
        return {f'{section}.{name}': (*values[f'{section}.{name}'][:at], *values[f'{section}.{name}'][at + 1:])
                for name in ('velocities', ordinates)}

    return changes


def _coarser(section: str, factor: float, base: SceneValues) -> Change:
    name = f'{section}.tolerance'

    def changes(values: SceneValues) -> Changes:
        if name not in values or values[name] >= factor * base[name]:
            return {}
        return {name: factor * base[name]}

    return changes


def _growth() -> Part:
    """Return the growth of mu_s with the rest time; without it mu_s is one number, and two suggest themselves."""
    def constant(value: str) -> Change:
        def changes(values: SceneValues) -> Changes:
            if values[f'{_STATIC}.law'] == 'constant' or values[f'{_STATIC}.limit'] == values[f'{_STATIC}.initial']:
                return {}
            return {f'{_STATIC}.law': 'constant', f'{_STATIC}.initial': values[f'{_STATIC}.{value}']}

        return changes

    return Part('rest-time growth of mu_s', (Variant(constant('limit'), 'mu_s = limit'),
                                             Variant(constant('initial'), 'mu_s = initial')))


def _speed_dependence(scene: Scene) -> Part:
    """Return the fall of mu_k with the speed; without it mu_k is that at rest or that at the limit velocity.

    The limit velocity stays, because the default psi ends there.
    """
    table = unscaled(scene).axis.friction.kinetic
    values_at = {'mu_k as at rest': table.coefficients[0], 'mu_k as at high speed': table.coefficients[-1]}

    def constant(value: float) -> Change:
        def changes(values: SceneValues) -> Changes:
            coefficients = values.get(f'{_KINETIC}.coefficients')
            if coefficients is None:
                return {f'{_KINETIC}.law': 'table', f'{_KINETIC}.velocities': (0.0, table.limit_velocity),
                        f'{_KINETIC}.coefficients': (value, value)}
            if len(set(coefficients)) == 1:
                return {}
            return {f'{_KINETIC}.coefficients': (value,) * len(coefficients), f'{_KINETIC}.end_slope': 0.0}

        return changes

    return Part('speed dependence of mu_k', tuple(Variant(constant(mu), how) for how, mu in values_at.items()))


def _excess_shape(scene: Scene) -> Part:
    """Return the smooth shape of psi; without it psi is a straight line to where it ends."""
    excess = scene.axis.friction.excess

    def changes(values: SceneValues) -> Changes:
        if excess is None or excess.law is None or values.get(f'{_EXCESS}.law', 'table') == 'table':
            return {}
        return {f'{_EXCESS}.law': 'table', f'{_EXCESS}.velocities': (0.0, excess.law.limit_velocity),
                f'{_EXCESS}.fractions': (1.0, 0.0)}

    return Part('curved shape of psi', (Variant(changes),))
