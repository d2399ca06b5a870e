# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""X17: commands that no axis can follow, and those that come late, twice or in a burst."""

import math
import random
from collections.abc import Callable
from functools import partial

from ...axis import Axis, InitialState
from ...core.errors import InputError, StickslipError
from ...core.input_profile import InputProfile, ramp, steps, table
from ...core.types import Event, Instant
from ...friction import KineticTable, StaticLaw, StaticLawKind
from ...inputs import load_scene
from ...realtime.commands import CommandSlot
from ...simulation.simulator import Simulator
from ...solvers import Solver
from ..axes import CONTACTS, RIGID, Contact, instant, make, paper_axis, run_events
from ..judges import Measurement, Setup, Tally, require, same_bits

_BAD = (math.nan, math.inf, -math.inf)
_PARAMETERS = (
    'axis.mass', 'axis.drive_stiffness', 'axis.drive_damping', 'axis.normal_force', 'contact.stiffness',
    'contact.damping', 'friction.static.initial', 'friction.static.limit', 'friction.static.time_constant',
    'drive.velocity', 'force.constant', 'initial.position', 'initial.velocity', 'initial.stretch',
    'initial.deflection', 'time.rate')


def bad_commands(setup: Setup) -> Measurement:
    """X17: refused by name at every door, the state untouched; the latest good command wins."""
    tally = Tally(0.0)
    for contact in CONTACTS:
        for bad in _BAD:
            for given in ('velocity', 'force'):
                tally.measure(_refused_by_the_simulator, setup.solver, contact, given, bad)
            tally.measure(_refused_time, setup.solver, contact, Instant(bad, 0.0))
        tally.measure(_refused_time, setup.solver, contact, instant(0.2))
        for seed in range(setup.choose(200, 10)):
            tally.measure(_burst, setup.solver, contact, seed)
        for huge in (1e100, -1e300, 1.7976931348623157e308):
            tally.measure(_huge, setup.solver, contact, huge)
    for bad in _BAD:
        for name in _PARAMETERS:
            tally.measure(_refused_by_the_scene, name, bad)
        tally.measure(_refused_by_the_slot, bad)
        tally.measure(_refused_profiles, bad)
    return tally.finding('accepted, or not by name, or with a changed state')


def _refused_by_the_simulator(solver: Solver, contact: Contact, given: str, bad: float) -> None:
    simulator, twin = (make(paper_axis(contact), 0.002, solver=solver) for _ in range(2))
    simulator.advance(instant(0.5))
    twin.advance(instant(0.5))
    command = simulator.command_drive if given == 'velocity' else simulator.command_force
    _check_refused(lambda: command(bad), given)
    require(simulator.sample() == twin.sample(), 'the state is another one')
    same_bits(simulator.advance(instant(2.0)), twin.advance(instant(2.0)))


def _check_refused(act: Callable[[], object], name: str) -> None:
    try:
        act()
    except InputError as error:
        require(name in error.name and str(error.value) in str(error), f'the refusal does not name {name}: {error}')
        return
    require(False, f'{name} is accepted')


def _refused_time(solver: Solver, contact: Contact, to: Instant) -> None:
    """See that a time that is none, or past, is refused; the guard comes first, as a solver could search for ever."""
    simulator = make(paper_axis(contact), 0.002, solver=solver)
    simulator.advance(instant(0.5))
    before = simulator.sample()
    _check_refused(lambda: simulator.advance(to), 'time')
    require(simulator.sample() == before, 'the state is another one')


def _burst(solver: Solver, contact: Contact, seed: int) -> None:
    """See that a burst with duplicates and NaN within a step is as good as its last good command alone."""
    rng = random.Random(seed)
    busy, quiet = (make(paper_axis(contact), 0.002, solver=solver) for _ in range(2))
    slot = CommandSlot('velocity', 'm/s', 0.1)
    seen, wanted = list[Event](), list[Event]()
    for step in range(1, 61):
        seen += busy.advance(instant(step / 20))
        wanted += quiet.advance(instant(step / 20))
        for _ in range(rng.choice((0, 1, 50))):
            value = rng.choice((rng.uniform(-0.05, 0.05), math.nan, 1e9))
            refusal = slot.offer(value, step)
            require(('velocity' in refusal) == (not abs(value) <= 0.1), 'not refused by name')
            if rng.random() < 0.3:
                slot.offer(value, step)   # twice
        if slot.latest is not None:
            if rng.random() < 0.5:        # a duplicate of the command in force changes nothing
                busy.command_drive(slot.latest.value)
            busy.command_drive(slot.latest.value)
            quiet.command_drive(slot.latest.value)
        require(busy.sample() == quiet.sample(), f'another state at step {step}')
    same_bits(seen, wanted)


def _huge(solver: Solver, contact: Contact, huge: float) -> None:
    """See that a command beyond all sense is refused, simulated or given up by name, and that a reset works after."""
    simulator = make(paper_axis(contact), 0.002, solver=solver)
    simulator.advance(instant(0.5))
    for command in (simulator.command_drive, simulator.command_force):
        try:
            command(huge)
            simulator.advance(Instant(simulator.time.second + 1.0, 0.0))
            simulator.sample()
        except StickslipError as error:
            require(len(str(error)) > 20, 'no reason is given')
    simulator.reset()
    same_bits(simulator.advance(instant(1.0)), run_events(paper_axis(contact), 0.002, 1.0, solver=solver), 'reset')


def _refused_by_the_scene(name: str, bad: float) -> None:
    _check_refused(lambda: load_scene('paper_fig8', {name: bad}), name)


def _refused_by_the_slot(bad: float) -> None:
    slot = CommandSlot('drive_velocity', 'm/s', 10.0)
    slot.offer(0.003, 1)
    for value in (bad, 10.000001, -1e300):
        require('drive_velocity' in slot.offer(value, 2), 'not refused by name')
    require(slot.latest == (0.003, 1) and slot.refused == 3, 'the good command before is lost')


def _simulator_on(make_profile: Callable[[], InputProfile]) -> Simulator:
    return Simulator(paper_axis(RIGID), InitialState(), make_profile(), make_profile())


def _refused_profiles(bad: float) -> None:
    """See that an input profile or an axis made in Python is as strict as a scene."""
    for make_profile in (lambda: steps('drive', [0.0, bad], [0.0, 0.0]),
                         lambda: table('drive', [0.0, bad], [0.0, 0.0])):
        _check_refused(make_profile, 'drive')
    friction = paper_axis(RIGID).friction
    _check_refused(lambda: Axis(bad, 1.0, 1.0, 1.0, RIGID, friction), 'mass')
    _check_refused(lambda: InitialState(position=bad), 'position')
    _check_refused(lambda: KineticTable((0.0,), (bad,)), 'coefficients')
    _check_refused(lambda: StaticLaw(StaticLawKind.CONSTANT, bad, 1.0), 'initial')
    for make_profile in (lambda: ramp(0.0, bad, 1.0), lambda: steps('drive', [0.0], [bad])):
        _check_refused(partial(_simulator_on, make_profile), 'drive')
