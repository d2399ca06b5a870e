# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The executable `sim_node` as a program: its arguments, and its node."""

from typing import TYPE_CHECKING

from ..process.program import Program, spin

if TYPE_CHECKING:
    from ..process.given_parameters import GivenParameters
    from ..process.stop_signals import Signals

_USAGE = """\
usage: sim_node [--help] [--ros-args [--params-file SCENE.yaml] [-p NAME:=VALUE]... [-r __ns:=/NAMESPACE]]

Simulates a feed axis with stick-slip friction in real time (node feed_axis).  Without a file it runs the scene
paper_fig8; -p scene:=NAME takes another shipped one, -p record.enabled:=true records a bag from the start.
"""


def _run(given: 'GivenParameters', signals: 'Signals') -> None:
    from .feed_axis import FeedAxis

    node = FeedAxis(given, lambda: signals.stop)
    spin(node, signals, lambda: node.loop.crash is not None, node.log.write)
    if node.loop.crash is not None:
        raise node.loop.crash


PROGRAM = Program('sim_node', _USAGE, _run)
