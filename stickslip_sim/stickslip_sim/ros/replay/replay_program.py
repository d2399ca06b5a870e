# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The executable `replay_node` as a program."""

from typing import TYPE_CHECKING

from ..process.program import Program, spin

if TYPE_CHECKING:
    from ..process.given_parameters import GivenParameters
    from ..process.stop_signals import Signals

_USAGE = """\
usage: replay_node [--help] --ros-args -p bag:=RUN_FOLDER [-p NAME:=VALUE]... [-r TOPIC:=OTHER]...

Plays a recorded run (node replay): all its topics for viewers, or with -p mode:=commands the orders it was given, into
a live sim_node.  The other parameters are named as the flags of ros2 bag play: rate, loop, start_offset,
playback_duration, clock, delay, start_paused, topics.
"""


def _run(given: 'GivenParameters', signals: 'Signals') -> None:
    from .node import Replay

    node = Replay(given)
    spin(node, signals, lambda: node.player.is_over)
    if node.player.crash is not None:
        raise node.player.crash


PROGRAM = Program('replay_node', _USAGE, _run)
