"""Axes that several tests use: the paper's, and random ones."""

import math
import random

from stickslip_sim.axis import Axis, CompliantContact, Friction, InitialState, RigidContact
from stickslip_sim.courses import Course, constant
from stickslip_sim.friction import ExcessTable, KineticTable, StaticLaw, StaticLawKind
from stickslip_sim.friction.kinetic import default_excess
from stickslip_sim.simulator import Simulator
from stickslip_sim.words import Event, EventKind, Instant

RIGID = RigidContact()
COMPLIANT = CompliantContact(5e6, 15000.0)


def paper_axis(contact: RigidContact | CompliantContact, *, branches: bool = True, tau: float = 0.2) -> Axis:
    kinetic = KineticTable((0.0, 0.035), (0.12, 0.05))
    static = StaticLaw(StaticLawKind.EXPONENTIAL, 0.12, 0.24, tau)
    return Axis(350.0, 6e5, 4000.0, 350 * 9.80665, contact,
                Friction(static, kinetic, default_excess(kinetic) if branches else None))


def run(axis: Axis, drive: float | Course, duration: float, force: float | Course = 0.0,
        initial: InitialState | None = None) -> list[Event]:
    """Return all events of a run from the start."""
    simulator = make(axis, drive, force, initial)
    return simulator.advance(instant(duration))


def make(axis: Axis, drive: float | Course, force: float | Course = 0.0,
         initial: InitialState | None = None) -> Simulator:
    return Simulator(axis, initial or InitialState(), drive if isinstance(drive, Course) else constant(drive),
                     force if isinstance(force, Course) else constant(force))


def instant(seconds: float) -> Instant:
    return Instant(math.floor(seconds), seconds - math.floor(seconds))


def of_kind(events: list[Event], kind: EventKind) -> list[Event]:
    return [event for event in events if event.kind == kind]


def random_axis(rng: random.Random) -> Axis:
    """Return a valid axis: stiff or soft, damped or not, either contact, either characteristics, one to five knots."""
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
