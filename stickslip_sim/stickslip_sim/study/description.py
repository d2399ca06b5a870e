# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""A study as JSON values, and back: what stands beside its table."""

from collections.abc import Mapping
from dataclasses import asdict
from importlib import metadata
from typing import Any

from ..errors import InputError
from ..receipt import versions
from ..scene.load import scene_of_parameters
from ..scene.ros_yaml import read_yaml
from ..scene.sections import parameters_of
from .distribution import Distribution
from .sample import Grid, Saltelli, Sample, Sobol
from .study import Study
from .variation import Variation

FORM = 'stickslip study 1'
_VARIED: Mapping[str, type] = {'name': str, 'low': float, 'high': float, 'count': int, 'log': bool}
_NO_STUDY = (KeyError, TypeError, ValueError, AttributeError, OverflowError)   # what other values than ours lead to


def description(study: Study, command: str = '') -> dict[str, Any]:
    """Return all that a study is, enough to run it again, with the `command` and the versions that run it."""
    sample = study.sample
    return {
        'form': FORM, 'command': command, 'scene': study.scene.name, 'scene_hash': study.scene.hash,
        'points': study.count, 'duration': study.duration,
        'over': [{**asdict(one), 'unit': one.unit} for one in sample.variations],
        'sobol': {'points': sample.count, 'seed': sample.seed} if isinstance(sample, Sobol) else None,
        'uncertain': {'samples': sample.samples, 'seed': sample.seed} if isinstance(sample, Saltelli) else None,
        'versions': versions_of_a_study(), 'scene_text': study.scene.text,
    }


def versions_of_a_study() -> dict[str, str]:
    """Return the versions of everything that the points of a study and their figures depend on."""
    return {**versions(), 'scipy': metadata.version('scipy')}


def study_of(told: Mapping[str, Any]) -> Study:
    """Return the study that a description is of, whoever wrote it; raises InputError."""
    try:
        scene = scene_of_parameters(parameters_of(read_yaml(told['scene_text'])), {})
        return Study(scene.values, _sample_of(told), told['duration'])
    except _NO_STUDY as error:
        raise InputError('study', f'{type(error).__name__}: {error}', 'described as a sweep does it',
                         'the description was changed; sweep again') from None


def _sample_of(told: Mapping[str, Any]) -> Sample:
    uncertain, drawn = told['uncertain'], told['sobol']
    if uncertain:
        laws = tuple(Distribution(one['name'], one['law'], tuple(one['numbers']), one['low'], one['high'])
                     for one in told['over'])
        return Saltelli(laws, _typed(uncertain, 'samples', int), _typed(uncertain, 'seed', int))
    variations = tuple(Variation(**{name: _typed(one, name, kind) for name, kind in _VARIED.items()})
                       for one in told['over'])
    return Sobol(variations, _typed(drawn, 'points', int), _typed(drawn, 'seed', int)) if drawn else Grid(variations)


def _typed(told: Mapping[str, Any], name: str, kind: type) -> Any:
    """Return a value; raises TypeError when it is of another kind, which Python might well calculate with."""
    if type(told[name]) is not kind:
        raise TypeError(f'{name} is no {kind.__name__}')
    return told[name]
