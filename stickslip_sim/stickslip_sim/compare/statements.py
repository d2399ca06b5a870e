# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The statements of the paper: the one list that reports and tests go by."""

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from enum import Enum
from itertools import chain
from typing import Any, NamedTuple

import numpy as np

from ..axis import Axis, CompliantContact, InitialState, RigidContact
from ..core.arrays import Numbers
from ..core.input_profile import constant
from ..core.types import Event, EventKind, Instant, Mode
from ..figures.catalogue import label_of
from ..figures.cycles import Cycle, cycle_figures
from ..figures.distance import cycle_difference
from ..figures.slips import breaks_away, complete_slips, complete_sticks
from ..runs import Run
from ..runs.run import kept
from ..simulation.simulator import Simulator
from .look import APPLIED, RunLook, RunPart, SteadyInputs, Watch, look_at, steady_inputs, watched, within
from .ring_down import RING_DOWN, SLIP_PEAKS, RingDown, closed_form, latest_ringing, slip_peaks

# What the paper says, as something that holds on a run, or not.

class StatementOutcome(Enum):
    """What comes of a statement."""

    HOLDS = 'holds'
    FAILS = 'does not hold'
    NOT_APPLICABLE = 'not applicable'


class Finding(NamedTuple):
    """What was found: the outcome, why in one line, and the numbers (SI)."""

    outcome: StatementOutcome
    text: str
    figures: dict[str, float]


class Statement(NamedTuple):
    """One statement of the paper, in our words, and the function that finds whether it holds.

    That has what the `watch` found of each part of the run.
    """

    name: str
    text: str
    finding: Callable[[Run, Sequence[Any]], Finding]
    watch: Watch | None = None


def found(holds: bool, text: str, **figures: float) -> Finding:
    """Return the finding on a statement that applies."""
    return Finding(StatementOutcome.HOLDS if holds else StatementOutcome.FAILS, text, figures)


def not_applicable(reason: str, **figures: float) -> Finding:
    """Return the finding on a statement that this run has nothing to say about."""
    return Finding(StatementOutcome.NOT_APPLICABLE, reason, figures)


# Statement: after a slip the slider oscillates a little, and soon no more, with the contact only.

_SMALL = 0.1       # of the longest slip's travel
_VANISHED = 0.05   # of the largest acceleration is left in the last quarter of a stick
_LONG = 5.0        # time constants that a stick must last for the oscillation to have vanished
_SAMPLES = 8       # in the first period
_VISIBLE = 1e-3    # of the largest acceleration: what is smaller is no swing


class _Ringing(NamedTuple):
    """The motion in one stick, after a slip of `travel` m."""

    travel: float
    amplitude: float   # m, from where the slider stands to where it comes to rest
    swings: int        # changes of the sign of the acceleration
    rest: float        # share of the largest acceleration that is left in the last quarter


class _SticksSeen(NamedTuple):
    """The motion in the sticks of a part that are complete: how a contact rings there, the largest speeds (m/s)."""

    rings: list[_Ringing]
    speeds: list[float]


def sticks_in(part: RunPart) -> _SticksSeen:
    """Look at the motion in each stick: with a compliant contact in those after a complete slip that show it."""
    ring, sticks = closed_form(part.scene.axis), complete_sticks(part.events)
    if ring is None:
        return _SticksSeen([], [float(np.abs(_part(part, *stick, 'velocity')).max(initial=0.0)) for stick in sticks])
    begins = {stop: begin for begin, stop in complete_slips(part.events)} if ring.damped_frequency else {}
    return _SticksSeen([_ringing(part, begins[stop], stop, end) for stop, end in sticks
                        if stop in begins and _is_fit(part, ring, begins[stop], stop, end)], [])


def _oscillation_finding(run: Run, seen: Sequence[_SticksSeen]) -> Finding:
    """Return what comes of the motion in the sticks."""
    ring = closed_form(run.scene.axis)
    if not isinstance(run.scene.axis.contact, CompliantContact) or ring is None:
        return _without_contact(run, list(chain(*(part.speeds for part in seen))))
    if ring.damped_frequency == 0.0:
        return not_applicable(f'the contact is overdamped: damping ratio {ring.damping_ratio:.4g}')
    rings = list(chain(*(part.rings for part in seen)))
    if not rings:
        return not_applicable('no slip and stick with constant inputs, long enough for the oscillation to vanish and '
                              'sampled finely enough to show it')
    share = max(each.amplitude for each in rings) / max(each.travel for each in rings)
    rest, swings, last = max(each.rest for each in rings), min(each.swings for each in rings), rings[-1]
    text = (f'{len(rings)} sticks, each with at least {swings} swings of at most {100.0 * share:.2g} % of a slip '
            f'({last.amplitude * 1e3:.3g} mm in the last); at most {100.0 * rest:.1g} % left in the last quarter')
    return found(swings >= 2 and share <= _SMALL and rest <= _VANISHED, text, sticks=len(rings), swings=swings,
                 amplitude=last.amplitude, amplitude_ratio=share, remaining_ratio=rest)


def _without_contact(run: Run, speeds: Sequence[float]) -> Finding:
    """Return what comes of the largest speeds in the sticks of a rigid contact: there must be no motion."""
    if not any(event.kind == EventKind.STICK for event in run.events):
        return not_applicable('no slip ends in this run')
    moving = max(speeds, default=0.0)
    return found(moving == 0.0, f'rigid contact: none; the largest speed in {len(speeds)} sticks is {moving:g} m/s',
                 sticks=len(speeds), largest_speed=moving)


def _is_fit(part: RunPart, ring: RingDown, begin: Event, stop: Event, end: Event) -> bool:
    """Whether the stick lasts, under the inputs of the slip before, and is sampled finely enough to see it swing."""
    times = part.samples['time']
    first, last = np.searchsorted(times, (stop.time, stop.time + 1.0 / ring.damped_frequency))
    return ((end.time - stop.time) * ring.decay >= _LONG and last - first >= _SAMPLES
            and steady_inputs(part, begin.time, end.time) is not None)


def _ringing(part: RunPart, begin: Event, stop: Event, end: Event) -> _Ringing:
    time, position, velocity, acceleration = (
        _part(part, stop, end, name) for name in ('time', 'position', 'velocity', 'acceleration'))
    settled = position - position[-1] - velocity[-1] * (time - time[-1])   # from the line along which it drifts
    size = np.abs(acceleration)
    signs = np.sign(acceleration[size > _VISIBLE * size.max()])
    last_quarter = time > time[-1] - 0.25 * (time[-1] - time[0])
    return _Ringing(abs(stop.position - begin.position), float(np.abs(settled).max()),
                    int(np.count_nonzero(np.diff(signs))), float(size[last_quarter].max() / size.max()))


def _part(part: RunPart, begin: Event, end: Event, name: str) -> Numbers:
    first, last = np.searchsorted(part.samples['time'], (begin.time, end.time))
    return part.samples[name][first:last]


OSCILLATION = Statement('oscillation after a slip',
                        'After the end of a slip there is a small, vanishing oscillation, with the contact only.',
                        _oscillation_finding, sticks_in)


# Statement: with the contact, the friction force is continuous from stick to slip and back.

_JUMP = 0.01     # of the largest friction force: less is none
_EXTRAPOLATED = 3     # that the force just after an event is extrapolated from
_REACH = 0.15    # of a period of the contact's ring-down: how far they may reach


class _Jumps(NamedTuple):
    """By how much the friction force jumps at each break-away and at each standstill, N."""

    there: list[float]
    back: list[float]


def jumps_in(part: RunPart) -> _Jumps:
    """Compare the friction force just before and just after each break-away and each standstill."""
    return _Jumps(*(list(_jumps(part, kind)) for kind in (EventKind.BREAKAWAY, EventKind.STICK)))


def _continuity_finding(run: Run, jumps: Sequence[_Jumps]) -> Finding:
    """Return what comes of the jumps of the friction force."""
    axis, seen = run.scene.axis, look_at(run)
    there, back = (list(chain(*each)) for each in zip(*jumps))
    if not there and not back:
        return not_applicable('no break-away and no standstill that is sampled finely enough')
    at_break_away, at_standstill = max(there, default=0.0), max(back, default=0.0)
    lowest, highest = seen.ranges['friction_force']
    largest = max(abs(lowest), abs(highest))
    text = (f'largest jump at {len(there)} break-aways {at_break_away:.2g} N, at {len(back)} standstills '
            f'{at_standstill:.2g} N; the friction force reaches {largest:.4g} N')
    figures = {'jump_at_break_away': at_break_away, 'jump_at_standstill': at_standstill,
               'largest_friction_force': largest}
    if not isinstance(axis.contact, CompliantContact) or axis.friction.excess is None:
        return not_applicable(f'without a compliant contact and acceleration dependence: {text}', **figures)
    if seen.steady is None:
        return not_applicable(f'said of a constant drive; under another a break-away may come while the slider gets '
                              f'slower, and friction then drops to the driving forces: {text}', **figures)
    return found(max(at_break_away, at_standstill) <= _JUMP * largest, text, **figures)


def _jumps(part: RunPart, kind: EventKind) -> Iterator[float]:
    """Yield by how much the friction force jumps at each event of a kind, N; the next part has that of the last."""
    times, ring = part.samples['time'], closed_form(part.scene.axis)
    reach = _REACH / ring.frequency if ring else math.inf
    ends = [event.time for event in part.events[1:]]
    for event, end in zip(part.events, ends if part.is_closed else [*ends, part.end]):
        if event.kind != kind or (kind == EventKind.BREAKAWAY and event.mode == Mode.STICK):
            continue
        first = int(np.searchsorted(times, event.time))
        if first + _EXTRAPOLATED <= len(times) and times[first + _EXTRAPOLATED - 1] <= min(end, event.time + reach):
            yield abs(_just_after(part, event, first) - event.friction_force)


def _just_after(part: RunPart, event: Event, first: int) -> float:
    """Return the friction force after an event: of the parabola through the next samples (the first may be at it)."""
    rows = slice(first, first + _EXTRAPOLATED)
    offsets = part.samples['time'][rows] - event.time
    force = part.samples['friction_force'][rows]
    weights = [np.prod([b / (b - a) for b in offsets if b != a]) for a in offsets]
    return float(np.dot(weights, force))


CONTINUITY = Statement('continuous friction force',
                       'With the contact, the friction force is continuous from stick to slip and back.',
                       _continuity_finding, jumps_in)


# Statement: from several starts the motion converges to one stable limit cycle.

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


# Statement: within a slip, friction over velocity has two values.

_GAP = 0.01   # of the lower value: less is one value


class _Gap(NamedTuple):
    """The friction at one speed of a slip, on both branches."""

    speed: float   # m/s
    upper: float   # N, accelerating
    lower: float   # N, decelerating


def branch_gaps(part: RunPart) -> list[_Gap]:
    """Compare both branches of each slip half-way between the speeds of its break-away and its peak."""
    if part.scene.axis.friction.excess is None:
        return []
    return [gap for slip in complete_slips(part.events) if _is_raised(part, *slip) and (gap := _gap(part, *slip))]


def _two_values_finding(run: Run, found_gaps: Sequence[list[_Gap]]) -> Finding:
    """Return what comes of the gaps between the branches."""
    if run.scene.axis.friction.excess is None:
        return not_applicable('without acceleration dependence friction has one value at each velocity')
    if run.scene.normal_load is not None:
        return not_applicable('the normal force varies, and friction with it')
    gaps = list(chain(*found_gaps))
    if not gaps:
        return not_applicable('no complete slip with a break-away above kinetic friction')
    least = min(gap.upper / gap.lower - 1.0 if gap.lower > 0.0 else np.inf for gap in gaps)
    last = gaps[-1]
    text = (f'{len(gaps)} slips, the upper value at least {100.0 * least:.3g} % above the lower; in the last one, at '
            f'{last.speed * 1e3:.4g} mm/s, {last.upper:.4g} N accelerating and {last.lower:.4g} N decelerating')
    return found(least > _GAP, text, slips=len(gaps), least_gap_ratio=least, speed=last.speed,
                 accelerating_force=last.upper, decelerating_force=last.lower)


def _is_raised(part: RunPart, begin: Event, _: Event) -> bool:
    """Whether static friction at the break-away is above kinetic friction, so that there is a second branch."""
    kinetic = part.scene.axis.friction.along(begin.direction).kinetic.coefficient(abs(begin.velocity))
    return begin.kind == EventKind.BREAKAWAY and begin.static_coefficient > (1.0 + _GAP) * kinetic


def _gap(part: RunPart, begin: Event, end: Event) -> _Gap | None:
    """Return the friction of both branches at one speed, None when a branch has no two points."""
    columns = within(part, begin.time, end.time)
    speed, force = np.abs(columns['velocity']), np.abs(columns['friction_force'])
    branches = [columns['mode'] == mode for mode in (Mode.ACCELERATING, Mode.DECELERATING)]
    if min(branch.sum() for branch in branches) < 2:
        return None
    middle = 0.5 * (abs(begin.velocity) + max(speed[branch].max() for branch in branches))
    upper, lower = (float(np.interp(middle, *_rising(speed[branch], force[branch]))) for branch in branches)
    return _Gap(float(middle), upper, lower)


def _rising(speed: Numbers, force: Numbers) -> tuple[Numbers, Numbers]:
    order = np.argsort(speed, kind='stable')
    return speed[order], force[order]


TWO_VALUES = Statement('two-valued friction',
                       'Within a slip the friction force over velocity has two values: more while the slider '
                       'accelerates than while it decelerates.', _two_values_finding, branch_gaps)


# Statement: the initial displacements correspond to the stick balance condition.

_ROUNDING = 1e-9   # relative: rounding of the forces


def _start_balance_finding(run: Run, _: Sequence[object]) -> Finding:
    """Compare the forces that displacements make at the start: of the drive spring, of the contact, and from outside.

    The drive damper is left out: a drive that sets off at a velocity has its force from the first instant on.
    """
    if run.begin != 0.0:
        return not_applicable(f'the recording begins at t = {run.begin:g} s, in mid-run')
    first = look_at(run).first
    if Mode(int(first['mode'])) != Mode.STICK:
        return not_applicable(f'the run begins in slip, at {first["velocity"]:.4g} m/s')
    axis = run.scene.axis
    spring = axis.drive_stiffness * (first['drive_position'] - first['position'])
    outside = first[APPLIED]
    held = first['friction_force'] if isinstance(axis.contact, CompliantContact) else spring + outside
    friction = axis.friction.along(held)
    static = friction.static.of_stick(0, friction.kinetic.coefficients[0])
    limit = run.scene.normal_force.value_at(0.0) * static.coefficient(first['rest_time'])
    open_by = abs(spring + outside - held)
    text = f'drive spring {spring:.6g} N, outside {outside:.6g} N, contact {held:.6g} N of at most {limit:.6g} N'
    balanced = open_by <= _ROUNDING * max(abs(spring), abs(outside), limit) and abs(held) <= (1.0 + _ROUNDING) * limit
    return found(balanced, text, spring_force=spring, external_force=outside, contact_force=held, limit=limit)


START_BALANCE = Statement('start in balance', 'The initial displacements correspond to the stick balance condition.',
                          _start_balance_finding)


# Statement: a long rest raises the first break-away to mu_s(inf) N.

_EQUAL = 1e-3   # relative; the exact solver has rounding only, others their step


def _long_rest_finding(run: Run, _: Sequence[object]) -> Finding:
    """Compare the first break-away of a run that begins after prolonged rest with those that follow."""
    axis = run.scene.axis
    break_aways = [event for event in run.events if breaks_away(event)]
    if not break_aways:
        return not_applicable('no break-away')
    first, *later = break_aways
    law = axis.friction.along(first.friction_force).static
    if not math.isinf(first.rest_time):
        return not_applicable(f'the first break-away follows a rest of {first.rest_time:.4g} s, not a prolonged one')
    if law.coefficient(math.inf) == law.initial or axis.normal_force == 0.0:
        return not_applicable('static friction does not grow with the rest time')
    if law.scatter is not None:
        return not_applicable('static friction scatters from stick to stick')
    if run.scene.normal_load is not None:
        return not_applicable('the normal force varies, and the limit with it')
    limit, force = law.coefficient(math.inf) * axis.normal_force, abs(first.friction_force)
    next_force = max((abs(event.friction_force) for event in later), default=0.0)
    text = f'first break-away at {force:.6g} N, mu_s(inf) N = {limit:.6g} N'
    text += f'; the highest of {len(later)} later ones is {next_force:.6g} N' if later else ''
    is_raised = abs(force - limit) <= _EQUAL * limit and next_force <= (1.0 + _EQUAL) * force
    return found(is_raised, text, first_force=force, limit=limit, highest_later_force=next_force)


LONG_REST = Statement('long rest', 'A long rest raises the first break-away to mu_s(inf) N.', _long_rest_finding)


STATEMENTS: tuple[Statement, ...] = (START_BALANCE, CONTINUITY, TWO_VALUES, OSCILLATION, LIMIT_CYCLE, CONTACT_EFFECT,
                                     LONG_REST)


def findings_on(run: Run) -> list[tuple[Statement, Finding]]:
    """Return what comes of every statement on a run."""
    if run.is_changed:
        changed = not_applicable('parameters were changed while it ran: it is no run of one axis')
        return [(statement, changed) for statement in STATEMENTS]
    found = observed(run).found
    return [(statement, statement.finding(run, found.get(statement.name, ()))) for statement in STATEMENTS]


@kept
def observed(run: Run) -> RunLook:
    """Look once through a run for all that is said of it."""
    return watched(run, {**{statement.name: statement.watch for statement in STATEMENTS if statement.watch},
                         RING_DOWN: latest_ringing, SLIP_PEAKS: slip_peaks})
