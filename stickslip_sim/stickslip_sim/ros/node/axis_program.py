# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The executable `sim_node` as a program: its arguments, and its node."""

from collections.abc import Sequence
from typing import TYPE_CHECKING

from ..process.params_files import params_files
from ..process.program import Program, spin

if TYPE_CHECKING:
    from ..process.stop_signals import Signals
    from .parameters import FileParameters

_USAGE = """\
usage: sim_node [--help] [--ros-args [--params-file SCENE.yaml] [-p NAME:=VALUE]... [-r __ns:=/NAMESPACE]]

Simulates a feed axis with stick-slip friction in real time (node feed_axis).  Without a file it runs the scene
paper_fig8; -p scene:=NAME takes another shipped one, -p record.enabled:=true records a bag from the start.
"""


def _read(args: Sequence[str]) -> 'FileParameters':
    from .parameters import FileParameters

    return FileParameters.read(list(params_files(args)))


def _run(files: 'FileParameters', signals: 'Signals') -> None:
    from .feed_axis import FeedAxis

    node = FeedAxis(files, lambda: signals.stop)
    spin(node, signals, lambda: node.loop.crash is not None, node.log.write)
    if node.loop.crash is not None:
        raise node.loop.crash


PROGRAM = Program('sim_node', _USAGE, _read, _run)
