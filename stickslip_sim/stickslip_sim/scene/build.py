# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""From values to a scene: each section becomes an object of a room below, which checks it."""

import math
from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import Any, NamedTuple

from ..axis import Axis, CompliantContact, Friction, InitialState, RigidContact, check_start
from ..core import input_profile
from ..core.errors import InputError
from ..core.input_profile import InputProfile, Sinusoid
from ..core.time_grid import Grid
from ..friction import ExcessTable, KineticTable, Scatter, StaticLaw, StaticLawKind, excess_table, kinetic_table, smooth
from ..friction.kinetic import default_excess
from ..simulation.faults import Faults
from ..simulation.plant import with_friction_scaled
from ..simulation.rig import RigSettings
from ..solvers.normal_load import under_load
from . import model
from .model import Scene, SolverSettings
from .schema import BACKWARD, BY_NAME, FILE_SETTINGS, JOINT_PREFIX, PROFILES, backward_name, forward_name
from .values import complete_values, section_of

# The friction of a scene, from complete values: forwards, and backwards where that differs.

_SECTIONS = ('friction.static.', 'friction.kinetic.', 'friction.excess.')
_INSIDE = f'.{BACKWARD}.'

_KINETIC: dict[str, Callable[..., smooth.SmoothKinetic]] = {
    'stribeck': smooth.stribeck, 'exponential': smooth.exponential, 'hyperbolic': smooth.hyperbolic,
}
_EXCESS: dict[str, Callable[..., smooth.SmoothExcess]] = {'cosine': smooth.cosine, 'power': smooth.power}


def friction_of(values: Mapping[str, Any]) -> Friction:
    """Return the friction of complete values; raises InputError."""
    forwards = {name: value for name, value in values.items() if _INSIDE not in name}
    changes = {forward_name(name): value for name, value in values.items() if _INSIDE in name}
    friction = _one_way(forwards)
    back = friction if not changes else _backwards(forwards | changes)
    return friction if back == friction else replace(friction, backward=back)


def _backwards(values: Mapping[str, Any]) -> Friction:
    """Return the friction of motion along −x; an InputError names the parameter of that."""
    try:
        return _one_way(values)
    except InputError as error:
        name, allowed = backward_name(error.name.partition('[')[0]), error.allowed
        for section in _SECTIONS:
            allowed = allowed.replace(section, f'{section}{BACKWARD}.')
        raise InputError(name if name in BY_NAME else error.name, error.value, allowed,
                         f'{error.fix}; backwards, what is left out is as forwards') from None


def _one_way(values: Mapping[str, Any]) -> Friction:
    static = section_of(values, 'friction.static')
    law = StaticLawKind[static.pop('law').upper()]
    static.setdefault('limit', static['initial'])
    deviation, of_run = static.pop('scatter', 0.0), static.pop('scatter_run', 0.0)
    if deviation or of_run:
        static['scatter'] = Scatter(deviation, of_run, values['seed'])
    kinetic = _kinetic(section_of(values, 'friction.kinetic'))
    return Friction(StaticLaw(law, **static), kinetic, _excess(values, kinetic))


def _kinetic(given: dict[str, Any]) -> KineticTable:
    law = given.pop('law')
    if law == 'table':
        return KineticTable(**given)
    tolerance = given.pop('tolerance')
    return kinetic_table(_KINETIC[law](**given), tolerance)


def _excess(values: Mapping[str, Any], kinetic: KineticTable) -> ExcessTable | None:
    if not values['friction.acceleration_dependence']:
        return None
    excess = section_of(values, 'friction.excess')
    law = excess.pop('law')
    if law != 'table':
        tolerance = excess.pop('tolerance')
        if 'limit_velocity' not in excess:
            excess['limit_velocity'] = default_excess(kinetic).velocities[-1]
        return excess_table(_EXCESS[law](**excess), tolerance)
    if len(excess) == 1:
        (given,) = excess
        raise InputError(f'friction.excess.{given}', excess[given], 'given with both velocities and fractions',
                         'add the other, or leave both out')
    return ExcessTable(**excess) if excess else default_excess(kinetic)


# Friction as the planned faults of a scene scale it, checked before the run.

def check_scaled_friction(axis: Axis, solver: SolverSettings, rig: RigSettings, rate: float) -> None:
    """Raise InputError when the solver cannot follow the axis at some time; `rate` in steps a second."""
    plan = Faults(Grid(rate), rig.faults)
    while plan.next_change < math.inf:
        plan.enter(int(plan.next_change))
        scale = plan.effect.friction_scale
        try:
            solver.check(with_friction_scaled(axis, scale))
        except InputError as error:
            raise InputError(f'with friction times {scale:g} by faults: {error.name}', error.value, error.allowed,
                             error.fix) from None


_BREAKPOINTS: dict[str, Callable[..., InputProfile]] = {'steps': input_profile.steps, 'table': input_profile.table}


class Dynamics(NamedTuple):
    """The part of a scene that decides the motion: axis, start, drive velocity (m/s), external force and load (N)."""

    axis: Axis
    initial: InitialState
    drive: InputProfile
    force: InputProfile
    load: InputProfile | None


def scene_from_values(values: Mapping[str, Any], summary: str = '') -> Scene:
    """Return the scene of values by dotted name, as a file with these would; None counts as not given.

    Raises InputError.
    """
    _check_read(values)
    values = complete_values(values)
    axis, initial, drive, force, load = dynamics_of(values)
    if 'solver.method' not in values and (method := model.method_of(values)):
        values['solver.method'] = method
    solver = SolverSettings(**section_of(values, 'solver'))
    solver.check(axis)
    if load is not None:
        _check_load(axis, solver, load)
    rig = model.rig_settings(values)
    check_scaled_friction(axis, solver, rig, values['time.rate'])
    time = model.time_settings(values)
    if values.get('record.log_time') == 'wall' and not time.is_wall_time:
        raise InputError('record.log_time', 'wall', 'simulation unless time.mode is realtime and time.factor is 1',
                         'stamps are simulation time here, and so are those of other bags: leave it out')
    return Scene(
        name=values['scene'],
        summary=summary or _summary(values),
        axis=axis,
        initial=initial,
        drive=drive,
        force=force,
        solver=solver,
        time=time,
        command=model.CommandSettings(*(values[f'command.{name}'] for name in model.CommandSettings.__slots__)),
        timing=model.TimingSettings(**section_of(values, 'timing')),
        rig=rig,
        record=model.RecordSettings(**section_of(values, 'record')),
        joint_prefix=str(values.get(JOINT_PREFIX.name, '')),
        seed=values['seed'],
        values=values,
        normal_load=load,
    )


def dynamics_of(values: Mapping[str, Any]) -> Dynamics:
    """Return what decides the motion, from complete values; raises InputError where they contradict each other."""
    axis = _axis(values)
    initial = InitialState(**section_of(values, 'initial'))
    load = _profile(values, 'normal_load', 'constant', 'rate', 'forces') if 'normal_load.course' in values else None
    check_start(axis, initial, load.value_at(0.0) if load else 0.0)
    if values['drive.course'] == 'position':
        input_profile.check_first_position('drive', values['drive.positions'][0], initial.position + initial.stretch)
    return Dynamics(axis, initial, _profile(values, 'drive', 'velocity', 'acceleration', 'velocities'),
                    _profile(values, 'force', 'constant', 'rate', 'forces'), load)


def _check_read(values: Mapping[str, object]) -> None:
    """Raise InputError on a profile in a file: who loads a scene has put its points in place of it."""
    for section in PROFILES:
        for name in FILE_SETTINGS:
            if (value := values.get(f'{section}.{name}')) is not None:
                raise InputError(f'{section}.{name}', value, f'in a scene file with {section}.file',
                                 'a recorded scene has the times and values themselves')


def _check_load(axis: Axis, solver: SolverSettings, load: InputProfile) -> None:
    """Raise InputError when the solver cannot follow an axis with a load on top of its normal force."""
    normal_force = load.plus(axis.normal_force)
    under_load(solver.make(axis), axis, normal_force)
    for normal in normal_force.bounds() if normal_force.is_stepwise else ():
        solver.check(replace(axis, normal_force=normal))


def _axis(values: Mapping[str, Any]) -> Axis:
    contact = section_of(values, 'contact')
    kind, arrest, ends_by = (contact.pop(name, None) for name in ('model', 'arrest', 'break_away'))
    compliant = kind == 'compliant' and CompliantContact(**contact, undeflected=arrest == 'undeflected',
                                                          ends_by_drive=ends_by == 'drive_force')
    given = section_of(values, 'axis')
    on_slideway = given.pop('damper', None) == 'slideway'
    axis = Axis(**given, friction=friction_of(values), contact=compliant or RigidContact(),
                damper_on_slideway=on_slideway)
    return with_friction_scaled(axis, values.get('friction.scale', 1.0))


def _profile(values: Mapping[str, Any], section: str, value: str, rate: str, breakpoints: str) -> InputProfile:
    given = section_of(values, section)
    profile = _pieces(given, section, value, rate, breakpoints)
    return replace(profile, sinusoids=_sinusoids(given, section))


def _pieces(given: Mapping[str, Any], section: str, value: str, rate: str, breakpoints: str) -> InputProfile:
    form = given['course']
    if form in ('constant', 'sine'):
        return input_profile.constant(given[value])
    if form == 'ramp':
        profile = input_profile.ramp(given[value], given[rate], given['duration'])
        name = f'{section}.{rate}'
    elif form == 'position':
        return input_profile.positions(section, given['times'], given['positions'], given.get('slopes'),
                                       given['period'])
    else:
        profile = _BREAKPOINTS[form](section, given['times'], given[breakpoints], given['period'])
        name = f'{section}.{breakpoints}'
    if not all(map(math.isfinite, (*profile.values, *profile.rates))):
        raise InputError(name, given[name.rpartition('.')[2]], 'an input profile of finite values and rates',
                         'make it smaller or the times longer')
    return profile


def _sinusoids(given: Mapping[str, Any], section: str) -> tuple[Sinusoid, ...]:
    sine = (Sinusoid(given['amplitude'], given['frequency'], given['phase']),) if given['course'] == 'sine' else ()
    if 'amplitudes' in given and 'frequencies' in given:
        return sine + input_profile.sinusoids(section, given['amplitudes'], given['frequencies'], given.get('phases'))
    for name in ('amplitudes', 'frequencies', 'phases'):
        if name in given:
            raise InputError(f'{section}.{name}', given[name], 'given with both amplitudes and frequencies',
                             'add the other, or leave all of them out')
    return sine


def _summary(values: Mapping[str, Any]) -> str:
    """Return a line about a scene whose file says nothing itself."""
    branches = 'with' if values['friction.acceleration_dependence'] else 'without'
    drive = values['drive.course'] if 'drive.velocity' not in values else f'{values["drive.velocity"] * 1e3:g} mm/s'
    return (f'{values["contact.model"]} contact, {values["friction.static.law"]} static friction,'
            f' {branches} acceleration dependence, drive {drive}')
