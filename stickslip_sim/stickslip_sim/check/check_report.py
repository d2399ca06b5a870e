# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The outcome as sentences and as JSON values; SI units."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import asdict
from typing import Any, NamedTuple

from ..runs import Run
from .kinds import TIMING_LIMIT
from .observed_run import commands_of, gaps_in, observed_motion, timing_of
from .outcomes import LimitOutcome


class Checked(NamedTuple):
    """A run that was checked, under the name that it has in what is written about it."""

    name: str
    run: Run
    outcomes: Sequence[LimitOutcome]


def verdict_line(checked: Checked) -> str:
    """Return passed or failed, of how many, and which failed."""
    _, run, outcomes = checked
    failed = failures(outcomes)
    if failed:
        return f'FAILED: {len(failed)} of {len(outcomes)}: {", ".join(failed)}'
    timing = timing_of(run)
    doubt = ', but the run is not valid in real time' if run.is_complete and timing and timing.valid is False else ''
    return f'PASSED: {len(outcomes)} of {len(outcomes)}{doubt}'


def checked_line(checked: Checked) -> str:
    """Return what was checked: from when to when, how much is known of it, and when its first command came."""
    name, run, _ = checked
    motion, commands = observed_motion(run), commands_of(run)
    text = (f'{name}: {motion.begin:g} to {motion.end:g} s, {motion.states} states, '
            f'{len(motion.events)} transitions')
    if commands is None:
        return text
    return f'{text}, {"no command" if commands.first is None else f"first command at t = {commands.first:g} s"}'


def real_time_verdict(run: Run) -> str:
    """Return what the node said of its timing at the end of a run; empty without that."""
    timing = timing_of(run) if run.is_complete else None
    return timing.verdict if timing else ''


def complaint(checked: Checked, limits_file: str) -> str:
    """Return in one line why a run did not pass, empty when it did."""
    name, _, outcomes = checked
    missed = [outcome.name for outcome in outcomes if not (outcome.passed or outcome.is_unchecked)]
    unchecked = [outcome.name for outcome in outcomes if outcome.is_unchecked]
    parts = [f'{name} does not keep {limits_file}: {", ".join(missed)}'] if missed else []
    if unchecked:
        parts.append(f'{name}: no drive velocity came within the window of {", ".join(unchecked)}, so that no '
                     'controller was checked: let the window begin with first_command, or allow that with commands: '
                     'optional')
    return '; '.join(parts)


def failures(outcomes: Sequence[LimitOutcome]) -> list[str]:
    """Return the names of the limits that were not kept."""
    return [outcome.name for outcome in outcomes if not outcome.passed]


def line_of(outcome: LimitOutcome) -> str:
    """Return what was measured, and the limit, in a sentence."""
    if outcome.limit is None or outcome.value is None:
        return outcome.remark
    unit = f' {outcome.limit.kind.unit}'.rstrip()
    text = f'{outcome.limit.kind.name} = {outcome.value!r}{unit}, limit {outcome.limit.maximum!r}{unit}'
    return f'{text} ({outcome.remark})' if outcome.remark else text


def checks_as_json(runs: Sequence[Checked]) -> dict[str, Any]:
    """Return everything that was found: of one run, or a list of several; an infinite figure is the text 'inf'."""
    found = [_found(checked) for checked in runs]
    return found[0] if len(found) == 1 else {'passed': all(one['passed'] for one in found), 'runs': found}


def _found(checked: Checked) -> dict[str, Any]:
    name, run, outcomes = checked
    motion, commands, timing = observed_motion(run), commands_of(run), timing_of(run)
    return {
        'run': {'name': name, 'begin': motion.begin, 'end': motion.end, 'states': motion.states,
                'events': len(motion.events), 'is_complete': run.is_complete, 'notes': list(gaps_in(run)),
                'first_command': commands.first if commands else None,
                'timing': asdict(timing) if timing else None},
        'passed': not failures(outcomes),
        'limits': [_entry(outcome) for outcome in outcomes],
    }


def _entry(outcome: LimitOutcome) -> Mapping[str, Any]:
    limit = outcome.limit
    found = {'name': outcome.name, 'passed': outcome.passed, 'remark': outcome.remark}
    if limit is None:
        return {**found, 'check': TIMING_LIMIT}
    return {**found, 'check': limit.kind.name, 'unit': limit.kind.unit, 'measured': _number(outcome.value),
            'max': limit.maximum, 'margin': _number(outcome.margin), 'window': outcome.span._asdict(),
            **limit.settings}


def _number(value: float | None) -> float | str | None:
    return value if value is None or math.isfinite(value) else str(value)
