# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""What friction and contact do in each mode: their force, how stiff and damped it makes the slider, the guards."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from stickslip_sim.axis import Axis, CompliantContact
from stickslip_sim.core.types import Mode

from .extended import Long
from .friction import Table
from .nodes import Node

SLIP = Mode.ACCELERATING, Mode.DECELERATING
F, U, Y, V, ONE, WAVE = range(6)   # places in z, see segments.py
_NONE = Long(0)


@dataclass
class Resistance:
    """The force against the slider: `now` at a node, from there on offset + damping · u + stiffness · y."""

    now: Any
    lower: Mapping[int, Any]     # the guards, rows by the places in z
    upper: Mapping[int, Any]
    moves: bool = True
    offset: Any = _NONE
    damping: Any = _NONE
    stiffness: Any = _NONE
    coefficient: Any = _NONE     # of friction at the node
    slope_size: Any = _NONE      # of all that is added up to the slope of friction, or to the damping of the contact
    psi_slope: Any = _NONE


def resistance(axis: Axis, table: Table, begin: Node) -> Resistance:
    """Return what acts from a node on."""
    if begin.mode in SLIP:
        return _of_slip(Long(axis.normal_force), table, begin)
    if begin.mode == Mode.COASTING:
        return _of_coasting(Long(axis.normal_force), table, begin)
    if isinstance(axis.contact, CompliantContact):
        return _of_contact(axis.contact, begin)
    return Resistance(Long(0), {F: -1}, {F: 1}, moves=False)


def _of_slip(normal: Any, table: Table, begin: Node) -> Resistance:
    """Return σ N (μ + b (w − w₀)); the guards are the zero of the acceleration, and a breakpoint or standstill."""
    rising, sigma, speed = begin.mode == Mode.ACCELERATING, Long(begin.direction), abs(begin.velocity)
    segment = table.segment(speed, rising)
    kinetic, psi = table.kinetic(segment), table.psi(segment)
    coefficient, slope, slope_size = kinetic.of(Long(speed)), kinetic.slope, abs(kinetic.slope)
    if rising:
        coefficient += begin.excess * psi.of(Long(speed))
        slope += begin.excess * psi.slope
        slope_size += 4 * abs(begin.excess * psi.slope)
    way = sigma if rising else -sigma
    border = (-Long(table.breakpoints[segment]) if not rising else
              table.breakpoints[segment + 1] if segment + 1 < len(table.breakpoints) else Long('inf'))
    return Resistance(sigma * normal * coefficient, {F: way}, {U: -way, ONE: border},
                      offset=sigma * normal * (coefficient - slope * Long(speed)), damping=normal * slope,
                      coefficient=coefficient, slope_size=slope_size, psi_slope=psi.slope)


def _of_coasting(normal: Any, table: Table, begin: Node) -> Resistance:
    """Return the friction of coasting, which follows the drive; the guards are both branches."""
    sigma, speed = Long(begin.direction), abs(begin.velocity)
    segment = table.segment(speed, True)
    coefficient = table.kinetic(segment).of(Long(speed))
    band = normal * begin.excess * table.psi(segment).of(Long(speed))
    return Resistance(sigma * normal * coefficient, {F: sigma, ONE: -normal * coefficient},
                      {F: -sigma, ONE: normal * coefficient + band}, moves=False)


def _of_contact(contact: CompliantContact, begin: Node) -> Resistance:
    """Return the force of a contact that gives; the guards are the force that ends a stick, and the limit."""
    stiffness, damping = Long(contact.stiffness), Long(contact.damping)
    offset = stiffness * Long(begin.deflection)
    guard = {U: damping, Y: stiffness, ONE: offset, F: Long(contact.ends_by_drive)}   # F_d + F_e is that force and f
    return Resistance(offset + damping * Long(begin.velocity), {at: -share for at, share in guard.items()}, guard,
                      offset=offset, damping=damping, stiffness=stiffness, slope_size=damping)
