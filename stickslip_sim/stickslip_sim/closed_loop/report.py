# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""What is said of many closed loops (how many pass, each limit, percentiles) and of a tuned one (why it swings)."""

import math
from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Mapping
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from ..check.limits import Limits
from ..check.report import check_report, checks_as_values, complaint, junit_text
from ..report.model import NOTE, Part, Sentence, Table
from ..report.quantity import counted, quantity
from ..report.values import versions
from ..runs.report import run_report
from ..study.report import percentiles_table
from .linear_loop import MOST_DELAY, LinearLoop, friction_slope
from .loop import ClosedLoopRun
from .many import ClosedLoops
from .study import LoopStudy
from .tuning import OTHER, PARTS, Swing, Tuning

_ROWS = 20               # of the matrix on a terminal
_REASONS = 5
_OF_CHANCE = 'encoder.noise', 'friction.static.scatter', 'friction.static.scatter_run'


class LoopOutcome(NamedTuple):
    """What one loop or many came to: how it is drawn, for people, as JSON and JUnit XML, and the limits it misses."""

    draw: Callable[[Path], object]
    report: Iterable[Part]
    values: Mapping[str, Any]
    complaint: str
    junit: str = ''


def outcome_of_run(run: ClosedLoopRun, limits: Limits | None, limits_file: str) -> LoopOutcome:
    """Return what a run came to, and its check against limits of a file; raises InputError where they do not fit."""
    checks = [] if limits is None else [run.check(limits)]
    return LoopOutcome(run.plot, [*run_report(run), *(part for one in checks for part in check_report(one))],
                       {'receipt': run.receipt, **(checks_as_values(checks) if checks else {})},
                       ''.join(complaint(one, limits_file) for one in checks), junit_text(checks) if checks else '')


def outcome_of_loops(found: ClosedLoops, limits_file: str | None) -> LoopOutcome:
    """Return what many loops came to."""
    failed = found.study.count - found.pass_rate.passed if limits_file else 0
    return LoopOutcome(found.plot, loops_report(found), found.values(),
                       f'{failed} of {found.study.count} points do not pass {limits_file}' if failed else '')


def loops_report(found: ClosedLoops) -> Iterator[Part]:
    """Yield the pass rate, what each limit came to, the matrix of the points that failed, percentiles and reasons."""
    study, rate = found.study, found.pass_rate
    counts = ', '.join(f'{count} {word}' for word, count in Counter(found.outcomes).most_common())
    yield (f'{study.scene.name}: {counted(study.count, "point")} of {", ".join(study.names)}, {found.ran} run now: '
           f'{counts}')
    yield (f'{rate.passed} of {rate.points} pass: {rate.passed / rate.points:.2%}, between {rate.low:.2%} and '
           f'{rate.high:.2%} with 95 % confidence')
    yield from _limits(found)
    yield from _matrix(found)
    yield _percentiles(found)
    if _has_chance(study):
        yield Sentence(f'all points have the seed of the scene, {study.scene.seed}: the same noise, losses and scatter',
                       NOTE)
    for i, reason in list(found.reasons.items())[:_REASONS]:
        at = ', '.join(f'{name} = {number:g}' for name, number in found.point(i).items())
        yield Sentence(f'point {i} ({at}): {reason}', NOTE)
    failed = sum(word not in ('passed', 'limits missed') for word in found.outcomes)
    if failed > _REASONS:
        yield Sentence(f'{failed - _REASONS} more points failed: see column outcome', NOTE)


def _has_chance(study: LoopStudy) -> bool:
    """Whether random numbers have a part in the runs."""
    lossy = {'encoder_dropout', 'command_loss'} & {fault.kind for fault in study.scene.rig.faults}
    return bool(lossy) or any(study.scene.values.get(name) or name in study.names for name in _OF_CHANCE)


def _limits(found: ClosedLoops) -> Iterator[Part]:
    limits = found.study.limits
    if not limits:
        return
    rows = []
    for limit, kept in zip(limits.limits, found.matrix.sum(axis=0).tolist()):
        worst = found.worst.get(limit.name)
        value = '–' if worst is None else quantity(float(found.columns[limit.name][worst]), limit.kind.unit)
        rows.append((limit.name, f'{kept} of {found.study.count}', limit.bound_text, value,
                     '–' if worst is None else str(worst)))
    yield Table(('limit', 'kept', 'at most', 'worst', 'at point'), rows)


def _matrix(found: ClosedLoops) -> Iterator[Part]:
    """Yield which limits the first points that failed have missed."""
    failed = np.flatnonzero(found.columns['outcome'] != 0.0).tolist()
    if not failed or not found.study.limit_names:
        return
    caption = f'the first {_ROWS} of {len(failed)} points that fail' if len(failed) > _ROWS else ''
    yield Table(('point', *found.study.names, *found.study.limit_names),
                [(str(i), *(f'{number:.5g}' for number in found.point(i).values()),
                  *('PASS' if kept else 'FAIL' for kept in found.matrix[i].tolist())) for i in failed[:_ROWS]], caption)


def _percentiles(found: ClosedLoops) -> Table:
    limits = found.study.limits
    units = {limit.name: limit.kind.unit for limit in (limits.limits if limits else ())}
    return percentiles_table('', [(name, units.get(name, 's' if name == 'until' else 'm'),
                                   list(of.values()) if of else None) for name, of in found.percentiles.items()])


# A tuned loop: a table of its margins, and why it swings; for people and as values.

_MODES = 'stick', 'slip'
_WHILE = {'feed': 'At {feed}', 'hold': 'At a setpoint that stands still'}


def tuning_report(found: Tuning) -> Iterator[Part]:
    """Yield the linear loops side by side, and why the loop swings, a sentence each."""
    yield (f'{found.controller} on {found.scene.name}, asked {found.rate:g} times a second: '
           f'its loop about stick, and about slip at {quantity(found.feed, "m/s")}')
    columns = [dict(_rows(loop)) if isinstance(loop := found.loops[mode], LinearLoop) else {} for mode in _MODES]
    heads = list(dict.fromkeys(head for column in columns for head in column))
    if heads:
        yield Table(('', *_MODES), [(head, *(column.get(head, '') for column in columns)) for head in heads])
    for mode, loop in found.loops.items():
        if isinstance(loop, str):
            yield Sentence(f'The controller cannot be probed about {mode}: {loop}.', NOTE)
    yield from verdicts(found)


def verdicts(found: Tuning) -> Iterator[str]:
    """Yield why the loop swings, a sentence for each reason."""
    for mode, loop in found.linear.items():
        if not loop.is_stable():
            yield _unstable(found, mode, loop)
    if found.ended:
        yield f'The closed loop ended early: {found.ended}.'
        return
    for swing in found.swings:
        yield f'{_swing(found, swing)}{_CAUSES[swing.cause](found, swing)}.'
    still = [part for part in PARTS if part not in {swing.during for swing in found.swings}]
    if still:
        where = ' and '.join(_WHILE[part].format(feed=quantity(found.feed, 'm/s')).removeprefix('At ')
                             for part in still)
        yield f'No swing lasts at {where} ({found.run.duration:g} s were simulated).'


def tuning_values(found: Tuning) -> dict[str, Any]:
    """Return all numbers, SI and degrees, by name; a loop that is not linear has its reason."""
    return {'controller': found.controller, 'scene': found.scene.name, 'feed': found.feed, 'rate': found.rate,
            'loops': {mode: _values(loop) if isinstance(loop, LinearLoop) else {'not_linear': loop}
                      for mode, loop in found.loops.items()},
            'swings': [swing._asdict() for swing in found.swings], 'verdicts': list(verdicts(found)),
            'versions': versions()}


def _values(loop: LinearLoop) -> dict[str, Any]:
    margin, crossing = loop.phase_margin
    least, largest = loop.stable_gains
    frequency, growth = loop.worst
    values: dict[str, Any] = {
        'stable': loop.is_stable(), 'phase_margin': margin, 'crossover': crossing, 'least_gain': least,
        'largest_gain': largest, 'largest_delay_steps': loop.largest_delay, 'slowest_frequency': frequency,
        'slowest_growth': growth, 'controller_states': len(loop.controller.a),
        'integrates': loop.controller.integrates, 'frequencies': loop.frequencies, 'slider_gain': abs(loop.slider),
        'open_loop_gain': abs(loop.open)}
    if loop.follows_setpoint and loop.is_stable():
        overshoot, settling = loop.overshoot_and_settling
        values |= {'bandwidth': loop.bandwidth, 'overshoot': overshoot, 'settling': settling}
    return values


def _rows(loop: LinearLoop) -> Iterator[tuple[str, str]]:
    frequency, growth = loop.worst
    stable = loop.is_stable()
    yield 'stable', 'yes' if stable else f'no: grows by {growth:.3g} /s at {quantity(frequency, "Hz", 3)}'
    margin, crossing = loop.phase_margin
    yield 'phase margin', (f'{margin:.1f}° at {quantity(crossing, "Hz", 3)}' if math.isfinite(margin)
                           else '|L| is nowhere 1')
    yield 'stable for gains', _gains(loop)
    delay, step = loop.largest_delay, 1.0 / loop.scene.time.rate
    if stable:
        yield 'largest further delay', (f'more than {MOST_DELAY} steps' if delay is None
                                        else f'{quantity(delay * step, "s", 4)} ({counted(delay, "step")})')
    if stable and loop.follows_setpoint:
        overshoot, settling = loop.overshoot_and_settling
        yield 'bandwidth', quantity(loop.bandwidth, 'Hz', 3)
        yield 'overshoot', f'{100.0 * overshoot:.3g} %'
        yield 'settled to 2 %', f'after {quantity(settling, "s", 3)}'


def _gains(loop: LinearLoop) -> str:
    least, largest = loop.stable_gains
    if math.isnan(least):
        return 'none'
    if math.isinf(largest):
        return f'× {least:.3g} and more' if least else 'any'
    return f'× {least:.3g} to × {largest:.3g}' if least else f'up to × {largest:.3g}'


def _unstable(found: Tuning, mode: str, loop: LinearLoop) -> str:
    frequency, growth = loop.worst
    least, largest = loop.stable_gains
    if math.isnan(least):
        fix = 'no factor on its commands makes it stable'
    else:
        fix = (f'it is stable with its commands × {largest:.3g} or less' if largest < 1.0
               else f'it is stable with its commands × {least:.3g} or more')
    slope = friction_slope(found.scene, found.feed) if mode == 'slip' else 0.0
    falling = '' if slope >= 0.0 or largest < 1.0 else (
        f' (friction falls there by {quantity(-slope, "N s/m", 3)}, the damping of the drive is '
        f'{quantity(found.scene.axis.drive_damping, "N s/m", 3)})')
    way = f'oscillates at {quantity(frequency, "Hz", 3)}, growing' if frequency > 0.0 else 'runs away, growing'
    return f'The loop about {mode} is unstable: it {way} by {growth:.3g} /s{falling}; {fix}.'


def _swing(found: Tuning, swing: Swing) -> str:
    where = _WHILE[swing.during].format(feed=quantity(found.feed, 'm/s'))
    sticks = f'sticks {100.0 * swing.stick_share:.2g} % of the time' if swing.stick_share else 'never sticks'
    return (f'{where} the slider swings by ±{quantity(swing.amplitude, "m", 3)} every '
            f'{quantity(swing.period, "s", 3)} and {sticks}: ')


def _friction(found: Tuning, swing: Swing) -> str:
    """Say what of friction it is, of a swing that ends without friction."""
    axis, load = found.scene.axis, found.scene.normal_force.value_at(0.0)
    side = axis.friction.along(found.feed)
    speed = abs(found.feed) if swing.during == 'feed' else 0.0
    most = side.static.limit if side.static.bounded else side.static.initial
    kinetic = load * side.kinetic.coefficient(speed)
    named = 'a stick-slip limit cycle' if swing.stick_share else 'a limit cycle of friction'
    stable = [mode for mode, loop in found.linear.items() if loop.is_stable()]
    loops = f', though the loop is stable about {" and about ".join(stable)}' if stable else ''
    held = f'static friction is up to {quantity(load * most, "N", 3)}, kinetic {quantity(kinetic, "N", 3)}'
    if not swing.stick_share:
        return f'{named}{loops}; {held}: the drive crosses the difference whenever the slider is to turn faster'
    integrates = any(loop.controller.integrates for loop in found.linear.values())
    winds = 'and the integrator of the controller wind' if integrates else 'winds'
    return f'{named}{loops}; {held}: in stick the drive {winds} the spring up until it breaks away'


def _encoder(found: Tuning, swing: Swing) -> str:
    encoder = found.scene.rig.encoder
    if not encoder.resolution:
        return f'noise of the encoder, {quantity(encoder.noise, "m", 3)}; without it the swing is gone'
    return (f'counts of the encoder, {quantity(encoder.resolution, "m", 3)} each '
            f'(±{swing.amplitude / encoder.resolution:.3g} counts); without them the swing is gone')


_CAUSES: dict[str, Callable[[Tuning, Swing], str]] = {
    'unstable': lambda *_: 'what the unstable loop grows to', 'friction': _friction, 'encoder': _encoder,
    OTHER: lambda *_: 'it swings without friction and encoder too, by what the controller does itself'}
