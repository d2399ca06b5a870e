#!/usr/bin/env python3
# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Run two axes around a circle in process, in both directions: the figures of ISO 230-4, and the picture.

For example: python3 examples/circle.py --radius 0.05 --feed 0.05 --scene ball_screw --plot circle.png
"""

import argparse
import math

import stickslip_sim as stickslip
from stickslip_sim.check.circle import check_circle
from stickslip_sim.check.limits import Limits
from stickslip_sim.check.report import Checked, check_report, draw_test
from stickslip_sim.report.text import text_lines
from stickslip_sim.runs import Run


def axis_run(scene: str, radius: float, feed: float, phase: float) -> Run:
    """Return two turns of one axis whose drive velocity is feed sin(ωt + phase)."""
    rate = feed / radius
    changes = {'drive.course': 'sine', 'drive.velocity': 0.0, 'drive.amplitude': feed,
               'drive.frequency': rate / (2.0 * math.pi), 'drive.phase': phase}
    return stickslip.simulate(stickslip.load_scene(scene, changes), duration=round(4.2 * math.pi / rate, 3))


def circle(scene: str, radius: float, feed: float) -> Checked:
    """Return the circular test of two axes of one scene: x = R cos ωt, y = ±R sin ωt."""
    x = axis_run(scene, radius, feed, math.pi)
    left, right = (axis_run(scene, radius, feed, sense * 0.5 * math.pi) for sense in (1.0, -1.0))
    return check_circle(Limits(()), [('x', x), ('y', left), ('x', x), ('y', right)])


def main() -> None:
    """Print the figures of a circle, and draw it."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('--radius', type=float, default=0.05, help='m')
    parser.add_argument('--feed', type=float, default=0.05, help='m/s')
    parser.add_argument('--scene', default='ball_screw', help='scene of both axes')
    parser.add_argument('--plot', help='FILE.png')
    options = parser.parse_args()
    found = circle(options.scene, options.radius, options.feed)
    print('\n'.join(text_lines(check_report(found))))
    if options.plot:
        draw_test(found, options.plot)


if __name__ == '__main__':
    main()
