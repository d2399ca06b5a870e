# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Statement: from several starts the motion converges to one stable limit cycle."""

import math
from collections.abc import Iterator, Sequence
from dataclasses import replace

from ..axis import Axis, CompliantContact, InitialState, RigidContact
from ..core.input_profile import constant
from ..core.types import Instant
from ..figures.catalogue import label_of
from ..figures.cycles import Cycle, cycle_figures
from ..figures.distance import cycle_difference
from ..runs import Run
from ..simulation.simulator import Simulator
from .look import look_at
from .run_part import SteadyInputs
from .statement import Finding, Statement, found, not_applicable

# Runs of the same axis from other starts or with another contact, by the exact solver, for statements that compare.

CYCLES = 100                                                          # that a run has to find its limit cycle
_IN_TURN = 8                                                          # slips that one limit cycle may consist of
_PATIENCE = 3.0                                                       # periods from a break-away to the end of a run


def last_cycles(axis: Axis, initial: InitialState, inputs: SteadyInputs, period: float) -> list[Cycle]:
    """Return the last few of about CYCLES cycles of `period` s; none when stick-slip does not last."""
    simulator = Simulator(axis, initial, constant(inputs.velocity), constant(inputs.force), accounting=True)
    end = Instant(float(int(CYCLES * period) + 1), 0.0)
    cycles = cycle_figures(simulator.advance(end))
    simulator.require_sound()
    return cycles[-_IN_TURN:] if lasts(cycles, end.seconds) else []


def lasts(cycles: Sequence[Cycle], end: float) -> bool:
    """Return whether there are cycles up to the end of a run (s), so that its last motion is stick-slip."""
    return bool(cycles) and end - cycles[-1].begin < _PATIENCE * longest_period(cycles)


def longest_period(cycles: Sequence[Cycle]) -> float:
    """Return the longest period among the last few cycles, s."""
    return max(cycle.period for cycle in cycles[-_IN_TURN:])


def distance(cycle: Cycle, others: Sequence[Cycle]) -> float:
    """Return the difference of a cycle to the one of others that is most like it."""
    return min(cycle_difference(cycle, other) for other in others)


def _inputs_of_a_cycle(run: Run) -> SteadyInputs | Finding:
    """Return the inputs of a run in which stick-slip lasts under constant ones; else why the statement says nothing."""
    inputs = look_at(run).steady
    if inputs is None:
        return not_applicable('drive or force are not constant')
    if not lasts(run.cycles(), run.end):
        return not_applicable(f'stick-slip does not last: {len(run.cycles())} complete cycles')
    return inputs


_SAME = 1e-6   # relative difference of two limit cycles that are one


def _limit_cycle_finding(run: Run, _: Sequence[object]) -> Finding:
    """Start the axis of this run in other ways, with the same inputs, and compare the cycles that it ends in."""
    inputs = _inputs_of_a_cycle(run)
    if isinstance(inputs, Finding):
        return inputs
    own = run.cycles()[-1]
    ends = {label: last_cycles(run.scene.axis, start, inputs, longest_period(run.cycles()))
            for label, start in _starts(run, own)}
    strays = [label for label, cycles in ends.items() if not cycles]
    if strays:
        return found(False, f'stick-slip does not last from {len(strays)} of {len(ends)} starts: {", ".join(strays)}',
                     starts=len(ends), without_cycle=len(strays))
    reference, *others = ends.values()
    spread = max(distance(reference[-1], cycles) for cycles in others)
    is_one, apart, end = spread <= _SAME, distance(own, reference), reference[-1]
    text = (f'{len(ends)} starts ({", ".join(ends)}) end after {CYCLES} cycles in {"one" if is_one else "several"}, '
            f'{spread:.1g} apart; period {end.period:.6g} s, jump {end.jump * 1e3:.6g} mm; the last of the '
            f'{len(run.cycles())} of this run is {apart:.1g} from it')
    return found(is_one, text, starts=len(ends), spread=spread, period=end.period, jump=end.jump, own_difference=apart)


def _starts(run: Run, own: Cycle) -> Iterator[tuple[str, InitialState]]:
    """Yield starts at rest, for any time before, and in motion, both ways."""
    rests = [0.0, 0.5 * own.stick_time]
    if run.scene.axis.friction.static.bounded:
        rests.append(math.inf)
    for rest in rests:
        yield f'rested {rest:.3g} s', InitialState(rest_time=rest)
    for share in (-0.5, 0.5, 2.0):
        velocity = share * own.peak_speed
        yield f'at {velocity * 1e3:.3g} mm/s', InitialState(velocity=velocity, rest_time=0.0)


LIMIT_CYCLE = Statement('stable limit cycle', 'From several starts the motion converges to one stable limit cycle.',
                        _limit_cycle_finding)


# Statement: the contact changes the course of the motion not essentially.

PAPER_CONTACT = CompliantContact(5.0e6, 15_000.0)   # N/m, N s/m
_NOT_ESSENTIALLY = 0.1                              # relative, of every figure
_FIGURES = ('period', 'stick_time', 'slip_time', 'jump', 'peak_speed', 'break_away_force')


def _contact_effect_finding(run: Run, _: Sequence[object]) -> Finding:
    """Compare the limit cycles of this axis with a rigid and with a compliant contact."""
    axis = run.scene.axis
    if axis.friction.excess is None:
        return not_applicable('said of the acceleration-dependent characteristic only')
    inputs = _inputs_of_a_cycle(run)
    if isinstance(inputs, Finding):
        return inputs
    rigid, compliant = (last_cycles(replace(axis, contact=contact), run.scene.initial, inputs,
                                    longest_period(run.cycles())) for contact in (RigidContact(), _compliant(axis)))
    if not rigid or not compliant:
        return found(False, 'stick-slip lasts with one of the two contacts only')
    changes = {name: _change(rigid[-1], compliant[-1], name) for name in _FIGURES}
    largest = max(abs(change) for change in changes.values())
    added = axis.drive_stiffness / _compliant(axis).stiffness
    text = f'the contact adds {100.0 * added:.3g} % to the compliance; limit cycle against that of a rigid contact: '
    text += ', '.join(f'{label_of(name)} {100.0 * change:+.3g} %' for name, change in changes.items())
    return found(largest <= _NOT_ESSENTIALLY, text, largest_change=largest, added_compliance=added, **changes)


def _compliant(axis: Axis) -> CompliantContact:
    """Return the compliant contact of the axis, or the paper's."""
    return axis.contact if isinstance(axis.contact, CompliantContact) else PAPER_CONTACT


def _change(rigid: Cycle, compliant: Cycle, field: str) -> float:
    before, after = getattr(rigid, field), getattr(compliant, field)
    return float(after / before - 1.0) if before else 0.0


CONTACT_EFFECT = Statement('the contact is not essential',
                           'The contact changes the course of the motion not essentially: every figure of the limit '
                           f'cycle by at most {100.0 * _NOT_ESSENTIALLY:g} %.', _contact_effect_finding)
