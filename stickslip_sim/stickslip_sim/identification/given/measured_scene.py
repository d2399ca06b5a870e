# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The scene that was found with the inputs that were measured in place of its own, so that it runs as the axis did."""

from collections.abc import Mapping
from typing import NamedTuple

from ...core.input_profile import InputProfile
from ...scene import Scene, scene_from_values
from ...scene.build import Dynamics
from ...scene.profile_schema import MOST_POINTS
from .readings import SensorReadings

_DRIVE, _FORCE = 'drive', 'force'   # sections of a scene


class InputForm(NamedTuple):
    """How a measured input stands in a scene and in a file: `values` in its section, `column` and `file` beside it."""

    values: str
    column: str
    file: str


FORMS: Mapping[str, InputForm] = {_DRIVE: InputForm('velocities', 'velocity', 'measured_drive.csv'),
                                  _FORCE: InputForm('forces', 'force', 'measured_force.csv')}


def with_measured_inputs(scene: Scene, measurement: SensorReadings, dynamics: Dynamics
                         ) -> tuple[Scene, tuple[str, ...]]:
    """Return a scene whose drive and force are as they were measured, and the sections that are.

    The `dynamics` are those of what was found: a measured force less the offset of its sensor.  One of more points than
    a scene holds stays as it was.
    """
    measured = {_DRIVE: (measurement.drive, dynamics.drive), _FORCE: (measurement.force, dynamics.force)}
    sections = {name: measured_section(name, found) for name, (given, found) in measured.items()
                if given is not None and len(found.starts) <= MOST_POINTS}
    values = {name: value for name, value in scene.values.items() if name.partition('.')[0] not in sections}
    for section in sections.values():
        values |= section
    return (scene_from_values(values) if sections else scene), tuple(sections)


def measured_section(name: str, profile: InputProfile) -> dict[str, object]:
    """Return a section of a scene with the pieces of a measured profile: a table, or steps where it holds values."""
    return {f'{name}.course': 'table' if any(profile.rates) else 'steps', f'{name}.times': profile.starts,
            f'{name}.{FORMS[name].values}': profile.values}
