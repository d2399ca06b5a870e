# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Statement: the contact changes the course of the motion not essentially."""

from collections.abc import Sequence
from dataclasses import replace

from ..axis import Axis, CompliantContact, RigidContact
from ..runs import Run
from ..simulation.cycles import Cycle
from .long_runs import last_cycles, lasts, longest_period
from .look import look_at
from .statement import Finding, Statement, found, not_applicable

PAPER_CONTACT = CompliantContact(5.0e6, 15_000.0)   # N/m, N s/m
_NOT_ESSENTIALLY = 0.1                              # relative, of every figure
_FIGURES = {'period': 'period', 'stick time': 'stick_time', 'slip time': 'slip_time', 'jump': 'jump',
            'peak speed': 'peak_speed', 'break-away force': 'break_away_force'}


def _finding(run: Run, _: Sequence[object]) -> Finding:
    """Compare the limit cycles of this axis with a rigid and with a compliant contact."""
    axis, inputs = run.scene.axis, look_at(run).steady
    if axis.friction.excess is None:
        return not_applicable('said of the acceleration-dependent characteristic only')
    if inputs is None:
        return not_applicable('drive or force are not constant')
    if not lasts(run.cycles(), run.end):
        return not_applicable(f'stick-slip does not last: {len(run.cycles())} complete cycles')
    rigid, compliant = (last_cycles(replace(axis, contact=contact), run.scene.initial, inputs,
                                    longest_period(run.cycles())) for contact in (RigidContact(), _compliant(axis)))
    if not rigid or not compliant:
        return found(False, 'stick-slip lasts with one of the two contacts only')
    changes = {name: _change(rigid[-1], compliant[-1], field) for name, field in _FIGURES.items()}
    largest = max(abs(change) for change in changes.values())
    added = axis.drive_stiffness / _compliant(axis).stiffness
    text = f'the contact adds {100.0 * added:.3g} % to the compliance; limit cycle against that of a rigid contact: '
    text += ', '.join(f'{name} {100.0 * change:+.3g} %' for name, change in changes.items())
    return found(largest <= _NOT_ESSENTIALLY, text, largest_change=largest, added_compliance=added,
                 **{_FIGURES[name]: change for name, change in changes.items()})


def _compliant(axis: Axis) -> CompliantContact:
    """Return the compliant contact of the axis, or the paper's."""
    return axis.contact if isinstance(axis.contact, CompliantContact) else PAPER_CONTACT


def _change(rigid: Cycle, compliant: Cycle, field: str) -> float:
    before, after = getattr(rigid, field), getattr(compliant, field)
    return float(after / before - 1.0) if before else 0.0


CONTACT_EFFECT = Statement('the contact is not essential',
                           'The contact changes the course of the motion not essentially: every figure of the limit '
                           f'cycle by at most {100.0 * _NOT_ESSENTIALLY:g} %.', _finding)
