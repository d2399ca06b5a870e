# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Scenes by name or path, whose profiles may be in files."""

import os
from collections.abc import Mapping
from dataclasses import replace
from fractions import Fraction
from pathlib import Path

from .. import runs
from ..core.errors import InputError, check_kind
from ..core.types import Progress
from ..scene import Scene, scene_from_values
from ..scene.load import named, named_scene, of_a_scene, read_scene
from ..scene.schema import NULL, PROFILES
from ..scene.values import overridden, stated
from .profile_file import prepared, sections_with_file, with_profiles

SceneOrName = Scene | str | os.PathLike[str]


def load_scene(name_or_path: str | os.PathLike[str], overrides: Mapping[str, object] | None = None) -> Scene:
    """Return a shipped scene or one from a file, with other values by dotted name.

    An override of a choice (contact.model) drops the values of the file for the old one (contact.stiffness).  A profile
    from a file lies in the folder of the scene, one of the overrides in the working directory, or below.  Raises
    InputError, whose text begins with the file, and RecordingError for a profile in a bag.
    """
    check_kind('scene', name_or_path, str | os.PathLike, 'the name or path of a scene',
               'values go into the second argument: load_scene(NAME, CHANGES)')
    name = os.fspath(name_or_path)
    with named(name):
        found = read_scene(name)
        return scene_with_profiles(found.values, overrides or {}, dict.fromkeys(PROFILES, found.folder),
                                   found.summary)


def scene_of(given: SceneOrName) -> Scene:
    """Return a scene, or the one of that name or path; raises as `load_scene`, and InputError on anything else."""
    check_kind('scene', given, Scene | str | os.PathLike, 'a Scene, or the name or path of one',
               'load_scene(NAME, CHANGES) takes other values')
    return given if isinstance(given, Scene) else load_scene(given)


def scene_with_profiles(values: Mapping[str, object], overrides: Mapping[str, object], folders: Mapping[str, Path],
                        summary: str = '') -> Scene:
    """Return the scene of the parameters of files in these `folders` by section, with other values.

    Raises InputError and RecordingError.
    """
    values, changes = of_a_scene(values), stated(overrides)
    if not values:
        raise InputError('parameters', None, 'of a scene', 'see the shipped scenes')
    shipped = {name: value for name, value in named_scene(values, changes.get('scene')).items()
               if values.get(name) != NULL}
    values = overridden(*prepared(shipped, stated(values)))
    values = overridden(*prepared(values, changes))
    places = {**folders, **dict.fromkeys(sections_with_file(changes), Path())}
    values, sources = with_profiles(values, places)
    return replace(scene_from_values(values, summary), sources=sources)


# Runs of a scene, or of the one of a name or path.

def simulate(scene: SceneOrName, duration: float, sample_period: float | Fraction | None = None,
             progress: Progress = None) -> runs.SimulatedRun:
    """Simulate `duration` seconds of a scene, with a sample every `sample_period` seconds from 0 on (None: each step).

    `progress` is called with the share that is done.  Raises InputError on times without a meaning and on a run too
    long to hold, SolverError when the solver gives up, and what `load_scene` raises.
    """
    return runs.simulate(scene_of(scene), duration, sample_period, progress)


def simulate_events(scene: SceneOrName, duration: float, progress: Progress = None) -> runs.SimulatedRun:
    """Simulate as `simulate` does, without any sample: for long runs, and where events say all."""
    return runs.simulate_events(scene_of(scene), duration, progress)
