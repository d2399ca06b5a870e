# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Times that a change may not lengthen, as medians of runs one after the other; compared with those of another time.

    python3 -m dev.timings runs/goldens/before
    python3 -m dev.timings runs/goldens/after --against runs/goldens/before

They stand beside the goldens, which leave them out.  `make hil` and `make identify` have programs of their own.
"""

import argparse
import json
import statistics
import sys
import tempfile
import time
from pathlib import Path

import rclpy

from benchmarks.hil.process import PATIENCE, SCENE, running
from benchmarks.hours import cost_of
from benchmarks.loop import executable
from stickslip_msgs.msg import SliderState
from stickslip_sim.bags.topics import SLIDER_STATE
from stickslip_sim.ros.node.endpoints import subscription

REPEATS = 5
FILE = 'timings.json'
_HOUR = ('simulate', SCENE, '--duration', '3600')


def first_state() -> float:
    """Return the time from the start of the installed node to its first state, s."""
    node = rclpy.create_node('timings')
    heard: list[SliderState] = []
    subscription(node, SLIDER_STATE, heard.append)
    begin = time.monotonic()
    with running([executable('sim_node'), '--ros-args', '--log-level', 'error', '-p', f'scene:={SCENE}']):
        while not heard and time.monotonic() < begin + PATIENCE:
            rclpy.spin_once(node, timeout_sec=PATIENCE)
        taken = time.monotonic() - begin
    node.destroy_node()
    return taken


def measured() -> dict[str, float]:
    """Return a run of each, s: CPU time but for the node, whose start is waited for."""
    with tempfile.TemporaryDirectory() as folder:
        to_bag = cost_of([*_HOUR, '--bag', f'{folder}/bag'])
    return {'start_of_the_tool_cpu': cost_of(['--version']).cpu, 'first_state_of_the_node': first_state(),
            'an_hour_cpu': cost_of(_HOUR).cpu, 'an_hour_with_bag_cpu': to_bag.cpu}


def main() -> int:
    """Measure, write the medians and print them; return the exit code."""
    parser = argparse.ArgumentParser(prog='python3 -m dev.timings', description=__doc__.splitlines()[0])
    parser.add_argument('folder', type=Path)
    parser.add_argument('--against', type=Path)
    options = parser.parse_args()
    rclpy.init()
    runs = [measured() for _ in range(REPEATS)]
    rclpy.shutdown()
    medians = {name: statistics.median(run[name] for run in runs) for name in runs[0]}
    options.folder.mkdir(parents=True, exist_ok=True)
    (options.folder / FILE).write_text(json.dumps(medians, indent=1) + '\n', encoding='utf-8')
    before = json.loads((options.against / FILE).read_text(encoding='utf-8')) if options.against else {}
    for name, value in medians.items():
        ratio = f'  {value / before[name]:5.3f} of {before[name]:.3f} s' if name in before else ''
        sys.stdout.write(f'{name:24} {value:7.3f} s{ratio}\n')
    return 0


if __name__ == '__main__':
    sys.exit(main())
