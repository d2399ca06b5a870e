# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Simulators that keep the account of energy."""

from stickslip_sim.axis import Axis, CompliantContact, InitialState
from stickslip_sim.core.input_profile import InputProfile, constant
from stickslip_sim.core.types import EnergyBalance
from stickslip_sim.simulation.simulator import Simulator

UNDAMPED = CompliantContact(5e6, 0.0)


def accounted(axis: Axis, drive: InputProfile, force: InputProfile | None = None,
              initial: InitialState | None = None) -> Simulator:
    return Simulator(axis, initial or InitialState(), drive, force or constant(0.0), accounting=True)


def energy_of(simulator: Simulator) -> EnergyBalance:
    energy = simulator.energy
    assert energy is not None
    return energy
