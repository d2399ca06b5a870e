# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The parts of a scene: all that it models and could do without, each with the changes that leave it out."""

from collections.abc import Callable, Iterator, Mapping
from typing import Any, NamedTuple

from ..scene import Scene
from ..scene.load import unscaled

# A part of a scene: a name, and one or more ways to leave it out.

SceneValues = Mapping[str, Any]   # of a scene, by dotted name
Changes = dict[str, Any]     # to such values
Change = Callable[[SceneValues], Changes]


class Variant(NamedTuple):
    """One way to leave a part out: `changes` returns the changes to values that may lack the part already (none).

    `how` says it in words where there is more than one way.
    """

    changes: Change
    how: str = ''


class Part(NamedTuple):
    """Something that a scene models and that another scene could do without."""

    name: str
    variants: tuple[Variant, ...]


def switch(name: str, parameter: str, there: object, without: object) -> Part:
    """Return the part that one choice brings in: `parameter` is `there` with it and `without` else."""
    return _part(name, lambda values: {parameter: without} if values.get(parameter) == there else {})


def number_part(name: str, parameter: str) -> Part:
    """Return the part whose size is one number, so that 0 leaves it out."""
    return _part(name, lambda values: {parameter: 0.0} if values.get(parameter, 0.0) != 0.0 else {})


def _part(name: str, changes: Change) -> Part:
    """Return the part that there is one way to leave out."""
    return Part(name, (Variant(changes),))


# The parts of the friction characteristics.

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
        yield _part(f'breakpoint of {what} at {speed * 1e3:.6g} mm/s', _without_breakpoint(section, ordinates, speed))
    for factor in _COARSER:
        yield _part(f'table of {what}: error {factor:g} times as large', _coarser(section, factor, values))


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
    return lambda values: {name: factor * base[name]} if name in values and values[name] < factor * base[name] else {}


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

    return _part('curved shape of psi', changes)


_INPUTS = (('drive', 'Hz on the drive'), ('force', 'Hz on the force'))


def parts_of(scene: Scene) -> list[Part]:
    """Return the parts that a scene has."""
    return [part for part in _possible_parts(scene)
            if any(variant.changes(scene.values) for variant in part.variants)]


def _possible_parts(scene: Scene) -> Iterator[Part]:
    values: SceneValues = scene.values
    yield switch('contact compliance', 'contact.model', 'compliant', 'rigid')
    yield number_part('contact damping', 'contact.damping')
    yield from friction_parts(scene)
    yield number_part('drive damping', 'axis.drive_damping')
    for section, where in _INPUTS:
        if values[f'{section}.course'] == 'sine':
            yield switch(f'sine of {values[f"{section}.frequency"]:g} {where}', f'{section}.course', 'sine', 'constant')
        for k, frequency in enumerate(values.get(f'{section}.frequencies', ())):
            yield _part(f'sine of {frequency:g} {where}', _without_sinusoid(section, k))
    yield _part('external force', _without_force)


def _without_sinusoid(section: str, k: int) -> Change:
    """Return the change of the amplitude of a sinusoid to 0, which is as good as none, and which `--set` can do."""
    name = f'{section}.amplitudes'

    def changes(values: SceneValues) -> Changes:
        amplitudes = values[name]
        return {name: (*amplitudes[:k], 0.0, *amplitudes[k + 1:])} if amplitudes[k] != 0.0 else {}

    return changes


def _without_force(values: SceneValues) -> Changes:
    changes: Changes = {}
    if values['force.course'] != 'constant':
        changes = {'force.course': 'constant', 'force.constant': 0.0}
    elif values['force.constant'] != 0.0:
        changes = {'force.constant': 0.0}
    amplitudes = values.get('force.amplitudes', ())
    return {**changes, 'force.amplitudes': (0.0,) * len(amplitudes)} if any(amplitudes) else changes


def without_idle_sinusoids(values: SceneValues) -> dict[str, object]:
    """Return the values of a scene without sines of amplitude 0, for a file that people read."""
    kept = dict(values)
    for section, _ in _INPUTS:
        lists = {name: values[name] for name in (f'{section}.amplitudes', f'{section}.frequencies', f'{section}.phases')
                 if name in values}
        rows = [row for row in zip(*lists.values()) if row[0] != 0.0]
        for name, column in zip(lists, zip(*rows)) if rows else ():
            kept[name] = column
        for name in lists if not rows else ():
            del kept[name]
    return kept


# The parts that a scene leaves out, and the values with which each of them, given, does nothing.

_ANY_TIME = 1.0        # s, a time constant of a growth from a value to the same value
_ANY_FREQUENCY = 10.0  # Hz, of a sine without an amplitude


class Absent(NamedTuple):
    """A part that is not in a scene; `changes` give it there with no effect."""

    name: str
    changes: Changes


def absent_parts(scene: Scene) -> list[Absent]:
    """Return the parts that a scene leaves out and that have values without an effect."""
    return [Absent(name, changes) for name, changes in _neutral(scene.values).items()]


def _neutral(values: SceneValues) -> dict[str, Changes]:
    found: dict[str, Changes] = {}
    if values['friction.static.law'] == 'constant':
        found['rest-time growth of mu_s'] = {
            'friction.static.law': 'exponential', 'friction.static.limit': values['friction.static.initial'],
            'friction.static.time_constant': _ANY_TIME}
    for section, what in (('drive', 'sine on the drive'), ('force', 'sine on the force')):
        if f'{section}.amplitudes' not in values:
            found[what] = {f'{section}.amplitudes': (0.0,), f'{section}.frequencies': (_ANY_FREQUENCY,)}
    for name, parameter in (('drive damping', 'axis.drive_damping'), ('contact damping', 'contact.damping'),
                            ('external force', 'force.constant'), ('encoder', 'encoder.resolution'),
                            ('command time-out', 'command.timeout')):
        if values.get(parameter) == 0.0:
            found[name] = {parameter: 0.0}
    return found
