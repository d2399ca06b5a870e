# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""A part of a scene: a name, and one or more ways to leave it out."""

from collections.abc import Callable, Mapping
from typing import Any, NamedTuple

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
    def changes(values: SceneValues) -> Changes:
        return {parameter: without} if values.get(parameter) == there else {}

    return Part(name, (Variant(changes),))


def number_part(name: str, parameter: str) -> Part:
    """Return the part whose size is one number, so that 0 leaves it out."""
    def changes(values: SceneValues) -> Changes:
        return {parameter: 0.0} if values.get(parameter, 0.0) != 0.0 else {}

    return Part(name, (Variant(changes),))
