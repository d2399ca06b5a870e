# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The work of each force along the motion from the anchor, and the energies that are stored.

The works are integrals over the motion that follows from the state at the anchor, and none is the balance itself: they
know nothing of where the engine says that the motion arrives (see `linear.moments`).  Without waves the inputs are
v + v′t and F + F′t, and every work is made from the integrals of x and of x²; x is the variable that a motion settles
in, the slider's velocity in stick, and in slip what the drive is ahead of it, v − ẋ.  Where that is nearly all of v,
little is left for the other one, and few of its digits; then the other one is x: of a slow slider that slips under a
fast drive, and of a contact so weak that it hardly holds.  `wave_works` adds the sines.
"""

from ...axis.layout import (
    ACCELERATION, COMPLIANT, CONTACT_DAMPING, CONTACT_STIFFNESS, DAMPING, DEFLECTION, DIRECTION, F, F_RATE, MASS, MODE,
    NORMAL, SPRING, STIFFNESS, V, VELOCITY, V_RATE, WAVES,
)
from ...axis.motion import COASTING, STICK, drive_travel, is_rigid_stick, oscillator_of, slip_friction, travel
from ...core.jit import compiled, inlined
from ...linear.moments import moments
from .wave_works import moving_works, still_works

_FEW = 0.05   # of the drive's way: what is left of it with more than one digit less is integrated by itself


@inlined
def works(p, s, t):
    """Return the work (J) of drive, external force, friction, drive damper and contact damper from the anchor up to t.

    The first two are positive when they give energy to the axis, the others when they take it.
    """
    if s[WAVES] != 0.0:
        if s[MODE] == COASTING or is_rigid_stick(p, s):
            return still_works(p, s, t)
        return moving_works(p, s, t)
    if s[MODE] == COASTING:
        return _coasting(p, s, t)
    return _rigid_hold(p, s, t) if is_rigid_stick(p, s) else _moving(p, s, t)


@inlined
def _rigid_hold(p, s, t):
    v, rate = s[V], s[V_RATE]
    way = (v + 0.5 * rate * t) * t
    damper = p[DAMPING] * _square(v, rate, t)
    return p[STIFFNESS] * (s[SPRING] + 0.5 * way) * way + damper, 0.0, 0.0, damper, 0.0


@inlined
def _coasting(p, s, t):
    u, v, rate = s[VELOCITY], s[V], s[V_RATE]
    ahead = v - u
    lead = (ahead + 0.5 * rate * t) * t
    stretch = s[SPRING] * t + (0.5 * ahead + rate * t / 6.0) * t * t
    stretch1 = (0.5 * s[SPRING] + (ahead / 3.0 + 0.125 * rate * t) * t) * t * t
    lead1 = (0.5 * ahead + rate * t / 3.0) * t * t
    damper = p[DAMPING] * _square(ahead, rate, t)
    drive = (p[STIFFNESS] * (v * stretch + rate * stretch1) + p[DAMPING] * (v * lead + rate * lead1))
    external = u * (s[F] + 0.5 * s[F_RATE] * t) * t
    return drive, external, u * (p[STIFFNESS] * stretch + p[DAMPING] * lead) + external, damper, 0.0


@inlined
def _moving(p, s, t):
    """Return the works in slip, or in a compliant contact."""
    v, rate = s[V], s[V_RATE]
    slips = s[MODE] != STICK
    steady, slope = slip_friction(p, s) if slips else (0.0, 0.0)
    contact, damping = (0.0, p[NORMAL] * slope) if slips else (p[CONTACT_STIFFNESS], p[CONTACT_DAMPING])
    way = (v + 0.5 * rate * t) * t
    if slips:
        stretch, stretch1, v_lead, lead_square, y, u1, square = _from_lead(p, s, t, contact, damping)
        if abs(y) < _FEW * abs(way):
            stretch, stretch1, v_lead, lead_square, y, u1, square = _from_slider(p, s, t)
    else:
        stretch, stretch1, v_lead, lead_square, y, u1, square = _from_slider(p, s, t)
        if abs(way - y) < _FEW * abs(way):
            stretch, stretch1, v_lead, lead_square, y, u1, square = _from_lead(p, s, t, contact, damping)
    drive = p[STIFFNESS] * (v * stretch + rate * stretch1) + p[DAMPING] * v_lead
    external, damper, lost = s[F] * y + s[F_RATE] * u1, p[DAMPING] * lead_square, damping * square
    if slips:
        return drive, external, p[NORMAL] * s[DIRECTION] * steady * y + lost, damper, 0.0
    return drive, external, 0.0, damper, lost


@compiled
def _from_slider(p, s, t):
    """Return ∫w, ∫t w, ∫v x, ∫x², ∫ẋ, ∫t ẋ and ∫ẋ² of w = s − x and x = v − ẋ, from the moments of ẋ."""
    v, rate = s[V], s[V_RATE]
    push = (p[STIFFNESS] * v + p[DAMPING] * rate + s[F_RATE]) / p[MASS]
    _, _, y, once, twice, square = moments(oscillator_of(s), s[VELOCITY], s[ACCELERATION], push,
                                           p[STIFFNESS] * rate / p[MASS], t)
    u1 = t * y - once
    v_u, v_square = v * y + rate * u1, _square(v, rate, t)
    stretch = (s[SPRING] + (0.5 * v + rate * t / 6.0) * t) * t - once
    stretch1 = (0.5 * s[SPRING] + (v / 3.0 + 0.125 * rate * t) * t) * t * t - (t * once - twice)
    return stretch, stretch1, v_square - v_u, v_square - 2.0 * v_u + square, y, u1, square


@compiled
def _from_lead(p, s, t, contact, damping):
    """Return what `_from_slider` does, from the moments of x.

    What resists the motion is `contact` times the way, `damping` times the speed, and what does not change.
    """
    v, rate = s[V], s[V_RATE]
    push = (contact * v + damping * rate - s[F_RATE]) / p[MASS]
    _, _, lead, once, twice, square = moments(oscillator_of(s), v - s[VELOCITY], rate - s[ACCELERATION], push,
                                              contact * rate / p[MASS], t)
    lead1 = t * lead - once
    v_lead = v * lead + rate * lead1
    y = (v + 0.5 * rate * t) * t - lead
    u1 = (0.5 * v + rate * t / 3.0) * t * t - lead1
    stretch = s[SPRING] * t + once
    stretch1 = 0.5 * s[SPRING] * t * t + (t * once - twice)
    return stretch, stretch1, v_lead, square, y, u1, _square(v, rate, t) - 2.0 * v_lead + square


@inlined
def _square(v, rate, t):
    """Return ∫(v + rate t)²."""
    return (v * v + (v + rate * t / 3.0) * rate * t) * t


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
