# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""A run that went wrong says so: a doctored event, state or account ends it, at the event or at the end."""

import math
from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from stickslip_sim.axis import Axis, InitialState, pack
from stickslip_sim.axis.layout import NORMAL
from stickslip_sim.axis.state_record import STATE_PLACES
from stickslip_sim.cli.main import run as tool
from stickslip_sim.core.errors import UnsoundError
from stickslip_sim.core.input_profile import InputProfile, Sinusoid, constant
from stickslip_sim.core.types import EventKind, Mode
from stickslip_sim.inputs import load_scene
from stickslip_sim.proof.axes import COMPLIANT, RIGID, Contact, instant, paper_axis
from stickslip_sim.runs.batch import figures_in, new_rows
from stickslip_sim.simulation.simulator import Simulator
from stickslip_sim.solvers import Solver, exact

Doctor = Callable[[Any], None]


def set_number(state: Any, place: str, number: float) -> None:
    """Set a number of a state, as `next.time`."""
    numbers = state.numbers()
    numbers[STATE_PLACES.index(place)] = number
    state.take(numbers)


def scale_number(state: Any, place: str, factor: float) -> None:
    """Multiply a number of a state."""
    set_number(state, place, factor * state.numbers()[STATE_PLACES.index(place)])


def doctored(change: Doctor, mode: Mode | None = None) -> Solver:
    """Return the exact solver with a state that is changed once: when it is in a mode, after the first half second."""
    done: list[bool] = []

    def advance(p: Any, s: Any, *arguments: Any) -> Any:
        rows, end = exact.advance(p, s, *arguments)
        if not done and s.second + s.fraction > 0.5 and (mode is None or s.mode == mode):
            done.append(True)
            change(s)
        return rows, end

    return exact.SOLVER._replace(advance=advance, step=None)


def run_in_steps(axis: Axis, solver: Solver, end: float = 3.0) -> None:
    """Run at 1 kHz, and check the end."""
    simulator = Simulator(axis, InitialState(), constant(0.002), constant(0.0), solver, accounting=True)
    for tick in range(1, round(1000 * end) + 1):
        simulator.advance(instant(tick / 1000))
    simulator.require_sound()


def event_too_early(s: Any) -> None:
    """Let the next event come after nine tenths of its time."""
    scale_number(s, 'next.time', 0.9)
    set_number(s, 'next.searched', math.inf)


def no_event(s: Any) -> None:
    """Let no event come any more."""
    set_number(s, 'next.time', math.inf)
    set_number(s, 'next.searched', math.inf)


def lost_energy(s: Any) -> None:
    """Let a hundredth of the drive's work be lost."""
    scale_number(s, 'sums.drive', 0.99)


def other_place(s: Any) -> None:
    """Let the slider jump by a hundredth of its spring's stretch."""
    jump = 0.01 * s.spring
    s.position -= jump
    s.spring += jump


def not_a_number(s: Any) -> None:
    """Let the speed be no number."""
    s.velocity = math.nan


@pytest.mark.parametrize('contact', [RIGID, COMPLIANT])
@pytest.mark.parametrize('mode', [Mode.STICK, Mode.ACCELERATING, Mode.COASTING, Mode.DECELERATING])
@pytest.mark.parametrize(('change', 'said'), [
    (event_too_early, 'at t = .* in mode {}: do not trust its figures'), (no_event, 'at t = 3.0 s, in mode {}')])
def test_an_event_that_is_none_or_is_missed_ends_the_run(change: Doctor, said: str, mode: Mode, contact: Contact
                                                         ) -> None:
    with pytest.raises(UnsoundError, match=said.format(mode.name)):
        run_in_steps(paper_axis(contact), doctored(change, mode))


@pytest.mark.parametrize('change', [lost_energy, other_place, not_a_number])
@pytest.mark.parametrize('contact', [RIGID, COMPLIANT])
def test_a_balance_that_is_open_ends_the_run(contact: Contact, change: Doctor) -> None:
    with pytest.raises(UnsoundError):
        run_in_steps(paper_axis(contact), doctored(change))


@pytest.mark.parametrize('contact', [RIGID, COMPLIANT])
def test_a_sound_run_passes(contact: Contact) -> None:
    run_in_steps(paper_axis(contact), doctored(lambda s: None))


def test_the_tool_gives_no_figure_of_such_a_run(monkeypatch: pytest.MonkeyPatch,
                                                capsys: pytest.CaptureFixture[str]) -> None:
    monkeypatch.setattr('stickslip_sim.scene.model.exact.SOLVER', doctored(event_too_early))
    assert tool(['simulate', 'paper_fig7', '--duration', '5']) == 4
    reported = capsys.readouterr()
    assert reported.out == ''
    assert 'violates its own motion or energy balance at t = ' in reported.err
    assert len(reported.err.splitlines()) == 1


def test_an_axis_of_a_batch_beyond_the_range_of_numbers_is_not_complete() -> None:
    parameters = np.tile(np.array(pack(paper_axis(RIGID))), (2, 1))
    parameters[1, NORMAL] = 1e250
    of = exact.SOLVER.records
    state = of.State()
    state.accounting = 1.0
    out = new_rows(2)
    with np.errstate(all='ignore'):   # what numpy says when this runs as plain Python
        exact.run_axes(parameters, np.array([[0.002, 0.0], [1e200, 0.0]]), np.array([[0.0, 0.0, math.inf]] * 2), 3.0,
                       0, 2, of.Parameters(parameters[0].tolist()), state, of.Events(64), of.Sinusoids([]), out)
    assert figures_in(out).complete.tolist() == [True, False]


@pytest.mark.parametrize('contact', [RIGID, COMPLIANT])
def test_a_load_that_comes_and_goes_within_one_stick_is_sound(contact: Contact) -> None:
    """Nothing went through in the end: rounding is all that the balance leaves, and all that it could be held to."""
    drive = InputProfile((0.0, 0.1, 0.2), (0.0, 0.001, 0.0), (0.01, -0.01, 0.0), sinusoids=(Sinusoid(1e-4, 5.0, 0.0),))
    simulator = Simulator(paper_axis(contact), InitialState(), drive, constant(0.0), accounting=True)
    for tick in range(1, 1001):
        simulator.advance(instant(tick / 1000))
        simulator.require_sound()


def test_a_contact_that_gives_way_against_its_motion_obeys_newton() -> None:
    """Friction is made small at every instant of a ring-down; from then on m ẍ = F_d + F_e − F, and energy balances."""
    axis = paper_axis(COMPLIANT)
    turned = 0
    for k in range(200):
        simulator = Simulator(axis, InitialState(), constant(0.002), constant(0.0), accounting=True)
        simulator.advance(instant(0.9275 + 1e-4 * k))   # the first stick begins at 0.927385 s
        before = simulator.sample()
        simulator.change_axis(replace(axis, normal_force=1.0))
        after = simulator.sample()
        turned += before.velocity * before.friction_force < 0.0 and after.mode != Mode.STICK
        pull = after.drive_force + after.external_force - after.friction_force
        assert axis.mass * after.acceleration == pytest.approx(pull, abs=1e-9)
        simulator.advance(instant(1.2))
        simulator.require_sound()
    assert turned > 20



def test_a_speed_that_peaks_on_a_breakpoint_turns_there() -> None:
    """The acceleration there is 0 within rounding, or less: the slider must not be taken to go on upwards."""
    scene = load_scene('paper_fig8', {
        'axis.mass': 87696.35152955492, 'axis.drive_stiffness': 12406160936.812164,
        'axis.drive_damping': 98442867.19902536, 'axis.normal_force': 968220.714862454,
        'contact.stiffness': 16092415817.98671, 'contact.damping': 0.0,
        'friction.static.initial': 0.9709148537627836, 'friction.static.limit': 1.9266025074642252,
        'friction.static.time_constant': 4.079918791087288, 'friction.acceleration_dependence': False,
        'friction.kinetic.velocities': [0.0, 0.019210304325592047, 0.026136200024539705],
        'friction.kinetic.coefficients': [0.764754331846208, 0.28753352922809755, 0.11548099698903541],
        'drive.velocity': 0.011023211591484136})
    simulator = Simulator(scene.axis, scene.initial, scene.drive, scene.force, accounting=True)
    events = simulator.advance(instant(0.2))
    simulator.require_sound()
    assert [event.kind for event in events] == [EventKind.BREAKAWAY, EventKind.KNOT, EventKind.DECELERATE]
    assert events[2].time - events[1].time < 1e-9
