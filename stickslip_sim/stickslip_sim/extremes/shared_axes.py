# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Axes, input profiles and runs that the extremes share."""

import math
import random
from dataclasses import replace

from ..axis import Axis, CompliantContact, Friction, InitialState, RigidContact
from ..core.input_profile import InputProfile, constant, ramp, steps, table
from ..core.types import Event, EventKind, Instant
from ..friction import ExcessTable, KineticTable, StaticLaw, StaticLawKind
from ..friction.kinetic import default_excess
from ..simulation.simulator import Simulator
from ..solvers import Solver, exact

Contact = RigidContact | CompliantContact

RIGID = RigidContact()
COMPLIANT = CompliantContact(5e6, 15000.0)
CONTACTS: tuple[Contact, ...] = (RIGID, COMPLIANT)


def paper_axis(contact: Contact, *, branches: bool = True, tau: float = 0.2) -> Axis:
    """Return the axis of the paper; `branches` is its acceleration dependence, `tau` (s) its rest-time constant."""
    kinetic = KineticTable((0.0, 0.035), (0.12, 0.05))
    static = StaticLaw(StaticLawKind.EXPONENTIAL, 0.12, 0.24, tau)
    return Axis(350.0, 6e5, 4000.0, 350 * 9.80665, contact,
                Friction(static, kinetic, default_excess(kinetic) if branches else None))


def with_static(axis: Axis, static: StaticLaw) -> Axis:
    """Return the axis with another static law."""
    return replace(axis, friction=replace(axis.friction, static=static))


def instant(seconds: float) -> Instant:
    """Return a time in two parts."""
    whole = math.floor(seconds)
    return Instant(float(whole), seconds - whole)


def make(axis: Axis, drive: float | InputProfile, force: float | InputProfile = 0.0,
         initial: InitialState | None = None,
         solver: Solver = exact.SOLVER) -> Simulator:
    """Return a simulator at time 0; a number is a constant input profile."""
    return Simulator(axis, initial or InitialState(), drive if isinstance(drive, InputProfile) else constant(drive),
                     force if isinstance(force, InputProfile) else constant(force), solver)


def run_events(axis: Axis, drive: float | InputProfile, duration: float, force: float | InputProfile = 0.0,
               initial: InitialState | None = None, solver: Solver = exact.SOLVER) -> list[Event]:
    """Return all events of a run from the start."""
    return make(axis, drive, force, initial, solver).advance(instant(duration))


def of_kind(events: list[Event], kind: EventKind) -> list[Event]:
    """Return the events of a kind."""
    return [event for event in events if event.kind == kind]


def elapsed(begin: Event, end: Event) -> float:
    """Return the seconds between two events, without losing digits late in a run."""
    return (end.second - begin.second) + (end.fraction - begin.fraction)


def random_axis(rng: random.Random) -> Axis:
    """Return a valid axis: stiff or soft, damped or not, either contact, either law, one to five breakpoints."""
    n = rng.randint(2, 5)
    speeds = (0.0, *sorted(rng.uniform(0.001, 0.06) for _ in range(n - 1)))
    at_rest = rng.uniform(0.05, 0.2)
    kinetic = KineticTable(speeds, (at_rest, *sorted((rng.uniform(0.02, at_rest) for _ in range(n - 1)), reverse=True)))
    initial = at_rest + rng.choice((0.0, 0.02))
    static = StaticLaw(StaticLawKind.EXPONENTIAL, initial, initial + rng.uniform(0.01, 0.2), 10 ** rng.uniform(-2, 0.5))
    mass, omega = 10 ** rng.uniform(0, 3), 10 ** rng.uniform(1, 2.3)
    stiffness = mass * omega * omega
    damping = rng.choice((0.0, rng.uniform(0.02, 0.6), 1.5)) * 2.0 * mass * omega
    contact = rng.choice((RIGID, CompliantContact(stiffness * rng.uniform(2, 50), rng.choice((0.0, 1.0, 5.0)) *
                                                  mass * omega)))
    excess: ExcessTable | None = rng.choice((None, default_excess(kinetic)))
    return Axis(mass, stiffness, damping, mass * 9.80665, contact, Friction(static, kinetic, excess))


def random_profiles(rng: random.Random) -> tuple[InputProfile, InputProfile]:
    """Return a drive (m/s) and a force (N): constant, ramp, steps or a periodic table; with a pulse or without."""
    speed = rng.choice((-1, 1)) * 10 ** rng.uniform(-3, -1.3)
    drive = rng.choice((constant(speed), ramp(0.0, speed, 2.0), steps('drive', [0.0, 1.0, 2.0], [speed, -speed, 0.0]),
                        table('drive', [0.0, 0.5, 1.5], [0.0, speed, -speed], 2.0)))
    force = rng.choice((constant(0.0), constant(rng.uniform(-100, 100)),
                        steps('force', [0.0, 0.7, 0.9], [0.0, rng.uniform(-3e3, 3e3), 0.0])))
    return drive, force


def scaled_profile(profile: InputProfile, factor: float) -> InputProfile:
    """Return the input profile with all its values multiplied."""
    return InputProfile(profile.starts, tuple(factor * x for x in profile.values),
                        tuple(factor * x for x in profile.rates),
                  profile.period, tuple(one._replace(amplitude=factor * one.amplitude) for one in profile.sinusoids))
