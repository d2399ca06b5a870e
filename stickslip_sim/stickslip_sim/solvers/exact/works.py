# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The work of each force along the motion from the anchor.

Two ways, both integrals of the motion and neither of them the balance itself:

* Gauss-Legendre panels over the closed form of the motion.  A panel is no longer than a radian and a half of the
  fastest rate, where the rule is exact to rounding; behind a motion that has died out panels grow with the time.  A
  mode whose motion is a polynomial, of a degree that four nodes integrate exactly, takes one panel.
  Under waves whole blocks of panels are summed as time goes on: an event would have to add up an hour of a hold.
* A wave that rings for longer is split into its polynomial and its wave, whose products have closed integrals, so that
  an undamped contact that rings for a year costs what a slip costs.
"""

import math

from ...axis.layout import (
    ACCELERATION, BOOKED, COMPLIANT, CONTACT_DAMPING, CONTACT_STIFFNESS, DAMPING, DEFLECTION, DIRECTION, EXCESS, F,
    FAST, F_RATE, GAMMA, MASS, MODE, NORMAL, NU, OMEGA2, PIECE, SLOW, SNAP, SPRING, STIFFNESS, V, VELOCITY, V_RATE,
    WAVES, SECOND, FRACTION,
)
from ...axis.motion import (
    ACCELERATING, COASTING, STICK, drive_force, drive_travel, friction_force, friction_line, is_rigid_stick, travel,
)
from ...axis.waves import fastest_wave, inputs_at
from ...compiled import compiled
from ...linear.moments import over_rate, wave_moments, wave_square

# the rule of eight nodes, then that of four
_NODES = (-0.96028985649753623168, -0.79666647741362673959, -0.52553240991632898582, -0.18343464249564980494,
          0.18343464249564980494, 0.52553240991632898582, 0.79666647741362673959, 0.96028985649753623168,
          -0.86113631159405257522, -0.33998104358485626480, 0.33998104358485626480, 0.86113631159405257522)
_WEIGHTS = (0.10122853629037625915, 0.22238103445337447054, 0.31370664587788728734, 0.36268378337836198297,
            0.36268378337836198297, 0.31370664587788728734, 0.22238103445337447054, 0.10122853629037625915,
            0.34785484513745385737, 0.65214515486254614263, 0.65214515486254614263, 0.34785484513745385737)
_RADIANS = 1.5          # of a panel: the error for a product of two waves is then below 1e-15 with eight nodes,
_FEW_RADIANS = 0.12     # and here with four
_GROWTH = 0.4           # of a panel per time that has passed since a damped motion began: error below 1e-15
_RINGING = 0.3          # ν/ω from which on a wave and its polynomial are far enough apart to be split
_BLOCK = 64             # panels that are summed as soon as they lie behind: 20 microseconds
_MOST_PANELS = 4096.0   # of equal length; they get longer beyond, but a growing motion ends long before


@compiled
def works(p, s, t):
    """Return the work (J) of drive, external force, friction, drive damper and contact damper from BOOKED up to t.

    The first two are positive when they give energy to the axis, the others when they take it.
    """
    rate, growth = 0.0, 0.0
    if s[MODE] != COASTING and not is_rigid_stick(p, s):
        omega = math.sqrt(s[OMEGA2])
        if omega * t > _RADIANS and s[NU] > _RINGING * omega and s[WAVES] == 0.0:
            return _ringing(p, s, t)
        rate = max(abs(s[SLOW]), abs(s[FAST]), omega)
        growth = _GROWTH if s[GAMMA] > 0.0 else 0.0
    if s[WAVES] != 0.0:
        return _panels(p, s, s[BOOKED], t, _rate_under_waves(p, s), 0.0)
    return _panels(p, s, 0.0, t, rate, growth)


@compiled
def block(p, s):
    """Return how long a block of panels is, s; infinite without waves."""
    rate = _rate_under_waves(p, s) if s[WAVES] != 0.0 else 0.0
    return _BLOCK * _RADIANS / rate if rate > 0.0 else math.inf


@compiled
def _rate_under_waves(p, s):
    rate = 0.0
    if s[MODE] != COASTING and not is_rigid_stick(p, s):
        rate = max(abs(s[SLOW]), abs(s[FAST]), math.sqrt(s[OMEGA2]))
    return max(rate, fastest_wave(s))


@compiled
def _panels(p, s, begin, t, rate, growth):
    first, last = (0, 8) if rate * t > _FEW_RADIANS else (8, 12)
    length = _RADIANS / rate if rate * t > _RADIANS else t
    drive, external, friction, damper, contact = 0.0, 0.0, 0.0, 0.0, 0.0
    if growth == 0.0 and s[WAVES] == 0.0:
        length = max(length, t / _MOST_PANELS)
    while begin < t:
        end = begin + max(length, growth * begin)
        if end > t - 0.1 * length:
            end = t
        half = 0.5 * (end - begin)
        for i in range(first, last):
            weight = half * _WEIGHTS[i]
            of_drive, of_force, of_friction, of_damper, of_contact = _powers(p, s, begin + half * (1.0 + _NODES[i]))
            drive += weight * of_drive
            external += weight * of_force
            friction += weight * of_friction
            damper += weight * of_damper
            contact += weight * of_contact
        begin = end
    return drive, external, friction, damper, contact


@compiled
def _powers(p, s, t):
    y, u, _ = travel(p, s, t)
    v, force = _inputs(s, t)
    pull = drive_force(p, s[SPRING] + (drive_travel(s, t) - y), v, u)
    slack = v - u
    friction, contact = 0.0, 0.0
    if s[MODE] == STICK:
        contact = p[CONTACT_DAMPING] * u * u
    else:
        friction = friction_force(p, s, 0.0, u, pull + force) * u
    return pull * v, force * u, friction, p[DAMPING] * slack * slack, contact


@compiled
def _inputs(s, t):
    if s[WAVES] != 0.0:
        return inputs_at(s, s[SECOND], s[FRACTION] + t, t)
    return s[V] + s[V_RATE] * t, s[F] + s[F_RATE] * t


@compiled
def _ringing(p, s, t):
    """Return the works of ẋ = α + β t + e^(−γt) (a cos νt + b sin νt)."""
    gamma, nu, omega2 = s[GAMMA], s[NU], s[OMEGA2]
    beta = s[SNAP] / omega2
    # the drive's velocity less α, from what makes them differ: a difference of the two would drift with the time
    contact = p[CONTACT_STIFFNESS] if s[MODE] == STICK else 0.0
    slope = ((contact * s[V] - p[DAMPING] * s[V_RATE] - s[F_RATE]) / p[MASS] + 2.0 * gamma * beta) / omega2
    alpha = ((p[STIFFNESS] * s[V] + p[DAMPING] * s[V_RATE] + s[F_RATE]) / p[MASS] - 2.0 * gamma * beta) / omega2
    a = s[VELOCITY] - alpha
    b = (s[ACCELERATION] - beta + gamma * a) / nu
    real, imaginary, real1, imaginary1 = wave_moments(gamma, nu, t)
    wave, wave1 = a * real + b * imaginary, a * real1 + b * imaginary1   # ∫ and ∫ t of the wave
    square = wave_square(gamma, nu, a, b, t)
    # the spring: s − x = middle + slope t + bend t² − Re(Y e^(λt))
    y_real, y_imaginary = over_rate(gamma, nu, a, -b)
    swing = y_real * real - y_imaginary * imaginary
    swing1 = y_real * real1 - y_imaginary * imaginary1
    middle, bend = s[SPRING] + y_real, 0.5 * (s[V_RATE] - beta)

    u = (alpha + 0.5 * beta * t) * t + wave
    u1 = (0.5 * alpha + beta * t / 3.0) * t * t + wave1
    u_square = (alpha * alpha + (alpha + beta * t / 3.0) * beta * t) * t + 2.0 * (alpha * wave + beta * wave1) + square
    w = (middle + (0.5 * slope + bend * t / 3.0) * t) * t - swing
    w1 = (0.5 * middle + (slope / 3.0 + 0.25 * bend * t) * t) * t * t - swing1
    v, v_rate = s[V], s[V_RATE]
    v_square = (v * v + (v + v_rate * t / 3.0) * v_rate * t) * t
    v_u = v * u + v_rate * u1
    drive = p[STIFFNESS] * (v * w + v_rate * w1) + p[DAMPING] * (v_square - v_u)
    external = s[F] * u + s[F_RATE] * u1
    damper = p[DAMPING] * (v_square - 2.0 * v_u + u_square)
    if s[MODE] == STICK:
        return drive, external, 0.0, damper, p[CONTACT_DAMPING] * u_square
    coefficient, rise, psi, psi_rise = friction_line(p, int(s[PIECE]), 0.0)
    if s[MODE] == ACCELERATING:
        coefficient += s[EXCESS] * psi
        rise += s[EXCESS] * psi_rise
    return drive, external, p[NORMAL] * (s[DIRECTION] * coefficient * u + rise * u_square), damper, 0.0


@compiled
def stored_energy(p, s, t):
    """Return m ẋ²/2 + c (s − x)²/2 + c_c δ²/2 at t after the anchor, J."""
    y, u, _ = travel(p, s, t)
    spring = s[SPRING] + (drive_travel(s, t) - y)
    return 0.5 * (p[MASS] * u * u + p[STIFFNESS] * spring * spring) + contact_energy(p, s, y)


@compiled
def contact_energy(p, s, y):
    """Return c_c δ²/2 after a travel of y from the anchor, J; 0 in slip and in a rigid contact."""
    if s[MODE] != STICK or p[COMPLIANT] == 0.0:
        return 0.0
    deflection = s[DEFLECTION] + y
    return 0.5 * p[CONTACT_STIFFNESS] * deflection * deflection
