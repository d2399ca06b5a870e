# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""From a run to its nodes, and what friction and contact do from each of them on.

A node is the state at an event, at a border of the inputs, or at an end.  From there a mode has a force, makes the
slider stiffer and damped, and has guards; what is wrong between two nodes is said in one way.
"""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any

from stickslip_sim.axis import Axis, CompliantContact
from stickslip_sim.core.types import Event, EventKind, Instant, Mode, Sample
from stickslip_sim.proof.axes import instant

from ..case import Run, borders
from .motion import EPSILON, Long, Table, Tables, axis_at

SLIP = Mode.ACCELERATING, Mode.DECELERATING
F, U, Y, V, ONE, WAVE = range(6)   # places in z, see segments.py
_NONE = Long(0)


@dataclass
class Node:
    """The state at an event or border, with the mode after it."""

    at: Instant
    event: Event | None
    mode: Mode
    direction: int
    position: float
    velocity: float
    drive_force: float
    deflection: float
    rest_time: float
    excess: Any
    excess_noise: Any
    new_force: bool     # an input may have jumped at this instant
    stick: int          # index of the stick of which mu_s is, where it scatters
    unbalanced: Any     # N, by which rounding of a speed on steep friction has set the spring apart from m a

    @property
    def label(self) -> str:
        """What stands here, for people."""
        return f'{self.event.kind.name} at {self.at.seconds!r} s' if self.event else f'state at {self.at.seconds!r} s'


def nodes(run: Run, tables: Tables) -> Iterator[Node]:
    """Yield the nodes of a run in the order of time."""
    parts = run.parts
    jumps = {Instant(0.0, 0.0)}
    for border in borders(parts):     # the end, too: an input may jump there
        jumps.add(instant(border))
    excess, mode, unbalanced, stick = (Long(0), Long(0)), Mode.STICK, Long(0), 0
    stretches = [(run.at_start, run.start), *run.stretches]
    for events, sample in stretches:
        for event in events:
            # a contact that yielded leaves no excess
            excess = (Long(0), Long(0)) if mode == Mode.YIELDING else _excess(event, excess, tables)
            mode = event.mode
            stick += event.kind == EventKind.REVERSE or mode == Mode.STICK
            axis = axis_at(parts, event.instant)
            unbalanced = _unbalanced(event, unbalanced, excess[0], tables, axis)
            yield _node_of_event(event, *excess, event.instant in jumps, axis, stick, unbalanced)
        yield _node_of_sample(sample, *excess, stick, unbalanced)


def _excess(event: Event, excess: tuple[Any, Any], tables: Tables) -> tuple[Any, Any]:
    """Return E from this event on, and its rounding."""
    if event.kind not in (EventKind.BREAKAWAY, EventKind.REVERSE):
        return excess
    speed, table = abs(event.velocity), tables.along(event.direction)
    segment = table.segment(speed, True)
    psi, coefficient = table.psi(segment).of(Long(speed)), table.kinetic(segment).of(Long(speed))
    limit = Long(event.static_coefficient)
    if not (table.has_branches and psi > 0 and limit >= coefficient):
        return Long(0), Long(0)
    return (limit - coefficient) / psi, 4 * EPSILON * (4 * (limit - coefficient) + limit + abs(
        table.kinetic(segment).slope * speed)) / psi + EPSILON * (limit - coefficient) * abs(
            table.psi(segment).slope * speed) / (psi * psi)


def _unbalanced(event: Event, before: Any, excess: Any, tables: Tables, axis: Axis) -> Any:
    """Return how far the spring may be from m a and friction, N, beyond rounding of forces: since the last rest.

    A breakpoint comes when the speed is there, to rounding; on a steep piece that is a time in which the spring moves.
    """
    if event.mode not in SLIP:
        return Long(0)
    if event.kind != EventKind.KNOT:
        return before
    speed, table = abs(event.velocity), tables.along(event.direction)
    sides = [table.segment(speed, rising) for rising in (False, True)]
    steepest = max(abs(table.kinetic(side).slope) + abs(excess * table.psi(side).slope) for side in sides)
    return max(before, 2 * EPSILON * Long(axis.normal_force) * steepest * Long(speed))


def _node_of_event(event: Event, excess: Any, excess_noise: Any, jumped: bool, axis: Axis, stick: int, unbalanced: Any
                   ) -> Node:
    contact, kinetic = axis.contact, axis.friction.along(event.direction).kinetic
    deflection = 0.0
    if isinstance(contact, CompliantContact) and (event.kind == EventKind.YIELD or event.velocity):
        deflection = (event.friction_force - contact.damping * event.velocity) / contact.stiffness
    elif isinstance(contact, CompliantContact) and event.mode == Mode.STICK and not contact.undeflected:
        deflection = event.direction * axis.normal_force * kinetic.coefficients[0] / contact.stiffness
    return Node(event.instant, event, event.mode, event.direction, event.position, event.velocity, event.drive_force,
                deflection, 0.0, excess, excess_noise, jumped, stick, unbalanced)


def _node_of_sample(sample: Sample, excess: Any, excess_noise: Any, stick: int, unbalanced: Any) -> Node:
    return Node(sample.instant, None, sample.mode, sample.direction, sample.position, sample.velocity,
                sample.drive_force, sample.contact_deflection, sample.rest_time, excess,
                excess_noise, True, stick, unbalanced)


_GUARDS = {Mode.STICK: ('the static limit', 'the static limit backwards'),
           Mode.COASTING: ('the lower branch', 'the upper branch'),
           Mode.YIELDING: ('where the contact holds', 'where the slider turns'),
           Mode.ACCELERATING: ('the zero of the acceleration', 'the next breakpoint'),
           Mode.DECELERATING: ('the zero of the acceleration', 'the next breakpoint or standstill')}
_MET = {(Mode.COASTING, EventKind.ACCELERATE): 1, (Mode.COASTING, EventKind.DECELERATE): 0,
        (Mode.YIELDING, EventKind.STICK): 0, (Mode.YIELDING, EventKind.BREAKAWAY): 1,
        **{(mode, kind): 0 for mode in SLIP for kind in (EventKind.COAST, EventKind.ACCELERATE, EventKind.DECELERATE)},
        **{(mode, EventKind.KNOT): 1 for mode in SLIP},
        (Mode.DECELERATING, EventKind.STICK): 1, (Mode.DECELERATING, EventKind.REVERSE): 1}


def guard_met(mode: Mode, kind: EventKind) -> int | None:
    """Return the guard that an event of a moving slider meets, None when it cannot come in this mode."""
    return _MET.get((mode, kind))


def passed(begin: Node, end: Node, guard: int, by: float, bound: float, after: float, left: float) -> str:
    """Say that a guard was passed between two nodes."""
    return (f'{_GUARDS[begin.mode][guard]} was passed by {by:.6g} (bound {bound:.3g}) {after!r} s after {begin.label}, '
            f'{begin.mode.name}, and {left:.3g} s before {end.label}')


def impossible(begin: Node, end: Node) -> str:
    """Say that an event does not fit the mode before it."""
    return f'{end.label} cannot follow {begin.mode.name}'


def not_met(begin: Node, end: Node, value: float, bound: float) -> str:
    """Say that an event comes off its guard."""
    return (f'{end.label} comes where its guard is {value:.6g} and not 0 (bound {bound:.3g}; from {begin.label}, '
            f'{begin.mode.name})')


def elsewhere(begin: Node, end: Node, name: str, found: float, wanted: float, bound: float) -> str:
    """Say that a motion ends in another state."""
    return (f'{name} at {end.label} is {found!r} and not {wanted!r} (bound {bound:.3g}; from {begin.label}, '
            f'{begin.mode.name})')


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
