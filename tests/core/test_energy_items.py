# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The items of the account of energy are what they are called."""

import dataclasses
import math
from itertools import pairwise

import pytest

from stickslip_sim.axis import Axis, Friction, InitialState
from stickslip_sim.core.input_profile import constant, steps
from stickslip_sim.core.types import EventKind, Instant, Mode
from stickslip_sim.friction import KineticTable, StaticLaw, StaticLawKind
from tests.support.accounts import accounted, energy_of
from tests.support.axes import COMPLIANT, RIGID, instant, paper_axis


def test_a_free_swing_turns_motion_into_stretch_and_friction_heat() -> None:
    """Undamped spring, Coulomb friction F: from v₀ the slider stops where m v₀²/2 = c x²/2 + F x."""
    axis = Axis(2.0, 800.0, 0.0, 10.0, RIGID, Friction(StaticLaw(StaticLawKind.CONSTANT, 9.0, 9.0),
                                                       KineticTable((0.0,), (0.1,)), None))
    simulator = accounted(axis, constant(0.0), initial=InitialState(0.0, 0.5, 0.0))
    (stop,) = simulator.advance(Instant(1.0, 0.0))
    energy = energy_of(simulator)
    x = (-1.0 + math.sqrt(1.0 + 800.0 * 2.0 * 0.25)) / 800.0
    assert stop.kind == EventKind.STICK
    assert energy.stored_at_start == 0.25
    assert energy.friction_loss == pytest.approx(1.0 * x, rel=1e-14)
    assert energy.stored == pytest.approx(400.0 * x * x, rel=1e-14)
    assert energy.drive_work == energy.external_work == energy.drive_damper_loss == energy.contact_exchange == 0.0


def test_a_full_cycle_of_an_undamped_spring() -> None:
    """Constant F_s, F_k: friction takes F_k times the jump, and the drive gives as much, every cycle."""
    friction = Friction(StaticLaw(StaticLawKind.CONSTANT, 0.24, 0.24), KineticTable((0.0,), (0.12,)), None)
    axis = Axis(350.0, 6e5, 0.0, 3432.3275, RIGID, friction)
    starts = [event for event in accounted(axis, constant(0.005)).advance(Instant(3.0, 0.0))
              if event.kind == EventKind.BREAKAWAY]
    for first, second in pairwise(starts):
        balances = []
        for event in (first, second):
            simulator = accounted(axis, constant(0.005))
            simulator.advance(event.instant)
            balances.append(energy_of(simulator))
        heat = 0.12 * 3432.3275 * (second.position - first.position)
        assert balances[1].friction_loss - balances[0].friction_loss == pytest.approx(heat, rel=1e-12)
        assert balances[1].drive_work - balances[0].drive_work == pytest.approx(heat, rel=1e-12)


def test_a_rigid_stick_stretches_the_spring_and_warms_the_damper() -> None:
    simulator = accounted(paper_axis(RIGID), constant(0.002))
    simulator.advance(Instant(0.0, 0.5))
    energy = energy_of(simulator)
    assert energy.stored == pytest.approx(0.5 * 6e5 * 0.001 ** 2, rel=1e-14)
    assert energy.drive_damper_loss == pytest.approx(4000.0 * 0.002 ** 2 * 0.5, rel=1e-14)
    assert energy.drive_work == pytest.approx(energy.stored + energy.drive_damper_loss, rel=1e-14)


def test_the_contact_appears_and_vanishes_with_its_deflection() -> None:
    axis = paper_axis(COMPLIANT)
    simulator = accounted(axis, constant(0.002))
    events = simulator.advance(Instant(1.0, 0.0))
    away, stop = (next(e for e in events if e.kind == kind) for kind in (EventKind.BREAKAWAY, EventKind.STICK))
    arrival = (0.12 * axis.normal_force) ** 2 / (2.0 * 5e6)
    release = ((away.friction_force - 15000.0 * away.velocity) / 5e6) ** 2 * 5e6 / 2.0
    assert stop.velocity == 0.0
    assert energy_of(simulator).contact_exchange == pytest.approx(arrival - release, rel=1e-10)


def test_the_damper_of_a_ringing_contact_takes_what_the_ringing_had() -> None:
    """Drive and load at rest: what the slider had in the ring-down ends in the two dampers."""
    simulator = accounted(paper_axis(COMPLIANT), steps('v', (0.0, 0.9), (0.002, 0.0)))
    while simulator.sample().mode != Mode.STICK or simulator.time.seconds < 0.9:
        simulator.advance(instant(simulator.time.seconds + 0.001))
    begin = energy_of(simulator)
    simulator.advance(Instant(60.0, 0.0))
    end = energy_of(simulator)
    taken = (end.contact_damper_loss + end.drive_damper_loss) - (begin.contact_damper_loss + begin.drive_damper_loss)
    assert taken == pytest.approx(begin.stored - end.stored, rel=1e-9)
    assert end.contact_damper_loss > 3.0 * end.drive_damper_loss - 3.0 * begin.drive_damper_loss


def test_a_jump_of_an_input_stores_nothing() -> None:
    simulator = accounted(paper_axis(COMPLIANT), constant(0.002))
    simulator.advance(Instant(0.8, 0.0))
    before = energy_of(simulator)
    simulator.command_drive(0.005)
    simulator.command_force(40.0)
    after = energy_of(simulator)
    assert after.stored == pytest.approx(before.stored, rel=1e-15)
    simulator.advance(Instant(2.0, 0.0))
    assert energy_of(simulator).relative_residual <= 1e-14
    assert energy_of(simulator).external_work > 0.0


@pytest.mark.parametrize('time', [0.4, 0.85, 0.95, 1.2])
def test_a_change_of_parameters_is_an_item_of_its_own(time: float) -> None:
    simulator = accounted(paper_axis(COMPLIANT), constant(0.002))
    simulator.advance(instant(time))
    before = energy_of(simulator)
    simulator.change_axis(dataclasses.replace(paper_axis(RIGID), drive_stiffness=9e5, mass=300.0))
    after = energy_of(simulator)
    assert after.parameter_exchange != 0.0
    assert after.stored - before.stored == pytest.approx(after.parameter_exchange + after.contact_exchange
                                                         - before.contact_exchange, rel=1e-12)
    simulator.change_axis(paper_axis(COMPLIANT))
    simulator.advance(Instant(5.0, 0.0))
    assert energy_of(simulator).relative_residual <= 1e-14
