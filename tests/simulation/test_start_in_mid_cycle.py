# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""A run that begins in mid-cycle, with a stretched spring and a deflected contact, goes on as one that came there."""

import math
import random
from dataclasses import replace

import pytest

from stickslip_sim.axis import Axis, InitialState
from stickslip_sim.core.errors import InputError
from stickslip_sim.core.input_profile import constant, positions
from stickslip_sim.core.types import Event, EventKind, Mode, Sample
from stickslip_sim.inputs import load_scene
from stickslip_sim.reference import simulate as simulate_reference
from stickslip_sim.runs import simulate, simulate_events
from stickslip_sim.runs.batch import run_batch
from stickslip_sim.scene import Scene
from stickslip_sim.simulation.simulator import Simulator
from stickslip_sim.solvers import Solver, exact, fixed_step
from tests.support.axes import COMPLIANT, RIGID, Contact, instant, paper_axis

FEED, END = 0.002, 4.0   # m/s, s


def start_of(sample: Sample) -> InitialState:
    return InitialState(sample.position, sample.velocity, sample.rest_time, sample.drive_position - sample.position,
                        sample.contact_deflection)


def run_to(axis: Axis, time: float, initial: InitialState | None = None, solver: Solver = exact.SOLVER
           ) -> tuple[Simulator, list[Event]]:
    simulator = Simulator(axis, initial or InitialState(), constant(FEED), constant(0.0), solver,
                          accounting=solver is exact.SOLVER)
    return simulator, simulator.advance(instant(time))


def agree(found: list[Event], wanted: list[Event], shift: float, within: float) -> None:
    assert [event.kind for event in found] == [event.kind for event in wanted]
    for event, other in zip(found, wanted, strict=True):
        assert event.time + shift == pytest.approx(other.time, abs=within)
        assert event.position == pytest.approx(other.position, abs=within)


@pytest.mark.parametrize(('contact', 'time'), [
    (RIGID, 1.0), (RIGID, 1.35), (COMPLIANT, 1.2), (COMPLIANT, 0.935), (COMPLIANT, 0.9)],
    ids=['rigid stick', 'rigid slip', 'stick', 'stick that rings', 'slip'])
def test_it_goes_on_as_the_run_that_came_there(contact: Contact, time: float) -> None:
    axis = paper_axis(contact)
    axis = replace(axis, friction=replace(axis.friction, excess=None))   # a slip begins on the branch without an excess
    whole, _ = run_to(axis, time)
    rest = whole.advance(instant(END))
    assert len(rest) > 8
    start = run_to(axis, time)[0].sample()
    again, found = run_to(axis, END - time, start_of(start))
    agree(found, rest, time, 1e-11)
    again.require_sound()   # the account begins with what the springs hold


@pytest.mark.parametrize('contact', [RIGID, COMPLIANT])
def test_the_reference_finds_the_same_events(contact: Contact) -> None:
    axis = paper_axis(contact)
    start = start_of(run_to(axis, 0.94)[0].sample())
    assert start.stretch > 0.0
    assert (start.deflection > 0.0) == (contact is COMPLIANT)
    _, found = run_to(axis, 2.0, start)
    agree(found, simulate_reference(axis, start, constant(FEED), constant(0.0), 2.0).events, 0.0, 1e-12)


def test_a_spring_beyond_the_limit_breaks_away_at_once() -> None:
    for solver in (exact.SOLVER, fixed_step.solver('rk4', 1e-4)):
        _, (first, *_) = run_to(paper_axis(RIGID), 1.0, InitialState(stretch=0.0015), solver)
        assert (first.kind, first.time, first.mode) == (EventKind.BREAKAWAY, 0.0, Mode.ACCELERATING)


def test_other_solvers_begin_there_too() -> None:
    axis = paper_axis(COMPLIANT)
    start = start_of(run_to(axis, 1.2)[0].sample())
    exactly, found = (run_to(axis, 0.6, start, solver)[1] for solver in (exact.SOLVER, fixed_step.solver('rk4', 1e-5)))
    for kind in (EventKind.BREAKAWAY, EventKind.STICK):   # between them a step may hide an event
        of_found, of_exactly = ([event for event in events if event.kind == kind] for events in (found, exactly))
        agree(of_found, of_exactly, 0.0, 1e-4)


def test_a_batch_begins_there_too() -> None:
    scene = load_scene('paper_fig8', {'initial.stretch': 0.0012, 'initial.deflection': 5e-5})
    run = simulate_events(scene, 5.0)
    figures = run_batch(scene.axis, 5.0, drive_velocity=[0.002], initial=scene.initial)
    assert figures.first_break_away[0] == next(event.time for event in run.events if event.kind == EventKind.BREAKAWAY)
    assert figures.period[0] == run.cycles()[-1].period


@pytest.mark.parametrize(('scene', 'given', 'what'), [
    ('paper_fig7', {'initial.deflection': 1e-5}, 'initial.deflection = 1e-05 is refused: must be 0 with a rigid'),
    ('paper_fig8', {'initial.deflection': 1e-3}, 'at most N mu_s = 823.759 N; it would carry 5000 N'),
    ('paper_fig8', {'initial.deflection': 1e-4, 'initial.rest_time': 0.0}, 'it would carry 500 N'),
    ('paper_fig8', {'initial.stretch': math.inf}, 'initial.stretch')])
def test_a_start_that_cannot_be_is_refused(scene: str, given: dict[str, float], what: str) -> None:
    with pytest.raises(InputError) as error:
        load_scene(scene, given)
    assert what in str(error.value)


# A drive whose position is prescribed is at each breakpoint where it was sent, and pulls as its position says.

PLACES, TIMES = (0.0, 0.0013, 0.0029, 0.0012, -0.0004), (0.0, 0.7, 1.5, 1.9, 3.0)


def scene_of(name: str, slopes: list[float] | None, times: tuple[float, ...] = TIMES,
             places: tuple[float, ...] = PLACES) -> Scene:
    return load_scene(name, {'drive.course': 'position', 'drive.times': list(times), 'drive.positions': list(places),
                             **({} if slopes is None else {'drive.slopes': slopes})})


@pytest.mark.parametrize('slopes', [None, [0.004, 0.0, 0.001, -0.002, 0.0]])
def test_the_drive_is_where_it_was_sent(slopes: list[float] | None) -> None:
    scene = scene_of('paper_fig8', slopes)
    run = simulate(scene, 4.0, sample_period=0.1)
    for time, place in zip(TIMES, PLACES, strict=True):
        assert run.samples['drive_position'][round(time / 0.1)] == pytest.approx(place, abs=1e-18)
    truth = simulate_reference(scene.axis, scene.initial, scene.drive, scene.force, 4.0).events
    assert [event.kind for event in run.events] == [event.kind for event in truth]
    assert max(abs(event.time - other.time) for event, other in zip(run.events, truth, strict=True)) < 1e-13


def test_a_slider_breaks_away_where_the_position_stretches_the_spring_to_the_limit() -> None:
    """Rigid contact, s = a t²: c s + h v = N mu_s."""
    scene = scene_of('paper_fig7', [0.0, 0.004], (0.0, 2.0), (0.0, 0.004))
    stiffness, damping, limit = 6e5, 4000.0, 0.24 * scene.axis.normal_force
    root = (-damping + math.sqrt(damping ** 2 + stiffness * limit / 0.001)) / stiffness   # of c a t² + 2 h a t = limit
    first = simulate(scene, 2.0).events[0]
    assert first.kind == EventKind.BREAKAWAY
    assert first.time == pytest.approx(root, rel=1e-14)


def test_no_digits_are_lost_on_a_long_way() -> None:
    rng, places = random.Random(7), [57.3]
    for _ in range(20_000):
        places.append(places[-1] + rng.uniform(-1e-4, 1.2e-4))
    profile = positions('drive', [k * 1e-3 for k in range(len(places))], places)
    reached = math.fsum(value * (end - start) for value, start, end in
                        zip(profile.values, profile.starts, profile.starts[1:], strict=False))
    assert reached == pytest.approx(places[-1] - places[0], abs=1e-15)
