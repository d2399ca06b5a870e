# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Put what `stickslip bench` wrote, and a tick beside a bare timer of ROS 2, into docs/data/races.json, and draw it.

    python3 -m benchmarks.races [runs/bench]    # without a folder: draw what the data has

The tick is one of 1 ms, called from Python; the callback of the rclpy timer publishes two messages of the node.
"""

import json
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import rclpy
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node

from stickslip_msgs.msg import FrictionForce, SliderState
from stickslip_sim.bench.contestants import sinusoids_for, state_for
from stickslip_sim.bench.outside import Ratio, at_most
from stickslip_sim.bench.problem import LETTERS, make_case
from stickslip_sim.bench.race import measure
from stickslip_sim.cli.bench import _TITLE
from stickslip_sim.plots import SolverCurve, plot_trade
from stickslip_sim.solvers import exact

from .measured import DATA, keep, kept

IMAGES = DATA.parent / 'images'
MARK, AIM = 0.02, 0.005
TICKS = 20_000
CALLBACKS = 1000
ROUNDS = 7
NO_FIGURES = dict.fromkeys(('missed', 'invented', 'reference_events', 'time', 'position'))


def ticks() -> Callable[[], object]:
    """Return what makes TICKS ticks of 1 ms."""
    problem, solver = make_case('B'), exact.SOLVER
    of = solver.records
    p, state, events = of.Parameters(problem.parameters.tolist()), state_for(problem, of), of.Events(64)
    sinusoids = sinusoids_for(problem, of)
    instants = [(float(k // 1000), k % 1000 / 1000.0) for k in range(1, TICKS + 1)]

    def run() -> None:
        solver.start(p, state, *problem.start, 0.0, 0.0, *problem.pieces[0, 1:], sinusoids, events, 0)
        advance = solver.advance
        for second, fraction in instants:
            advance(p, state, second, fraction, events, 0)

    return run


def callbacks() -> Callable[[], object]:
    """Return what lets a timer of rclpy call CALLBACKS times, with all that brings it about."""
    rclpy.init()
    node = Node('tick')
    state, friction = SliderState(), FrictionForce()
    publishers = (node.create_publisher(SliderState, 'slider_state', 10),
                  node.create_publisher(FrictionForce, 'friction_force', 10))
    left = [0]

    def publish() -> None:
        publishers[0].publish(state)
        publishers[1].publish(friction)
        left[0] -= 1

    node.create_timer(1e-3, publish)
    executor = SingleThreadedExecutor()
    executor.add_node(node)

    def run() -> None:
        left[0] = CALLBACKS
        while left[0] > 0:
            executor.spin_once()

    return run


def tick_ratio() -> Ratio:
    """Return what a tick costs of a bare callback; processor time, in turns."""
    runs = [ticks(), callbacks()]
    for run in runs:
        run()
    tick, callback = measure(runs, ROUNDS)
    return at_most('a tick of 1 ms from Python / a bare rclpy timer callback with two messages', 'B',
                   tick.median / TICKS / (callback.median / CALLBACKS), MARK, AIM)


def row(case: str, raced: dict[str, Any]) -> dict[str, object]:
    """Return a row of the race with the figures that the page and its readers compare."""
    figures, cost = raced['errors'] or NO_FIGURES, raced['cost_per_simulated_second']
    return {'case': case, 'solver': raced['solver'], 'setting': raced['label'], 'cost': cost and cost['median'],
            'missed': figures['missed'], 'invented': figures['invented'], 'of': figures['reference_events'],
            'time_error': figures['time'], 'position_error': figures['position'], 'note': raced['note']}


def take(folder: Path) -> None:
    """Keep the races of a folder, with the ratio of a tick measured now."""
    found = json.loads((folder / 'bench.json').read_text(encoding='utf-8'))
    found['ratios'].append(tick_ratio()._asdict())
    keep(DATA / 'races.json', command='make bench', **{name: found[name] for name in (
        'machine', 'versions', 'rounds', 'ratios')},
        cases=[{name: case[name] for name in ('name', 'summary', 'duration', 'reference_events')}
               for case in found['cases']],
        rows=[row(case['name'], raced) for case in found['cases'] for raced in case['rows']])


def draw(folder: Path) -> None:
    """Draw the cost of every solver over its error: of the four cases, and of the shipped scenes."""
    found = kept('races')
    for picture, is_letter in (('trade', True), ('trade_scenes', False)):
        panels: dict[str, list[SolverCurve]] = {}
        for case in found['cases']:
            if (case['name'] in LETTERS) != is_letter:
                continue
            points: dict[str, list[tuple[float, float, bool]]] = {}
            for one in found['rows']:
                if one['case'] == case['name'] and one['cost'] is not None:
                    flawed = one['missed'] + one['invented'] > 0
                    points.setdefault(one['solver'], []).append((one['time_error'], one['cost'], flawed))
            panels[f'{case["name"]}: {case["summary"]}' if is_letter else case['name']] = [
                SolverCurve(label, *zip(*each)) for label, each in points.items()]
        plot_trade(panels, _TITLE, folder / f'{picture}.png')


if __name__ == '__main__':
    for given in sys.argv[1:]:
        take(Path(given))
    draw(IMAGES)
