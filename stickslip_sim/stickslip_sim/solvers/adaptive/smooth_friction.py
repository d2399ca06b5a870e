# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Friction at a state, with a smooth law of mu_k in place of the table of the transitions, where there is one."""

from ...axis.codes import ACCELERATING, COASTING, STICK
from ...axis.forces import applied_force, force_rounding, friction_line, segment_above
from ...axis.layout import Parameters
from ...axis.mode_entry import choose_slip
from ...axis.rows import EventRow
from ...axis.state_record import State
from .mode_problem import SmoothLaw


def choose_sub_mode(law: SmoothLaw | None, p: Parameters, s: State) -> bool:
    """Set the sub-mode of a slip from the forces; return False when the slider comes to rest instead."""
    coefficient, psi = _coefficients(law, p, s)
    upper = coefficient + s.excess * psi
    push = s.direction * applied_force(p, s)
    return choose_slip(p, s, push - p.normal_force * upper, push - p.normal_force * coefficient,
                       force_rounding(p, s, upper))


def slip_friction_force(law: SmoothLaw | None, p: Parameters, s: State) -> float:
    """Return the friction force at the state of a slip, N."""
    if s.mode == COASTING:
        return applied_force(p, s)
    coefficient, psi = _coefficients(law, p, s)
    return s.direction * p.normal_force * (coefficient + (s.excess * psi if s.mode == ACCELERATING else 0.0))


def correct_excess(law: SmoothLaw | None, p: Parameters, s: State, event: EventRow) -> None:
    """Let E make friction continuous with the smooth law, where the transition took its table."""
    if law is None or s.mode == STICK or s.excess == 0.0:
        return
    coefficient, psi = _coefficients(law, p, s)
    limit = abs(event.friction) / p.normal_force if p.normal_force > 0.0 else event.static
    s.excess = (limit - coefficient) / psi


def find_segment(law: SmoothLaw | None, p: Parameters, s: State) -> None:
    """Set the segment for psi, which no breakpoint keeps up to date with a smooth law."""
    if law is not None:
        s.segment = float(segment_above(p, s.direction, abs(s.velocity)))


def _coefficients(law: SmoothLaw | None, p: Parameters, s: State) -> tuple[float, float]:
    """Return mu_k and psi at the speed."""
    speed = abs(s.velocity)
    coefficient, _, psi, _ = friction_line(p, segment_above(p, s.direction, speed), speed)
    return (coefficient if law is None else law.coefficient(speed)), psi
