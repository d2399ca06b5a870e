# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Axes, input profiles and runs that the cases share."""

import math
import random
from dataclasses import replace
from typing import NamedTuple

from ..axis import Axis, CompliantContact, Friction, InitialState, RigidContact
from ..core.errors import InputError
from ..core.input_profile import InputProfile, Sinusoid, constant, ramp, steps, table
from ..core.types import Event, EventKind, Instant
from ..friction import ExcessTable, KineticTable, StaticLaw, StaticLawKind
from ..friction.kinetic import default_excess
from ..simulation.simulator import Simulator
from ..solvers import Solver, exact

Contact = RigidContact | CompliantContact

RIGID = RigidContact()
COMPLIANT = CompliantContact(5e6, 15000.0)
CONTACTS: tuple[Contact, ...] = (RIGID, COMPLIANT)
FRICTIONLESS = Friction(StaticLaw(StaticLawKind.CONSTANT, 0.0, 0.0), KineticTable((0.0,), (0.0,)), None)
GRAZING_FREQUENCIES = 0.02, 0.2          # Hz: slow enough for the ring-down of a start to vanish before the first peak
PHASES = -0.45 * math.pi, 0.45 * math.pi   # rad: the first extreme is the peak


class Parts(NamedTuple):
    """All that a run is made of; the duration in s.  A load (N) is on top of the normal force of the axis."""

    axis: Axis
    initial: InitialState
    drive: InputProfile
    force: InputProfile
    duration: float
    load: InputProfile | None = None

    @property
    def inputs(self) -> tuple[InputProfile, ...]:
        """All input profiles."""
        return (self.drive, self.force) if self.load is None else (self.drive, self.force, self.load)

    def axis_under(self, load: float) -> Axis:
        """Return the axis with the normal force that it has under a load."""
        return self.axis if self.load is None else replace(self.axis, normal_force=load + self.axis.normal_force)

    @property
    def heaviest(self) -> Axis:
        """The axis with the largest normal force that it has at any time."""
        return self.axis_under(self.load.bounds()[1]) if self.load else self.axis

    def simulator(self, solver: Solver = exact.SOLVER, *, accounting: bool = False) -> Simulator:
        """Return the simulator at time 0."""
        return Simulator(self.axis, self.initial, self.drive, self.force, solver, accounting=accounting,
                         load=self.load)

    def events(self, solver: Solver = exact.SOLVER) -> list[Event]:
        """Run to the end in one call; raises SolverError."""
        return self.simulator(solver).advance(instant(self.duration))


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
         initial: InitialState | None = None, solver: Solver = exact.SOLVER) -> Simulator:
    """Return a simulator at time 0."""
    return Simulator(axis, initial or InitialState(), input_of(drive), input_of(force), solver)


def input_of(given: float | InputProfile) -> InputProfile:
    """Return an input profile; a number is a constant one."""
    return given if isinstance(given, InputProfile) else constant(given)


def run_events(axis: Axis, drive: float | InputProfile, duration: float, force: float | InputProfile = 0.0,
               initial: InitialState | None = None, solver: Solver = exact.SOLVER) -> list[Event]:
    """Return all events of a run from the start."""
    return make(axis, drive, force, initial, solver).advance(instant(duration))


def of_kind(events: list[Event], kind: EventKind) -> list[Event]:
    """Return the events of a kind."""
    return [event for event in events if event.kind == kind]


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


def random_parts(rng: random.Random, duration: float) -> Parts:
    """Return a run of `duration` s from prolonged rest, of a random axis under random profiles."""
    return Parts(random_axis(rng), InitialState(), *random_profiles(rng), duration)


def grazing_drive(axis: Axis, overshoot: float, frequency: float, phase: float) -> InputProfile:
    """Return a drive profile (m/s) whose contact force peaks at N mu_inf (1 + overshoot), from prolonged rest.

    The hardest break-away to see, and not to invent: a slow sine that grazes the static limit.  The drive swings by
    A/w (cos θ − cos(wt + θ)); the force that reaches the contact of the stuck slider peaks at mean + amplitude of its
    steady answer, both proportional to A, so that A follows from the overshoot in closed form.
    The peak comes at (π − phase)/(2π frequency), or a little later through the damper; it is the only way to the limit.
    Raises InputError without a drive spring or a finite limit, or for a phase (rad) whose first extreme is no peak.
    """
    if not PHASES[0] <= phase <= PHASES[1]:
        raise InputError('phase', phase, f'from {PHASES[0]!r} to {PHASES[1]!r} rad', 'take a phase around 0')
    if not axis.drive_stiffness > 0.0 or not axis.friction.static.bounded:
        raise InputError('axis', axis, 'with a drive spring and a bounded static law', 'take another axis')
    limit = axis.normal_force * axis.friction.static.coefficient(math.inf)
    peak = _force_peak(axis, 2.0 * math.pi * frequency, phase)
    return replace(constant(0.0), sinusoids=(Sinusoid(limit * (1.0 + overshoot) / peak, frequency, phase),))


def _force_peak(axis: Axis, w: float, phase: float) -> float:
    """Return the peak of the force in the contact for a drive velocity of 1 m/s sin(w t + phase), N."""
    pull = complex(axis.drive_stiffness, w * axis.drive_damping)
    if not isinstance(axis.contact, CompliantContact):
        return (axis.drive_stiffness * math.cos(phase) + abs(pull)) / w
    contact = complex(axis.contact.stiffness, w * axis.contact.damping)
    share = axis.contact.stiffness / (axis.drive_stiffness + axis.contact.stiffness)
    swing = abs(pull * contact / (pull + contact - axis.mass * w * w))
    return (axis.drive_stiffness * math.cos(phase) * share + swing) / w
