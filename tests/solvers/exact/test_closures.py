# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The other closures where the paper is silent: exact as the ones by default, in every solver, and recorded."""

import math
import random
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path

import pytest

from stickslip_sim.axis import Axis, CompliantContact, Friction, InitialState
from stickslip_sim.compare.fresh import simulate_densely
from stickslip_sim.compare.statements import CONTINUITY, StatementOutcome, findings_on
from stickslip_sim.core.errors import InputError
from stickslip_sim.core.input_profile import InputProfile, Sinusoid, constant, steps
from stickslip_sim.core.types import Event, EventKind, Mode
from stickslip_sim.friction import StaticLawKind
from stickslip_sim.inputs import load_scene
from stickslip_sim.proof.axes import random_profiles, with_static
from stickslip_sim.recording import read_run
from stickslip_sim.reference import simulate as simulate_reference
from stickslip_sim.simulation.simulator import Simulator
from stickslip_sim.solvers import Solver, adaptive, exact, fixed_step
from tests.support.axes import COMPLIANT, RIGID, Contact, instant, paper_axis, random_axis, run_events
from tests.support.check_files import verified
from tests.support.tool import Capture, answered

pytestmark = pytest.mark.slow

DELAY = 0.1   # s
CLOSURES: Mapping[str, Mapping[str, object]] = {   # of a scene
    'undeflected': {'contact.arrest': 'undeflected'},
    'drive_force': {'contact.break_away': 'drive_force'},
    'delay': {'friction.static.delay': DELAY},
    'slideway': {'axis.damper': 'slideway'},
}
FEED, SHORT = 0.002, 2.0   # m/s, s
START = InitialState(rest_time=3.0)
SINES = Sinusoid(0.003, 3.0, 0.4), Sinusoid(150.0, 41.0, 0.0)


def closed(axis: Axis, closure: str) -> Axis:
    """Return an axis with another closure."""
    if closure == 'slideway':
        return replace(axis, damper_on_slideway=True)
    if closure == 'delay':
        return with_static(axis, replace(axis.friction.static, delay=DELAY))
    assert isinstance(axis.contact, CompliantContact)
    if closure == 'undeflected':
        return replace(axis, contact=replace(axis.contact, undeflected=True))
    return replace(axis, contact=replace(axis.contact, ends_by_drive=True))


def random_problem(closure: str, seed: int) -> tuple[Axis, InputProfile, InputProfile]:
    rng = random.Random(seed)
    axis = random_axis(rng)
    while closure in ('undeflected', 'drive_force') and not isinstance(axis.contact, CompliantContact):
        axis = random_axis(rng)
    if closure == 'delay':   # any law, and another delay
        kind, exponent = rng.choice(tuple(StaticLawKind)), rng.choice((0.5, 1.0, 2.0))
        axis = with_static(axis, replace(axis.friction.static, kind=kind, exponent=exponent))
        return with_static(axis, replace(axis.friction.static, delay=10 ** rng.uniform(-3, 0))), *random_profiles(rng)
    return closed(axis, closure), *random_profiles(rng)


def of_two_directions(friction: Friction) -> Friction:
    back = replace(friction.static, initial=1.1 * friction.static.initial, limit=1.3 * friction.static.limit,
                   time_constant=0.5 * friction.static.time_constant)
    return replace(friction, backward=replace(friction, static=back))


def agree(found: list[Event], axis: Axis, drive: InputProfile, force: InputProfile, end: float, within: float) -> None:
    """Compare with the reference, up to where the last digits decide: when the slider has taken the drive's speed."""
    truth = simulate_reference(axis, START, drive, force, end).events
    settled = [abs(event.velocity - drive.value_at(event.time)) < 1e-7 * abs(event.velocity) for event in truth]
    last = settled.index(True) if True in settled else len(truth)
    assert [event.kind for event in found[:last]] == [event.kind for event in truth[:last]]
    assert last < len(truth) or len(found) == len(truth)
    for event, other in zip(found[:last], truth[:last], strict=True):
        assert event.time == pytest.approx(other.time, abs=within)
        assert event.position == pytest.approx(other.position, abs=within)
        assert event.friction_force == pytest.approx(other.friction_force, rel=1e-9, abs=1e-9 * axis.normal_force)


@pytest.mark.parametrize('closure', CLOSURES)
@pytest.mark.parametrize('seed', [0, 1, 8])
def test_random_axes_have_the_events_of_the_reference(closure: str, seed: int) -> None:
    axis, drive, force = random_problem(closure, seed)
    if seed >= 8:
        axis = replace(axis, friction=of_two_directions(axis.friction))
    simulator = Simulator(axis, START, drive, force, accounting=True)
    found = simulator.advance(instant(SHORT))
    simulator.require_sound()
    agree(found, axis, drive, force, SHORT, 1e-11)
    energy = simulator.energy
    assert energy is not None
    assert energy.relative_residual < 1e-11


@pytest.mark.parametrize('closure', CLOSURES)
@pytest.mark.parametrize(('solver', 'within'), [(adaptive.solver('DOP853', 1e-10, 1e-13), 1e-7),
                                                (fixed_step.solver('rk4', 1e-5), 1e-3)], ids=['adaptive', 'fixed_step'])
def test_other_solvers_find_the_same_cycle(closure: str, solver: Solver, within: float) -> None:
    axis = closed(paper_axis(COMPLIANT), closure)
    exactly, found = (arrests(run_events(axis, FEED, SHORT, solver=one)) for one in (exact.SOLVER, solver))
    assert len(exactly) == 2
    assert found == pytest.approx(exactly, abs=within)


def arrests(events: list[Event]) -> list[float]:
    return [event.time for event in events if event.kind == EventKind.STICK]


@pytest.mark.parametrize('closure', CLOSURES)
def test_a_recorded_run_is_verified(closure: str, tmp_path: Path, capsys: Capture) -> None:
    scene = load_scene('paper_fig8', CLOSURES[closure])
    assert scene.axis == closed(paper_axis(COMPLIANT), closure)
    assert scene.hash != load_scene('paper_fig8').hash
    changes = [word for name, value in CLOSURES[closure].items() for word in ('--set', f'{name}={value}')]
    answered(capsys, 'simulate', 'paper_fig8', '--duration', '1', *changes, '--bag', tmp_path / 'run')
    code, out, _ = verified(capsys, tmp_path / 'run')
    assert (code, 'identical' in out) == (0, True)
    assert not read_run(tmp_path / 'run').samples['external_force'].any()   # nothing is left of the balance of forces


@pytest.mark.parametrize('closure', CLOSURES)
def test_the_statements_of_the_paper_apply(closure: str) -> None:
    """The balance of forces that they go by leaves a constant drive constant."""
    run = simulate_densely(load_scene('paper_fig8', CLOSURES[closure]), 5.0)
    found = {statement.name: finding.outcome for statement, finding in findings_on(run)}
    assert StatementOutcome.NOT_APPLICABLE not in found.values()
    assert (found[CONTINUITY.name] == StatementOutcome.FAILS) == (closure == 'undeflected')


def test_an_undeflected_contact_begins_without_a_force_and_gains_no_energy() -> None:
    axis = closed(paper_axis(COMPLIANT), 'undeflected')
    first = next(event for event in run_events(axis, FEED, 1.0, initial=START)
                 if event.kind == EventKind.STICK)
    simulator = Simulator(axis, START, constant(FEED), constant(0.0), accounting=True)
    simulator.advance(first.instant)
    sample, energy = simulator.sample(), simulator.energy
    assert (sample.contact_deflection, sample.friction_force) == (0.0, 0.0)
    assert sample.acceleration == pytest.approx(sample.drive_force / axis.mass)
    assert energy is not None
    left = 0.5 * axis.normal_force * 0.24 * axis.normal_force * 0.24 / 5e6   # of the break-away, but for its damper
    assert energy.contact_exchange == pytest.approx(-left, rel=0.1)
    assert not math.isclose(first.friction_force, 0.0)   # as it was just before


@pytest.mark.parametrize('sines', [(), SINES[1:]])
def test_a_break_away_by_the_drive_is_where_its_force_meets_the_limit(sines: tuple[Sinusoid, ...]) -> None:
    force = replace(constant(0.0), sinusoids=sines)
    axis = closed(paper_axis(COMPLIANT), 'drive_force')
    released = [event for event in run_events(axis, 5.0 * FEED, SHORT, force) if event.kind == EventKind.BREAKAWAY]
    assert len(released) > 5
    for event in released:
        pull = event.drive_force + force.value_at(event.time)
        assert pull == pytest.approx(event.static_coefficient * axis.normal_force, rel=1e-12)
    by_contact = [event.time for event in run_events(paper_axis(COMPLIANT), 5.0 * FEED, SHORT, force)
                  if event.kind == EventKind.BREAKAWAY]
    assert [event.time for event in released] != pytest.approx(by_contact, abs=1e-6)


def test_static_friction_waits_for_its_growth() -> None:
    """Rigid contact, from a rest of no age: N mu_0 = c v t + h v within the delay, else N mu_s(t − delay)."""
    axis = paper_axis(RIGID)
    for delay in (0.0, 0.1, 0.336, 0.337, 0.5, 10.0):
        law = replace(axis.friction.static, delay=delay)
        first = run_events(with_static(axis, law), FEED, SHORT, initial=InitialState(rest_time=0.0))[0]
        pull = axis.drive_stiffness * FEED * first.time + axis.drive_damping * FEED
        assert first.kind == EventKind.BREAKAWAY
        assert pull == pytest.approx(axis.normal_force * first.static_coefficient, rel=1e-14)
        grown = 0.24 - 0.12 * math.exp(-max(first.time - delay, 0.0) / 0.2)
        assert first.static_coefficient == pytest.approx(grown, rel=1e-14)
        assert first.static_coefficient == law.coefficient(first.rest_time)
        assert (first.static_coefficient == 0.12) == (delay > 0.3365)


@pytest.mark.parametrize('contact', [RIGID, COMPLIANT])
def test_a_damper_on_the_slideway_is_one_on_the_drive_and_a_force(contact: Contact) -> None:
    """−h ẋ = h (v − ẋ) − h v."""
    axis = paper_axis(contact)
    drive = steps('drive', (0.0, 1.1, 1.5), (FEED, 4.0 * FEED, -FEED))
    force = steps('force', drive.starts, [-axis.drive_damping * value for value in drive.values])
    found = run_events(closed(axis, 'slideway'), drive, SHORT)
    same = run_events(axis, drive, SHORT, force)
    assert [event.kind for event in found] == [event.kind for event in same]
    for event, other in zip(found, same, strict=True):
        assert event.time == pytest.approx(other.time, abs=1e-13)
        stretch = event.drive_position - event.position
        assert event.drive_force == pytest.approx(axis.drive_stiffness * stretch, abs=1e-9)   # the spring's alone


def test_the_rest_of_a_contact_has_no_direction() -> None:
    friction = of_two_directions(with_static(paper_axis(RIGID), replace(paper_axis(RIGID).friction.static, delay=DELAY)
                                             ).friction)
    assert friction.backward is not None
    other = replace(friction.backward, static=replace(friction.backward.static, delay=0.0))
    with pytest.raises(InputError, match=r'friction\.static\.backward\.delay = 0\.0 is refused: must be 0\.1 s'):
        replace(friction, backward=other)


def test_a_lifted_slider_comes_to_rest_before_a_standing_drive() -> None:
    """N = 0: it rings down to rounding of the force that its spring holds, and stays there."""
    rng = random.Random(5)
    for _ in range(60):
        mass, stiffness = 10.0 ** rng.uniform(-1.0, 3.5), 10.0 ** rng.uniform(3.0, 7.0)
        damping = 2.0 * rng.uniform(0.2, 0.99) * math.sqrt(mass * stiffness)
        contact = CompliantContact(10.0 ** rng.uniform(-1.0, 2.0) * stiffness, rng.uniform(0.0, damping),
                                   ends_by_drive=True)
        axis = replace(paper_axis(contact), mass=mass, drive_stiffness=stiffness, drive_damping=damping,
                       normal_force=0.0)
        pull = rng.choice((-1.0, 1.0)) * rng.uniform(1.0, 500.0)
        simulator = Simulator(axis, START, constant(0.0), constant(pull), accounting=True)
        simulator.advance(instant(400.0 * mass / damping + 1.0))
        simulator.require_sound()
        sample = simulator.sample()
        assert sample.position == pytest.approx(pull / stiffness, rel=1e-12)
        assert abs(sample.velocity) < 1e-12 * abs(pull) / damping


CONTACTS: list[Contact] = [RIGID, COMPLIANT, replace(COMPLIANT, damping=0.0),
                           replace(COMPLIANT, ends_by_drive=True, undeflected=True)]


def lifted(contact: Contact, damping: float) -> Axis:
    return replace(paper_axis(contact), drive_damping=damping, normal_force=0.0)


@pytest.mark.parametrize('contact', CONTACTS, ids=['rigid', 'contact_force', 'undamped', 'drive_force'])
@pytest.mark.parametrize('start', [InitialState(stretch=1e-3), InitialState(velocity=0.1),
                                   InitialState(velocity=-0.1, stretch=1e-3, position=0.3)])
@pytest.mark.parametrize('damping', [500.0, 4000.0, 24000.0])
def test_a_free_swing_dies_out(damping: float, start: InitialState, contact: Contact) -> None:
    """It ends at 2⁻⁴⁹ of the largest force that turned it, and not at 1e-320 N, where it contradicted itself."""
    simulator = Simulator(lifted(contact, damping), start, constant(0.0), constant(0.0), accounting=True)
    events = simulator.advance(instant(4000.0))
    simulator.require_sound()
    turns = [event for event in events if event.kind in (EventKind.STICK, EventKind.REVERSE)]
    assert (turns[-1].mode, simulator.sample().mode, simulator.sample().velocity) == (Mode.STICK, Mode.STICK, 0.0)
    largest = max(abs(event.drive_force) for event in turns)
    assert abs(turns[-1].drive_force) <= largest * 2.0 ** -49
    assert all(abs(event.drive_force) > largest * 2.0 ** -49 for event in turns[:-1])
    simulator.command_force(1.0)
    assert simulator.advance(instant(4001.0))   # a new force moves it


@pytest.mark.parametrize('contact', CONTACTS, ids=['rigid', 'contact_force', 'undamped', 'drive_force'])
def test_a_free_swing_dies_out_as_in_the_reference(contact: Contact) -> None:
    axis, start = lifted(contact, 8000.0), InitialState(stretch=1e-3)
    seen = run_events(axis, 0.0, 8.0, initial=start)
    right = simulate_reference(axis, start, constant(0.0), constant(0.0), 8.0, digits=30).events
    assert [(event.kind, event.mode, event.direction) for event in seen] == [
        (event.kind, event.mode, event.direction) for event in right]
    assert seen[-1].kind == EventKind.STICK
    assert [event.time for event in seen] == pytest.approx([event.time for event in right], abs=1e-12)
