# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""A normal force that jumps or varies smoothly: closed forms, the reference at 30 digits, any split, energy, edges."""

import math
from dataclasses import replace

import numpy as np
import pytest

from stickslip_sim.axis import Axis, CompliantContact, Friction, InitialState
from stickslip_sim.core.errors import InputError
from stickslip_sim.core.input_profile import InputProfile, Sinusoid, constant, ramp, steps, table
from stickslip_sim.core.types import EventKind, Mode
from stickslip_sim.friction import KineticTable, StaticLaw, StaticLawKind
from stickslip_sim.proof.judges import error_of_events
from stickslip_sim.reference import simulate as reference
from stickslip_sim.simulation.simulator import Simulator
from stickslip_sim.solvers import Solver, adaptive, exact, fixed_step, with_advance
from tests.support.axes import COMPLIANT, RIGID, Contact, instant, paper_axis

NORMAL = 3432.3275
NOTHING = constant(0.0)
CLAMPED = steps('normal_load', (0.0, 0.3, 0.72, 0.9, 1.4), (0.0, 800.0, -900.0, -NORMAL, 2000.0))
RELEASED = steps('normal_load', (0.0, 0.25), (0.0, -NORMAL), 0.5)
AT_EVENTS = steps('normal_load', (0.0, 0.70, 0.77, 0.78, 0.80, 0.82), (0.0, -500.0, 300.0, -700.0, 0.0, 900.0))
JUMPING = {'clamped': CLAMPED, 'released': RELEASED, 'within a slip': AT_EVENTS}
SINE = InputProfile((0.0,), (0.0,), (0.0,), sinusoids=(Sinusoid(1000.0, 7.0, 0.0),))
TOUCHING = replace(SINE, sinusoids=(Sinusoid(NORMAL, 3.0, 0.5),))    # N = 0 for an instant, three times a second
TABLE = table('normal_load', (0.0, 0.2, 0.75, 0.9, 1.3), (0.0, 800.0, -1500.0, -900.0, 1200.0), 1.4)
SMOOTH = {'sine': SINE, 'N touches 0': TOUCHING, 'ramp': ramp(0.0, 900.0, math.inf), 'table': TABLE,
          'sum': replace(TABLE, sinusoids=(Sinusoid(500.0, 25.0, 1.0), Sinusoid(300.0, 2.5, 2.0)))}
LOADS = {**JUMPING, **SMOOTH}


def coulomb(contact: Contact = RIGID, stiffness: float = 0.0, mu_s: float = 0.3) -> Axis:
    static = StaticLaw(StaticLawKind.CONSTANT, mu_s, mu_s)
    return Axis(2.0, stiffness, 0.0, 16.0, contact, Friction(static, KineticTable((0.0,), (0.25,)), None))


def simulator(axis: Axis, load: InputProfile, force: InputProfile = NOTHING, drive: InputProfile = NOTHING,
              initial: InitialState | None = None, solver: Solver = exact.SOLVER) -> Simulator:
    return Simulator(axis, initial or InitialState(), drive, force, solver, accounting=True, load=load)


@pytest.mark.parametrize(('solver', 'error'), [
    (exact.SOLVER, 1e-15), (adaptive.solver(rtol=1e-10), 1e-9), (fixed_step.solver('rk4', 1e-4), 1e-4)])
def test_a_slip_under_jumps_is_the_closed_form(solver: Solver, error: float) -> None:
    """Without a spring and with constant mu_k a slip slows down by mu_k N/m: here 2, 1, 0 and 4 m/s²."""
    load = steps('normal_load', (0.0, 0.1, 0.2, 0.3), (0.0, -8.0, -16.0, 16.0))
    sim = simulator(coulomb(), load, initial=InitialState(velocity=1.0), solver=solver)
    sim.advance(instant(0.3))
    assert sim.sample().velocity == pytest.approx(0.7, abs=error)
    assert sim.sample().position == pytest.approx(0.1 - 0.01 + 0.08 - 0.005 + 0.07, abs=error)
    (stop,) = sim.advance(instant(1.0))
    assert stop.kind == EventKind.STICK
    assert stop.time == pytest.approx(0.3 + 0.7 / 4.0, abs=error)


@pytest.mark.parametrize(('contact', 'branches'), [(RIGID, True), (COMPLIANT, False)])
@pytest.mark.parametrize('load', LOADS)
def test_events_are_those_of_the_reference(load: str, contact: Contact, branches: bool) -> None:
    pytest.importorskip('mpmath')
    axis, drive = paper_axis(contact, branches=branches), constant(0.004)
    force = steps('force', (0.0, 0.72, 1.1), (0.0, 200.0, -150.0))
    sim = simulator(axis, LOADS[load], force, drive)
    events, end = sim.advance(instant(2.0)), sim.sample()
    run = reference(axis, InitialState(), drive, force, 2.0, 30, LOADS[load])
    assert len(events) > 8
    assert error_of_events(events, run.events, 2.0) < 1e-12
    assert end.position == pytest.approx(run.final.position, rel=1e-11)
    for event, wanted in zip(events, run.events):
        assert event.friction_force == pytest.approx(wanted.friction_force, rel=1e-9, abs=1e-6)
        assert event.mode == wanted.mode


@pytest.mark.parametrize('contact', [RIGID, COMPLIANT])
@pytest.mark.parametrize('load', ['clamped', 'sine', 'N touches 0', 'sum'])
def test_any_split_of_time_gives_the_same_bits(load: str, contact: Contact) -> None:
    axis, drive = paper_axis(contact), constant(0.004)
    whole = simulator(axis, LOADS[load], NOTHING, drive)
    events = whole.advance(instant(2.0))
    split = simulator(axis, LOADS[load], NOTHING, drive)
    times = sorted({0.3, 0.72, 0.9, 1.4, *np.linspace(0.01, 2.0, 171), *(event.time for event in events)})
    seen = [event for time in times for event in split.advance(instant(float(time)))]
    assert seen == events
    assert split.sample() == whole.sample()
    kept = simulator(axis, LOADS[load], NOTHING, drive)
    seen = kept.advance(instant(1.0))
    again = simulator(axis, LOADS[load], NOTHING, drive)
    again.restore(kept.checkpoint(), axis, drive, NOTHING)
    assert seen + again.advance(instant(2.0)) == events
    assert again.sample() == whole.sample()


@pytest.mark.parametrize('contact', [RIGID, COMPLIANT])
def test_a_walk_through_thousands_of_pieces_gives_the_bits_of_one_after_the_other(contact: Contact) -> None:
    rng = np.random.default_rng(5)
    times = (np.arange(3000) / 1000.0).tolist()
    load = steps('normal_load', times, rng.choice([0.0, 300.0, -NORMAL, -1000.0], 3000).tolist(), 3.2)
    drive = steps('drive', times[::3], rng.uniform(-0.01, 0.02, 1000).tolist())
    ends = []
    for solver in (exact.SOLVER, with_advance(exact.SOLVER, exact.advance)):
        sim = simulator(paper_axis(contact), load, NOTHING, drive, solver=solver)
        ends.append((sim.advance(instant(3.5)), sim.sample(), sim.checkpoint(), sim.energy))
    assert len(ends[0][0]) > 100
    assert ends[0] == ends[1]


@pytest.mark.parametrize('contact', [RIGID, COMPLIANT])
@pytest.mark.parametrize('load', LOADS)
def test_energy_closes_and_a_jump_does_no_work(load: str, contact: Contact) -> None:
    sim = simulator(paper_axis(contact), LOADS[load], NOTHING, constant(0.004))
    sim.advance(instant(2.0))
    sim.require_sound()
    energy = sim.energy
    assert energy is not None
    assert energy.relative_residual < 1e-13
    assert energy.parameter_exchange == 0.0


def test_a_reset_begins_with_the_first_load_again() -> None:
    sim = simulator(paper_axis(RIGID), CLAMPED, NOTHING, constant(0.004))
    events = sim.advance(instant(2.0))
    sim.reset()
    assert sim.advance(instant(2.0)) == events


def test_the_rest_time_goes_on_and_the_limit_jumps() -> None:
    """A force grows; N falls at 1 s, and mu_s, which has grown since time 0, grows on."""
    axis = paper_axis(RIGID)
    load = steps('normal_load', (0.0, 1.0), (0.0, 600.0 / 0.23 - NORMAL))
    sim = simulator(axis, load, ramp(0.0, 500.0, 2.0), initial=InitialState(rest_time=0.0))
    assert sim.advance(instant(1.1)) == []
    assert sim.sample().rest_time == pytest.approx(1.1, rel=1e-15)
    breakaway, *_ = sim.advance(instant(2.0))
    static = axis.friction.static.coefficient(breakaway.time)
    assert breakaway.rest_time == pytest.approx(breakaway.time, rel=1e-15)
    assert breakaway.friction_force == pytest.approx(600.0 / 0.23 * static, rel=1e-14)


def test_a_contact_keeps_its_deflection_and_lets_go_below_its_force() -> None:
    load = steps('normal_load', (0.0, 1.0, 2.0), (0.0, -1000.0, -2800.0))
    sim = simulator(paper_axis(COMPLIANT), load, constant(400.0))
    before, after = [], []
    for time in (1.0, 2.0):
        assert sim.advance(instant(math.nextafter(time, 0.0))) == []
        before.append(sim.sample())
        after.append(sim.advance(instant(time)))
    assert after[0] == []
    assert sim.sample().friction_coefficient > 0.0
    assert before[1].contact_deflection == pytest.approx(400.0 / (5e6 + 6e5), rel=1e-9)
    (breakaway,) = [event for event in after[1] if event.kind == EventKind.BREAKAWAY]
    assert breakaway.time == 2.0
    assert breakaway.friction_force == pytest.approx((NORMAL - 2800.0) * 0.24, rel=1e-14)
    assert breakaway.position == pytest.approx(before[1].position, rel=1e-12)


def test_a_force_and_its_limit_that_rise_together_break_nothing_away() -> None:
    both = steps('force', (0.0, 1.0), (0.0, 7.0)), steps('normal_load', (0.0, 1.0), (0.0, 16.0))
    force, load = both
    assert simulator(coulomb(), load, force).advance(instant(2.0)) == []
    fall = simulator(coulomb(), steps('normal_load', (0.0, 1.0), (16.0, 0.0)), steps('force', (0.0, 1.0), (7.0, 1.0)))
    assert fall.advance(instant(2.0)) == []


def test_parameters_that_change_meanwhile_keep_the_load() -> None:
    axis = paper_axis(RIGID)
    sim = simulator(axis, steps('normal_load', (0.0, 0.3, 0.9), (0.0, 800.0, -900.0)))
    sim.advance(instant(0.5))
    sim.change_axis(replace(axis, normal_force=1000.0))
    sim.command_force(0.24 * 1800.0 * 0.999)
    assert sim.advance(instant(0.6)) == []
    sim.command_force(0.24 * 1800.0 * 1.001)
    assert [event.kind for event in sim.advance(instant(0.61))][:1] == [EventKind.BREAKAWAY]
    with pytest.raises(InputError, match=r'axis\.normal_force \+ normal_load = -400\.0'):
        sim.change_axis(replace(axis, normal_force=500.0))


def test_a_deflection_at_the_start_is_held_by_the_load_too() -> None:
    axis = replace(paper_axis(CompliantContact(5e6, 15000.0)), normal_force=0.0)
    start = InitialState(deflection=1e-4)
    with pytest.raises(InputError, match='carries at most'):
        simulator(axis, constant(0.0), initial=start)
    sim = simulator(axis, constant(NORMAL), initial=start)
    assert sim.sample().mode == Mode.STICK


def test_a_load_that_varies_smoothly_is_refused_by_name() -> None:
    with pytest.raises(InputError, match=r'normal_load .*solver.name: fixed_step.*exact'):
        simulator(coulomb(), ramp(0.0, 1.0, 1.0), solver=fixed_step.solver())


def test_no_break_away_under_a_sine_is_missed() -> None:
    """Three of the 31 within 8 s are over within a step of an adaptive solver."""
    sim = simulator(paper_axis(RIGID), SINE, drive=constant(0.002))
    events = sim.advance(instant(8.0))
    breaks = [event.time for event in events if event.kind == EventKind.BREAKAWAY]
    assert (len(events), len(breaks)) == (137, 31)
    assert breaks[5] == pytest.approx(1.81893, abs=5e-6)


@pytest.mark.parametrize('contact', [RIGID, COMPLIANT])
def test_a_sine_of_no_amplitude_is_no_load(contact: Contact) -> None:
    plain = simulator(paper_axis(contact), NOTHING, drive=constant(0.002)).advance(instant(3.0))
    still = replace(SINE, sinusoids=(Sinusoid(0.0, 7.0, 0.0),))
    assert simulator(paper_axis(contact), still, drive=constant(0.002)).advance(instant(3.0)) == plain
    small = replace(SINE, sinusoids=(Sinusoid(1e-9, 7.0, 0.0),))
    near = simulator(paper_axis(contact), small, drive=constant(0.002)).advance(instant(3.0))
    assert [event.kind for event in near] == [event.kind for event in plain]
    assert [event.time for event in near] == pytest.approx([event.time for event in plain], rel=1e-11)


@pytest.mark.parametrize('contact', [RIGID, COMPLIANT])
@pytest.mark.parametrize('load', SMOOTH)
def test_the_mirrored_axis_does_the_same_the_other_way(load: str, contact: Contact) -> None:
    there = simulator(paper_axis(contact), SMOOTH[load], drive=constant(0.004)).advance(instant(2.0))
    back = simulator(paper_axis(contact), SMOOTH[load], drive=constant(-0.004)).advance(instant(2.0))
    assert [(event.time, event.kind, event.velocity) for event in there] == [
        (event.time, event.kind, -event.velocity) for event in back]
