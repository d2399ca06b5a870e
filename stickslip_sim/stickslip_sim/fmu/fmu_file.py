# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""A scene as an FMU: the description of its variables, its numbers, the compiled engine and the sources."""

import io
import platform
import struct
import sys
import zipfile
from collections.abc import Iterator, Sequence
from itertools import chain
from pathlib import Path
from typing import NamedTuple
from xml.sax.saxutils import quoteattr

from ..axis import pack
from ..axis.layout import PARAMETER_FIELDS
from ..core import ranges
from ..core.errors import InputError
from ..core.hot_path import UNIT
from ..core.input_profile import InputProfile
from ..core.types import EventKind, Mode
from ..core.version import __version__
from ..plain_c.c_files import c_files
from ..scene import PARAMETERS, Scene
from ..simulation.inputs import Inputs, LoadedInputs

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
_FACTOR = 'friction.scale'
_UNITS = {'s': {'s': 1}, 'm': {'m': 1}, 'm/s': {'m': 1, 's': -1}, 'm/s2': {'m': 1, 's': -2}, 'kg': {'kg': 1},
          'N': {'kg': 1, 'm': 1, 's': -2}, 'N/m': {'kg': 1, 's': -2}, 'N.s/m': {'kg': 1, 's': -1}}
_OUTPUTS = {   # of a sample, in its order
    'mode': ('', 'what the slider does'), 'direction': ('', 'of slip, 0 in stick'), 'position': ('m', 'of the slider'),
    'velocity': ('m/s', 'of the slider'), 'acceleration': ('m/s2', 'of the slider'),
    'drive_position': ('m', 'of the drive'), 'drive_velocity': ('m/s', 'of the drive'),
    'drive_force': ('N', 'of the spring and the damper of the drive'), 'external_force': ('N', 'on the slider'),
    'friction_force': ('N', 'on the slider, against a slip'),
    'friction_coefficient': ('', 'size of the friction force over the normal force'),
    'contact_deflection': ('m', 'of a compliant contact'), 'rest_time': ('s', '0 where it does not stick')}
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
    sources = c_files(scene, 1.0)
    library = _library()
    tuned = [one for one in PARAMETERS if one.name in _TUNED and one.live
             and (one.when is None or one.when.holds(scene.values))
             and not (one.name == 'axis.normal_force' and scene.normal_load is not None)]
    starts = [float(str(scene.values.get(one.name, {_FACTOR: 1.0}.get(one.name, 0.0)))) for one in tuned]
    parameters = [_Variable(40 + i, one.name, 'Float64', 'parameter', 'tunable', one.description,
                            one.unit.replace(' ', '.'), start, one.low, one.high)
                  for i, (one, start) in enumerate(zip(tuned, starts, strict=True))]
    variables = [*_inputs(scene), *_outputs(), *parameters]
    rows = [(*_fields(one.name, scene), one.low or 0.0, ranges.TIME.high if one.high is None else one.high)
            for one in tuned]
    files: dict[str, str | bytes] = {
             'modelDescription.xml': (_description_3 if version == 3 else _description_2)(scene, variables),
             'resources/axis.txt': _numbers(scene, rows, starts, [one.start or 0.0 for one in _inputs(scene)]),
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
    machine = platform.machine().lower()
    return f'{sys.platform}64' if version == 2 and machine == 'x86_64' else f'{machine}-{sys.platform}'


def _fields(name: str, scene: Scene) -> tuple[float, float]:
    """Return where the one or two numbers of a parameter stand; friction that depends on the direction has two."""
    names = _TUNED[name]
    if not names:
        return float(len(PARAMETER_FIELDS)), 0.0
    return (float(PARAMETER_FIELDS.index(names[0])),
            float(PARAMETER_FIELDS.index(names[0 if scene.axis.friction.backward else -1])))


def _inputs(scene: Scene) -> list[_Variable]:
    load = scene.normal_load
    normal = load.plus(scene.axis.normal_force) if load else None
    return [_Variable(1 + i, f'{name}_command', 'Float64', 'input', 'continuous',
                      f'{what}; the profile of the scene acts until this is set', unit, profile.value_at(0.0) + 0.0)
            for i, (name, what, unit, profile) in enumerate((
                ('drive_velocity', 'velocity of the drive', 'm/s', scene.drive),
                ('external_force', 'external force on the slider', 'N', scene.force),
                ('normal_force', 'normal force', 'N', normal))) if profile is not None]


def _outputs() -> Iterator[_Variable]:
    for i, (name, (unit, what)) in enumerate(_OUTPUTS.items()):
        kind = {'mode': 'Mode', 'direction': 'Int64'}.get(name, 'Float64')
        yield _Variable(10 + i, name, kind, 'output', 'continuous' if kind == 'Float64' else 'discrete', what, unit)
    yield _Variable(30, 'event_count', 'Int64', 'output', 'discrete', 'events since the start')
    yield _Variable(31, 'event_time', 'Float64', 'output', 'discrete', 'time of the last event', 's')
    yield _Variable(32, 'event_kind', 'EventKind', 'output', 'discrete', 'kind of the last event')


# The numbers that the library reads, as the bits of doubles: no locale and no rounding comes between.

def _numbers(scene: Scene, rows: Sequence[Sequence[float]], starts: Sequence[float], commands: list[float]) -> str:
    parameters, load = pack(scene.axis), scene.normal_load
    normal = None if load is None else load.plus(scene.axis.normal_force)
    inputs = Inputs(scene.drive, scene.force) if load is None else LoadedInputs(scene.drive, scene.force, load)
    sinusoids, initial = inputs.sinusoids(), scene.initial
    profiles = [scene.drive, scene.force, normal]
    numbers = [
        len(parameters), len(rows), len(sinusoids) / 5, float(normal is not None),
        *(len(one.starts) if one else 0 for one in profiles), *parameters, *chain.from_iterable(rows), *starts,
        initial.position, initial.velocity, initial.rest_time, initial.stretch, initial.deflection,
        *commands, *[0.0] * (3 - len(commands)), *sinusoids, *chain.from_iterable(map(_profile, profiles))]
    words = (f'{struct.unpack("<Q", struct.pack("<d", number))[0]:016x}' for number in numbers)
    return '\n'.join([f'{scene.hash} {len(numbers)}', *words, ''])


def _profile(of: InputProfile | None) -> list[float]:
    return [of.period, *(value + 0.0 for value in chain(of.starts, of.values, of.rates))] if of else [0.0]


# The description in both versions

def _attributes(**given: object) -> str:
    return ''.join(f' {name.rstrip("_")}={quoteattr(str(value))}' for name, value in given.items()
                   if value is not None and value != '')


def _element(tag: str, /, *inside: str, **given: object) -> str:
    head = f'<{tag}{_attributes(**given)}'
    return f'{head}>\n' + '\n'.join(inside) + f'\n</{tag}>' if inside else f'{head}/>'


def _description_3(scene: Scene, variables: list[_Variable]) -> str:
    time = _Variable(0, 'time', 'Float64', 'independent', 'continuous', 'simulation time', 's')
    of_outputs = [{'valueReference': one.reference} for one in variables if one.causality == 'output']
    return _element(
        'fmiModelDescription',
        _element('CoSimulation', modelIdentifier=_IDENTIFIER, canHandleVariableCommunicationStepSize='true',
                 canGetAndSetFMUState='true', canSerializeFMUState='true', hasEventMode='true'),
        _units(), _element('TypeDefinitions', *(_element('EnumerationType', *_items(items), name=name)
                                                for name, items in _ENUMERATIONS.items())),
        '<LogCategories><Category name="logStatusError"/></LogCategories>',
        '<DefaultExperiment startTime="0" stopTime="10" stepSize="0.001"/>',
        _element('ModelVariables', *(_element(
            one.type if one.type not in _ENUMERATIONS else 'Enumeration', name=one.name, valueReference=one.reference,
            declaredType=one.type if one.type in _ENUMERATIONS else None, causality=one.causality,
            variability=one.variability, description=one.description, unit=one.unit, min=one.low, max=one.high,
            start=one.start) for one in (time, *variables))),
        _element('ModelStructure', *(_element('Output', **one) for one in of_outputs),
                 *(_element('InitialUnknown', **one) for one in of_outputs)),
        fmiVersion='3.0', instantiationToken=scene.hash, **_of_the_model(scene))


def _description_2(scene: Scene, variables: list[_Variable]) -> str:
    def typed(one: _Variable) -> str:
        name = {'Float64': 'Real', 'Int64': 'Integer'}.get(one.type, 'Enumeration')
        return _element(name, declaredType=one.type if name == 'Enumeration' else None, unit=one.unit, min=one.low,
                        max=one.high, start=one.start)

    of_outputs = [_element('Unknown', index=i) for i, one in enumerate(variables, 1) if one.causality == 'output']
    return _element(
        'fmiModelDescription',
        _element('CoSimulation', _element('SourceFiles', _element('File', name='stickslip_axis.c'),
                                          _element('File', name='stickslip_fmu.c')),
                 modelIdentifier=_IDENTIFIER, canHandleVariableCommunicationStepSize='true',
                 canGetAndSetFMUstate='true', canSerializeFMUstate='true'),
        _units(), _element('TypeDefinitions', *(
            _element('SimpleType', _element('Enumeration', *_items(items)), name=name)
            for name, items in _ENUMERATIONS.items())),
        '<LogCategories><Category name="logStatusError"/></LogCategories>',
        '<DefaultExperiment startTime="0" stopTime="10" stepSize="0.001"/>',
        _element('ModelVariables', *(_element(
            'ScalarVariable', typed(one), name=one.name, valueReference=one.reference, causality=one.causality,
            variability=one.variability, description=one.description) for one in variables)),
        _element('ModelStructure', _element('Outputs', *of_outputs), _element('InitialUnknowns', *of_outputs)),
        fmiVersion='2.0', guid=scene.hash, **_of_the_model(scene))


def _of_the_model(scene: Scene) -> dict[str, object]:
    return {'modelName': scene.name, 'description': scene.summary, 'generationTool': f'stickslip {__version__}',
            'variableNamingConvention': 'structured'}


def _units() -> str:
    return _element('UnitDefinitions', *(_element('Unit', _element('BaseUnit', **base), name=name)
                                         for name, base in _UNITS.items()))


def _items(items: dict[str, int]) -> list[str]:
    return [_element('Item', name=name, value=value) for name, value in items.items()]
