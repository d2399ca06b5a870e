# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The page with the figures of the bench: docs/hil_figures.md."""

from collections.abc import Callable, Mapping
from itertools import takewhile
from typing import Any, NamedTuple

from .process import BARE, RECORDING_BARE, SCENE, SIMULATING
from .yardstick import section

Figures = Mapping[str, float]
RATE = 1000.0           # 1/s, of the comparison
MARK = 0.75             # processor time of sim_node / of a bare node that records
LATENCY_MARK = 1.5      # steps
ROUNDS = 3              # at each rate: the machine stalls now and then, for some 30 ms


class Column(NamedTuple):
    """A column of a table."""

    title: str
    text: Callable[[Figures], str]


def of(name: str, scale: float = 1.0, form: str = '.0f') -> Callable[[Figures], str]:
    """Return what shows a figure, or a dash where there is none."""
    return lambda figures: f'{figures[name] * scale:{form}}' if name in figures else '–'


COLUMNS = (
    Column('CPU per step, µs', of('cpu', 1e6)),
    Column('steps, 1/s', of('rate', form='.1f')),
    Column('commands, 1/s', of('answers')),
    Column('steps unheard', of('unheard')),
    Column('unrecorded', of('unrecorded')),
    Column('overruns, %', of('overruns', 1e2, '.2f')),
    Column('waited for a core, ms/s', of('waited', 1e3)),
    Column('lateness p50, µs', of('lateness_p50', 1e6)),
    Column('p99', of('lateness_p99', 1e6)),
    Column('max', of('lateness_max', 1e6)),
    Column('latency p50, µs', of('latency_p50', 1e6)),
    Column('p99', of('latency_p99', 1e6)),
    Column('answer to effect p50, steps', of('answer_steps_p50')),
    Column('p99', of('answer_steps_p99')),
)

_START = ('As any process is started', 'With SCHED_FIFO and locked memory')

_LEGEND = (
    '* CPU: user and system time of the whole process of the node, per step.',
    '* Unheard: steps that the controller did not receive.  Unrecorded: steps that are not in the bag.',
    '* Overruns: share of the steps that started more than a period late.',
    '* Waited: how long threads of the node that could run had no core.',
    '* Latency, from `timing` of the node: from the arrival of a command to the first published state that it moved.',
    '* Answer to effect, as the controller sees it: from the state that it answered to the first state that moved.',
)


def page(found: Mapping[str, Any]) -> str:
    """Return the page for what `__main__` measured."""
    seconds, repeats = f'{found["seconds"]:g}', found['repeats']
    return '\n'.join([
        '# The bench for controllers, measured', '',
        'See here the CPU time and the latency of the node, beside a bare node, and the highest rate that it holds.',
        f'`python3 -m benchmarks.hil --seconds {seconds} --repeats {repeats}` wrote this page on',
        f'{found["machine"]}.', '',
        '## Beside a bare node', '',
        f'At 1 kHz, in turns, {seconds} s each, {repeats} times:', '',
        f'* `sim_node` on `{SCENE}` with its default topics and its recording;',
        '* a bare node with the same loop (thread, absolute deadlines, EventsExecutor beside it), which fills and',
        '  publishes the same two messages with rclpy and simulates nothing.', '',
        'A controller in a process of its own answers every state with a drive velocity.  The figures are medians; of',
        'unheard and unrecorded steps sums, of maxima the worst.', '',
        *table('node', found['cases']), '', *_LEGEND, '', *verdict(found['cases']), '',
        '## The highest rate', '',
        f'`sim_node` alone, {ROUNDS} times {seconds} s at each rate, up to the first rate at which steps are lost or',
        'lag behind the clock; medians, sums and the worst as above.  The controller, which has no priority, answers',
        '1000 states a second.', '',
        *(line for priority, rates in found['rates'].items() for line in (
            f'{_START[priority > 0]}:', '', *table('rate, 1/s', rates), '', *highest(found['troubles'][priority]), '')),
        *section(found['yardsticks'], found['seconds'], repeats, found['no_priority']), ''])


def table(first: str, rows: Mapping[str, Figures]) -> list[str]:
    """Return a table with a row for each entry."""
    return [f'| {first} | ' + ' | '.join(column.title for column in COLUMNS) + ' |', '|---' * (len(COLUMNS) + 1) + '|',
            *(f'| {name} | ' + ' | '.join(column.text(figures) for column in COLUMNS) + ' |'
              for name, figures in rows.items())]


def verdict(cases: Mapping[str, Figures]) -> list[str]:
    """Say how the node compares."""
    node = cases[SIMULATING]
    latency = node['latency_p50']
    return [f'* Processor time: {node["cpu"] / cases[BARE]["cpu"]:.2f} × that of the bare node, '
            f'{node["cpu"] / cases[RECORDING_BARE]["cpu"]:.2f} × that of the bare node that records'
            f' (mark: at most {MARK:g}).',
            f'* Latency of a command: {latency * 1e3:.2f} ms, {latency * RATE:.2f} steps'
            f' (median; mark: at most {LATENCY_MARK:g} steps).']


def highest(troubles: Mapping[str, tuple[str, str]]) -> list[str]:
    """Say which rates hold, given for each what is lost and what is late, empty texts where nothing is."""
    whole = list(takewhile(lambda rate: not troubles[rate][0], troubles))
    valid = list(takewhile(lambda rate: not any(troubles[rate]), troubles))
    texts = {rate: '; '.join(filter(None, both)) or 'holds' for rate, both in troubles.items()}
    return [*(f'* {rate} 1/s: {text}' for rate, text in texts.items()), '',
            f'The highest rate with no more late steps than the scene allows (`timing.max_overruns`): {_last(valid)}.',
            f'The highest at which no step is lost: {_last(whole)}.']


def _last(rates: list[str]) -> str:
    return f'{rates[-1]} 1/s' if rates else 'none'
