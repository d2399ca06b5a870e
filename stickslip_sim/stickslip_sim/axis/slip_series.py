# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The motion of a slip under a normal force that varies, and of a contact that yields: power series with a bound.

With w = s − x, the friction force σ a N + b N u of a segment of the table, E included, and a N(t) that is analytic,

    m u′ = c w + h v − h u + F_e − σ a N − b N u,    w′ = v − u

is linear with analytic coefficients, so that its Taylor series converges everywhere.  In τ = t/H, with the scaled
coefficients of the inputs and of N,

    u_{k+1} = H/(m (k+1)) [c w_k − h u_k + push_k − b Σ_j N_j u_{k−j}],    w_{k+1} = H/(k+1) (v_k − u_k).

A contact that yields has a = mu_k(0), b = 0, and δ′ = (σ a N − c_c δ)/h_c beside it.

**Bound.**  The polynomials solve the equations but for a defect d: what the orders left out would add, and rounding of
the recurrence, (k + 4) ε times the sum of the terms' magnitudes.  In (u, Ω w), Ω² = c/m, the springs are skew, so that
the logarithmic norm of the system is max(0, −(h + N b)/m) = μ, and the error stays below exp(μ H) (d_t + d_r)
(Dahlquist 1958).  H is shortened until d_t is at most 4 ε of the velocity.  It depends on the segment start alone: a
segment that ends without an event is followed by the next, and no split of a run changes a bit.
"""

import math

from ..core.hot_path import compiled, inlined
from ..linear.waves import TURN
from .codes import COASTING, STICK, YIELDING
from .forces import feed_damping, kinetic_at_rest, slip_friction
from .layout import Parameters
from .sinusoids import fastest_sinusoid
from .smooth_load import load_bounds
from .state_record import HIGHEST_ORDER, State

_EPSILON = 2.220446049250313e-16
THETA = 1.6         # radians of a segment: 0.75 (ε K!)^(1/K)
_ANY = 1.0           # s, of a segment in which nothing swings, whose series end by themselves
_SHORTER = 0.75      # a segment whose remainder is too large is shortened by this factor
_SHORTENINGS = 200
_GROWN = 6.0         # more than exp(THETA)


@inlined
def moves_by_series(s: State) -> bool:
    """Whether the motion from the segment start on is given by its power series."""
    mode = s.mode
    return mode == YIELDING or (s.is_loaded != 0.0 and mode != STICK and mode != COASTING)


@compiled
def begin_series(p: Parameters, s: State) -> None:
    """Set the series from the segment start on, how long they hold, and the bound on their error."""
    steady, slope = kinetic_at_rest(p, s.direction), 0.0
    if s.mode != YIELDING:
        steady, slope = slip_friction(p, s)
    end, damping = _first_end(p, s, slope)
    natural = math.sqrt(p.stiffness / p.mass)
    cut, rounding = 0.0, 0.0
    for _ in range(_SHORTENINGS):
        size, tail_push, tail_v = _known_terms(p, s, steady, end)
        rounding, stretch = _recurrence(p, s, slope, end)
        rounding += 4.0 * _EPSILON * end / p.mass * size
        cut = _remainder(p, s, slope, end, stretch, tail_push, tail_v)
        if cut <= 4.0 * _EPSILON * velocity_scale(s):
            break
        end *= _SHORTER
    growth = max(0.0, -(p.damping + slope * load_bounds(p, s, 0.0, end).most) / p.mass)
    s.series_end = end
    s.series_error = (cut + rounding) * (1.0 + (natural + 2.0 * damping) * end * math.exp(growth * end))
    if s.mode == YIELDING:
        _yield_deflection(p, s, steady, end)


@inlined
def _first_end(p: Parameters, s: State, slope: float) -> tuple[float, float]:
    """Return H before it is shortened, s, and (h + |b| N)/2m."""
    natural, swing = math.sqrt(p.stiffness / p.mass), fastest_sinusoid(s)
    load = load_bounds(p, s, 0.0, 0.0)
    damping = 0.5 * (p.damping + abs(slope) * load.most) / p.mass
    pace = max(natural, swing) + 0.4 * min(natural, swing) + damping + math.sqrt(abs(slope) * load.slope / p.mass)
    if s.mode == YIELDING and p.contact_damping > 0.0:
        pace = max(pace, p.contact_stiffness / p.contact_damping)
    if pace > 0.0:
        return THETA / pace, damping
    return (p.normal_force / abs(p.normal_rate) if p.normal_force * p.normal_rate != 0.0 else _ANY), damping


@compiled
def _known_terms(p: Parameters, s: State, steady: float, end: float) -> tuple[float, float, float]:
    """Set v, N and the forces that do not depend on the motion, by orders; return the forces' size and the tails."""
    feed, pressed = feed_damping(p), -s.direction * steady
    for k in range(HIGHEST_ORDER + 1):
        s.scratch[k].v, s.scratch[k].push, s.scratch[k].n, s.scratch[k].tail = 0.0, 0.0, 0.0, 0.0
    v, f = (s.inputs.base_v, s.inputs.base_f) if s.sinusoid_count != 0.0 else (s.inputs.v, s.inputs.f)
    normal = s.inputs.base_n if s.is_loaded != 0.0 else p.normal_force
    s.scratch[0].v, s.scratch[1].v = v, s.inputs.v_rate * end
    s.scratch[0].n, s.scratch[1].n = normal, p.normal_rate * end
    s.scratch[0].push = feed * v + f + pressed * normal
    s.scratch[1].push = (feed * s.inputs.v_rate + s.inputs.f_rate + pressed * p.normal_rate) * end
    s.scratch[0].tail, s.scratch[1].tail = normal, abs(p.normal_rate) * end
    size = feed * abs(v) + abs(f) + steady * normal + (
        feed * abs(s.inputs.v_rate) + abs(s.inputs.f_rate) + steady * abs(p.normal_rate)) * end
    tail_push, tail_v = 0.0, 0.0
    for i in range(int(s.sinusoid_count)):
        v, n = s.sinusoids[i].v, s.sinusoids[i].n
        push = feed * v + s.sinusoids[i].f + pressed * n
        value, slope, factor = s.sinusoids[i].sine, s.sinusoids[i].cosine, 1.0
        for k in range(HIGHEST_ORDER + 1):
            s.scratch[k].v += v * value * factor
            s.scratch[k].n += n * value * factor
            s.scratch[k].push += push * value * factor
            s.scratch[k].tail += abs(n) * factor
            value, slope = slope, -value
            if k == HIGHEST_ORDER:   # and all orders that follow
                s.scratch[k].tail += abs(n) * factor
                tail_push += 2.0 * abs(push) * factor
                tail_v += 2.0 * abs(v) * factor
            factor *= TURN * s.sinusoids[i].frequency * end / (k + 1.0)
        size += _GROWN * (feed * abs(v) + abs(s.sinusoids[i].f) + steady * abs(n))
    for k in range(HIGHEST_ORDER):
        s.scratch[HIGHEST_ORDER - 1 - k].tail += s.scratch[HIGHEST_ORDER - k].tail
    return size, tail_push, tail_v


@compiled
def _recurrence(p: Parameters, s: State, slope: float, end: float) -> tuple[float, float]:
    """Set the series of the velocity; return their rounding, m/s, and the last order of the spring's stretch, m.

    A slip begins with the acceleration of its state, which is 0 where a tie says so.
    """
    stretch, rounding = s.spring, 0.0
    s.series[0].u = s.velocity
    for k in range(HIGHEST_ORDER):
        u = s.series[k].u
        drag, size = 0.0, 0.0
        if slope != 0.0:
            for j in range(k + 1):
                term = s.scratch[j].n * s.series[k - j].u
                drag += term
                size += abs(term)
        share = end / (k + 1.0)
        force = p.stiffness * stretch - p.damping * u + s.scratch[k].push - slope * drag
        rounding += (k + 4.0) * _EPSILON * share / p.mass * (p.stiffness * abs(stretch) + p.damping * abs(u)
                                                              + abs(slope) * size)
        if k == 0 and s.mode != YIELDING:
            s.series[1].u = s.acceleration * end
        else:
            s.series[k + 1].u = share / p.mass * force
        stretch = share * (s.scratch[k].v - u)
    return rounding, stretch


@compiled
def _remainder(p: Parameters, s: State, slope: float, end: float, stretch: float, tail_push: float, tail_v: float
               ) -> float:
    """Return d_t: what the orders left out would add within H, m/s."""
    last = abs(s.series[HIGHEST_ORDER].u)
    force = p.stiffness * abs(stretch) + p.damping * last + tail_push
    if slope != 0.0:
        for k in range(HIGHEST_ORDER + 1):
            force += abs(slope * s.series[k].u) * s.scratch[HIGHEST_ORDER - k].tail
    return end / p.mass * force + math.sqrt(p.stiffness / p.mass) * end * (last + tail_v)


@compiled
def velocity_scale(s: State) -> float:
    """Return the size of the velocity in a segment, m/s: what rounding is relative to."""
    total = 0.0
    for k in range(HIGHEST_ORDER + 1):
        total += abs(s.series[k].u)
    return total


@compiled
def _yield_deflection(p: Parameters, s: State, steady: float, end: float) -> None:
    """Set the series of the deflection of a contact that yields, and add its bound to that of the velocity."""
    pressed, stiffness, damping = s.direction * steady, p.contact_stiffness, p.contact_damping
    if damping == 0.0:
        for k in range(HIGHEST_ORDER + 1):
            s.series[k].deflection = pressed * s.scratch[k].n / stiffness
        return
    s.series[0].deflection = s.deflection
    rounding = 0.0
    for k in range(HIGHEST_ORDER):
        force, share = pressed * s.scratch[k].n, end / (k + 1.0) / damping
        s.series[k + 1].deflection = share * (force - stiffness * s.series[k].deflection)
        rounding += (k + 4.0) * _EPSILON * share * (abs(force) + stiffness * abs(s.series[k].deflection))
    last, tail = s.series[HIGHEST_ORDER].deflection, s.scratch[HIGHEST_ORDER].tail
    cut = end / damping * (stiffness * abs(last) + abs(pressed) * tail)
    s.series_error += (cut + rounding) * (stiffness / damping + 1.0 / end)


@compiled
def series_travel(s: State, t: float) -> tuple[float, float, float]:
    """Return the slider's travel, velocity and acceleration at t after the segment start."""
    at = t / s.series_end
    y, u, slope = 0.0, 0.0, 0.0
    for i in range(HIGHEST_ORDER + 1):
        k = HIGHEST_ORDER - i
        slope = slope * at + u
        u = u * at + s.series[k].u
        y = y * at + s.series[k].u / (k + 1.0)
    return y * t, u, slope / s.series_end


@compiled
def series_deflection(s: State, t: float) -> tuple[float, float]:
    """Return the deflection of a contact that yields, and its rate, at t after the segment start."""
    at = t / s.series_end
    value, slope = 0.0, 0.0
    for i in range(HIGHEST_ORDER + 1):
        slope = slope * at + value
        value = value * at + s.series[HIGHEST_ORDER - i].deflection
    return value, slope / s.series_end
