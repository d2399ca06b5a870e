# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The extremes in their order, and how they are measured one after another."""

import json
import math
import time
from collections.abc import Collection, Iterator, Sequence

from ..core.errors import InputError
from ..report.model import Section, Table
from ..report.text import markdown_lines
from ..report.values import versions
from .cases.bad_commands import bad_commands
from .cases.bits import events_inside_a_tick, mirrored_and_scaled, run_twice, splits
from .cases.energy_balance import cost_of_the_account, energy_balance
from .cases.estimates import answers, estimates, orders
from .cases.guards import guards_at_their_limit, meeting_events, near_critical, shaken, steep_segments, touched_limits
from .cases.linear_modes import edges_of_the_modes, unstable_slip
from .cases.scales import late_far_slow_fast, stiff_contacts
from .cases.sticks import at_the_limit, blows, coasting, grazing, rest_times, ringing, year_long_hold
from .judges import Extreme, ExtremeResult, Setup

EXTREMES = (
    Extreme('X1', 'grazing break-away: a slow sine whose force peak passes the limit by 1e-4, 1e-6, 1e-12, or fails to',
            'CVODE 55, DOP853 (1e-9) 52, Drake 60 of 60 missed at 1e-6; heyoka none',
            'none missed, none invented', grazing),
    Extreme('X2', 'a blow of 2 ms and 33 kN on a stuck axis at a random instant',
            'RK45 51, DOP853 45, CVODE 60 of 60 missed', 'none missed, instants within 1e-12 s', blows),
    Extreme('X3', 'a guard exactly at its limit on entry: mu_s(0) = mu_k(0)',
            'scipy fires the same event until its cap; a crossing that starts at zero is an open issue of '
            'DifferentialEquations.jl and SUNDIALS', 'progress at every event', guards_at_their_limit),
    Extreme('X4', 'peak speed below v_gr, the two branches apart',
            'naive switching chatters: events grow as 1/dt, and it converges to another trajectory',
            'the coasting closure; independent of any step, <= 1e-12', coasting),
    Extreme('X5', 'break-away while the contact still rings (5 to 20 mm/s)',
            'every scipy setting returned the same wrong number of events', 'the events of the reference, <= 1e-12',
            ringing),
    Extreme('X6', 'the unstable slip mode, net damping −2867 and −14639 N s/m, under fixed steps',
            'implicit Euler: stick-slip vanishes above 4.8 ms; explicit Euler grows 20 % too fast at 1 ms',
            'error of the growth <= 1e-12 at any step', unstable_slip),
    Extreme('X7', 'a year at 10, 50, 90, 99 % of the static limit',
            'MuJoCo creeps 0.25 to 2.4 mm/s by default; friction in Drake needs slip',
            'no drift; the next break-away within 1e-12', year_long_hold),
    Extreme('X8', 'contact stiffness x 1e3 to 1e9, contact damping 0 and x 1e6, mass 1 g and 1e6 kg',
            'explicit steps shrink as 1/sqrt(c_c)', 'accuracy <= 1e-12; the same cost of an event (at most x 3)',
            stiff_contacts),
    Extreme('X9', 'critical damping to 1e-15, no spring, no damper, over-damped, negative damping',
            'cancellation, NaN', '<= 1e-12', edges_of_the_modes),
    Extreme('X10', 'rest-time constants 1e-12 to 1e12 s, rest 1e-9 to 1e9 s', 'cancellation in 1 − exp(−t/tau)',
            '<= 1e-14 in mu_s', rest_times),
    Extreme('X11', 'feed 1 nm/s to 1 m/s; clock at 1e9 s; position at 1e6 m',
            'absolute time and position eat the digits', 'times between events within 1e-11 s', late_far_slow_fast),
    Extreme('X12', 'two events at one instant; an event one ULP from a tick', 'order-dependent results, double firing',
            'independent of order and ticks', meeting_events),
    Extreme('X13', 'one call, a million calls, random splits', 'results depend on the split',
            'the same events to the bit; positions within 1e-13 m', splits),
    Extreme('X14', 'ten thousand events inside one tick', 'stops or spins',
            'bounded time, a named refusal, a valid state', events_inside_a_tick),
    Extreme('X15', 'fixed-step solvers across events', 'order lost', 'the measured order is the declared one', orders),
    Extreme('X16', 'energy: drive work = stored + dissipated, of each cycle and over an hour', 'not reported',
            'balance <= 1e-12 of the throughput; friction never gives', energy_balance),
    Extreme('X17', 'NaN, infinite, late, duplicate, burst commands', 'the solver loops for ever',
            'a named refusal, the state untouched', bad_commands),
    Extreme('X18', 'break-away exactly at the limit', 'Modelica breaks away 0.1 % late by construction', '<= 1e-12',
            at_the_limit),
    Extreme('X19', 'mirror image; units scaled by powers of two', 'not tested', 'the same bits', mirrored_and_scaled),
    Extreme('X20', 'the same scene twice, in two processes; recorded commands again', 'not promised', 'the same bits',
            run_twice),
    Extreme('X21', 'a rigid contact with two branches under sinusoids: friction is continuous at the break-away, and '
            'the rate of the force alone says that it slips',
            'this engine doubled break-aways while it took the rate of the event before: 66 of 102 wrong',
            'the events of the reference, <= 1e-12', shaken),
    Extreme('X22', 'kinetic friction that falls within 0.05 to 50 mm/s: slips grow by a factor of up to e⁶⁰⁰',
            'stickslip 0.1.0: a product of three derivatives overflowed, and a step of 0 passed for the root; 8 of 400 '
            'axes left for 1e95 km/s', 'the events of the reference, <= 1e-12', steep_segments),
    Extreme('X23', 'slips critically damped to 1e-5 to 1e-13, from both sides',
            'stickslip 0.1.0: the same product underflowed, and 1 axis of 1000 missed its events',
            'the events of the reference, <= 1e-12', near_critical),
    Extreme('X24', 'answers of sweep and critical: sticks and reversals by turns, sticks after long pauses, a cycle '
            'about to vanish', 'looking at the last cycle, or for two equal ones: wrong for 3 of 41 masses, and '
            'borders "to 1e-9" that do not exist or that 937 sticks contradict', 'what 10,000 s show', answers),
    Extreme('X25', 'the energy account: sinusoids of 1 Hz to 1 MHz; stiff, over-damped, undamped, resonant contacts',
            'not reported; 0.1.0 of this engine: a hold of 1000 s under 1 kHz 2.3 s for 54 us of motion, 1 MHz no end',
            'the account costs at most as much again as the motion; balance <= 1e-12', cost_of_the_account),
    Extreme('X26', 'honest error estimates of all solvers, for steps of 10 µs to 10 ms and tolerances of 1e-3 to 1e-12',
            'a repeat with half the step or a tenth of the tolerance showed a millionth of the error, 5e-9 s',
            'true error within the estimate, events those of the reference as far as it says', estimates),
    Extreme('X27', 'an undamped contact with mu_s = mu_k at rest comes back to its limit in every period',
            'stickslip 0.1.0: 21 % of such axes broke away for 1e-10 s at a touch', 'none invented, none missed',
            touched_limits),
)


def chosen(numbers: Collection[str] = ()) -> tuple[Extreme, ...]:
    """Return the extremes with these numbers, in their order; all without any.  Raises InputError on unknown ones."""
    known = {extreme.number for extreme in EXTREMES}
    for number in numbers:
        if number not in known:
            raise InputError('--only', number, f'numbers from {EXTREMES[0].number} to {EXTREMES[-1].number}',
                             'separate them by commas: X1,X7')
    return tuple(extreme for extreme in EXTREMES if not numbers or extreme.number in numbers)


def results(extremes: Collection[Extreme], setup: Setup) -> Iterator[ExtremeResult]:
    """Yield the outcome of each, as soon as it is there."""
    for extreme in extremes:
        begin = time.perf_counter()
        finding = extreme.measure(setup)
        yield ExtremeResult(extreme, finding, time.perf_counter() - begin)


# The table of the extremes as text for people, as Markdown and as JSON.

_MARK = 52   # columns


def table_head() -> str:
    """Return the head of the table."""
    return f'{"":4} {"":6} {"mark":{_MARK}}  measured'


def row(outcome: ExtremeResult) -> list[str]:
    """Return the lines of an extreme: its name, verdict, mark and measured figure, and the cases that missed."""
    verdict = 'met' if outcome.passed else 'MISSED'
    lines = [f'{outcome.extreme.number:4} {outcome.extreme.name}',
             f'{"":4} {verdict:6} {outcome.extreme.mark:{_MARK}}  {outcome.finding.figure}  ({outcome.seconds:.1f} s)']
    return lines + [f'{"":11} {example}' for example in outcome.finding.examples]


def markdown_text(outcomes: Sequence[ExtremeResult], quick: bool) -> str:
    """Return the table as a page."""
    met = sum(outcome.passed for outcome in outcomes)
    known = ', '.join(f'{name} {version}' for name, version in versions().items())
    rows = [(found.extreme.number, found.extreme.name, found.extreme.elsewhere, found.extreme.mark,
             found.finding.figure, 'yes' if found.passed else '**no**') for found in outcomes]
    page = Section('The extremes', [
        f'`stickslip extremes{" --quick" if quick else ""}`: {met} of {len(outcomes)} marks met; {known}.',
        Table(('#', 'extreme', 'elsewhere', 'mark', 'measured', 'met'), rows)])
    return '\n'.join(markdown_lines([page], level=1))


def json_text(outcomes: Sequence[ExtremeResult], quick: bool) -> str:
    """Return the table as JSON, with the versions it holds for."""
    rows = [_row(outcome) for outcome in outcomes]
    document = {'size': 'reduced' if quick else 'full', 'versions': versions(),
                'passed': all(outcome.passed for outcome in outcomes), 'extremes': rows}
    return json.dumps(document, indent=2, allow_nan=False, ensure_ascii=False) + '\n'


def _row(outcome: ExtremeResult) -> dict[str, object]:
    extreme, finding = outcome.extreme, outcome.finding
    worst = str(finding.worst) if math.isnan(finding.worst) else finding.worst
    return {'number': extreme.number, 'name': extreme.name, 'elsewhere': extreme.elsewhere, 'mark': extreme.mark,
            'passed': outcome.passed, 'seconds': outcome.seconds, 'figure': finding.figure, 'cases': finding.cases,
            'misses': finding.misses, 'worst': worst, 'limit': finding.limit, 'examples': list(finding.examples)}
