# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""A scene as an FMU: the description of its variables, its numbers, the compiled engine and the sources."""

import io
import os
import struct
import sys
import zipfile
from collections.abc import Iterable, Iterator
from html import escape
from itertools import chain
from pathlib import Path
from typing import NamedTuple

from ..axis.fields import names_of
from ..axis.layout import PARAMETER_FIELDS
from ..axis.rows import SampleRow
from ..core import ranges
from ..core.errors import InputError
from ..core.hot_path import UNIT
from ..core.input_profile import InputProfile
from ..core.types import EventKind, Mode, Sample
from ..core.version import __version__
from ..plain_c.c_files import SceneNumbers, c_files, notes_of, numbers_of
from ..scene import PARAMETERS, Scene

_IDENTIFIER = 'stickslip_axis'
# The parameters of a running node that are numbers of the axis as well, by the fields that they set.
_TUNED = {
    'axis.mass': ('mass',), 'axis.drive_stiffness': ('stiffness',), 'axis.drive_damping': ('damping',),
    'axis.normal_force': ('normal_force',), 'contact.stiffness': ('contact_stiffness',),
    'contact.damping': ('contact_damping',), 'friction.static.initial': ('static_initial', 'backward_initial'),
    'friction.static.limit': ('static_limit', 'backward_limit'),
    'friction.static.time_constant': ('static_tau', 'backward_tau'),
    'friction.static.exponent': ('static_exponent', 'backward_exponent'), 'friction.static.delay': ('static_delay',),
    'friction.scale': ()}
_MOST = ranges.TIME.high   # of a number that has no limit of its own
_FNV_BASIS, _FNV_PRIME = 0xcbf29ce484222325, 0x100000001b3   # of the sum FNV-1a
_UNITS = {'s': {'s': 1}, 'm': {'m': 1}, 'm/s': {'m': 1, 's': -1}, 'm/s2': {'m': 1, 's': -2}, 'kg': {'kg': 1},
          'N': {'kg': 1, 'm': 1, 's': -2}, 'N/m': {'kg': 1, 's': -2}, 'N.s/m': {'kg': 1, 's': -1}}
_ENUMERATIONS = {'Mode': {mode.name: int(mode) for mode in Mode},
                 'EventKind': {'NONE': -1, **{'ARREST' if kind is EventKind.STICK else kind.name: int(kind)
                                              for kind in EventKind}}}
_BUILD = f'''<?xml version="1.0" encoding="UTF-8"?>
<fmiBuildDescription fmiVersion="3.0">
  <BuildConfiguration modelIdentifier="{_IDENTIFIER}">
    <SourceFileSet language="C11" compilerOptions="-O2 -ffp-contract=off -fvisibility=hidden">
      <SourceFile name="stickslip_axis.c"/>
      <SourceFile name="stickslip_fmu.c"/>
    </SourceFileSet>
    <Library name="m" external="true"/>
  </BuildConfiguration>
</fmiBuildDescription>
'''


class _Variable(NamedTuple):
    """A variable of the description; its type is Float64, Int64 or the name of an enumeration."""

    reference: int
    name: str
    type: str
    causality: str
    variability: str
    description: str
    unit: str = ''
    start: float | None = None
    low: float | None = None
    high: float | None = None


def fmu_bytes(scene: Scene, version: int) -> bytes:
    """Return the FMU of FMI `version` 3 or 2; raises InputError where it cannot be made."""
    if scene.solver.name != 'exact':
        raise InputError('solver.name', scene.solver.name, 'exact in an FMU', 'export with --set solver.name=exact')
    scene.make_simulator()    # refuses what the engine cannot follow
    sources, library, numbers = c_files(scene, 1.0), _library(), numbers_of(scene)
    variables = list(_variables(scene, numbers.profiles['normal']))
    files: dict[str, str | bytes] = {
             'modelDescription.xml': _description(scene, variables, version),
             'resources/axis.txt': _numbers(scene, numbers, variables),
             'resources/scene.yaml': scene.text,
             'sources/stickslip_fmu.c': (Path(__file__).parent / 'stickslip_fmu.c').read_text(encoding='utf-8'),
             **{f'sources/{name}': sources[name] for name in ('stickslip_axis.c', 'stickslip_axis.h')},
             f'binaries/{_platform(version)}/{_IDENTIFIER}.so': library}
    if version == 3:
        files['sources/buildDescription.xml'] = _BUILD
    out = io.BytesIO()
    with zipfile.ZipFile(out, 'w', zipfile.ZIP_DEFLATED) as archive:
        for name, text in files.items():
            archive.writestr(zipfile.ZipInfo(name), text, zipfile.ZIP_DEFLATED)    # the same bytes each time
    return out.getvalue()


def _library() -> bytes:
    """Return the engine as a shared library, which the build of the package makes beside the hot path."""
    path = Path(str(UNIT.__file__)) if UNIT else Path()
    path = path.with_name(path.name.replace('_hot', '_fmu', 1))
    if not path.is_file():
        raise InputError('FMU', 'no library', 'one beside the compiled hot path', 'build the package again')
    return path.read_bytes()


def _platform(version: int) -> str:
    machine = os.uname().machine.lower()
    return f'{sys.platform}64' if version == 2 and machine == 'x86_64' else f'{machine}-{sys.platform}'


def _variables(scene: Scene, normal: InputProfile | None) -> Iterator[_Variable]:
    """Yield all variables; the library has the references of those that it computes by heart."""
    yield _Variable(0, 'time', 'Float64', 'independent', 'continuous', 'simulation time', 's')
    for i, (name, what, unit, profile, low) in enumerate((
            ('drive_velocity', 'velocity of the drive', 'm/s', scene.drive, -_MOST),
            ('external_force', 'external force on the slider', 'N', scene.force, -_MOST),
            ('normal_force', 'normal force', 'N', normal, 0.0)), 1):
        if profile is not None:
            yield _Variable(i, f'{name}_command', 'Float64', 'input', 'continuous', f'{what}; the profile of the scene'
                            ' acts until this is set', unit, profile.value_at(0.0) + 0.0, low, _MOST)
    notes = notes_of(SampleRow)
    for i, (name, field) in enumerate(zip(Sample._fields[2:], names_of(SampleRow)[2:], strict=True), 10):
        kind = {'mode': 'Mode', 'direction': 'Int64'}.get(name, 'Float64')
        unit, _, what = notes[field].replace('^', '').partition(', ') if kind == 'Float64' else ('', '', notes[field])
        yield _Variable(i, name, kind, 'output', 'continuous' if kind == 'Float64' else 'discrete',
                        *((what, unit) if unit in _UNITS else (notes[field], '')))
    yield _Variable(30, 'event_count', 'Int64', 'output', 'discrete', 'events since the start')
    yield _Variable(31, 'event_time', 'Float64', 'output', 'discrete', 'time of the last event', 's')
    yield _Variable(32, 'event_kind', 'EventKind', 'output', 'discrete', 'kind of the last event')
    tuned = (one for one in PARAMETERS if one.name in _TUNED and (one.when is None or one.when.holds(scene.values))
             and not (one.name == 'axis.normal_force' and normal is not None)
             and (one.name != 'friction.scale' or scene.values.get(one.name) != 0.0))    # nothing grows out of 0
    for i, one in enumerate(tuned, 40):
        start = scene.values.get(one.name, 1.0 if one.name == 'friction.scale' else 0.0)
        yield _Variable(i, one.name, 'Float64', 'parameter', 'tunable', one.description, one.unit.replace(' ', '.'),
                        float(str(start)), one.low or 0.0, _MOST if one.high is None else one.high)


# The numbers that the library reads, as the bits of doubles: no locale and no rounding comes between.

def _numbers(scene: Scene, of: SceneNumbers, variables: Iterable[_Variable]) -> str:
    sections = [chain.from_iterable(_row(one, scene) for one in variables), of.parameters, of.initial, of.sinusoids,
                *map(_profile, of.profiles.values())]
    numbers = [float(number) for section in map(list, sections) for number in (len(section), *section)]
    words, total = struct.unpack(f'<{len(numbers)}Q', struct.pack(f'<{len(numbers)}d', *numbers)), _FNV_BASIS
    for word in words:
        total = (total ^ word) * _FNV_PRIME % 2**64
    return '\n'.join([f'{scene.hash} {len(words)} {total:x}', *map('{:016x}'.format, words), ''])


def _row(one: _Variable, scene: Scene) -> tuple[float, ...]:
    """Return a variable as the library has it, with the one or two numbers of the axis that it sets.

    Friction that depends on the direction has two numbers, of which the forward one is set.
    """
    is_what = {'input': 2, 'parameter': 3}.get(one.causality, int(one.type != 'Float64'))
    names = _TUNED.get(one.name, ())
    fields = [PARAMETER_FIELDS.index(name) for name in names] or [len(PARAMETER_FIELDS)]
    return (one.reference, is_what, one.start or 0.0, one.low or 0.0, one.high or 0.0, fields[0],
            fields[0 if scene.axis.friction.backward else -1])


def _profile(of: InputProfile | None) -> list[float]:
    return [of.period, *(value + 0.0 for value in chain(of.starts, of.values, of.rates))] if of else []


# The description in both versions

def _element(tag: str, /, *inside: str, **given: object) -> str:
    head = f'<{tag}' + ''.join(f' {name}="{escape(str(value))}"' for name, value in given.items()
                               if value is not None and value != '')
    return f'{head}>\n' + '\n'.join(inside) + f'\n</{tag}>' if inside else f'{head}/>'


def _description(scene: Scene, variables: list[_Variable], version: int) -> str:
    outputs = [(i, one.reference) for i, one in enumerate(variables, 1) if one.causality == 'output']
    items = {name: [_element('Item', name=item, value=value) for item, value in values.items()]
             for name, values in _ENUMERATIONS.items()}
    state = 'State' if version == 3 else 'state'
    able: dict[str, object] = {
        'modelIdentifier': _IDENTIFIER, 'canHandleVariableCommunicationStepSize': 'true',
        f'canGetAndSetFMU{state}': 'true', f'canSerializeFMU{state}': 'true'}
    if version == 3:
        kind = _element('CoSimulation', **able, hasEventMode='true')
        types = [_element('EnumerationType', *inside, name=name) for name, inside in items.items()]
        structure = [_element(tag, valueReference=reference) for tag in ('Output', 'InitialUnknown')
                     for _, reference in outputs]
        token = {'fmiVersion': '3.0', 'instantiationToken': scene.hash}
    else:
        kind = _element('CoSimulation', _element('SourceFiles', *(
            _element('File', name=name) for name in ('stickslip_axis.c', 'stickslip_fmu.c'))), **able)
        types = [_element('SimpleType', _element('Enumeration', *inside), name=name) for name, inside in items.items()]
        structure = [_element(tag, *(_element('Unknown', index=i) for i, _ in outputs))
                     for tag in ('Outputs', 'InitialUnknowns')]
        token = {'fmiVersion': '2.0', 'guid': scene.hash}
    return _element(
        'fmiModelDescription', kind,
        _element('UnitDefinitions', *(_element('Unit', _element('BaseUnit', **base), name=name)
                                      for name, base in _UNITS.items())),
        _element('TypeDefinitions', *types), '<LogCategories><Category name="logStatusError"/></LogCategories>',
        '<DefaultExperiment startTime="0" stopTime="10" stepSize="0.001"/>',
        _element('ModelVariables', *(_described(one, version) for one in variables)),
        _element('ModelStructure', *structure), **token, modelName=scene.name, description=scene.summary,
        generationTool=f'stickslip {__version__}', variableNamingConvention='structured')


def _described(one: _Variable, version: int) -> str:
    is_listed = one.type in _ENUMERATIONS
    what: dict[str, object] = {'name': one.name, 'valueReference': one.reference, 'causality': one.causality,
                               'variability': one.variability, 'description': one.description}
    value: dict[str, object] = {'declaredType': one.type if is_listed else None, 'unit': one.unit, 'min': one.low,
                                'max': one.high, 'start': one.start}
    kind = 'Enumeration' if is_listed else one.type
    if version == 3:
        return _element(kind, **what, **value)
    kind = {'Float64': 'Real', 'Int64': 'Integer'}.get(kind, kind)
    return _element('ScalarVariable', _element(kind, **value), **what)
