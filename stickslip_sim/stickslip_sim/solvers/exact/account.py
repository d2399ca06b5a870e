# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Keep the account of energy in the state: add up works and exchanges so that a run of any length loses nothing.

Each sum carries what rounding has lost of it (Neumaier, ZAMM 54, 1974).
"""

from ...axis.layout import CONTACT_EXCHANGE, PARAMETER_EXCHANGE, STORED_AT_START, SUMS, SUM_COUNT, THROUGHPUT
from ...core.jit import compiled, inlined
from .works import contact_energy, stored_energy, works


@compiled
def book_works(p, s, t):
    """Add the works from the anchor up to t, where the anchor is about to move."""
    throughput = 0.0
    for item, work in enumerate(works(p, s, t)):
        _add(s, SUMS + item, work)
        throughput += abs(work)
    _add(s, SUMS + THROUGHPUT, throughput)


@compiled
def book_contact(p, s, before):
    """Add the contact energy that a transition made appear or vanish; it was `before`, J."""
    _book(s, SUMS + CONTACT_EXCHANGE, contact_energy(p, s, 0.0) - before)


@compiled
def book_parameters(p, s, before):
    """Add what a change of parameters did to the stored energy; it was `before`, J."""
    _book(s, SUMS + PARAMETER_EXCHANGE, stored_energy(p, s, 0.0) - before)


@compiled
def read_account(p, s, t, out):
    """Fill a row of `energy.EnergyBalance`: the sums, and what came up to t after the anchor."""
    for item in range(SUM_COUNT):
        out[item] = s[SUMS + item] + s[SUMS + SUM_COUNT + item]
    throughput = out[THROUGHPUT]
    for item, work in enumerate(works(p, s, t)):
        out[item] += work
        throughput += abs(work)
    out[7] = stored_energy(p, s, t)
    out[8] = s[STORED_AT_START]
    out[9] = throughput


@compiled
def balance(p, s, t):
    """Return what the balance leaves open at t after the anchor, and what went through or is stored, J."""
    given = _sum(s, 0) + _sum(s, 1) + _sum(s, CONTACT_EXCHANGE) + _sum(s, PARAMETER_EXCHANGE)
    taken = _sum(s, 2) + _sum(s, 3) + _sum(s, 4)
    scale = _sum(s, THROUGHPUT)
    if t != 0.0:
        drive, external, friction, damper, contact = works(p, s, t)
        given += drive + external
        taken += friction + damper + contact
        scale += abs(drive) + abs(external) + abs(friction) + abs(damper) + abs(contact)
    stored = stored_energy(p, s, t)
    return abs((given - taken) - (stored - s[STORED_AT_START])), max(scale, max(stored, s[STORED_AT_START]))


@inlined
def _sum(s, item):
    return s[SUMS + item] + s[SUMS + SUM_COUNT + item]


@inlined
def _book(s, item, amount):
    _add(s, item, amount)
    _add(s, SUMS + THROUGHPUT, abs(amount))


@inlined
def _add(s, item, amount):
    before = s[item]
    after = before + amount
    s[item] = after
    s[item + SUM_COUNT] += (before - after) + amount if abs(before) >= abs(amount) else (amount - after) + before
