# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Keep the account of energy in the state: add up works and exchanges so that a run of any length loses nothing.

Each sum carries what rounding has lost of it (Neumaier, ZAMM 54, 1974).
"""

from ...axis.layout import Parameters
from ...axis.rows import EnergyRow
from ...axis.state_record import State
from ...core.hot_path import compiled, inlined
from .panels import Works
from .works import contact_energy, stored_energy, works


@compiled
def book_works(p: Parameters, s: State, t: float) -> None:
    """Add the works from the segment start up to t, where the next segment is about to start."""
    done = works(p, s, t)
    s.sums.drive, s.lost.drive = _added(s.sums.drive, s.lost.drive, done.drive)
    s.sums.external, s.lost.external = _added(s.sums.external, s.lost.external, done.external)
    s.sums.friction, s.lost.friction = _added(s.sums.friction, s.lost.friction, done.friction)
    s.sums.damper, s.lost.damper = _added(s.sums.damper, s.lost.damper, done.damper)
    s.sums.contact, s.lost.contact = _added(s.sums.contact, s.lost.contact, done.contact)
    _book_throughput(s, _size(done, 0.0))


@compiled
def book_contact(p: Parameters, s: State, before: float) -> None:
    """Add the contact energy that a transition made appear or vanish; it was `before`, J."""
    amount = contact_energy(p, s, 0.0) - before
    s.sums.contact_exchange, s.lost.contact_exchange = _added(s.sums.contact_exchange, s.lost.contact_exchange, amount)
    _book_throughput(s, abs(amount))


@compiled
def book_parameters(p: Parameters, s: State, before: float) -> None:
    """Add what a change of parameters did to the stored energy; it was `before`, J."""
    amount = stored_energy(p, s, 0.0) - before
    s.sums.parameter_exchange, s.lost.parameter_exchange = _added(s.sums.parameter_exchange, s.lost.parameter_exchange,
                                                                  amount)
    _book_throughput(s, abs(amount))


@compiled
def read_account(p: Parameters, s: State, t: float, out: EnergyRow) -> None:
    """Fill a row of `energy.EnergyBalance`: the sums, and what came up to t after the segment start."""
    done = works(p, s, t)
    out.drive = s.sums.drive + s.lost.drive + done.drive
    out.external = s.sums.external + s.lost.external + done.external
    out.friction = s.sums.friction + s.lost.friction + done.friction
    out.damper = s.sums.damper + s.lost.damper + done.damper
    out.contact = s.sums.contact + s.lost.contact + done.contact
    out.contact_exchange = s.sums.contact_exchange + s.lost.contact_exchange
    out.parameter_exchange = s.sums.parameter_exchange + s.lost.parameter_exchange
    out.stored = stored_energy(p, s, t)
    out.stored_at_start = s.stored_at_start
    out.throughput = _size(done, s.sums.throughput + s.lost.throughput)


@compiled
def balance(p: Parameters, s: State, t: float) -> tuple[float, float]:
    """Return what the balance leaves open at t after the segment start, and what went through or is stored, J."""
    given = (s.sums.drive + s.lost.drive) + (s.sums.external + s.lost.external)
    given += s.sums.contact_exchange + s.lost.contact_exchange
    given += s.sums.parameter_exchange + s.lost.parameter_exchange
    taken = (s.sums.friction + s.lost.friction) + (s.sums.damper + s.lost.damper) + (s.sums.contact + s.lost.contact)
    scale = s.sums.throughput + s.lost.throughput
    if t != 0.0:
        done = works(p, s, t)
        given += done.drive + done.external
        taken += done.friction + done.damper + done.contact
        scale += _size(done, 0.0)
    stored = stored_energy(p, s, t)
    return abs((given - taken) - (stored - s.stored_at_start)), max(scale, max(stored, s.stored_at_start))


@inlined
def _size(done: Works, total: float) -> float:
    """Return a total and the magnitudes of the works, added one by one."""
    return total + abs(done.drive) + abs(done.external) + abs(done.friction) + abs(done.damper) + abs(done.contact)


@inlined
def _book_throughput(s: State, amount: float) -> None:
    s.sums.throughput, s.lost.throughput = _added(s.sums.throughput, s.lost.throughput, amount)


@inlined
def _added(total: float, lost: float, amount: float) -> tuple[float, float]:
    """Return a sum, and what rounding has lost of it, after adding an amount."""
    after = total + amount
    return after, lost + ((total - after) + amount if abs(total) >= abs(amount) else (amount - after) + total)
