# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""What an axis refuses at its edge: one line with the name, the value, the range and the fix."""

import math
from dataclasses import replace
from functools import partial
from typing import Any

import pytest

from stickslip_sim.axis import CompliantContact, Friction, InitialState, check_start, pack
from stickslip_sim.axis.fields import flat, names_of, places_of
from stickslip_sim.axis.layout import MASS, NORMAL, SEGMENT_SIZE, TABLE, Parameters
from stickslip_sim.axis.rows import Events, SampleRow, Sinusoids
from stickslip_sim.axis.state_record import STATE_PLACES, State, clear_state
from stickslip_sim.core.errors import InputError
from stickslip_sim.core.types import Event, Sample
from stickslip_sim.friction import StaticLaw, StaticLawKind
from tests.support.plain_axes import (
    AXIS,
    BACKWARD,
    COMPLIANT,
    CONVENTIONAL,
    FRICTION,
    KINETIC,
    SIDED,
    STATIC,
    parameters,
)

NOT_NUMBERS = (math.nan, math.inf, -math.inf)


def refusal(make: Any, **given: Any) -> str:
    with pytest.raises(InputError) as caught:
        make(**given)
    assert '\n' not in str(caught.value)
    return str(caught.value)


def axis(**changes: Any) -> object:
    return replace(AXIS, **changes)


@pytest.mark.parametrize(('make', 'name', 'bad', 'said'), [
    (axis, 'mass', (0.0, -1.0, -1e-300, *NOT_NUMBERS),
     'axis.mass = {!r} is refused: must be finite and > 0 kg; give the mass of the slider'),
    *((axis, name, (-1.0, -1e-300, *NOT_NUMBERS),
       f'axis.{name} = {{!r}} is refused: must be finite and >= 0 {unit}; use 0 to leave it out') for name, unit in (
           ('drive_stiffness', 'N/m'), ('drive_damping', 'N s/m'), ('normal_force', 'N'))),
    (partial(CompliantContact, damping=1.0), 'stiffness', (0.0, -1.0, *NOT_NUMBERS),
     'contact.stiffness = {!r} is refused: must be finite and > 0 N/m; use contact.model: rigid'),
    (partial(CompliantContact, stiffness=1.0), 'damping', (-1.0, *NOT_NUMBERS),
     'contact.damping = {!r} is refused: must be finite and >= 0 N s/m'),
    *((InitialState, name, NOT_NUMBERS, f'initial.{name} = {{!r}} is refused: must be finite, in {unit}')
      for name, unit in (('position', 'm'), ('velocity', 'm/s'), ('stretch', 'm'), ('deflection', 'm'))),
    (InitialState, 'rest_time', (-1.0, math.nan, -math.inf), 'initial.rest_time = {!r} is refused: must be >= 0 s')])
def test_a_number_out_of_its_range_is_refused(make: Any, name: str, bad: tuple[float, ...], said: str) -> None:
    for value in bad:
        assert refusal(make, **{name: value}).startswith(said.format(value))


def test_the_ends_of_the_ranges_are_allowed() -> None:
    assert all(axis(**{name: 0.0}) != AXIS for name in ('drive_stiffness', 'drive_damping', 'normal_force'))
    assert CompliantContact(1.0, 0.0).damping == 0.0
    assert InitialState(rest_time=math.inf) == InitialState()


def test_kinetic_friction_at_rest_is_not_above_static_friction() -> None:
    """Equal, as the paper has it, is allowed."""
    lower = replace(STATIC, initial=0.2)
    assert refusal(Friction, static=lower, kinetic=KINETIC, excess=None).startswith(
        'friction.kinetic.coefficients[0] = 0.25 is refused: must be <= friction.static.initial (0.2)')
    assert STATIC.initial == KINETIC.coefficients[0]
    back = Friction(lower, replace(KINETIC, coefficients=(0.1, 0.05, 0.05)), None)
    with pytest.raises(InputError, match=r'friction\.kinetic\.coefficients\[0\] = 0\.25'):
        replace(CONVENTIONAL, static=lower, backward=back)


@pytest.mark.parametrize(('backward', 'said'), [
    (SIDED, 'friction.backward = '),
    (replace(BACKWARD, static=StaticLaw(StaticLawKind.CONSTANT, 0.375, 0.375)), 'must be the same law as forwards'),
    (replace(BACKWARD, static=replace(BACKWARD.static, delay=1.0)), 'friction.static.backward.delay = 1.0'),
    (replace(BACKWARD, excess=None), 'given in both directions or in none')])
def test_the_two_directions_are_of_one_kind(backward: Friction, said: str) -> None:
    with pytest.raises(InputError) as caught:
        replace(FRICTION, backward=backward)
    assert said in str(caught.value)


def test_prolonged_rest_needs_a_law_with_a_limit() -> None:
    grows = replace(AXIS, friction=Friction(replace(STATIC, kind=StaticLawKind.LOGARITHMIC), KINETIC, None))
    assert refusal(check_start, axis=grows, initial=InitialState()).startswith(
        'initial.rest_time = inf is refused: must be finite with the logarithmic static law')
    check_start(grows, InitialState(rest_time=1e9))


def test_a_rigid_contact_starts_undeflected() -> None:
    assert refusal(check_start, axis=AXIS, initial=InitialState(deflection=1e-6)).startswith(
        'initial.deflection = 1e-06 is refused: must be 0 with a rigid contact')
    check_start(AXIS, InitialState())


@pytest.mark.parametrize('side', [1.0, -1.0])
@pytest.mark.parametrize(('load', 'velocity', 'rest', 'carried'), [
    (0.0, 0.0, math.inf, 32.0), (64.0, 0.0, math.inf, 64.0), (0.0, 0.0, 0.0, 16.0), (0.0, 0.125, math.inf, 32.0)])
def test_a_contact_starts_with_what_it_holds(load: float, velocity: float, rest: float, carried: float, side: float
                                             ) -> None:
    """|c_c δ + h_c ẋ| <= N mu_s(t⁻), with a load on top of N; just on the limit it holds."""
    compliant = replace(AXIS, contact=COMPLIANT)
    deflection = (carried - 64.0 * velocity) / 4096.0
    start = InitialState(velocity=side * velocity, rest_time=rest, deflection=side * deflection)
    check_start(compliant, start, load)
    beyond = replace(start, deflection=side * (deflection + 1.0 / 4096.0))
    assert refusal(check_start, axis=compliant, initial=beyond, load=load).startswith(
        f'initial.deflection = {beyond.deflection!r} is refused: must be such that the contact carries at most '
        f'N mu_s = {carried:g} N; it would carry {side * (carried + 1.0):g} N')


def test_the_limit_of_a_start_is_that_against_its_force() -> None:
    compliant = replace(AXIS, contact=COMPLIANT, friction=SIDED)
    check_start(compliant, InitialState(deflection=-48.0 / 4096.0))
    with pytest.raises(InputError, match='at most N mu_s = 32 N'):
        check_start(compliant, InitialState(deflection=33.0 / 4096.0))


def test_friction_turned_round() -> None:
    """The two directions change places; friction without a direction stays."""
    assert (SIDED.mirrored.along(1.0), SIDED.mirrored.along(-1.0)) == (
        replace(BACKWARD, backward=FRICTION), FRICTION)
    assert FRICTION.mirrored is FRICTION
    assert SIDED.sides == (FRICTION, BACKWARD)
    assert (SIDED.along(-1.0), SIDED.along(0.0), FRICTION.along(-1.0)) == (BACKWARD, SIDED, FRICTION)


# The records that the solvers work on: rows of numbers, in the order of their fields, to the last bit.

def test_the_numbers_of_an_axis_are_where_their_names_say() -> None:
    p = parameters(contact=COMPLIANT, damper_on_slideway=True)
    assert (p.mass, p.stiffness, p.damping, p.feed_share, p.normal_force) == (2.0, 1024.0, 32.0, 0.0, 64.0)
    assert (p.compliant, p.contact_stiffness, p.contact_damping) == (1.0, 4096.0, 64.0)
    assert (p.arrest_share, p.ends_by_drive) == (1.0, 0.0)
    assert (p.static_initial, p.static_limit, p.static_tau, p.branches, p.sided) == (0.25, 0.5, 2.0, 1.0, 0.0)
    numbers = pack(AXIS)
    assert (numbers[MASS], numbers[NORMAL], len(numbers)) == (2.0, 64.0, TABLE + 3 * SEGMENT_SIZE)


def test_what_an_axis_leaves_out_is_0() -> None:
    p = parameters()
    assert (p.feed_share, p.compliant, p.contact_stiffness, p.contact_damping) == (1.0, 0.0, 0.0, 0.0)


@pytest.mark.parametrize(('changes', 'expected'), [({'undeflected': True}, (0.0, 0.0)),
                                                   ({'ends_by_drive': True}, (1.0, 1.0))])
def test_how_a_contact_begins_and_ends(changes: dict[str, bool], expected: tuple[float, float]) -> None:
    p = parameters(contact=replace(COMPLIANT, **changes))
    assert (p.arrest_share, p.ends_by_drive) == expected


def test_the_segments_backwards_follow_those_forwards() -> None:
    p = parameters(friction=SIDED)
    assert (p.segment_count, p.backward_segment, len(p.segments)) == (5.0, 3.0, 5)
    assert (p.backward_initial, p.backward_limit, p.backward_tau, p.sided) == (0.375, 0.75, 1.0, 1.0)
    assert [(one.speed, one.friction) for one in p.segments] == [
        (0.0, 0.25), (0.25, 0.125), (0.5, 0.0625), (0.0, 0.125), (0.125, 0.03125)]


def test_a_state_goes_on_from_its_numbers() -> None:
    """Each number has its place, sinusoids behind the others."""
    s = State(2)
    count = len(s.numbers())
    assert count == len(STATE_PLACES) + 2 * 10
    s.take(range(count))
    assert s.numbers() == list(range(count))
    assert s.velocity == STATE_PLACES.index('velocity')
    assert s.inputs.v_rate == STATE_PLACES.index('inputs.v_rate')
    assert s.cache.oscillators[3].fast == STATE_PLACES.index('cache.oscillators[3].fast')
    assert s.sinusoids[1].frequency == len(STATE_PLACES) + 10
    other = State(2)
    other.take(s.numbers())
    assert other.numbers() == s.numbers()
    clear_state(s)
    assert s.numbers() == [0.0] * len(STATE_PLACES) + list(range(len(STATE_PLACES), count))


def test_rows_have_the_order_of_what_is_made_of_them() -> None:
    row = Events(2)
    row.rows[1].kind, row.rows[1].rest = 4.0, 0.5
    event = Event._make(row.row(1))
    assert (event.kind, event.rest_time, row.count) == (4.0, 0.5, 2)
    assert len(flat(SampleRow())) == len(Sample._fields)
    assert SampleRow(velocity=2.0).tolist() == list(Sample._make(SampleRow(velocity=2.0).tolist()))
    assert Sample._make(SampleRow(velocity=2.0).tolist()).velocity == 2.0


def test_sinusoids_come_from_a_flat_row() -> None:
    given = Sinusoids([1.0, 0.25, 2.0, 3.0, 4.0, 5.0, 0.5, 7.0, 8.0, 9.0])
    assert [(one.frequency, one.phase, one.v, one.f, one.n) for one in given.rows] == [
        (1.0, 0.25, 2.0, 3.0, 4.0), (5.0, 0.5, 7.0, 8.0, 9.0)]
    assert given.count == 2


def test_places_name_records_within_records() -> None:
    assert set(names_of(State)) < set(places_of(State))
    assert {'segments'}.isdisjoint(names_of(Parameters))
