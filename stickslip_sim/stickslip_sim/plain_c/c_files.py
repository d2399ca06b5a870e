# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The engine as one file of plain C with its header, and an example of a scene: for any program that is not Python."""

import re
import sys
import zlib
from collections.abc import Iterator, Sequence
from pathlib import Path
from string import Template
from typing import Any, NamedTuple

from ..axis import pack
from ..axis.fields import names_of
from ..axis.layout import PARAMETER_FIELDS, SEGMENT_FIELDS, Parameters, Segment
from ..axis.rows import EnergyRow, EventRow, GivenSinusoid, SampleRow
from ..core.errors import InputError
from ..core.hot_path import UNIT, hot_path
from ..core.input_profile import InputProfile
from ..core.types import EventKind, Mode
from ..core.version import __version__
from ..scene import Scene
from ..simulation.inputs import Inputs, LoadedInputs

NAMES = 'stickslip_axis.c', 'stickslip_axis.h', 'example.c'
_HERE = Path(__file__).parent


class SceneNumbers(NamedTuple):
    """A scene as its numbers: of its axis, how it begins, its inputs, and their sinusoids in a row."""

    parameters: Sequence[float]
    initial: list[float]
    profiles: dict[str, InputProfile | None]    # of drive, force and normal force
    sinusoids: list[float]


def numbers_of(scene: Scene) -> SceneNumbers:
    """Return the numbers that a program outside of Python gets of a scene."""
    load, initial = scene.normal_load, scene.initial
    inputs = Inputs(scene.drive, scene.force) if load is None else LoadedInputs(scene.drive, scene.force, load)
    return SceneNumbers(
        pack(scene.axis),
        [initial.position, initial.velocity, initial.rest_time, initial.stretch, initial.deflection],
        {'drive': scene.drive, 'force': scene.force, 'normal': load and load.plus(scene.axis.normal_force)},
        inputs.sinusoids())


def c_files(scene: Scene, duration: float) -> dict[str, str]:
    """Return the texts of the three files, by name; raises InputError where plain Python runs."""
    if UNIT is None:
        raise InputError('hot path', hot_path(), 'compiled: it carries its C',
                         'build the package with a C compiler, and leave STICKSLIP_COMPILED=0 out')
    engine: str = zlib.decompress(UNIT.ENGINE).decode()
    return {'stickslip_axis.c': engine + _text('stickslip_axis.c'),
            'stickslip_axis.h': filled('stickslip_axis.h', _header()),
            'example.c': filled('example.c', _example(scene, duration))}


def _header() -> dict[str, Any]:
    notes, of_segments = notes_of(Parameters), notes_of(Segment)
    return {
        'VERSION': __version__, 'SEGMENT_SIZE': len(SEGMENT_FIELDS),
        'SEGMENTS': ';\n   '.join(f'{name}: {of_segments[name]}' for name in SEGMENT_FIELDS),
        'PARAMETERS': '\n'.join(f'    AXIS_{name.upper()},   /* {notes[name]} */' for name in PARAMETER_FIELDS),
        'MODES': ''.join(f', AXIS_{mode.name}' for mode in sorted(Mode)[1:]),
        'KINDS': ''.join(f', AXIS_{"ARREST" if kind.name == "STICK" else kind.name}' for kind in sorted(EventKind)[1:]),
        **{record.__name__: _fields(record) for record in (GivenSinusoid, EventRow, SampleRow, EnergyRow)}}


def _example(scene: Scene, duration: float) -> dict[str, Any]:
    numbers, initial, profiles, sinusoids = numbers_of(scene)
    rows = [sinusoids[i:i + 5] for i in range(0, len(sinusoids), 5)]
    arrays, words, notes = list[str](), dict[str, str](), notes_of(Parameters)
    for name, profile in profiles.items():
        words[name.upper()] = '{0}' if profile is None else _profile(name, profile, arrays)
    if rows:
        arrays.append(f'static const axis_sinusoid sinusoids[] = {{{", ".join(f"{{{c_row(row)}}}" for row in rows)}}};')
    return {
        'NAME': scene.name, 'VERSION': __version__, 'DURATION': _number(duration),
        'PARAMETERS': '\n'.join([
            *(f'    [AXIS_{name.upper()}] = {_number(number)},   /* {notes[name]} */'
              for name, number in zip(PARAMETER_FIELDS, numbers, strict=False)),
            *(f'    {c_row(numbers[i:i + len(SEGMENT_FIELDS)])},'
              for i in range(len(PARAMETER_FIELDS), len(numbers), len(SEGMENT_FIELDS)))]),
        'ARRAYS': '\n'.join(['', *arrays, '']) if arrays else '',
        'VARIES': 'true' if profiles['normal'] else 'false', 'COUNT': len(rows),
        'SINUSOIDS': 'sinusoids' if rows else 'NULL', 'INITIAL': c_row(initial), **words}


def _profile(name: str, of: InputProfile, arrays: list[str]) -> str:
    """Return an input in C; one of more pieces than one adds its arrays."""
    if len(of.starts) == 1 and of.period == float('inf'):
        return f'{{.value = {_number(of.values[0])}, .rate = {_number(of.rates[0])}}}'
    for what, row in (('starts', of.starts), ('values', of.values), ('rates', of.rates)):
        arrays.append(f'static const double {name}_{what}[] = {{{c_row(row)}}};')
    return (f'{{.count = {len(of.starts)}, .starts = {name}_starts, .values = {name}_values, .rates = {name}_rates, '
            f'.period = {_number(of.period)}}}')


def _fields(record: type[Any]) -> str:
    notes = notes_of(record)
    return '\n'.join(f'    double {"static_" if name == "static" else name};' + (f'   /* {note} */' if note else '')
                     for name in names_of(record) for note in [notes.get(name, '')])


def notes_of(record: type[Any]) -> dict[str, str]:
    """Return what the source says of each field, in characters of C."""
    source = Path(sys.modules[record.__module__].__file__ or '').read_text(encoding='utf-8')
    _, _, body = source.partition(f'\nclass {record.__name__}:\n')    # `inspect` takes 5 ms for each
    found = re.findall(r'^    (\w+): float\b[^#\n]*(?:# *(.*))?$', re.split(r'\n(?=\S)', body)[0], re.MULTILINE)
    return {name: note.rstrip(',').replace('`', '').replace('²', '^2') for name, note in found}


def c_row(numbers: Any) -> str:
    """Return numbers as they stand in an array of C."""
    return ', '.join(map(_number, numbers))


def _number(number: float) -> str:
    return {'inf': 'INFINITY', '-inf': '-INFINITY'}.get(repr(float(number)), repr(float(number)))


def _text(name: str) -> str:
    return (_HERE / name).read_text(encoding='utf-8')


def filled(name: str, words: dict[str, Any]) -> str:
    """Return a template of this room with its words filled in."""
    return Template(_text(name)).substitute(words)


def written(folder: Path, scene: Scene, duration: float) -> Iterator[Path]:
    """Write the files into a folder; yield their paths."""
    for name, text in c_files(scene, duration).items():
        (folder / name).write_text(text, encoding='utf-8')
        yield folder / name
