# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""From the dictionary of a stored run to the objects of the product."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from stickslip_sim.axis import Axis, CompliantContact, Friction, InitialState, RigidContact
from stickslip_sim.core.input_profile import InputProfile, Sinusoid
from stickslip_sim.friction import ExcessTable, KineticTable, StaticLaw, StaticLawKind
from stickslip_sim.friction.kinetic import default_excess
from stickslip_sim.reference import ReferenceRun, simulate
from stickslip_sim.reference.exact_run import Run

Parameters = Mapping[str, Any]


def axis_of(values: Parameters) -> Axis:
    contact = values['contact']
    model = (
        RigidContact() if contact['model'] == 'rigid' else CompliantContact(contact['stiffness'], contact['damping'])
    )
    return Axis(**values['axis'], contact=model, friction=_friction(values['friction']))


def _friction(values: Parameters) -> Friction:
    static = values['static']
    law = StaticLaw(
        StaticLawKind[static['law'].upper()],
        static['initial'],
        static.get('limit', static['initial']),
        static.get('time_constant', 1.0),
        static.get('exponent', 1.0),
    )
    given = values['kinetic']
    kinetic = KineticTable(tuple(given['velocities']), tuple(given['coefficients']), given.get('end_slope', 0.0))
    if not values.get('acceleration_dependence', False):
        return Friction(law, kinetic, None)
    shape = values.get('excess')
    excess = ExcessTable(tuple(shape['velocities']), tuple(shape['fractions'])) if shape else default_excess(kinetic)
    return Friction(law, kinetic, excess)


def profile_of(given: Sequence[Sequence[float]] | Parameters) -> InputProfile:
    """A list of [start, value, slope], or a dictionary with that as `segments`, a `period` and `waves`."""
    if not isinstance(given, Mapping):
        given = {'segments': given}
    starts, values, rates = zip(*given['segments'], strict=True)
    sinusoids = tuple(Sinusoid(*sinusoid) for sinusoid in given.get('waves', ()))
    return InputProfile(starts, values, rates, given.get('period', float('inf')), sinusoids)


def parameters_of(axis: Axis, initial: InitialState, drive: InputProfile, force: InputProfile) -> dict[str, Any]:
    """Return the dictionary of the objects of a simulator."""
    numbers = ('mass', 'drive_stiffness', 'drive_damping', 'normal_force')
    contact: dict[str, Any] = {'model': 'rigid'}
    if isinstance(axis.contact, CompliantContact):
        contact = {'model': 'compliant', 'stiffness': axis.contact.stiffness, 'damping': axis.contact.damping}
    static, kinetic, excess = axis.friction.static, axis.friction.kinetic, axis.friction.excess
    friction: dict[str, Any] = {
        'static': {name: getattr(static, name) for name in ('initial', 'limit', 'time_constant', 'exponent')}
        | {'law': static.kind.name.lower()},
        'kinetic': {name: getattr(kinetic, name) for name in ('velocities', 'coefficients', 'end_slope')},
        'acceleration_dependence': excess is not None,
    }
    if excess:
        friction['excess'] = {'velocities': excess.velocities, 'fractions': excess.fractions}
    return {
        'axis': {name: getattr(axis, name) for name in numbers},
        'contact': contact,
        'friction': friction,
        'drive': _segments(drive),
        'force': _segments(force),
        'initial': {name: getattr(initial, name) for name in ('position', 'velocity', 'rest_time')},
    }


def _segments(profile: InputProfile) -> dict[str, Any]:
    return {
        'segments': list(zip(profile.starts, profile.values, profile.rates)),
        'period': profile.period,
        'waves': profile.sinusoids,
    }


def inputs_of(values: Parameters) -> tuple[Axis, InitialState, InputProfile, InputProfile]:
    """Return what a simulator takes."""
    start = InitialState(**values['initial'])
    return axis_of(values), start, profile_of(values['drive']), profile_of(values['force'])


def reference_run(values: Parameters, duration: float, digits: int = 40) -> ReferenceRun:
    return simulate(*inputs_of(values), duration, digits)


def exact_run(values: Parameters, duration: float, digits: int = 40) -> Run:
    """Return the events in multiple precision."""
    return reference_run(values, duration, digits).exact
