# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The records that the solvers work on: rows of numbers, in the order of their fields, to the last bit."""

from dataclasses import replace

import pytest

from stickslip_sim.axis import pack
from stickslip_sim.axis.fields import flat, names_of, places_of
from stickslip_sim.axis.layout import MASS, NORMAL, SEGMENT_SIZE, TABLE, Parameters
from stickslip_sim.axis.rows import Events, SampleRow, Sinusoids
from stickslip_sim.axis.state_record import STATE_PLACES, State, clear_state
from stickslip_sim.core.types import Event, Sample
from tests.support.plain_axes import AXIS, COMPLIANT, SIDED, parameters


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
