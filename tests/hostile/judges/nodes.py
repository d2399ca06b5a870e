# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""From a run to its nodes: the state at each event, at each border of the inputs, and at both ends."""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

from stickslip_sim.axis import CompliantContact
from stickslip_sim.core.types import Event, EventKind, Instant, Mode, Sample

from ..case import Parts, Run, borders, instant
from .extended import EPSILON, Long
from .friction import Tables
from .inputs import axis_at


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
    excess, mode = (Long(0), Long(0)), Mode.STICK
    stretches = [(run.at_start, run.start), *run.stretches]
    for events, sample in stretches:
        for event in events:
            # a contact that yielded leaves no excess
            excess = (Long(0), Long(0)) if mode == Mode.YIELDING else _excess(event, excess, tables)
            mode = event.mode
            yield _node_of_event(event, *excess, event.instant in jumps, parts)
        yield _node_of_sample(sample, *excess)


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


def _node_of_event(event: Event, excess: Any, excess_noise: Any, jumped: bool, parts: Parts) -> Node:
    axis = axis_at(parts, event.instant)
    contact, kinetic = axis.contact, axis.friction.along(event.direction).kinetic
    deflection = 0.0
    if isinstance(contact, CompliantContact) and (event.kind == EventKind.YIELD or event.velocity):
        deflection = (event.friction_force - contact.damping * event.velocity) / contact.stiffness
    elif isinstance(contact, CompliantContact) and event.mode == Mode.STICK and not contact.undeflected:
        deflection = event.direction * axis.normal_force * kinetic.coefficients[0] / contact.stiffness
    return Node(event.instant, event, event.mode, event.direction, event.position, event.velocity, event.drive_force,
                deflection, 0.0, excess, excess_noise, jumped)


def _node_of_sample(sample: Sample, excess: Any, excess_noise: Any) -> Node:
    return Node(sample.instant, None, sample.mode, sample.direction, sample.position, sample.velocity,
                sample.drive_force, sample.contact_deflection, sample.rest_time, excess,
                excess_noise, True)
