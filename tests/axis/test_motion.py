# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The motion of each mode, against the power series of its balance of forces and against forms written by hand."""

import math
from dataclasses import dataclass
from decimal import Decimal, localcontext
from typing import Any

import pytest

from stickslip_sim.axis import motion, sinusoids
from stickslip_sim.axis.codes import ACCELERATING, COASTING, DECELERATING, STICK
from stickslip_sim.axis.forces import force_rate
from stickslip_sim.axis.layout import Parameters
from stickslip_sim.axis.rows import Sinusoids
from stickslip_sim.axis.state_record import State
from stickslip_sim.linear.oscillator import integrals, short_integrals
from tests.support.plain_axes import COMPLIANT, CONVENTIONAL, parameters, slip, state

EXCESS = 0.25
# F at standstill and its slope on the first segment of the tables, N and N s/m: 16 N falling to 8 N at 0.25 m/s, and
# the excess on top, 16 N falling to 0 at 0.5 m/s
FRICTION = {DECELERATING: (16.0, -32.0), ACCELERATING: (32.0, -64.0)}
INPUTS = [{'v': 0.125}, {'v': 0.125, 'f_rate': 8.0}, {'v': 0.125, 'v_rate': 0.5, 'f_rate': -8.0},
          {'v': -0.0625, 'f': 3.0}]
AXES: list[dict[str, Any]] = [
    {}, {'drive_damping': 0.0}, {'drive_stiffness': 0.0}, {'drive_stiffness': 0.0, 'drive_damping': 0.0},
    {'damper_on_slideway': True}, {'drive_damping': 512.0}]


X, U, S, V, F, DEFLECTION, SINE, COSINE, ONE = range(9)
_DIGITS = 80      # the terms rise to e^60 of the sum
_SMALL = Decimal('1e-40')


@dataclass(frozen=True)
class Balance:
    """A mode of an axis, with its inputs v + v_rate t and f + f_rate t; a sinusoid of `frequency` Hz on top of both.

    The slider begins at x = 0 with `velocity`, and the drive's end of the spring at `stretch`.  `friction` is F at
    standstill, N with its sign, and `viscous` its slope in N s/m; with a `contact_stiffness` the slider sticks.
    """

    mass: float = 2.0
    stiffness: float = 1024.0
    damping: float = 32.0
    is_on_slideway: bool = False
    friction: float = 0.0
    viscous: float = 0.0
    contact_stiffness: float = 0.0
    contact_damping: float = 0.0
    velocity: float = 0.0
    stretch: float = 0.0
    deflection: float = 0.0
    v: float = 0.0
    v_rate: float = 0.0
    f: float = 0.0
    f_rate: float = 0.0
    frequency: float = 0.0
    phase: float = 0.0      # turns
    v_amplitude: float = 0.0
    f_amplitude: float = 0.0

    def after(self, t: float) -> 'Motion':
        """Return the motion at a time in s."""
        rates = self._rates()
        begin = [0.0, self.velocity, self.stretch, self.v, self.f, self.deflection, sine_of(self.phase),
                 sine_of(self.phase + 0.25), 1.0]
        end = _exponential(rates, begin, t)
        change = sum(rate * number for rate, number in zip(rates[U].values(), map(end.__getitem__, rates[U])))
        return Motion(travel=float(end[X]), velocity=float(end[U]), acceleration=float(change),
                      drive_travel=float(end[S] - Decimal(self.stretch)), stretch=float(end[S] - end[X]),
                      deflection=float(end[DEFLECTION]), v=float(end[V] + Decimal(self.v_amplitude) * end[SINE]),
                      f=float(end[F] + Decimal(self.f_amplitude) * end[SINE]))

    def _rates(self) -> dict[int, dict[int, Decimal]]:
        """Return the rows of the matrix A of z′ = A z."""
        w = 2.0 * math.pi * self.frequency
        feed = 0.0 if self.is_on_slideway else self.damping
        forces = {X: -self.stiffness, S: self.stiffness, V: feed, F: 1.0, ONE: -self.friction,
                  U: -self.damping - self.viscous - self.contact_damping, DEFLECTION: -self.contact_stiffness,
                  SINE: feed * self.v_amplitude + self.f_amplitude}
        rows = {X: {U: 1.0}, DEFLECTION: {U: 1.0}, S: {V: 1.0, SINE: self.v_amplitude}, V: {ONE: self.v_rate},
                F: {ONE: self.f_rate}, SINE: {COSINE: w}, COSINE: {SINE: -w},
                U: {column: force / self.mass for column, force in forces.items()}, ONE: {}}
        return {row: {column: Decimal(rate) for column, rate in rates.items() if rate != 0.0}
                for row, rates in rows.items()}


def _exponential(rates: dict[int, dict[int, Decimal]], begin: list[float], t: float) -> list[Decimal]:
    with localcontext() as context:
        context.prec = _DIGITS
        term = [Decimal(number) for number in begin]
        total, k = term, 0
        while k < 3 or max(map(abs, term)) > _SMALL:
            k += 1
            step = Decimal(t) / k
            term = [step * sum((rate * term[column] for column, rate in rates[row].items()), Decimal(0))
                    for row in range(len(begin))]
            total = [one + more for one, more in zip(total, term)]
        return total


@dataclass(frozen=True)
class Motion:
    """Where a motion has come to: m, m/s, m/s²; the inputs at that time."""

    travel: float
    velocity: float
    acceleration: float
    drive_travel: float
    stretch: float
    deflection: float
    v: float
    f: float

    @property
    def of_slider(self) -> tuple[float, float, float]:
        """Travel, velocity and acceleration."""
        return self.travel, self.velocity, self.acceleration


def sine_of(turns: float) -> float:
    """Return the sine of a phase in turns."""
    return math.sin(2.0 * math.pi * turns)


def balance(axis: dict[str, Any], **numbers: float) -> Balance:
    return Balance(stiffness=axis.get('drive_stiffness', 1024.0), damping=axis.get('drive_damping', 32.0),
                   is_on_slideway=axis.get('damper_on_slideway', False), **numbers)


def begun(p: Parameters, s: State, start: Motion) -> State:
    """Return the state with the acceleration of its balance and its closed form."""
    s.acceleration = start.acceleration
    motion.begin_motion(p, s)
    return s


@pytest.mark.parametrize('direction', [1.0, -1.0])
@pytest.mark.parametrize('mode', [DECELERATING, ACCELERATING])
@pytest.mark.parametrize('inputs', INPUTS, ids=str)
@pytest.mark.parametrize('axis', AXES, ids=str)
def test_a_slip_follows_its_balance_of_forces(axis: dict[str, Any], inputs: dict[str, float], mode: float,
                                              direction: float) -> None:
    """Before a radian is over and after it; all that the segment start has moves along."""
    p = parameters(**axis)
    at_rest, slope = FRICTION[mode]
    inputs = {name: direction * number for name, number in inputs.items()}
    numbers = {'velocity': direction * 0.0625, **inputs}
    truth = balance(axis, friction=direction * at_rest, viscous=slope, stretch=direction * 0.03125, **numbers)
    for t in (0.001, 0.03, 0.2):
        s = begun(p, state(mode=mode, direction=direction, excess=EXCESS, spring=direction * 0.03125, position=1.0,
                           drive=2.0, **numbers), truth.after(0.0))
        expected = truth.after(t)
        assert motion.travel(p, s, t) == pytest.approx(expected.of_slider, rel=1e-12, abs=1e-14)
        assert motion.drive_travel(s, t) == pytest.approx(expected.drive_travel, rel=1e-14)
        motion.move_start(p, s, 3.0, 0.25, t)
        assert (s.second, s.fraction, s.rest, s.mode) == (3.0, 0.25, 0.0, mode)
        assert (s.position, s.drive, s.velocity, s.acceleration, s.spring, s.inputs.v, s.inputs.f) == pytest.approx(
            (1.0 + expected.travel, 2.0 + expected.drive_travel, expected.velocity, expected.acceleration,
             expected.stretch, expected.v, expected.f), rel=1e-12, abs=1e-14)


@pytest.mark.parametrize('inputs', [*INPUTS, {'f': 5.0}], ids=str)
@pytest.mark.parametrize('axis', AXES, ids=str)
def test_a_compliant_stick_rings(axis: dict[str, Any], inputs: dict[str, float]) -> None:
    """At √((c + c_c)/m), damped by h + h_c; the rest time and the deflection go on."""
    p = parameters(contact=COMPLIANT, **axis)
    numbers = {'velocity': -0.0625, 'deflection': 0.00390625, **inputs}
    truth = balance(axis, stretch=0.015625, contact_stiffness=4096.0, contact_damping=64.0, **numbers)
    for t in (0.001, 0.03, 0.2):
        s = begun(p, state(mode=STICK, spring=0.015625, rest=0.5, **numbers), truth.after(0.0))
        expected = truth.after(t)
        motion.move_start(p, s, 0.0, t, t)
        assert (s.position, s.velocity, s.acceleration, s.spring, s.deflection) == pytest.approx(
            (expected.travel, expected.velocity, expected.acceleration, expected.stretch, expected.deflection),
            rel=1e-12, abs=1e-14)
        assert s.rest == 0.5 + t


def test_an_undamped_slip_is_a_cosine() -> None:
    """Constant friction, a drive that stands: x about (c w − F)/c, at √(c/m)."""
    p = parameters(drive_damping=0.0, friction=CONVENTIONAL, normal_force=0.0)
    s = state(mode=DECELERATING, direction=1.0, spring=0.125, velocity=0.25)
    s.acceleration = 1024.0 * 0.125 / 2.0
    motion.begin_motion(p, s)
    omega = math.sqrt(1024.0 / 2.0)
    for t in (0.01, 0.1, 1.0):
        y, u, a = motion.travel(p, s, t)
        sine, cosine = math.sin(omega * t), math.cos(omega * t)
        assert y == pytest.approx(0.125 * (1.0 - cosine) + 0.25 / omega * sine, rel=1e-12)
        assert u == pytest.approx(0.125 * omega * sine + 0.25 * cosine, abs=1e-13)
        assert a == pytest.approx(omega * (0.125 * omega * cosine - 0.25 * sine), abs=1e-12)


def test_a_slip_without_a_spring_and_a_damper_is_a_parabola() -> None:
    p = parameters(drive_stiffness=0.0, drive_damping=0.0, normal_force=0.0)
    s = state(mode=ACCELERATING, direction=1.0, velocity=0.25, acceleration=3.0)
    motion.begin_motion(p, s)
    assert motion.travel(p, s, 2.0) == (0.25 * 2.0 + 3.0 * 2.0, 0.25 + 3.0 * 2.0, 3.0)


def test_coasting_goes_on_and_rigid_stick_stands() -> None:
    """The spring is stretched by the drive less the slider; only stick has a rest time."""
    p = parameters()
    s = state(mode=COASTING, direction=-1.0, velocity=-0.25, v=0.5, v_rate=1.0, f=2.0, f_rate=3.0, spring=0.125)
    motion.begin_motion(p, s)
    assert motion.travel(p, s, 2.0) == (-0.5, -0.25, 0.0)
    motion.move_start(p, s, 2.0, 0.0, 2.0)
    assert (s.position, s.drive, s.spring, s.velocity, s.rest) == (-0.5, 3.0, 0.125 + 3.0 + 0.5, -0.25, 0.0)
    assert (s.inputs.v, s.inputs.f) == (2.5, 8.0)
    s = state(mode=STICK, v=0.5, spring=0.125, rest=1.0)
    motion.begin_motion(p, s)
    assert motion.travel(p, s, 2.0) == (0.0, 0.0, 0.0)
    motion.move_start(p, s, 2.0, 0.0, 2.0)
    assert (s.position, s.drive, s.spring, s.velocity, s.rest, s.deflection) == (0.0, 1.0, 1.125, 0.0, 3.0, 0.0)


def test_a_contact_that_is_held_for_a_year_stays_where_it_is() -> None:
    """It has come to (F_e − F_c)/(c + c_c), and stays there."""
    p = parameters(contact=COMPLIANT)
    s = state(mode=STICK, f=10.0, acceleration=5.0)
    motion.begin_motion(p, s)
    for t in (1e2, 3e7):
        assert motion.travel(p, s, t) == pytest.approx((10.0 / (1024.0 + 4096.0), 0.0, 0.0), rel=1e-14, abs=1e-30)


def test_a_spring_keeps_its_digits_through_a_long_slide() -> None:
    """A slider follows its drive for a million metres: c w = N mu_k, to the last digits."""
    p = parameters(friction=CONVENTIONAL)
    s = slip(p, DECELERATING, 4.5, v=4.5, f_rate=0.0)
    s.inputs.f = s.inputs.base_f = 0.0
    friction = 64.0 * (0.0625 + 0.5 * 4.0)
    s.spring = 0.125
    s.acceleration = (1024.0 * 0.125 - friction) / 2.0
    motion.begin_motion(p, s)
    motion.move_start(p, s, 2e5, 0.0, 2e5)
    assert (s.velocity, s.spring) == pytest.approx((4.5, friction / 1024.0), rel=1e-13)
    p = parameters(damper_on_slideway=True)
    s = state(mode=COASTING, direction=1.0, velocity=4.5, v=4.5, spring=0.125)
    motion.begin_motion(p, s)
    motion.move_start(p, s, 2e5, 0.0, 2e5)
    assert s.spring == 0.125
    s = state(mode=COASTING, direction=1.0, velocity=4.5, v=4.5, v_rate=2.0 ** -40, spring=0.125)
    motion.begin_motion(p, s)
    motion.move_start(p, s, 4096.0, 0.0, 4096.0)
    assert s.spring == 0.125 + 2.0 ** -40 / 2.0 * 4096.0 ** 2


def test_a_spring_keeps_its_digits_behind_a_drive_that_speeds_up() -> None:
    """Without friction c w = m v′ − F_e at ẋ = v, after billions of metres, too."""
    p = parameters(normal_force=0.0)
    s = state(mode=ACCELERATING, direction=1.0, velocity=4.5, v=4.5, v_rate=0.5, f=-9.0, acceleration=0.5,
              spring=(2.0 * 0.5 + 9.0) / 1024.0)
    motion.begin_motion(p, s)
    motion.move_start(p, s, 1e5, 0.0, 1e5)
    assert (s.inputs.v, s.velocity, s.spring) == pytest.approx((50004.5, 50004.5, 10.0 / 1024.0), rel=1e-10)
    s = state(mode=ACCELERATING, direction=1.0, velocity=4.5, v=4.5, f_rate=-0.0009765625, spring=0.5, f=-512.0,
              acceleration=0.0)
    p = parameters(normal_force=0.0, drive_damping=0.0)
    motion.begin_motion(p, s)
    motion.move_start(p, s, 1e3, 0.0, 1e3)       # F_e falls by a newton, and c w rises by one, but for a ringing
    assert s.spring == pytest.approx((512.0 + 0.9765625) / 1024.0, abs=1e-4)
    assert motion.spring_after(p, s, 1.0, 1e9, 1e9, 4.5, 3.0) == pytest.approx(
        (2.0 * 3.0 + 512.0 + 0.9765625 + 0.0009765625) / 1024.0, rel=1e-13)


@pytest.mark.parametrize(('on_slideway', 'damped'), [(False, 32.0 * (4.5 - 4.25)), (True, -32.0 * 4.25)])
def test_far_from_the_start_the_spring_is_what_the_balance_leaves(on_slideway: bool, damped: float) -> None:
    """c w = m ẍ + F − F_e − h (v − ẋ); with the damper on the slideway h ẋ instead."""
    p = parameters(damper_on_slideway=on_slideway)
    s = state(mode=DECELERATING, direction=1.0, segment=2.0, v=4.5, f=-5.0)
    friction = 64.0 * (0.0625 + 0.5 * 3.75)
    assert motion.spring_after(p, s, 1.0, 1e9, 1e9, 4.25, 3.0) == pytest.approx(
        (2.0 * 3.0 + friction + 5.0 - damped) / 1024.0, rel=1e-14)


def test_what_is_kept_of_other_motions_changes_nothing() -> None:
    """A tick of one length in one mode, in another, and in the first again."""
    p = parameters()
    s = slip(p, DECELERATING, 0.0625, push=9.0, v=0.125, acceleration=-3.5)
    motion.begin_motion(p, s)
    first = motion.travel(p, s, 0.01)
    for changes in ({'mode': ACCELERATING, 'excess': 0.25}, {'mode': DECELERATING, 'excess': 0.0}):
        for name, number in changes.items():
            setattr(s, name, number)
        motion.begin_motion(p, s)
        fresh = state(direction=1.0, velocity=0.0625, v=0.125, acceleration=-3.5, f=s.inputs.f, **changes)
        motion.begin_motion(p, fresh)
        assert motion.travel(p, s, 0.01) == motion.travel(p, fresh, 0.01)
    assert motion.travel(p, s, 0.01) == first
    harder = parameters(drive_stiffness=4096.0)
    fresh = state(mode=DECELERATING, direction=1.0, velocity=0.0625, v=0.125, acceleration=-3.5, f=s.inputs.f)
    for one in (s, fresh):
        motion.begin_motion(harder, one)
    assert motion.travel(harder, s, 0.01) == motion.travel(harder, fresh, 0.01) != first


@pytest.mark.parametrize(('off', 'error'), [(0.0, 1e-12), (1e-6, 1e-12), (-1e-6, 1e-12), (1e-4, 1e-10), (-1e-4, 1e-10)])
def test_an_event_beside_the_last_evaluation_is_read_off_it(off: float, error: float) -> None:
    """As the search for events leaves it: what it evaluated last, and the event beside it."""
    numbers = {'velocity': 0.0625, 'v': 0.125, 'f_rate': 8.0}
    p = parameters(drive_damping=96.0)
    truth = balance({'drive_damping': 96.0}, friction=16.0, viscous=-32.0, stretch=0.03125, **numbers)
    s = begun(p, state(mode=DECELERATING, direction=1.0, spring=0.03125, **numbers), truth.after(0.0))
    at = s.cache.at
    at.time = 0.03
    at.g, at.rate, at.first, at.second = short_integrals(motion.oscillator_of(s), at.time)
    assert motion.travel_at(p, s) == pytest.approx(truth.after(0.03).of_slider, rel=1e-12)
    s.next.time = 0.03 + off
    expected = truth.after(0.03 + off)
    assert motion.travel_to_event(p, s, s.next.time)[:2] == pytest.approx(expected.of_slider[:2], rel=error)
    assert motion.travel_to_event(p, s, s.next.time)[2] == pytest.approx(expected.acceleration, rel=1e4 * error)
    motion.move_start(p, s, 0.0, s.next.time, s.next.time)
    assert (s.position, s.velocity, s.spring) == pytest.approx((expected.travel, expected.velocity, expected.stretch),
                                                               rel=error)


# Sines on top of v and F_e, A sin(2π (f t + phase)) of the absolute time: inputs, forces and motion under them.

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
    travel = 0.25 / w * 2.0 * math.sin(w * t / 2.0) * math.sin(TURN * 0.1 + w * t / 2.0)
    assert sinusoids.sinusoid_drive_travel(s, t) == pytest.approx(travel, rel=1e-10)
    assert motion.drive_travel(s, t) == pytest.approx(0.5 * t + 0.125 * t * t + travel, rel=1e-12)


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
