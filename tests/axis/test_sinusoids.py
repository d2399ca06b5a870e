# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Sines on top of v and F_e, A sin(2π (f t + phase)) of the absolute time: inputs, forces and motion under them."""

import math
from typing import Any

import pytest

from stickslip_sim.axis import motion, sinusoids
from stickslip_sim.axis.codes import COASTING, DECELERATING, STICK
from stickslip_sim.axis.forces import force_rate
from stickslip_sim.axis.rows import Sinusoids
from stickslip_sim.axis.state_record import State
from stickslip_sim.linear.oscillator import integrals
from tests.support.plain_axes import COMPLIANT, parameters
from tests.support.slider_balance import Balance, sine_of

Given = tuple[float, float, float, float]     # Hz, turns, m/s, N
BOTH: Given = (2.0, 0.1, 0.25, 6.0)
TURN = 2.0 * math.pi


def waved(*given: Given, v: float = 0.0, v_rate: float = 0.0, f: float = 0.0, f_rate: float = 0.0, **numbers: float
          ) -> State:
    """Return a state under sinusoids, which they were just given to."""
    s = State(len(given))
    s.cache.at.time = -1.0
    s.inputs.v, s.inputs.v_rate, s.inputs.f, s.inputs.f_rate = v, v_rate, f, f_rate
    for name, number in numbers.items():
        setattr(s, name, number)
    sinusoids.load_sinusoids(s, Sinusoids([number for one in given for number in (*one, 0.0)]))
    return s


def test_sines_come_on_top_of_the_inputs() -> None:
    s = waved(BOTH, (3.0, 0.25, 0.5, -2.0), second=7.0, fraction=0.125, v=1.0, f=2.0)
    first, other = sine_of(2.0 * 7.125 + 0.1), sine_of(3.0 * 7.125 + 0.25)
    assert (s.inputs.v, s.inputs.f) == pytest.approx(
        (1.0 + 0.25 * first + 0.5 * other, 2.0 + 6.0 * first - 2.0 * other), rel=1e-13)
    assert (s.inputs.base_v, s.inputs.base_f, s.sinusoid_count) == (1.0, 2.0, 2.0)


def test_the_inputs_go_on_with_the_time() -> None:
    s = waved(BOTH, second=2.0, v=1.0, v_rate=0.5, f=2.0, f_rate=-4.0)
    t = 0.375
    sine = sine_of(2.0 * t + 0.1)       # four turns are over at 2 s
    expected = (1.0 + 0.5 * t + 0.25 * sine, 2.0 - 4.0 * t + 6.0 * sine)
    assert sinusoids.inputs_at(s, 2.0, t, t) == pytest.approx(expected, rel=1e-14)
    s.fraction = t
    sinusoids.move_sinusoids(s, t)
    assert (s.inputs.v, s.inputs.f) == pytest.approx(expected, rel=1e-14)


def test_the_same_sinusoids_are_known_again() -> None:
    s = waved(BOTH, v=1.0, f=2.0)
    assert sinusoids.same_sinusoids(s, 1.0, 2.0, Sinusoids([*BOTH, 0.0]))
    for k in range(5):
        other = [number + (k == i) for i, number in enumerate((*BOTH, 0.0))]
        assert not sinusoids.same_sinusoids(s, 1.0, 2.0, Sinusoids(other))
    assert not sinusoids.same_sinusoids(s, 1.5, 2.0, Sinusoids([*BOTH, 0.0]))
    assert not sinusoids.same_sinusoids(s, 1.0, 2.5, Sinusoids([*BOTH, 0.0]))
    assert not sinusoids.same_sinusoids(s, 1.0, 2.0, Sinusoids([]))


@pytest.mark.parametrize('t', [1e-9, 0.01, 0.5, 12.3])
def test_the_drive_travels_by_the_integral_of_its_sine(t: float) -> None:
    """A/w (cos φ − cos(φ + w t))."""
    s = waved((2.0, 0.1, 0.25, 0.0), v=0.5, v_rate=0.25)
    w = TURN * 2.0
    waves = 0.25 / w * 2.0 * math.sin(w * t / 2.0) * math.sin(TURN * 0.1 + w * t / 2.0)
    assert sinusoids.sinusoid_drive_travel(s, t) == pytest.approx(waves, rel=1e-10)
    assert motion.drive_travel(s, t) == pytest.approx(0.5 * t + 0.125 * t * t + waves, rel=1e-12)


@pytest.mark.parametrize('on_slideway', [False, True])
def test_under_a_still_slider_the_force_changes_with_the_stretch_and_with_the_damper(on_slideway: bool) -> None:
    """c ∫ v dt + h v + F_e, since the segment start."""
    p, t, w, phase = parameters(damper_on_slideway=on_slideway), 0.07, TURN * 2.0, TURN * 0.1
    s = waved(BOTH, mode=STICK)
    damped = (0.0 if on_slideway else 32.0 * 0.25) + 6.0
    force, rate, size = sinusoids.sinusoid_force(p, s, 0.0, t)
    assert force == pytest.approx(1024.0 * 0.25 / w * (math.cos(phase) - math.cos(phase + w * t))
                                  + damped * (math.sin(phase + w * t) - math.sin(phase)), rel=1e-12)
    assert rate == pytest.approx(1024.0 * 0.25 * math.sin(phase + w * t) + damped * w * math.cos(phase + w * t),
                                 rel=1e-12)
    assert size >= abs(force)


@pytest.mark.parametrize('on_slideway', [False, True])
def test_the_rate_of_the_force_under_sines(on_slideway: bool) -> None:
    """(F_d + F_e)′ = c (v − ẋ) + h v′ + F_e′ at constant velocity, and its rate c v′ + h v″ + F_e″."""
    p, w, phase = parameters(damper_on_slideway=on_slideway), TURN * 2.0, TURN * 0.1
    s = waved(BOTH, mode=COASTING, v=0.5, v_rate=2.0, f_rate=-3.0, velocity=0.125)
    h = 0.0 if on_slideway else 32.0
    sine, cosine = math.sin(phase), math.cos(phase)
    rate = 1024.0 * (0.5 + 0.25 * sine - 0.125) + h * (2.0 + 0.25 * w * cosine) - 3.0 + 6.0 * w * cosine
    second = 1024.0 * (2.0 + 0.25 * w * cosine) - w * w * (h * 0.25 + 6.0) * sine
    assert force_rate(p, s) == pytest.approx((rate, second), rel=1e-12)


@pytest.mark.parametrize(('phase', 'f_rate', 'expected'), [
    (0.25, 0.0, (0.0, -6.0 * (TURN * 2.0) ** 2)),                         # at its peak it falls from now on
    (0.75, 0.0, (0.0, 6.0 * (TURN * 2.0) ** 2)),
    (0.0, -6.0 * TURN * 2.0 * (1.0 + 2.0 ** -52), (0.0, -6.0 * (TURN * 2.0) ** 3))])    # the ramp takes one away
def test_a_tie_is_decided_by_the_first_rate_that_is_left(phase: float, f_rate: float, expected: tuple[float, float]
                                                         ) -> None:
    s = waved((2.0, phase, 0.0, 6.0), mode=COASTING, f_rate=f_rate)
    assert sinusoids.forced_rate(parameters(), s) == pytest.approx(expected, rel=1e-12)


def test_the_last_rate_that_is_looked_at_is_the_fourth() -> None:
    """Two peaks at once whose second rates make up for each other; where all four do, there is none."""
    w = TURN * 2.0
    s = waved((2.0, 0.25, 0.0, 4.0), (4.0, 0.25, 0.0, -1.0), mode=COASTING)
    assert sinusoids.forced_rate(parameters(), s) == pytest.approx((0.0, 4.0 * w ** 4 - 16.0 * w ** 4), rel=1e-12)
    s = waved((2.0, 0.25, 0.0, 4.0), (2.0, 0.75, 0.0, 4.0), mode=COASTING, v=0.25, f_rate=-256.0 * (1.0 + 2.0 ** -50))
    assert sinusoids.forced_rate(parameters(), s) == (0.0, 0.0)


def response(t: float, *given: Given) -> sinusoids.SinusoidTravel:
    """Return what sinusoids add to a slip within t."""
    p, s = parameters(drive_damping=96.0), waved(*given, mode=DECELERATING, direction=1.0)
    motion.begin_motion(p, s)
    g, rate, first, _, _ = integrals(motion.oscillator_of(s), t)
    return sinusoids.sinusoid_travel(p, s, motion.oscillator_of(s), t, g, rate, first)


def test_velocity_acceleration_and_jerk_are_rates_of_each_other() -> None:
    """By central differences, which are off by the square of the step."""
    t, step = 0.05, 1e-5
    at, after, before = (response(t + off, BOTH) for off in (0.0, step, -step))
    for value, later, earlier in ((at.u, after.y, before.y), (at.a, after.u, before.u), (at.jerk, after.a, before.a)):
        assert value == pytest.approx((later - earlier) / (2.0 * step), rel=1e-6)


def test_the_sizes_of_the_sums_bound_them_at_any_phase() -> None:
    """Bounds of rounding: at least the amplitude and at most twice that, and no sinusoid takes from another."""
    t, other = 0.05, (3.0, 0.6, -0.25, 2.0)
    found = [response(t, (BOTH[0], k / 64.0, *BOTH[2:])) for k in range(64)]
    forces = [sinusoids.sinusoid_force(parameters(), waved((BOTH[0], k / 64.0, *BOTH[2:])), 0.0, t)
              for k in range(64)]
    for values, sizes in (([one.y for one in found], [one.size_y for one in found]),
                          ([one.u for one in found], [one.size_u for one in found]),
                          ([one.a for one in found], [one.size_a for one in found]),
                          ([force for force, _, _ in forces], [size for _, _, size in forces])):
        amplitude = max(map(abs, values))     # within 0.2 %: a phase every 1/64 turn
        assert 0.99 * amplitude <= min(sizes)
        assert max(sizes) <= 2.01 * amplitude
    one, two, both = response(t, BOTH), response(t, other), response(t, BOTH, other)
    assert both == pytest.approx([a + b for a, b in zip(one, two)], rel=1e-12)


@pytest.mark.parametrize('given', [BOTH, (2.0, 0.6, 0.0, 6.0), (math.sqrt(512.0) / TURN, 0.0, 0.25, 0.0)],
                         ids=['both', 'force', 'resonance'])
@pytest.mark.parametrize('axis', [{}, {'drive_damping': 0.0}, {'damper_on_slideway': True}], ids=str)
@pytest.mark.parametrize('sticks', [False, True], ids=['slip', 'stick'])
def test_the_motion_under_a_sine_follows_its_balance_of_forces(sticks: bool, axis: dict[str, Any], given: Given
                                                               ) -> None:
    """Of a slip and of a compliant stick, at resonance too, before and after a radian."""
    p = parameters(contact=COMPLIANT, **axis)
    numbers = {'velocity': 0.0625, 'v': 0.125, 'f_rate': 8.0, 'v_rate': 0.25 if sticks else 0.0}
    mode: dict[str, float] = ({'contact_stiffness': 4096.0, 'contact_damping': 64.0} if sticks
                              else {'friction': 16.0, 'viscous': -32.0})
    truth = Balance(damping=axis.get('drive_damping', 32.0), is_on_slideway=axis.get('damper_on_slideway', False),
                    stretch=0.03125, frequency=given[0], phase=given[1], v_amplitude=given[2], f_amplitude=given[3],
                    **mode, **numbers)
    for t in (0.001, 0.04, 0.6):
        s = waved(given, mode=STICK if sticks else DECELERATING, direction=0.0 if sticks else 1.0, spring=0.03125,
                  **numbers)
        s.acceleration = truth.after(0.0).acceleration
        motion.begin_motion(p, s)
        expected = truth.after(t)
        assert motion.travel(p, s, t) == pytest.approx(expected.of_slider, rel=1e-11, abs=1e-12)
        motion.move_start(p, s, 0.0, t, t)
        assert (s.position, s.velocity, s.spring, s.inputs.v, s.inputs.f) == pytest.approx(
            (expected.travel, expected.velocity, expected.stretch, expected.v, expected.f), rel=1e-11, abs=1e-13)


def test_the_fastest_of_all() -> None:
    three = waved((2.0, 0.0, 1.0, 0.0), (5.0, 0.0, 1.0, 0.0), (3.0, 0.0, 1.0, 0.0))
    assert sinusoids.fastest_sinusoid(three) == TURN * 5.0
    assert sinusoids.fastest_sinusoid(waved()) == 0.0
