# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""A contact that yields is the limit of two contacts without such a rule; and it yields under a constant N, too.

The two are integrated here by Runge and Kutta's method: an interface that slides at any force beyond the limit, with a
viscosity η, and one with a mass, a pad, under Coulomb friction.
"""

import math
from collections.abc import Callable
from dataclasses import replace
from itertools import pairwise
from typing import NamedTuple

import pytest

from stickslip_sim.axis import Axis, CompliantContact, Friction, InitialState
from stickslip_sim.core.input_profile import constant, ramp
from stickslip_sim.core.types import EventKind
from stickslip_sim.friction import KineticTable, StaticLaw, StaticLawKind
from stickslip_sim.reference import simulate as simulate_reference
from stickslip_sim.simulation.simulator import Simulator
from tests.support.axes import COMPLIANT, instant, make, paper_axis

MU, LOAD_RATE, FALLS = 0.12, -2e5, 0.002   # N mu_s = N mu_k(0) = N MU; N/s; s
DAMPED = CompliantContact(5e6, 15000.0)
UNDAMPED = CompliantContact(5e6, 0.0)


def axis_with(contact: CompliantContact) -> Axis:
    one_value = Friction(StaticLaw(StaticLawKind.CONSTANT, MU, MU), KineticTable((0.0, 0.035), (MU, 0.05)), None)
    return replace(paper_axis(contact), friction=one_value)


def start_of(contact: CompliantContact) -> InitialState:
    """Return a start in mid-swing: the contact carries 400 N of 412 N, and the slider moves back at 2 mm/s."""
    return InitialState(velocity=-0.002, stretch=400.0 / 6e5,
                        deflection=(400.0 + 0.002 * contact.damping) / contact.stiffness)


def velocity_by_the_rule(contact: CompliantContact, time: float) -> float:
    simulator = Simulator(axis_with(contact), start_of(contact), constant(0.0), constant(0.0),
                          load=ramp(0.0, LOAD_RATE, FALLS))
    kinds = [event.kind for event in simulator.advance(instant(time))]
    assert kinds == ([EventKind.YIELD, EventKind.STICK] if time > FALLS else [EventKind.YIELD])
    return simulator.sample().velocity


class Motion(NamedTuple):
    """The slider's velocity, the stretch of the spring, the deflection of the contact, the interface's velocity."""

    u: float
    w: float
    delta: float
    slides: float

    def after(self, h: float, rates: 'Motion') -> 'Motion':
        return Motion(*(one + h * rate for one, rate in zip(self, rates)))


Rates = Callable[[float, Motion], Motion]
Interface = Callable[[Axis, CompliantContact, float], Rates]


def limit_at(t: float, normal: float) -> float:
    return MU * (normal + LOAD_RATE * min(t, FALLS))


def viscous(axis: Axis, contact: CompliantContact, eta: float) -> Rates:
    """Return the rates where the interface carries L + η z′ as it slides."""
    def rates(t: float, now: Motion) -> Motion:
        carried = contact.stiffness * now.delta + contact.damping * now.u
        slides = max(carried - limit_at(t, axis.normal_force), 0.0) / (contact.damping + eta)
        return moving(axis, now, carried - contact.damping * slides, slides, 0.0)
    return rates


def pad(axis: Axis, contact: CompliantContact, mass: float) -> Rates:
    """Return the rates where the interface has a mass, and Coulomb friction N MU."""
    def rates(t: float, now: Motion) -> Motion:
        slides = max(now.slides, 0.0)
        carried = contact.stiffness * now.delta + contact.damping * (now.u - slides)
        beyond = carried - limit_at(t, axis.normal_force)
        return moving(axis, now, carried, slides, beyond / mass if slides > 0.0 or beyond > 0.0 else 0.0)
    return rates


def moving(axis: Axis, now: Motion, carried: float, slides: float, hastens: float) -> Motion:
    drive = axis.drive_stiffness * now.w - axis.drive_damping * now.u
    return Motion((drive - carried) / axis.mass, -now.u, now.u - slides, hastens)


def integrated(rates: Rates, start: InitialState, time: float, steps: int) -> float:
    """Return the slider's velocity; a pad that would turn round stands still."""
    now, h = Motion(start.velocity, start.stretch, start.deflection, 0.0), time / steps
    for k in range(steps):
        t = k * h
        a = rates(t, now)
        b = rates(t + 0.5 * h, now.after(0.5 * h, a))
        c = rates(t + 0.5 * h, now.after(0.5 * h, b))
        d = rates(t + h, now.after(h, c))
        now = now.after(h, Motion(*((p + 2.0 * q + 2.0 * r + s) / 6.0 for p, q, r, s in zip(a, b, c, d))))
        now = now._replace(slides=max(now.slides, 0.0))
    return now.u


@pytest.mark.parametrize('time', [0.0018, 0.008], ids=['as it yields', 'after it holds again'])
@pytest.mark.parametrize(('contact', 'interface', 'sizes', 'steps'), [
    (DAMPED, viscous, (3000.0, 300.0, 30.0), 4000), (UNDAMPED, viscous, (300.0, 30.0, 3.0), 8000),
    (DAMPED, pad, (0.5, 0.05, 0.005), 16000)], ids=['viscous', 'viscous, no damper', 'pad'])
def test_it_is_the_limit_of_an_interface(contact: CompliantContact, interface: Interface, sizes: tuple[float, ...],
                                         steps: int, time: float) -> None:
    """A tenth of the viscosity, or of the mass, is a tenth of the distance; stick alone is far off."""
    axis, start = axis_with(contact), start_of(contact)
    right = velocity_by_the_rule(contact, time)
    off = [abs(integrated(interface(axis, contact, size), start, time, steps) - right) for size in sizes]
    assert [b / a for a, b in pairwise(off)] == pytest.approx([0.1] * 2, rel=0.5)
    held = abs(integrated(viscous(axis, contact, math.inf), start, time, steps) - right)
    assert off[-1] < 0.02 * held


def test_under_a_constant_normal_force_a_start_in_mid_swing_can_yield() -> None:
    """The spring throws back a slider that moves back: c_c ẋ + h_c ẍ > 0, and F_c rises to the limit while ẋ < 0."""
    axis = paper_axis(COMPLIANT)
    start = InitialState(velocity=-0.02, stretch=0.01, deflection=2e-4)
    events = make(axis, 0.0, 0.0, start).advance(instant(0.02))
    first = events[0]
    assert (first.kind, first.direction) == (EventKind.YIELD, 1)
    assert -0.02 < first.velocity < 0.0
    assert first.friction_force == pytest.approx(axis.normal_force * 0.24, rel=1e-12)
    right = simulate_reference(axis, start, constant(0.0), constant(0.0), 0.02, digits=30).events
    assert [(event.kind, event.mode, event.direction) for event in events] == [
        (event.kind, event.mode, event.direction) for event in right]
    assert [event.time for event in events] == pytest.approx([event.time for event in right], abs=1e-14)
