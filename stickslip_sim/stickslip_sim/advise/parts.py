# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The parts of a scene: all that it models and could do without, each with the changes that leave it out."""

from collections.abc import Iterator

from ..scene import Scene
from .friction_parts import friction_parts
from .part import Change, Changes, Part, SceneValues, Variant, number_part, switch

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
            yield Part(f'sine of {frequency:g} {where}', (Variant(_without_sinusoid(section, k)),))
    yield Part('external force', (Variant(_without_force),))


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
