# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The scene that was identified, as a file that says of each number where it comes from."""

import itertools
import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from ..core.arrays import Numbers
from ..core.errors import InputError
from ..core.input_profile import InputProfile
from ..core.version import __version__
from ..report.quantity import quantity
from ..scene import Scene, scene_from_values
from ..scene.build import Dynamics
from ..scene.schema import BY_NAME, MOST_POINTS
from ..study.points import scene_at
from ..study.sample import LAWS, Distribution
from ..study.study import MOST_VARIATIONS
from ..study.uncertainty import LEAST_KEPT
from ..study.variation import parameter_of
from .curve.best_law import short_text
from .identified import AT_BOUND, FOUND, NOT_IDENTIFIABLE, VOID, Combination, Estimate, Identification, moved
from .readings import SensorReadings

# The scene that was found with the inputs that were measured in place of its own, so that it runs as the axis did.

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


IDENTIFIED_SCENE = 'identified.yaml'
OF_SENSORS = 'sensor.'
_BEYOND = 1e-3    # of the standard deviation: digits below it say nothing
_DIGITS = 6       # or more


def identified_text(found: Identification, run: str, start: str) -> str:
    """Return the scene as a file; `run` and `start` are the names of the measurement and of the scene it began with."""
    scene = rounded_scene(found)
    estimates = {one.name: one for one in found.estimates}
    remarks = {name: _remark(name, value, estimates, start) for name, value in scene.values.items()}
    files = {f'{section}.file': FORMS[section].file for section in found.measured_inputs}
    remarks |= dict.fromkeys(files, 'as it was measured')
    points = {f'{section}.{name}' for section in found.measured_inputs for name in ('times', FORMS[section].values)}
    return '\n'.join(_head(found, run, start)) + '\n' + short_text(scene, remarks, files, points)


def input_texts(found: Identification) -> dict[str, str]:
    """Return the measured inputs that the scene names, as CSV files by their names."""
    values = found.scene.values
    texts = {}
    for section in found.measured_inputs:
        form = FORMS[section]
        times, numbers = values[f'{section}.times'], values[f'{section}.{form.values}']
        assert isinstance(times, tuple)
        assert isinstance(numbers, tuple)
        rows = (f'{time!r},{number!r}' for time, number in zip(times, numbers, strict=True))
        texts[form.file] = '\n'.join((f'time,{form.column}', *rows)) + '\n'
    return texts


def rounded_scene(found: Identification) -> Scene:
    """Return the identified scene without digits that mean nothing; all of them where rounding gives no scene."""
    known = [one for one in found.estimates if not one.name.startswith(OF_SENSORS) and one.kind != NOT_IDENTIFIABLE]
    try:
        return scene_at(found.scene.values, [one.name for one in known], np.array([*map(_rounded, known)]))
    except InputError:
        return found.scene


def number_words(value: float, unit: str) -> str:
    """Return a number with its unit, for people: with a prefix where that is usual, not before s/m or N s/m."""
    return f'{value:.5g} {unit}' if ' ' in unit or unit.startswith('s/') else quantity(value, unit)


def interval_words(one: Estimate) -> str:
    """Return the 95 % interval of an estimate, for people: by its width where the digits of its ends do not differ."""
    low, high = one.best_interval
    if math.isnan(low):
        return 'void'
    ends = [number_words(end, one.unit) for end in (low, high)]
    if ends[0] != ends[1] or low == high:
        return ' to '.join(ends)
    return f'{ends[0]} ± {quantity(0.5 * (high - low), one.unit, 2)}'


def _rounded(one: Estimate) -> float:
    """Return the value to a thousandth of its standard deviation, and to six digits at least."""
    spread = one.standard_deviation if one.logarithmic else one.standard_deviation / max(abs(one.value), 1e-300)
    digits = _DIGITS
    if 0.0 < spread < math.inf:
        digits = min(max(_DIGITS, math.ceil(-math.log10(_BEYOND * spread))), 17)
    return float(f'{one.value:.{digits}g}')


def _head(found: Identification, run: str, start: str) -> Iterator[str]:
    channels = ' and '.join(one.name for one in found.channels)
    yield f'# {found.scene.name}: identified from {channels} of the run {run}, with {start} to begin with.'
    yield f'# By stickslip {__version__}; the figures in brackets are 95 % intervals.'
    if not found.fits:
        yield '# THE MODEL DOES NOT FIT this run: no interval holds; report.html shows where.'
    for one in found.estimates:
        if one.name.startswith(OF_SENSORS):
            value = number_words(one.value, one.unit)
            yield f'# Of a sensor, and not of the scene: {one.name} {value} ({interval_words(one)})'
    for together in found.combinations:
        yield f'# {together.statement}'


def _remark(name: str, value: object, estimates: Mapping[str, Estimate], start: str) -> str:
    """Return where a value comes from; empty for a word."""
    unit = BY_NAME[name].unit
    if isinstance(value, tuple):
        own = {index: estimates[key] for index in range(len(value)) if (key := f'{name}[{index}]') in estimates}
        origins = [f'[{index}] {_origin(one)}' for index, one in own.items()]
        if len(own) < len(value):
            origins.append(f'{"the others" if own else "as"} in {start}')
        return _with_unit(unit, '; '.join(origins)) if isinstance(value[0], float) else ''
    if name in estimates:
        return _with_unit(unit, _origin(estimates[name]))
    return _with_unit(unit, f'as in {start}') if isinstance(value, float) else ''


def _with_unit(unit: str, text: str) -> str:
    return f'{unit}; {text}' if unit else text


def _origin(one: Estimate) -> str:
    if one.kind == NOT_IDENTIFIABLE:
        return f'not identifiable from this run: {one.derivation}'
    bound = f'at the end of its range {one.low:g} to {one.high:g}, or at a fixed number of the scene'
    where = {AT_BOUND: bound, FOUND: 'found'}.get(one.kind, 'the best of a model that does not fit')
    low, high = one.best_interval
    interval = '' if math.isnan(low) else f' ({low:.6g} to {high:.6g})'
    return f'{where}{interval}, start {one.start:.6g}: {one.derivation}'


# What an identification leaves open of a scene, as a file for `stickslip uncertainty --with`.
#
# A number that was found is normal, or lognormal where the fit took its logarithm, and correlated with the others as in
# the fit.  One at the end of its range falls from there; those that the run knows only together share a factor, and
# one that it does not know at all is uniform over its range.

# Numbers that a run knows only together, as distributions: each by itself is wide, and all go up and down as one.
#
# Where only the product of pₖ to the power wₖ is free, ln pₖ = ln p̂ₖ + wₖ s with one s for all: the covariance of the
# logarithms is σ² w wᵀ, with σ as wide as the ranges leave it.

REACH = 2.0   # standard deviations from the value to the nearest end of a range


def with_shared_factors(found: Identification) -> tuple[list[Estimate], Numbers, frozenset[str]]:
    """Return the estimates and their correlation (k, k), with those of combinations as if found, and their names."""
    estimates = list(found.estimates)
    places = {one.name: k for k, one in enumerate(estimates) if one.kind == NOT_IDENTIFIABLE}
    covariance = np.zeros((len(estimates),) * 2)
    for together in found.combinations:
        if len(together.names) > 1 and all(name in places for name in together.names):
            rows = [places[name] for name in together.names]
            weights = np.zeros(len(estimates))
            weights[rows] = together.weights
            covariance += _shared_spread(together, [estimates[k] for k in rows])**2 * np.outer(weights, weights)
    deviations = np.sqrt(np.diag(covariance))
    shared = [k for k in range(len(estimates)) if deviations[k] > 0.0]
    correlation = np.array(found.correlation, dtype=np.float64)
    correlation[shared] = correlation[:, shared] = 0.0
    for i in shared:
        for j in shared:
            correlation[i, j] = covariance[i, j] / (deviations[i] * deviations[j])
        scale = 1.0 if estimates[i].logarithmic else estimates[i].high - estimates[i].low
        estimates[i] = replace(estimates[i], kind=FOUND, standard_deviation=float(deviations[i]) * scale)
    return estimates, correlation, frozenset(estimates[k].name for k in shared)


def _shared_spread(together: Combination, estimates: list[Estimate]) -> float:
    """Return the standard deviation of what is free: no number is to leave its range within REACH of them."""
    ways = [_way(one) / abs(weight) for one, weight in zip(estimates, together.weights, strict=True)]
    return min(together.spread, min(ways) / REACH)


def _way(one: Estimate) -> float:
    """Return how far it is to the nearest end of the range, as the fit sees the number."""
    if one.logarithmic:
        return max(min(math.log(one.high / one.value), math.log(one.value / one.low)), 0.0)
    return max(min(one.high - one.value, one.value - one.low), 0.0) / (one.high - one.low)


_TAILS = (4.0, 3.0, 2.0, 1.5, 1.0)   # standard deviations: the widest whose corners are scenes
_WEAKEST = 5e-4                      # a correlation that is left out
_SHRINK = 1e-6                       # of the correlations: what rounding makes indefinite is a matrix again
_LEAST = 1e-9                        # of the eigenvalues
_NARROWEST = 1e-9                    # of its size: a standard deviation that is smaller is rounding


class _Entry(NamedTuple):
    """A distribution of the file: its words, and the ends of its range."""

    words: str
    low: float
    high: float


def posterior_text(found: Identification, run: str) -> str:
    """Return the file: numbers of the scene that were free, at most as many as a study takes."""
    every, correlation, shared = with_shared_factors(found)
    free = [k for k, one in enumerate(every) if not one.name.startswith(OF_SENSORS)]
    chosen = sorted(sorted(free, key=lambda k: -_relative(every[k]))[:MOST_VARIATIONS])
    estimates = [every[k] for k in chosen]
    entries = _entries(rounded_scene(found), estimates, shared)
    lines = [f'# What the run {run} leaves open of {found.scene.name}, for stickslip uncertainty --with.',
             '# Correlations are those of the fit.',
             *([] if found.fits else ['# THE MODEL DOES NOT FIT this run: neither do these spreads hold.']),
             *_left_out(found, free, chosen), 'seed: 0', 'parameters:']
    lines += [f'  {_key(one.name)}: {{{entry.words}}}' for one, entry in zip(estimates, entries, strict=True)]
    return '\n'.join([*lines, *_correlation_lines(estimates, correlation[np.ix_(chosen, chosen)])]) + '\n'


def _relative(one: Estimate) -> float:
    return math.inf if one.kind == NOT_IDENTIFIABLE else _spread(one) / (1.0 if one.logarithmic else _size(one))


def _left_out(found: Identification, free: Sequence[int], chosen: Sequence[int]) -> Iterator[str]:
    names = [found.estimates[k].name for k in free if k not in chosen]
    if names:
        yield f'# A study takes {MOST_VARIATIONS} numbers; those known best are left out: {", ".join(names)}'


def _entries(scene: Scene, estimates: Sequence[Estimate], shared: frozenset[str]) -> list[_Entry]:
    """Return the distributions, with tails as long as every combination of their ends is a scene.

    Those of `shared` factors are all cut at one place, so that they stay together, and within their ranges.
    """
    for tails in _TAILS:
        found = [_entry(one, min(tails, REACH) if one.name in shared else tails) for one in estimates]
        if _corners_are_scenes(scene, estimates, found):
            break
    return found


def _corners_are_scenes(scene: Scene, estimates: Sequence[Estimate], entries: Sequence[_Entry]) -> bool:
    names = [one.name for one in estimates]
    try:
        for corner in itertools.product(*((entry.low, entry.high) for entry in entries)):
            scene_at(scene.values, names, np.array(corner))
    except InputError:
        return False
    return True


def _entry(one: Estimate, tails: float) -> _Entry:
    if one.kind == NOT_IDENTIFIABLE:
        return _Entry(f'distribution: uniform, low: {one.low!r}, high: {one.high!r}', one.low, one.high)
    spread = _spread(one)
    if one.kind not in (FOUND, VOID):
        return _one_sided(one, spread)
    law, number = ('lognormal', math.exp(spread)) if one.logarithmic else ('normal', spread)
    numbers = one.value, number
    low, high = _allowed(one.name, moved(one, -tails * spread), moved(one, tails * spread))
    if Distribution(one.name, law, numbers, low, high).kept < LEAST_KEPT:
        return _one_sided(one, spread)
    words = ', '.join(f'{name}: {number!r}' for name, number in zip(LAWS[law].numbers, numbers, strict=True))
    return _Entry(f'distribution: {law}, {words}, between: [{low!r}, {high!r}]', low, high)


def _one_sided(one: Estimate, spread: float) -> _Entry:
    """Return what falls from the end of a range inwards, over two standard deviations."""
    inward = 1.0 if one.value - one.low <= one.high - one.value else -1.0
    low, high = sorted((one.value, min(max(moved(one, 2.0 * inward * spread), one.low), one.high)))
    return _Entry(f'distribution: triangular, low: {low!r}, mode: {one.value!r}, high: {high!r}', low, high)


def _spread(one: Estimate) -> float:
    """Return the standard deviation, of the logarithm where the fit took it, between that of rounding and the range."""
    width = math.log(one.high / one.low) if one.logarithmic else one.high - one.low
    known = one.standard_deviation if math.isfinite(one.standard_deviation) else 0.0
    return max(min(known, width), _NARROWEST * (1.0 if one.logarithmic else _size(one)))


def _size(one: Estimate) -> float:
    return max(abs(one.value), one.high - one.low)


def _allowed(name: str, low: float, high: float) -> tuple[float, float]:
    """Return a range within that of the parameter."""
    entry, _ = parameter_of(name)
    return (low if entry.low is None else max(low, entry.low)), (high if entry.high is None else min(high, entry.high))


def _correlation_lines(estimates: Sequence[Estimate], correlation: Numbers) -> Iterator[str]:
    if len(estimates) < 2:    # none where numbers of sensors alone were free
        return
    matrix = _definite(estimates, correlation)
    names = [one.name for one in estimates]
    rows = [[(names[j], matrix[i, j]) for j in range(i) if abs(matrix[i, j]) > _WEAKEST] for i in range(len(names))]
    if any(rows):
        yield 'correlations:'
    for name, row in zip(names, rows):
        if row:
            yield f'  {_key(name)}: {{{", ".join(f"{_key(other)}: {number:.6f}" for other, number in row)}}}'


def _definite(estimates: Sequence[Estimate], correlation: Numbers) -> Numbers:
    """Return the correlations of numbers that were found, shrunk until they are definite; 0 for all others."""
    known = np.array([one.kind in (FOUND, VOID) for one in estimates])
    matrix = np.where(np.isfinite(correlation) & known & known[:, None], correlation, 0.0)
    matrix[np.abs(matrix) <= _WEAKEST] = 0.0
    np.fill_diagonal(matrix, 1.0)
    shrink = _SHRINK
    while np.linalg.eigvalsh(matrix)[0] < _LEAST or np.abs(matrix - np.eye(len(matrix))).max(initial=0.0) > 0.999999:
        matrix = (1.0 - shrink) * matrix + shrink * np.eye(len(matrix))
        shrink *= 2.0
    return matrix


def _key(name: str) -> str:
    return f'"{name}"' if '[' in name else name
