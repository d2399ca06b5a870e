# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The account of energy closes under sinusoids, at any frequency, and costs the same."""

import dataclasses
import math

import pytest

from stickslip_sim.axis import CompliantContact
from stickslip_sim.core.input_profile import InputProfile, Sinusoid, constant
from stickslip_sim.core.types import Instant
from tests.conftest import Program
from tests.support.accounts import UNDAMPED, accounted, energy_of
from tests.support.axes import COMPLIANT, RIGID, instant, paper_axis

NEAR = math.sqrt(5.6e6 / 350.0) / (2.0 * math.pi)   # Hz, the paper's contact without a damper


@pytest.mark.parametrize('contact', [RIGID, COMPLIANT, UNDAMPED])
@pytest.mark.parametrize('base', [0.002, 0.0])
def test_the_balance_closes_under_sines(contact: CompliantContact, base: float) -> None:
    drive = InputProfile((0.0,), (base,), (0.0,), sinusoids=(Sinusoid(0.5 * base + 1e-4, 3.0, 0.3),))
    force = InputProfile((0.0,), (0.0,), (0.0,), sinusoids=(Sinusoid(60.0, 20.0, 0.0),))
    simulator = accounted(paper_axis(contact), drive, force)
    simulator.advance(Instant(60.0, 0.0))
    energy = energy_of(simulator)
    assert energy.throughput > 1e-3
    assert energy.relative_residual <= 1e-12


@pytest.mark.parametrize('contact', [RIGID, COMPLIANT, UNDAMPED])
def test_a_long_hold_under_a_vibration_does_not_depend_on_its_splits(contact: CompliantContact) -> None:
    force = InputProfile((0.0,), (0.0,), (0.0,), sinusoids=(Sinusoid(100.0, 50.0, 0.1),))
    at_once, in_parts = (accounted(paper_axis(contact), constant(0.0), force) for _ in range(2))
    for k in range(1, 2001):
        in_parts.advance(Instant(*divmod(0.03 * k, 1.0)))
        assert energy_of(in_parts).relative_residual <= 1e-11
    at_once.advance(in_parts.time)
    assert in_parts.energy == at_once.energy
    for simulator in (at_once, in_parts):
        simulator.command_drive(0.01)
        simulator.advance(Instant(61.0, 0.0))
    assert in_parts.energy == at_once.energy
    assert energy_of(at_once).relative_residual <= 1e-13


@pytest.mark.parametrize('frequency', [1e-3, 1.0, 50.0, 1e3, 1e6])
@pytest.mark.parametrize('contact', [RIGID, COMPLIANT, UNDAMPED, *(CompliantContact(5e6, h) for h in (1e6, 1e8, 1e10))])
def test_a_hold_of_a_thousand_seconds_closes_at_any_frequency(contact: CompliantContact, frequency: float) -> None:
    for drive, force in (((1e-7 * frequency, frequency, 0.3), (100.0, 0.7 * frequency, 0.1)),
                         ((0.0, 1.0, 0.0), (100.0, frequency, 0.1))):
        simulator = accounted(paper_axis(contact), InputProfile((0.0,), (0.0,), (0.0,), sinusoids=(Sinusoid(*drive),)),
                              InputProfile((0.0,), (0.0,), (0.0,), sinusoids=(Sinusoid(*force),)))
        assert simulator.advance(Instant(1000.0, 0.0)) == []
        assert energy_of(simulator).relative_residual <= 1e-12


@pytest.mark.parametrize('damping', [0.0, 1e-3, 1.0, 100.0])
@pytest.mark.parametrize('detuned', [0.0, 1e-12, 1e-9, 1e-6, 1e-5, 1e-4, 1e-3, 1e-2])
def test_near_resonance_the_balance_closes(damping: float, detuned: float) -> None:
    axis = dataclasses.replace(paper_axis(UNDAMPED), drive_damping=damping)
    force = InputProfile((0.0,), (0.0,), (0.0,), sinusoids=(Sinusoid(0.1, NEAR * (1.0 + detuned), 0.1),))
    simulator = accounted(axis, constant(0.0), force)
    for time in (0.01, 0.1, 1.0, 10.0, 30.0):
        simulator.advance(instant(time))
        assert energy_of(simulator).relative_residual <= 1e-12, time


@pytest.mark.parametrize('damping', [0.0, 1.5e4, 1e6, 1e8, 1e9])
def test_slow_and_fast_sinusoids_together_over_stick_and_slip(damping: float) -> None:
    drive = InputProfile((0.0,), (0.002,), (1e-5,), sinusoids=(Sinusoid(1e-3, 3.0, 0.1), Sinusoid(1e-4, 0.01, 0.7)))
    force = InputProfile((0.0,), (0.0,), (0.0,), sinusoids=(Sinusoid(10.0, 400.0, 0.0), Sinusoid(10.0, NEAR, 0.0)))
    simulator = accounted(paper_axis(CompliantContact(5e6, damping)), drive, force)
    assert len(simulator.advance(Instant(10.0, 0.0))) > 20
    assert energy_of(simulator).relative_residual <= 1e-13
    assert energy_of(simulator).external_work != 0.0


COUNTED = """
import sys
from stickslip_sim.axis import CompliantContact, InitialState
from stickslip_sim.core.input_profile import InputProfile, Sinusoid
from stickslip_sim.simulation.simulator import Simulator
from stickslip_sim.core.types import Instant
from tests.support.axes import RIGID, paper_axis
calls = 0
def count(frame, event, argument):
    global calls
    calls += event == 'call'
    if calls > 200000:
        sys.setprofile(None)
        raise SystemExit('no end')
def counted(contact, frequency, duration, accounting):
    global calls
    inputs = InputProfile((0.0,), (0.0,), (0.0,), sinusoids=(Sinusoid(1e-7, frequency, 0.1),)), InputProfile(
        (0.0,), (0.0,), (0.0,), sinusoids=(Sinusoid(50.0, frequency, 0.2),))
    simulator = Simulator(paper_axis(contact), InitialState(), *inputs, accounting=accounting)
    calls = 0
    sys.setprofile(count)
    simulator.advance(Instant(duration, 0.0))
    simulator.energy
    sys.setprofile(None)
    return calls
for contact in (RIGID, CompliantContact(5e6, 15000.0), CompliantContact(5e6, 1e8)):
    for frequency in (3.0, 1e3, 1e6):
        for duration in (60.0, 1000.0, 3e7):
            print(counted(contact, frequency, duration, True) - counted(contact, frequency, duration, False))
"""


def test_the_account_of_a_hold_takes_the_same_work_at_any_frequency_and_length(in_a_process: Program) -> None:
    counts = [int(line) for line in in_a_process(COUNTED, compiled=False).split()]
    assert len(counts) == 27
    assert 0 < max(counts) <= 200   # calls of functions
