# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""A rig goes on from a checkpoint to the last bit; friction that changes during a run: every solver follows it."""

import json
import math
import random
from dataclasses import replace
from random import Random
from typing import Any

import pytest

from stickslip_sim.axis import Axis, InitialState
from stickslip_sim.axis.fields import places_of
from stickslip_sim.axis.state_record import State
from stickslip_sim.core.errors import InputError, SolverError
from stickslip_sim.core.input_profile import constant, positions
from stickslip_sim.core.types import Event, EventKind, Mode, Sample
from stickslip_sim.inputs import load_scene
from stickslip_sim.recording import checkpoint_file
from stickslip_sim.reference import simulate as simulate_reference
from stickslip_sim.runs import simulate, simulate_events
from stickslip_sim.runs.batch import run_batch
from stickslip_sim.scene import Scene, changed
from stickslip_sim.simulation import Fault, Rig, StepResult
from stickslip_sim.simulation.simulator import Simulator
from stickslip_sim.solvers import Solver, exact, fixed_step
from tests.support.axes import COMPLIANT, RIGID, Contact, instant, paper_axis
from tests.support.rigs import inject, run

LIMITS = {'command.acceleration_limit': 0.5, 'command.on_timeout': 'ramp_to_zero'}
SINES = {'force.course': 'sine', 'force.amplitude': 200.0, 'force.frequency': 7.0, 'drive.course': 'table',
         'drive.times': [0.0, 0.3], 'drive.velocities': [0.001, 0.004], 'drive.period': 0.5}
LOADS = {'normal_load.course': 'steps', 'normal_load.times': [0.0, 0.15, 0.2503], 'normal_load.period': 0.4,
         'normal_load.forces': [0.0, -3000.0, 900.0]}
SCENES = [('paper_fig8', LIMITS), ('paper_fig7', SINES), ('cutting_force', {}), ('paper_fig8', LOADS),
          ('paper_fig8', {'solver.name': 'fixed_step', 'solver.step': 1e-4}),
          ('paper_fig8', {'friction.static.scatter': 0.2, 'drive.velocity': 0.02})]


def go(rig: Rig, scene: Scene, first: int, count: int) -> list[StepResult]:
    """Make steps with orders of every kind, chosen by the number of the step."""
    results = []
    for n in range(first, first + count):
        stream = Random(n)
        velocity = stream.uniform(-0.01, 0.01) if n % 7 == 0 else None
        force = stream.uniform(-900.0, 900.0) if n % 97 == 0 else None
        if n % 100 == 50:
            kind = stream.choice(['friction_scale', 'force_pulse', 'command_loss', 'command_delay', 'drive_freeze'])
            rig.inject(Fault('', kind, 0.01, 0.1, 0.0 if kind == 'drive_freeze' else stream.random()))
        if n % 444 == 3:
            rig.time_out(0.2)
        if n % 333 == 3:
            rig.change_axis(changed(scene, {'axis.mass': stream.uniform(200.0, 400.0)}).axis)
        results.append(rig.make_step(velocity, force))
    return results


def continued(scene: Scene, rig: Rig) -> Rig:
    """Return another rig that goes on from the checkpoint as a file has it."""
    (data,) = checkpoint_file(rig.checkpoint()).values()
    again = scene.make_rig()
    again.restore(json.loads(data))
    return again


@pytest.mark.parametrize(('name', 'overrides'), SCENES)
@pytest.mark.parametrize('steps', [1, 455, 1257])
def test_to_the_last_bit(name: str, overrides: dict[str, object], steps: int) -> None:
    scene = load_scene(name, overrides)
    rig = scene.make_rig()
    go(rig, scene, 0, steps)
    rig.change_axis(scene.axis)
    again = continued(scene, rig)
    expected, found = go(rig, scene, steps, 1500), go(again, scene, steps, 1500)
    assert [result.sample for result in found] == [result.sample for result in expected]
    assert [result.events for result in found] == [result.events for result in expected]
    assert sum(len(result.events) for result in expected) > 5


def test_the_order_of_faults_and_parameters_between_two_steps_does_not_matter() -> None:
    scene = load_scene('paper_fig8')
    heavier = changed(scene, {'axis.normal_force': 9000.0}).axis
    found = []
    for is_cleared_first in (True, False):
        rig = scene.make_rig()
        rig.inject(Fault('slippery', 'friction_scale', 0.0, 100.0, 0.1))
        go(rig, scene, 0, 700)
        if is_cleared_first:
            rig.clear_fault('slippery')
        rig.change_axis(heavier)
        if not is_cleared_first:
            rig.clear_fault('slippery')
        found.append([result.sample for result in go(rig, scene, 700, 500)])
    assert found[0] == found[1]


@pytest.mark.parametrize(('place', 'value'), [
    ('state', [0.0] * 7), ('state', 'none'), ('mode', 5.0), ('mode', 0.5), ('segment', -1.0), ('segment', 1e300),
    ('sinusoid_count', 3.0), ('until', 'soon'), ('time', [1.0]), ('waiting', [[1.0]]),
])
def test_a_state_that_no_solver_may_see(place: str, value: Any) -> None:
    scene = load_scene('paper_fig8')
    rig = scene.make_rig()
    saved = rig.checkpoint()
    if place in places_of(State):
        saved['simulator']['state'][places_of(State).index(place)] = value
    else:
        saved['simulator'][place] = value
    with pytest.raises((TypeError, ValueError)):
        scene.make_rig().restore(saved)


@pytest.mark.parametrize(('place', 'value'), [
    ('wire', [[], [[1, 2, 3], 0]]), ('wire', [[], [[0] * 624, 625]]),
    ('drive', [[[], [], [], 'inf', []], None, 'inf', False]),
    ('force', [[0.0], ['x'], [0.0], 'inf', []]), ('faults', {'active': [], 'planned': [[1, 2, ['a']]], 'chosen': 0}),
    ('faults', {'active': [[['a', 'rust', 0.0, 1.0, 0.0], 2.0]], 'planned': [], 'chosen': 0}),
])
def test_a_rig_that_never_was(place: str, value: Any) -> None:
    scene = load_scene('paper_fig8')
    rig = scene.make_rig()
    with pytest.raises((TypeError, ValueError, InputError)):
        rig.restore({**rig.checkpoint(), place: value})


LAWS = [('stribeck', 1e-6), ('exponential', 1e-6), ('hyperbolic', 1e-5)]
_PER_ERROR = 20.0    # s that a slip may be early or late per error of a table: up to 9 were seen
_STEPPED = 2e-4      # s that these fixed steps add
SOLVERS: dict[str, dict[str, Any]] = {
    'adaptive': {'solver.name': 'adaptive'}, 'fixed_step': {'solver.name': 'fixed_step', 'solver.step': 2e-6},
}


def scaled_from(start: float, factor: float) -> dict[str, Any]:
    """Return what a scene says of friction that is times a factor from a time on."""
    return {'faults.ids': ['a'], 'faults.kinds': ['friction_scale'], 'faults.starts': [start],
            'faults.durations': [100.0], 'faults.values': [factor]}


def slips(events: list[Event]) -> list[Event]:
    """Return where slips begin and end."""
    return [event for event in events if event.kind in (EventKind.BREAKAWAY, EventKind.STICK)]


def assert_same_slips(found: list[Event], expected: list[Event], seconds: float) -> None:
    assert [event.kind for event in slips(found)] == [event.kind for event in slips(expected)]
    for event, other in zip(slips(found), slips(expected)):
        assert event.time == pytest.approx(other.time, abs=seconds)
        assert event.position == pytest.approx(other.position, abs=0.1 * seconds)


@pytest.mark.parametrize(('law', 'tolerance'), LAWS)
@pytest.mark.parametrize(('solver', 'factor'), [('adaptive', 3.0), ('fixed_step', 0.5)])
def test_a_fault_scales_the_law_as_it_scales_the_table(solver: str, law: str, tolerance: float, factor: float) -> None:
    given = {'friction.kinetic.law': law, 'friction.kinetic.tolerance': tolerance, **scaled_from(2.0, factor)}
    expected, found = (load_scene('stribeck', {**given, **other}).make_rig().advance(instant(4.5))
                       for other in ({}, SOLVERS[solver]))
    assert sum(event.time > 2.0 for event in slips(expected)) >= 2
    assert_same_slips(found, expected, _PER_ERROR * tolerance + (_STEPPED if solver == 'fixed_step' else 0.0))


def driven(rig: Rig, steps: int) -> list[Event]:
    return [event for result in run(rig, steps) for event in result.events]


SLOW = {'time.rate': 50.0, 'friction.kinetic.tolerance': 1e-6}
OTHER_LAW = {'friction.kinetic.initial': 0.11, 'friction.kinetic.limit': 0.03, 'friction.kinetic.viscous': 0.05,
             'friction.kinetic.stribeck_velocity': 0.008}


@pytest.mark.parametrize('start_anew', [False, True])
def test_a_live_parameter_changes_the_law(start_anew: bool) -> None:
    runs = []
    for solver in ({}, SOLVERS['adaptive']):
        scene = load_scene('stribeck', {**SLOW, **solver})
        rig = scene.make_rig()
        driven(rig, 90)
        rig.change_axis(changed(scene, OTHER_LAW).axis)
        if start_anew:
            rig.make_step()
            rig.reset()
        runs.append(driven(rig, 120))
    expected, found = runs
    assert len(slips(expected)) > 2
    assert_same_slips(found, expected, _PER_ERROR * SLOW['friction.kinetic.tolerance'])


def test_a_checkpoint_is_continued_with_the_law_of_its_time() -> None:
    scene = load_scene('stribeck', {**SLOW, **SOLVERS['adaptive'], **scaled_from(1.0, 3.0)})
    rig, again = scene.make_rig(), scene.make_rig()
    other = changed(scene, OTHER_LAW).axis
    rig.change_axis(other)
    driven(rig, 100)
    (data,) = checkpoint_file(rig.checkpoint()).values()
    again.change_axis(other)
    again.restore(json.loads(data))
    expected = driven(rig, 150)
    assert len(slips(expected)) >= 2
    assert driven(again, 150) == expected


STEEP = {'solver.name': 'fixed_step', 'solver.step': 1e-3, 'drive.velocity': 0.2, 'friction.kinetic.end_slope': 5.0}


def test_steps_too_long_for_the_scaled_friction_end_the_run() -> None:
    """Where friction rises with the speed a scaled one damps harder, and fixed steps of 1 ms would diverge."""
    rig = load_scene('paper_fig7', STEEP).make_rig()
    with pytest.raises(SolverError, match=r'faults in force scale friction by 100: solver\.step = 0\.001 is refused'):
        run(rig, 600, {500: [inject('friction_scale', value=100.0)]})
    rig.reset()
    assert driven(rig, 800)


def test_friction_beyond_all_numbers_ends_the_run() -> None:
    rig = load_scene('stribeck').make_rig()
    with pytest.raises(SolverError, match='faults in force scale friction by inf: friction'):
        run(rig, 2, {1: [inject('friction_scale', value=100.0)] * 200})


def test_what_the_faults_of_a_scene_make_of_friction_is_checked_with_the_scene() -> None:
    with pytest.raises(InputError, match=r'with friction times 100 by faults: solver\.step = 0\.001 is refused'):
        load_scene('paper_fig7', {**STEEP, **scaled_from(0.5, 100.0)})
    one_after_the_other = {'faults.ids': ['a', 'b'], 'faults.kinds': ['friction_scale'] * 2,
                           'faults.starts': [0.5, 0.7], 'faults.values': [10.0, 10.0]}
    load_scene('paper_fig7', {**STEEP, **one_after_the_other, 'faults.durations': [0.2, 0.2]})
    with pytest.raises(InputError, match=r'with friction times 100 by faults: solver\.step'):
        load_scene('paper_fig7', {**STEEP, **one_after_the_other, 'faults.durations': [0.3, 0.2]})


# A run that begins in mid-cycle, with a stretched spring and a deflected contact, goes on as one that came there.

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
