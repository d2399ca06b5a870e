# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""A contact that swings without loss: after a period it touches its limit again, and holds.

With mu_s = mu_k(0), no damper and inputs at rest, the contact force starts on the limit at an arrest and moves inwards.
It is back there after each whole period, exactly, and never beyond: what breaks away then is invented.  No arithmetic
can know, not even that of the reference; the argument does.
"""

import math
from itertools import pairwise

from stickslip_sim.axis import CompliantContact
from stickslip_sim.core.types import EventKind

from ..case import Find, Run

_BESIDE = 1e-6    # of a period


def judge(run: Run) -> None:
    """Raise Find where a contact that only touches its limit breaks away."""
    axis, drive, force = run.parts.axis, run.parts.drive, run.parts.force
    contact, friction = axis.contact, axis.friction
    if not isinstance(contact, CompliantContact) or contact.damping > 0.0 or axis.drive_damping > 0.0:
        return
    if contact.undeflected or contact.ends_by_drive:   # it does not begin on its limit
        return
    if any(drive.values) or any(drive.rates) or drive.sinusoids or force.sinusoids or any(force.rates) \
            or len(force.values) > 1 or run.parts.load is not None:
        return
    if any(side.static.initial != side.kinetic.coefficients[0] for side in friction.sides):
        return
    period = 2.0 * math.pi / math.sqrt((axis.drive_stiffness + contact.stiffness) / axis.mass)
    for before, event in pairwise(run.events):
        if before.kind == EventKind.STICK and event.kind == EventKind.BREAKAWAY:
            turns = ((event.second - before.second) + (event.fraction - before.fraction)) / period
            if abs(turns - round(turns)) < _BESIDE and round(turns) > 0:
                raise Find(f'a break-away at {event.time!r} s, {(turns - round(turns)) * period:.3g} s beside a touch '
                           f'of the limit, {round(turns)} periods after the arrest')
