# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""A study as JSON values, and back: the file beside its table."""

import json
from collections.abc import Mapping
from dataclasses import asdict
from importlib import metadata
from typing import Any

from ..core.errors import InputError
from ..runs.receipt import versions
from ..scene.load import parse_scene
from .distribution import Distribution
from .sample import EvenGrid, Saltelli, Sampling, Sobol
from .study import Study
from .variation import Variation, checked

FORM = 'stickslip study 1'
_OF_THE_SAMPLE = ('points', 'duration', 'over', 'sobol', 'uncertain')


def description(study: Study, command: str = '') -> dict[str, Any]:
    """Return all that a study is, enough to run it again, with the `command` and the versions that run it."""
    sample = study.sample
    return {
        'form': FORM, 'command': command, 'scene': study.scene.name, 'scene_hash': study.scene.hash,
        'points': study.count, 'duration': study.duration,
        'over': [{**_json(asdict(one)), 'unit': one.unit} for one in sample.variations],
        'sobol': {'points': sample.count, 'seed': sample.seed} if isinstance(sample, Sobol) else None,
        'uncertain': _uncertain(sample) if isinstance(sample, Saltelli) else None,
        'versions': versions_of_a_study(), 'scene_text': study.scene.text,
    }


def versions_of_a_study() -> dict[str, str]:
    """Return the versions of everything that the points of a study and their figures depend on."""
    return {**versions(), 'scipy': metadata.version('scipy')}


def study_of(found: Mapping[str, Any]) -> Study:
    """Return the study that a description is of; raises InputError."""
    try:
        scene = parse_scene(found['scene_text'])
        study = Study(scene.values, _sample_of(found), found['duration'])
        described = description(study)
        if all(json.dumps(found[name]) == json.dumps(described[name]) for name in _OF_THE_SAMPLE):
            return study
    except (ArithmeticError, AttributeError, LookupError, TypeError, ValueError):
        pass
    raise InputError('study', str(found.get('scene')), 'as a sweep describes it', 'it was changed; sweep again')


def _uncertain(sample: Saltelli) -> dict[str, Any]:
    correlations = {'correlations': [list(row) for row in sample.correlations]} if sample.correlations else {}
    return {'samples': sample.samples, 'seed': sample.seed, **correlations}


def _json(values: Mapping[str, Any]) -> dict[str, Any]:
    return {name: list(value) if isinstance(value, tuple) else value for name, value in values.items()}


def _sample_of(found: Mapping[str, Any]) -> Sampling:
    uncertain, drawn = found['uncertain'], found['sobol']
    if uncertain:
        laws = tuple(Distribution(one['name'], one['law'], tuple(one['numbers']), one['low'], one['high'])
                     for one in found['over'])
        correlations = tuple(map(tuple, uncertain.get('correlations', ())))
        return Saltelli(laws, uncertain['samples'], uncertain['seed'], correlations or None)
    variations = tuple(checked(Variation(one['name'], float(one['low']), float(one['high']), int(one['count']),
                                         bool(one['log']))) for one in found['over'])
    return Sobol(variations, drawn['points'], drawn['seed']) if drawn else EvenGrid(variations)
