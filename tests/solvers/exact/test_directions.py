# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Friction that depends on the direction: the reference, mirror images, splits, energy, and every solver."""

import math
import random
from dataclasses import replace

import pytest

from stickslip_sim.axis import Axis, CompliantContact, Friction, InitialState
from stickslip_sim.core.errors import InputError
from stickslip_sim.core.input_profile import InputProfile, Sinusoid, constant, ramp
from stickslip_sim.core.types import Event, EventKind, Instant
from stickslip_sim.friction import KineticTable, StaticLaw, StaticLawKind, kinetic_table, smooth
from stickslip_sim.inputs import load_scene
from stickslip_sim.proof.axes import random_profiles
from stickslip_sim.proof.judges import error_of_events
from stickslip_sim.runs import simulate_events
from stickslip_sim.scene import Scene
from stickslip_sim.simulation.simulator import Simulator
from stickslip_sim.solvers import adaptive, exact, fixed_step
from tests.support.axes import COMPLIANT, RIGID, Contact, instant, make, paper_axis, random_axis

NONE = StaticLaw(StaticLawKind.EXPONENTIAL, 0.0, 0.0, 0.2)
FREE = KineticTable((0.0,), (0.0,))
EASY = {'friction.static.backward.initial': 0.1, 'friction.static.backward.limit': 0.15,
        'friction.kinetic.backward.coefficients': (0.1, 0.03)}


def random_sides(rng: random.Random) -> Axis:
    """Return an axis with the friction of another one backwards, or with none."""
    axis, other = random_axis(rng), random_axis(rng)
    excess = axis.friction.excess and (other.friction.excess or axis.friction.excess)
    back = replace(other.friction, excess=excess)
    if rng.random() < 0.2:
        back = replace(back, static=NONE, kinetic=FREE)
    return replace(axis, friction=replace(axis.friction, backward=back))


def start_of(rng: random.Random, axis: Axis) -> InitialState:
    """Return a start at rest, sliding either way, or with a loaded spring."""
    stretch = rng.choice((0.0, rng.uniform(-1.0, 1.0))) * axis.normal_force * 0.2 / axis.drive_stiffness
    return rng.choice((InitialState(stretch=stretch), InitialState(velocity=rng.uniform(-0.05, 0.05), rest_time=0.0),
                       InitialState(rest_time=0.1, stretch=stretch)))


def mirrored(profile: InputProfile) -> InputProfile:
    return InputProfile(profile.starts, tuple(-x for x in profile.values), tuple(-x for x in profile.rates),
                        profile.period, tuple(one._replace(amplitude=-one.amplitude) for one in profile.sinusoids))


@pytest.mark.parametrize('seed', range(6))
def test_events_are_those_of_the_reference(seed: int) -> None:
    reference = pytest.importorskip('stickslip_sim.reference')
    rng = random.Random(seed)
    axis = random_sides(rng)
    drive, force = random_profiles(rng)
    initial = start_of(rng, axis)
    seen = make(axis, drive, force, initial).advance(instant(3.0))[:25]
    duration = 0.5 * (seen[-2].time + seen[-1].time) if len(seen) == 25 else 3.0
    wanted = reference.simulate(axis, initial, drive, force, duration, 30).events
    seen = [event for event in seen if event.time <= duration]
    assert error_of_events(seen, wanted, duration) <= 1e-11
    assert [event.static_coefficient for event in seen] == pytest.approx(
        [event.static_coefficient for event in wanted], rel=1e-9)


@pytest.mark.parametrize('contact', [RIGID, COMPLIANT])
def test_the_reference_knows_the_directions_of_sines_and_of_kato(contact: Contact) -> None:
    reference = pytest.importorskip('stickslip_sim.reference')
    kato = StaticLaw(StaticLawKind.KATO, 0.12, 0.24, 0.2, 0.6)
    ahead = replace(paper_axis(contact).friction, static=kato)
    back = replace(ahead, static=replace(kato, initial=0.14, limit=0.14, exponent=1.0))
    axis = replace(paper_axis(contact), friction=replace(ahead, backward=back))
    drive = InputProfile((0.0,), (0.0,), (0.0,), sinusoids=(Sinusoid(0.01, 0.8, 0.3),))
    seen = make(axis, drive).advance(instant(2.0))
    assert {event.direction for event in seen} == {1, -1}
    wanted = reference.simulate(axis, InitialState(), drive, constant(0.0), 2.0, 30).events
    assert error_of_events(seen, wanted, 2.0) <= 1e-11


def test_a_law_that_is_convex_backwards_alone_lets_go_before_it_has_risen() -> None:
    """Up to half the time constant mu_s outruns the force again: both ends of the search are below the limit."""
    ahead = replace(paper_axis(RIGID).friction, static=StaticLaw(StaticLawKind.KATO, 0.12, 0.24, 0.2, 0.6))
    convex = replace(ahead.static, exponent=3.0)
    axis = replace(paper_axis(RIGID), friction=replace(ahead, backward=replace(ahead, static=convex)))
    start = InitialState(rest_time=0.0, stretch=-408.0 / axis.drive_stiffness)
    event, *_ = make(axis, -0.0005, initial=start).advance(instant(0.1))
    assert (event.kind, event.direction) == (EventKind.BREAKAWAY, -1)
    assert event.drive_force == pytest.approx(-axis.normal_force * convex.coefficient(event.rest_time), rel=1e-14)


@pytest.mark.parametrize('seed', range(10))
def test_the_same_friction_given_twice_changes_no_event(seed: int) -> None:
    rng = random.Random(seed)
    axis = random_axis(rng)
    drive, force = random_profiles(rng)
    twice = replace(axis, friction=replace(axis.friction, backward=axis.friction))
    seen = make(twice, drive, force).advance(instant(5.0))
    wanted = make(axis, drive, force).advance(instant(5.0))
    assert [(e.kind, e.mode, e.direction) for e in seen] == [(e.kind, e.mode, e.direction) for e in wanted]
    assert [e.time for e in seen] == pytest.approx([e.time for e in wanted], rel=1e-12, abs=1e-12)


def limits(friction: Friction, normal: float) -> tuple[float, float]:
    """Return the forces at which a prolonged rest ends, forwards and backwards."""
    return (normal * friction.static.coefficient(math.inf), -normal * friction.along(-1.0).static.coefficient(math.inf))


@pytest.mark.parametrize('contact', [RIGID, COMPLIANT])
def test_each_way_breaks_away_at_its_own_limit(contact: Contact) -> None:
    both = paper_axis(contact)
    back = replace(both.friction, static=replace(both.friction.static, limit=0.15))
    axis = replace(both, friction=replace(both.friction, backward=back))
    for feed, limit in zip((0.002, -0.002), limits(axis.friction, axis.normal_force)):
        first = make(axis, feed).advance(instant(2.0))[0]
        assert first.kind == EventKind.BREAKAWAY
        assert first.friction_force == pytest.approx(limit, rel=1e-12)
        assert first.static_coefficient == pytest.approx(abs(limit) / axis.normal_force, rel=1e-12)


@pytest.mark.parametrize('contact', [RIGID, COMPLIANT, CompliantContact(5e6, 0.0)])
@pytest.mark.parametrize('drive', [constant(-0.002), ramp(0.0, -0.004, math.inf)])
def test_a_way_without_friction_holds_nothing(contact: Contact, drive: InputProfile) -> None:
    ahead = replace(paper_axis(contact).friction, excess=None)
    axis = replace(paper_axis(contact), friction=replace(ahead, backward=Friction(NONE, FREE, None)))
    first = make(axis, drive).advance(instant(0.1))[0]
    assert (first.time, first.kind, first.direction) == (0.0, EventKind.BREAKAWAY, -1)
    assert make(axis, mirrored(drive)).advance(instant(0.1)) == []


def test_a_slip_reverses_at_once_where_the_other_way_holds_less() -> None:
    ahead = replace(paper_axis(RIGID).friction, excess=None)
    back = replace(ahead, static=replace(ahead.static, initial=0.03, limit=0.03), kinetic=KineticTable((0.0,), (0.03,)))
    axis = replace(paper_axis(RIGID), drive_damping=0.0, friction=replace(ahead, backward=back))
    turns = [e for e in make(axis, 0.002).advance(instant(3.0)) if e.kind == EventKind.REVERSE]
    assert {turn.direction for turn in turns} == {-1}
    assert all(turn.static_coefficient == 0.03 and turn.drive_force < -0.03 * axis.normal_force for turn in turns)


@pytest.mark.parametrize('name', ['paper_fig7', 'paper_fig8', 'stribeck'])
def test_other_solvers_find_the_same_events(name: str) -> None:
    of_a_law = {'friction.static.backward.initial': 0.1, 'friction.static.backward.limit': 0.15,
                'friction.kinetic.backward.initial': 0.1, 'friction.kinetic.backward.limit': 0.03}
    scene = load_scene(name, (of_a_law if name == 'stribeck' else EASY) | {'drive.velocity': -0.002})
    wanted = cycles_of(simulate_events(scene, 1.5).events)
    assert len(wanted) > 2
    for solver, error in ((adaptive.solver(rtol=1e-10, atol=1e-13), 1e-5), (fixed_step.solver('rk4', 1e-5), 1e-3)):
        simulator = Simulator(scene.axis, scene.initial, scene.drive, scene.force, solver)
        seen = cycles_of(simulator.advance(instant(1.5)))
        assert [e.kind for e in seen] == [e.kind for e in wanted]
        assert [e.time for e in seen] == pytest.approx([e.time for e in wanted], abs=error)


def cycles_of(events: list[Event]) -> list[Event]:
    return [event for event in events if event.kind in (EventKind.BREAKAWAY, EventKind.STICK, EventKind.REVERSE)]


def test_the_adaptive_solver_takes_the_smooth_law_of_each_direction() -> None:
    laws = smooth.stribeck(0.12, 0.05, 0.01), smooth.stribeck(0.1, 0.03, 0.02)
    static = StaticLaw(StaticLawKind.CONSTANT, 0.2, 0.2)
    ahead, back = (Friction(static, kinetic_table(law, 1e-6), None) for law in laws)
    axis = replace(paper_axis(RIGID), friction=replace(ahead, backward=back))
    solver = adaptive.solver(rtol=1e-9, atol=1e-12, kinetic=laws[0], backward=laws[1])
    for feed in (0.002, -0.002):
        seen, wanted = (cycles_of(make(axis, feed, solver=one).advance(instant(1.2))) for one in (solver, exact.SOLVER))
        assert [e.time for e in seen] == pytest.approx([e.time for e in wanted], abs=1e-4)


def test_a_live_change_takes_effect_in_its_direction() -> None:
    one, other = (load_scene('paper_fig8', changes).axis for changes in ({}, EASY))
    events = {}
    for feed in (0.002, -0.002):
        simulator = make(one, feed)
        simulator.advance(Instant(1.0, 0.0))
        simulator.change_axis(other)
        events[feed] = simulator.advance(Instant(4.0, 0.0))
    plain = make(one, 0.002)
    plain.advance(Instant(1.0, 0.0))
    assert [e.time for e in events[0.002]] == pytest.approx([e.time for e in plain.advance(Instant(4.0, 0.0))],
                                                           rel=1e-12)
    assert min(e.static_coefficient for e in events[-0.002]) == 0.1


def test_a_scene_leaves_out_backwards_what_is_as_forwards() -> None:
    scene = load_scene('paper_fig8', {'friction.static.backward.limit': 0.3, 'friction.scale': 0.5})
    ahead, back = scene.axis.friction.sides
    assert back.static == replace(ahead.static, limit=0.15)
    assert (back.kinetic, back.excess) == (ahead.kinetic, ahead.excess)
    same = load_scene('paper_fig8', {'friction.static.backward.limit': 0.24})
    assert same.axis == load_scene('paper_fig8').axis


def test_psi_ends_where_mu_k_of_its_direction_does() -> None:
    scene = load_scene('paper_fig8', {'friction.kinetic.backward.velocities': (0.0, 0.01)})
    assert [side.excess and side.excess.velocities for side in scene.axis.friction.sides] == [(0.0, 0.035), (0.0, 0.01)]


@pytest.mark.parametrize(('changes', 'text'), [
    ({'friction.static.backward.initial': 0.3}, 'friction.static.backward.limit = 0.24 is refused'),
    ({'friction.kinetic.backward.coefficients': (0.13, 0.05)}, '<= friction.static.backward.initial (0.12)'),
    ({'friction.kinetic.backward.coefficients': (0.1, 0.05, 0.01)}, 'friction.kinetic.backward.velocities'),
    ({'friction.kinetic.backward.initial': 0.1}, 'omitted with friction.kinetic.law: table'),
    ({'friction.kinetic.backward.law': 'table'}, 'friction.kinetic.backward.law'),
    ({'friction.static.backward.limit': -0.1}, 'friction.static.backward.limit = -0.1 is refused')])
def test_what_has_no_meaning_is_refused_by_its_name(changes: dict[str, object], text: str) -> None:
    with pytest.raises(InputError) as refused:
        load_scene('paper_fig8', changes)
    assert text in str(refused.value)


def feeds(scene: Scene) -> list[float]:
    return [event.time for event in simulate_events(scene, 2.0).events]


def test_the_sense_of_the_drive_matters_only_with_two_frictions() -> None:
    there, back = (load_scene('paper_fig8', EASY | {'drive.velocity': feed}) for feed in (0.002, -0.002))
    assert feeds(there) == pytest.approx(feeds(load_scene('paper_fig8')), rel=1e-12)
    assert feeds(back)[0] < feeds(there)[0]
