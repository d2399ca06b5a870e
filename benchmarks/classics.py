# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Classical results on stick-slip in closed form, beside the exact engine: shown in docs/paper.md.

m ẍ = c (v t − x) + h (v − ẋ) − F, with ω = √(c/m), ζ = h/(2 √(cm)) and s = √(1 − ζ²).  Friction drops by ΔF as the slip
begins; A = ΔF/(v √(cm)) is that drop over what the feed v stands for.  tests/solvers/exact/test_classics.py keeps it.
"""

import math
from collections.abc import Callable
from dataclasses import replace
from functools import partial
from typing import NamedTuple

from scipy.optimize import brentq

from stickslip_sim.axis import Axis, Friction, InitialState, RigidContact
from stickslip_sim.core.input_profile import InputProfile, Sinusoid, constant
from stickslip_sim.core.types import Event, EventKind, Sample
from stickslip_sim.figures.cycles import cycle_figures
from stickslip_sim.friction import KineticTable, StaticLaw, StaticLawKind, kinetic_table
from stickslip_sim.friction.smooth import hyperbolic
from stickslip_sim.proof.axes import instant, make, of_kind, run_events
from stickslip_sim.study.critical import SliderOnDrive, critical_feed


class CoulombCycle(NamedTuple):
    """The limit cycle of constant static and kinetic friction without damping: times s, speed m/s, jump m."""

    slip_time: float
    stick_time: float
    period: float
    peak_speed: float
    jump: float


def coulomb_cycle(slider: SliderOnDrive, drop: float, feed: float) -> CoulombCycle:
    """Return the cycle for a drop of friction ΔF (N) and a feed v (m/s), h = 0."""
    a = drop / (feed * slider.impedance)
    slip = 2.0 / slider.frequency * (math.pi - math.atan(a))
    stick = 2.0 * drop / (slider.stiffness * feed)
    return CoulombCycle(slip, stick, slip + stick, feed * (1.0 + math.hypot(1.0, a)), feed * (slip + stick))


def slip_speed(slider: SliderOnDrive, drop: float, feed: float, time: float) -> float:
    """Return ẋ (m/s) at a time (s) after the break-away, under constant kinetic friction and 0 <= ζ < 1."""
    zeta = slider.damping_ratio
    s, a = math.sqrt(1.0 - zeta * zeta), drop / (feed * slider.impedance)
    phase = s * slider.frequency * time
    sinusoid = math.cos(phase) - (a - zeta) / s * math.sin(phase)
    return feed * (1.0 - math.exp(-zeta * slider.frequency * time) * sinusoid)


def light_damping_feed(slider: SliderOnDrive, drop: float) -> float:
    """Return the usual estimate of v_c (m/s), the limit of small ζ: ΔF/√(4π ζ c m)."""
    return drop / (math.sqrt(4.0 * math.pi * slider.damping_ratio) * slider.impedance)


def healing_stick_time(grown: Callable[[float], float], stiffness: float, feed: float) -> float:
    """Return the stick time t (s) of the cycle, c v t = 2 ΔS(t), h = 0; `grown` is ΔS (N), concave and bounded."""
    end = 2.0 * grown(math.inf) / (stiffness * feed)
    return float(brentq(lambda t: 2.0 * grown(t) - stiffness * feed * t, 1e-9 * end, end, xtol=1e-300, rtol=1e-15))


def swing_ratio(slider: SliderOnDrive, slope: float) -> float:
    """Return what half a swing about steady sliding leaves of the last one, friction falling by `slope` σ N s/m.

    exp(−π γ/√(ω² − γ²)) with γ = (h − σ)/(2 m): it grows where σ > h.
    """
    gamma = 0.5 * (slider.damping - slope) / slider.mass
    return math.exp(-math.pi * gamma / math.sqrt(slider.frequency ** 2 - gamma * gamma))


class Swing(NamedTuple):
    """A forced oscillation under P cos(w t + phase) that is at +amplitude at t = 0; amplitude in P/c, phase in rad."""

    amplitude: float
    phase: float


def den_hartog(ratio: float, friction: float) -> Swing:
    """Return the steady oscillation without stops, for r = w/ω and constant friction in P (Den Hartog 1931), h = 0.

    X = √(V² − f² U²), V = 1/(1 − r²), U = sin(π/r)/(r (1 + cos(π/r))).
    """
    v = 1.0 / (1.0 - ratio * ratio)
    u = math.tan(0.5 * math.pi / ratio) / ratio
    amplitude = math.sqrt(v * v - friction * friction * u * u)
    return Swing(amplitude, math.atan2(-friction * u / v, amplitude / v))


# The same by the engine.

PAPER = SliderOnDrive(350.0, 6e5, 4000.0)
UNDAMPED = PAPER._replace(damping=0.0)
UNIT = SliderOnDrive(1.0, 1.0)
STATIC, KINETIC = 824.0, 412.0   # N
DROP = STATIC - KINETIC
FEED = 0.005                     # m/s
DAMPING_RATIOS = 0.01, 0.1, 0.2
EXACT = 1e-12                    # where everything is a closed form; the engine's own bound

LEINE_TOLERANCE = 1e-6           # of the table of F_s/(1 + 3 |u|), of F_s
_LEINE_SPEED = 0.2
_LEINE = {'slip time': 4.2959995255, 'stick time': 7.7050317694, 'period': 12.0010312948,
          'largest stretch': 1.1339446764, 'smallest stretch': -0.5554326901}

HEALING = StaticLaw(StaticLawKind.EXPONENTIAL, 0.12, 0.24, 0.2)
NORMAL = 350 * 9.80665           # N


class Result(NamedTuple):
    """A figure as the literature has it and as the engine has it; they differ by at most `tolerance` · |expected|."""

    name: str
    unit: str
    expected: float
    found: float
    tolerance: float = EXACT


def axis_of(slider: SliderOnDrive, friction: Friction, normal_force: float = 1.0) -> Axis:
    """Return an axis with a rigid contact and the conventional characteristics."""
    return Axis(*slider, normal_force, RigidContact(), friction)


def coulomb_axis(slider: SliderOnDrive, static: float, kinetic: float) -> Axis:
    """Return an axis with constant static and kinetic friction in N."""
    law = StaticLaw(StaticLawKind.CONSTANT, static, static)
    return axis_of(slider, Friction(law, KineticTable((0.0,), (kinetic,)), None))


def healing_axis(law: StaticLaw) -> Axis:
    """Return the undamped axis whose kinetic friction is mu_s(0): only rest makes a drop."""
    return axis_of(UNDAMPED, Friction(law, KineticTable((0.0,), (law.initial,)), None), NORMAL)


def state_at(axis: Axis, feed: float, time: float) -> Sample:
    """Return the state at a time (s), from prolonged rest."""
    simulator = make(axis, feed)
    simulator.advance(instant(time))
    return simulator.sample()


def undamped_cycle() -> list[Result]:
    """Constant friction without damping: the limit cycle."""
    events = run_events(coulomb_axis(UNDAMPED, STATIC, KINETIC), FEED, 3.0)
    expected, found = coulomb_cycle(UNDAMPED, DROP, FEED), cycle_figures(events)[-1]
    units = ('s', 's', 's', 'm/s', 'm')
    return [Result(f'undamped Coulomb cycle: {name.replace("_", " ")}', unit, value, getattr(found, name))
            for (name, value), unit in zip(expected._asdict().items(), units, strict=True)]


def damped_slip() -> list[Result]:
    """The paper's damper and constant kinetic friction: the speed during a slip."""
    axis = coulomb_axis(PAPER, STATIC, KINETIC)
    start = run_events(axis, FEED, 1.0)[0].time
    return [Result(f'damped slip: speed after {time * 1e3:g} ms', 'm/s', slip_speed(PAPER, DROP, FEED, time),
                   state_at(axis, FEED, start + time).velocity) for time in (0.001, 0.01, 0.03, 0.05, 0.07)]


def critical_feeds() -> list[Result]:
    """Constant friction with damping: the feed at which stick-slip ends, by bisection on the engine."""
    return [Result(f'critical feed, ζ = {zeta:g}', 'm/s', critical_feed(damped(zeta), DROP),
                   feed_where_sticking_ends(zeta)) for zeta in DAMPING_RATIOS]


def damped(zeta: float) -> SliderOnDrive:
    """Return the paper's slider with another damping ratio."""
    return UNDAMPED._replace(damping=2.0 * zeta * UNDAMPED.impedance)


def sticks_again(zeta: float, feed: float) -> bool:
    """Whether the slider comes to rest after the first break-away, with constant friction."""
    events = run_events(coulomb_axis(damped(zeta), STATIC, KINETIC), feed, STATIC / (UNDAMPED.stiffness * feed) + 1.0)
    return bool(of_kind(events, EventKind.STICK))


def feed_where_sticking_ends(zeta: float) -> float:
    """Return the lowest feed (m/s) without a stick, to the last bit but one."""
    low, high = 1e-3, 1.0
    while high - low > 4.0 * math.ulp(high):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if sticks_again(zeta, middle) else (low, middle)
    return high


def healing_cycles() -> list[Result]:
    """No fall with speed and no damping: the stick time of the cycle that growth at rest alone keeps up."""
    results = []
    for law, feed in ((HEALING, 0.0034), (HEALING, 0.0062),
                      (replace(HEALING, kind=StaticLawKind.KATO, exponent=0.5), 0.07)):
        expected = healing_stick_time(partial(grown, law), UNDAMPED.stiffness, feed)
        found = cycle_figures(run_events(healing_axis(law), feed, 200.0))[-1].stick_time
        results.append(Result(f'growth at rest ({law.kind.name.lower()}), {feed * 1e3:g} mm/s: stick time', 's',
                              expected, found))
    return results


def grown(law: StaticLaw, rest: float) -> float:
    """Return by how much static friction (N) has grown after a rest (s)."""
    return NORMAL * (law.coefficient(rest) - law.initial)


def steady_sliding() -> list[Result]:
    """The paper's falling mu_k about steady sliding: what each half swing makes of the last; 2000 N is the border."""
    return [Result(f'steady sliding, N = {normal:g} N: ratio of half swings', '',
                   swing_ratio(PAPER, normal * (0.12 - 0.05) / 0.035), _swing_ratio(normal))
            for normal in (1800.0, 2000.0, 2200.0)]


def _swing_ratio(normal_force: float) -> float:
    """Return the mean ratio of neighbouring extremes of ẋ − v, from a start 1 mm/s off; F_e balances the friction."""
    feed = 0.0175
    kinetic = KineticTable((0.0, 0.035), (0.12, 0.05))
    axis = axis_of(PAPER, Friction(HEALING, kinetic, None), normal_force)
    events = run_events(axis, feed, 1.0, normal_force * kinetic.coefficient(feed), InitialState(velocity=feed + 1e-3))
    swings = [abs(event.velocity - feed) for event in events]
    return math.pow(swings[-1] / swings[0], 1.0 / (len(swings) - 1))


def forced_oscillations() -> list[Result]:
    """Den Hartog's oscillator, from rest: half the distance of the turning points once it is steady."""
    results = []
    for ratio, friction in ((0.8, 0.5), (1.5, 0.3), (2.0, 0.2)):
        turns = turning_points(forced_axis(friction), shaken(ratio, 0.0), 400.0 * math.pi / ratio)
        results.append(Result(f'Den Hartog, w/ω = {ratio:g}, F/P = {friction:g}: amplitude', 'P/c',
                              den_hartog(ratio, friction).amplitude, half_range(turns)))
    return results


def forced_axis(friction: float) -> Axis:
    """Return m = c = 1, h = 0 with constant friction in N."""
    return coulomb_axis(UNIT, friction, friction)


def shaken(ratio: float, phase: float, mean: float = 0.0) -> InputProfile:
    """Return the force mean + cos(ratio t + phase)."""
    return replace(constant(mean), sinusoids=(Sinusoid(1.0, ratio / (2.0 * math.pi), phase + 0.5 * math.pi),))


def turning_points(axis: Axis, force: InputProfile, duration: float) -> list[Event]:
    """Return where the slider stops or turns back, its drive standing still."""
    events = run_events(axis, 0.0, duration, force)
    return [event for event in events if event.kind in (EventKind.REVERSE, EventKind.STICK)]


def half_range(turns: list[Event]) -> float:
    """Return half the distance of the last two turning points, m."""
    return 0.5 * abs(turns[-1].position - turns[-2].position)


def leine_axis(tolerance: float) -> Axis:
    """Return m = c = F_s = 1, h = 0 with F_s/(1 + 3 |u|) as a table."""
    law = StaticLaw(StaticLawKind.CONSTANT, 1.0, 1.0)
    return axis_of(UNIT, Friction(law, kinetic_table(hyperbolic(1.0, 0.0, 1.0 / 3.0), tolerance), None))


def leine_cycle(tolerance: float = LEINE_TOLERANCE) -> list[Result]:
    """Leine et al. 1998: the first cycle is the limit cycle; it is off by no more than the table's tolerance."""
    axis = leine_axis(tolerance)
    events = run_events(axis, _LEINE_SPEED, 20.0)
    cycle, peak = cycle_figures(events)[0], max(events, key=lambda event: event.velocity)
    moments = (cycle.begin + 1e-3, peak.time), (peak.time, cycle.begin + cycle.slip_time - 1e-3)
    stretches = [state_at(axis, _LEINE_SPEED, _overtaking(axis, *span)).drive_force for span in moments]
    found = (cycle.slip_time, cycle.stick_time, cycle.period, *stretches)
    return [Result(f'Leine 1998: {name}', '', value, figure, tolerance / abs(value))
            for (name, value), figure in zip(_LEINE.items(), found, strict=True)]


def _overtaking(axis: Axis, begin: float, end: float) -> float:
    """Return when the slider is as fast as the drive: there the spring is longest or shortest."""
    def lead(time: float) -> float:
        return state_at(axis, _LEINE_SPEED, time).velocity - _LEINE_SPEED

    return float(brentq(lead, begin, end, xtol=1e-12))


GROUPS: tuple[Callable[[], list[Result]], ...] = (
    undamped_cycle, damped_slip, critical_feeds, healing_cycles, steady_sliding, forced_oscillations, leine_cycle)
