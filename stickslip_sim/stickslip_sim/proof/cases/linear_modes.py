# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""X6 and X9: linear modes that grow, and those on the edge between two kinds of motion, at any step."""

import math
import random
from dataclasses import replace

from mpmath import mpf, workdps

from ...axis import Axis, CompliantContact, Friction, InitialState
from ...core.types import EventKind, Instant, Mode, Sample
from ...friction import KineticTable, StaticLaw, StaticLawKind
from ...solvers import Solver
from ..axes import FRICTIONLESS, RIGID, instant, make, paper_axis
from ..closed_form import CLOSED_FORM_DIGITS, LinearMode, exact
from ..judges import Measurement, Setup, Tally, require

_STEPS = (0.02, 0.01, 0.0048, 0.001, 1e-4, 1e-5)   # s


def unstable_slip(setup: Setup) -> Measurement:
    """X6: the slip modes with net damping −2867 and −14639 N s/m, read at steps of 10 µs to 20 ms."""
    tally = Tally(1e-12)
    for step in setup.choose(_STEPS, _STEPS[:-1]):
        tally.measure(_grows_on_the_falling_branch, setup.solver, step)
        tally.measure(_grows_after_a_break_away, setup.solver, step)
    return tally.finding('wrong', 'steps 10 µs to 20 ms')


def _grows_on_the_falling_branch(solver: Solver, step: float) -> float:
    """Start a little slower than the drive on the conventional branch; error of the swing relative to its size."""
    axis = replace(paper_axis(RIGID, branches=False), normal_force=350 * 9.81)
    slope = (0.05 - 0.12) / 0.035
    mode = LinearMode(axis.mass, mpf(axis.drive_damping) + mpf(axis.normal_force) * mpf(slope), axis.drive_stiffness)
    drive, start = 0.0175, 0.0165
    force = axis.normal_force * (0.12 + slope * drive)   # so that sliding with the drive is the unstable equilibrium
    simulator = make(axis, drive, force, InitialState(velocity=start), solver)
    with workdps(CLOSED_FORM_DIGITS):
        friction = mpf(axis.normal_force) * (mpf(0.12) + mpf(slope) * mpf(start))
        push = (mpf(axis.drive_damping) * (mpf(drive) - mpf(start)) + mpf(force) - friction) / axis.mass
        pull = mpf(axis.drive_stiffness) * (mpf(drive) - mpf(start)) / axis.mass
        worst = 0.0
        for k in range(1, round(0.5 / step) + 1):
            events = simulator.advance(instant(k * step))
            require(all(event.mode != Mode.STICK and event.kind != EventKind.KNOT for event in events), 'it stops')
            if k % max(1, round(0.02 / step)) == 0:
                t = exact(*simulator.time)
                swing = push * mode.integral(0, t) + pull * mode.integral(1, t)
                size = abs(mpf(start) - mpf(drive)) * mode.growth(t)
                worst = max(worst, abs(float((mpf(simulator.sample().velocity) - (mpf(start) + swing)) / size)))
    return worst


def _grows_after_a_break_away(solver: Solver, step: float) -> float:
    """From prolonged rest on the accelerating branch; relative error of the speed up to where it coasts."""
    axis = replace(paper_axis(RIGID), normal_force=350 * 9.81)
    slope = (0.05 - 0.24) / 0.035
    v, c, h = 0.002, axis.drive_stiffness, axis.drive_damping
    simulator = make(axis, v, solver=solver)
    mode = LinearMode(axis.mass, mpf(h) + mpf(axis.normal_force) * mpf(slope), c)
    with workdps(CLOSED_FORM_DIGITS):
        begin = (mpf(axis.normal_force) * mpf(0.24) / mpf(v) - mpf(h)) / mpf(c)
        worst, checked = 0.0, 0
        for k in range(1, round(0.76 / step) + 1):
            events = simulator.advance(instant(k * step))
            require(all(event.kind == EventKind.BREAKAWAY for event in events), 'it coasts too soon')
            t = exact(*simulator.time) - begin
            sample = simulator.sample()
            if t > mpf('0.01') and k % max(1, round(0.01 / step)) == 0:
                require(sample.mode == Mode.ACCELERATING, 'it does not accelerate')
                wanted = mpf(c) * mpf(v) / axis.mass * mode.integral(1, t)
                worst, checked = max(worst, abs(float(mpf(sample.velocity) / wanted - 1))), checked + 1
    require(checked, 'nothing was read')
    return worst


def edges_of_the_modes(setup: Setup) -> Measurement:
    """X9: critical to 1e-15, no spring, no damper, strongly over-damped, negative damping; slip and stick."""
    tally = Tally(1e-12)
    for seed in range(setup.choose(400, 12)):
        for kind in _DAMPING:
            tally.measure(_slides_freely, setup.solver, kind, seed)
            if not kind.startswith('negative'):
                tally.measure(_rings, setup.solver, kind, seed)
    return tally.finding()


_DAMPING = {
    'critical': 1.0, 'critical + 1e-15': 1.0 + 1e-15, 'critical - 1e-15': 1.0 - 1e-15, 'critical + 1e-12': 1.0 + 1e-12,
    'critical - 1e-8': 1.0 - 1e-8, 'critical + 1e-4': 1.0 + 1e-4, 'none': 0.0, 'slight': 1e-12, 'half': 0.5,
    'over': 30.0, 'strongly over': 1e4, 'no spring': math.nan, 'nothing at all': -math.inf,
    'negative, swinging': -0.3, 'negative, critical': -1.0, 'negative, over': -20.0,
}   # over the critical one


def _slides_freely(solver: Solver, kind: str, seed: int) -> float:
    """Error of position and speed of a slip, each relative to the largest term it is made of."""
    rng = random.Random(f'{kind} {seed}')
    mass, stiffness, damping = _spring_and_damper(rng, kind)
    normal, slope, friction = 0.0, 0.0, FRICTIONLESS
    if damping < 0.0:
        damping, normal, slope, friction = _falling_branch(rng, damping)
    axis = Axis(mass, stiffness, damping, normal, RIGID, friction)
    rate = (abs(damping + normal * slope) + math.sqrt(stiffness * mass)) / mass or 1.0
    start, drive = 1.0, 1.0 + rng.uniform(0.0, 0.2)
    simulator = make(axis, drive, normal * friction.kinetic.coefficients[0], InitialState(velocity=start), solver)
    worst = 0.0
    for _ in range(4):
        simulator.reset()
        to = Instant(0.0, min(10 ** rng.uniform(-3, 0.7) / rate, 0.999))
        if simulator.advance(to):
            continue
        worst = max(worst, _error(axis, slope, drive, simulator.sample()))
    return worst


def _falling_branch(rng: random.Random, wanted: float) -> tuple[float, float, float, Friction]:
    """Return damping, normal force, slope of mu_k and friction that make the damping of a slip `wanted`, below 0."""
    damping, normal, reach = rng.choice((0.0, 0.3 * abs(wanted))), 1e3 * abs(wanted), 16.0
    at_rest = -(wanted - damping) / normal * reach
    kinetic = KineticTable((0.0, reach), (at_rest, 0.0))
    friction = Friction(StaticLaw(StaticLawKind.CONSTANT, at_rest, at_rest), kinetic, None)
    return damping, normal, (0.0 - at_rest) / reach, friction


def _error(axis: Axis, slope: float, drive: float, sample: Sample) -> float:
    """Return the larger error of position and speed of a slip that began at 1 m/s, at time 0 and position 0."""
    with workdps(CLOSED_FORM_DIGITS):
        mass, normal, damping = axis.mass, mpf(axis.normal_force), mpf(axis.drive_damping)
        mode = LinearMode(mass, damping + normal * mpf(slope), axis.drive_stiffness)
        at_rest = mpf(axis.friction.kinetic.coefficients[0])
        held = normal * (at_rest + mpf(slope))
        push = (damping * (mpf(drive) - 1) + normal * at_rest - held) / mass
        pull = mpf(axis.drive_stiffness) * (mpf(drive) - 1) / mass
        t = mpf(sample.fraction)
        terms = [[t, push * mode.integral(1, t), pull * mode.integral(2, t)],
                 [mpf(1), push * mode.integral(0, t), pull * mode.integral(1, t)]]
        return max(abs(float((mpf(got) - sum(parts)) / max(map(abs, parts))))
                   for got, parts in zip((sample.position, sample.velocity), terms))


def _spring_and_damper(rng: random.Random, kind: str) -> tuple[float, float, float]:
    """Return mass, stiffness and damping, with the critical one 2 √(c m)."""
    mass, omega = 10 ** rng.uniform(-3, 6), 10 ** rng.uniform(0, 5)
    stiffness, ratio = mass * omega * omega, _DAMPING[kind]
    if math.isnan(ratio):
        return mass, 0.0, 2.0 * mass * omega
    if math.isinf(ratio):
        return mass, 0.0, 0.0
    root = math.ldexp(1.0, rng.randint(-10, 10))   # √(c m) without rounding, so that critical is critical
    if abs(abs(ratio) - 1.0) < 1e-10:
        mass, stiffness, omega = root * 4.0, root * 9.0, 1.5
        return mass, stiffness, 2.0 * 6.0 * root * ratio
    return mass, stiffness, 2.0 * mass * omega * ratio


def _rings(solver: Solver, kind: str, seed: int) -> float:
    """Error of a compliant stick under a constant force, relative to its deflection and its largest speed."""
    rng = random.Random(f'rings {kind} {seed}')
    mass, stiffness, damping = _spring_and_damper(rng, kind)
    if stiffness == 0.0:
        stiffness = mass
    contact = CompliantContact(stiffness, damping)
    hold = Friction(StaticLaw(StaticLawKind.CONSTANT, 1e9, 1e9), KineticTable((0.0,), (0.0,)), None)
    axis = Axis(mass, 0.0, 0.0, 1e9 * stiffness, contact, hold)
    rate = damping / mass + math.sqrt(stiffness / mass)
    simulator = make(axis, 0.0, stiffness, solver=solver)
    worst = 0.0
    for _ in range(4):
        simulator.reset()
        to = instant(10 ** rng.uniform(-2, 1) / rate)
        require(simulator.advance(to) == [], 'it does not hold')
        sample = simulator.sample()
        with workdps(CLOSED_FORM_DIGITS):
            mode, t = LinearMode(mass, damping, stiffness), exact(*to)
            x, u = (mpf(stiffness) / mass * mode.integral(order, t) for order in (1, 0))
            worst = max(worst, abs(float((mpf(sample.position) - x) / x)),
                        abs(float((mpf(sample.velocity) - u) / max(abs(u), x * mpf(rate)))))
    return worst
