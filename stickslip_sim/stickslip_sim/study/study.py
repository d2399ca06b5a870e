# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""A study: variants of one scene, and the figures of each."""

import itertools
import json
from collections.abc import Callable, Mapping, Sequence
from dataclasses import asdict, dataclass
from functools import cached_property
from importlib import metadata
from typing import Any, ClassVar

import numpy as np

from ..core.arrays import Numbers
from ..core.errors import InputError
from ..figures.point_figures import FIGURES, MOTIONS, Figures, Runs, figures_of_runs, no_runs
from ..report.values import versions
from ..runs.simulated import check_run_times
from ..scene import Scene, scene_from_values
from ..scene.load import named, parse_scene
from .points import runs_alone, runs_in_batches, scene_at, works_in_batches
from .sample import Distribution, EvenGrid, Saltelli, Sampling, Sobol
from .table import rows_of
from .variation import Variation, checked

MOST_VARIATIONS = 10
_IN_A_CHUNK, _ALONE_IN_A_CHUNK = 2000, 20   # points: a fraction of a second


@dataclass(frozen=True)
class Study:
    """The scene of the effective `values`, varied as `sample` says.

    Each point runs for `duration` s, or with None until its motion settles (`points`).  Raises InputError unless
    every combination of the ends of the variations is a scene.
    """

    values: Mapping[str, object]
    sample: Sampling
    duration: float | None = None
    form: ClassVar[str] = 'stickslip study 1'
    largest: ClassVar[float] = 1e150    # of a cell, by far; its square, for variances, is still a number
    figure_names: ClassVar[tuple[str, ...]] = FIGURES
    words: ClassVar[Mapping[float, str]] = {float(motion): word for motion, word in MOTIONS.items()}

    def __post_init__(self) -> None:
        check_variations(self.sample.variations, self.scene_at)
        if self.duration is not None:
            check_run_times(self.duration, None)
        elif not self.works_in_batches:
            raise InputError('duration', None, 'given for a scene with faults, inputs that change with time, or a '
                             'solver other than exact', 'add --duration S')

    @property
    def names(self) -> tuple[str, ...]:
        """The parameters that vary."""
        return tuple(one.name for one in self.sample.variations)

    @property
    def ranges(self) -> tuple[Variation, ...]:
        """The parameters that vary between two ends; none in a sample of distributions."""
        return tuple(one for one in self.sample.variations if isinstance(one, Variation))

    @property
    def count(self) -> int:
        """How many points there are."""
        return self.sample.count

    @cached_property
    def scene(self) -> Scene:
        """The scene that is varied."""
        return scene_from_values(self.values)

    @cached_property
    def works_in_batches(self) -> bool:
        """Whether the compiled batch can run the points."""
        return works_in_batches(self.scene)

    @property
    def chunk(self) -> int:
        """How many points to work on between two looks at the clock; the figures do not depend on it."""
        return _IN_A_CHUNK if self.works_in_batches else _ALONE_IN_A_CHUNK

    def points(self, first: int, last: int) -> Numbers:
        """Return the points from `first` on, up to `last`: a row each, a column for each of `names`."""
        return self.sample.points(first, last)

    def scene_at(self, point: Numbers) -> Scene:
        """Return the scene of a point; raises InputError."""
        return scene_at(self.values, self.names, point)

    def figures(self, first: int, last: int) -> Figures:
        """Return the figures of the points from `first` on, up to `last`."""
        return figures_of_runs(self.runs(self.points(first, last), first))

    def rows(self, first: int, last: int) -> Numbers:
        """Return the points from `first` on, up to `last`, with their figures: a row each."""
        return rows_of(self.points(first, last), self.figures(first, last))

    def described(self, command: str = '') -> dict[str, Any]:
        """Return its description, as `description` does."""
        return description(self, command)

    def runs(self, points: Numbers, first: int = 0) -> Runs:
        """Run the scenes of points, from the one of index `first` on.

        Where static friction scatters, each pair of independent points of distributions has a seed of its own; the
        points between them share it, so that their indices are those of the numbers.
        """
        if self.scene.axis.friction.static.scatter is None or not isinstance(self.sample, Saltelli):
            return self._runs(self.values, points)
        runs = no_runs(len(points))
        pairs = np.arange(first, first + len(points)) // self.sample.each
        for pair in range(pairs[0], pairs[-1] + 1):
            members = np.flatnonzero(pairs == pair)
            runs.put(members, self._runs({**self.values, 'seed': (self.scene.seed + pair) % _SEEDS}, points[members]))
        return runs

    def _runs(self, values: Mapping[str, Any], points: Numbers) -> Runs:
        if self.works_in_batches:
            return runs_in_batches(values, self.names, points, self.duration)
        return runs_alone(values, self.names, points, self.duration or 0.0)


def check_variations(variations: Sequence[Variation | Distribution], scene_at: Callable[[Numbers], Scene]) -> None:
    """Raise InputError unless they are a few, of different names, and every combination of their ends is a scene."""
    names = [one.name for one in variations]
    if not 1 <= len(names) <= MOST_VARIATIONS:
        raise InputError('--over', f'{len(names)} times', f'given once to {MOST_VARIATIONS} times',
                         'vary fewer parameters in one study')
    twice = [name for name in names if names.count(name) > 1]
    if twice:
        raise InputError('--over', twice[0], 'given once for each parameter', 'drop one of the two')
    for corner in itertools.product(*((one.low, one.high) for one in variations)):
        with named('at ' + ', '.join(f'{name}={number:g}' for name, number in zip(names, corner))):
            scene_at(np.array(corner))


_SEEDS = 2 ** 63   # that a scene may have


# A study as JSON values, and back: the file beside its table.

_OF_THE_SAMPLE = ('points', 'duration', 'over', 'sobol', 'uncertain')


def description(study: Study, command: str = '') -> dict[str, Any]:
    """Return all that a study is, enough to run it again, with the `command` and the versions that run it."""
    sample = study.sample
    return {
        'form': study.form, 'command': command, 'scene': study.scene.name, 'scene_hash': study.scene.hash,
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
    raise InputError('study', str(found.get('scene')), 'as written by sweep', 'it was changed; sweep again')


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
