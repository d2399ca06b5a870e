# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The scene that was identified, as a file that says of each number where it comes from."""

import math
from collections.abc import Iterator, Mapping
from typing import NamedTuple

import numpy as np

from ..core.errors import InputError
from ..core.input_profile import InputProfile
from ..core.version import __version__
from ..report.quantity import quantity
from ..scene import Scene, scene_from_values
from ..scene.build import Dynamics
from ..scene.profile_schema import MOST_POINTS
from ..scene.schema import BY_NAME
from ..study.points import scene_at
from .curve.law_in_scene import short_text
from .identified import AT_BOUND, FOUND, NOT_IDENTIFIABLE, Estimate, Identification
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
    where = {AT_BOUND: f'at the end of its range {one.low:g} to {one.high:g}', FOUND: 'found'}.get(
        one.kind, 'the best of a model that does not fit')
    low, high = one.best_interval
    interval = '' if math.isnan(low) else f' ({low:.6g} to {high:.6g})'
    return f'{where}{interval}, start {one.start:.6g}: {one.derivation}'
