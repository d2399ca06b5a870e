# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The executables: each takes the signals before anything else, also before the imports that take long."""

import sys
from collections.abc import Callable, Sequence

from .stop_signals import Signals

TYPE_CHECKING = False    # as in the package: `typing` is not imported before it is needed
if TYPE_CHECKING:
    from .programs import GivenParameters

_SIM_NODE = """\
usage: sim_node [--help] [--ros-args [--params-file SCENE.yaml] [-p NAME:=VALUE]... [-r __ns:=/NAMESPACE]]

Simulate a feed axis with stick-slip friction in real time (node feed_axis).  The default scene is paper_fig8; choose
another shipped one with -p scene:=NAME, and record a bag from the start with -p record.enabled:=true.
"""
_REPLAY_NODE = """\
usage: replay_node [--help] --ros-args -p bag:=RUN_FOLDER [-p NAME:=VALUE]... [-r TOPIC:=OTHER]...

Play a recorded run (node replay): all its topics for viewers, or with -p mode:=commands its commands into a live
sim_node.  The other parameters are named like the flags of ros2 bag play: rate, loop, start_offset,
playback_duration, clock, delay, start_paused, topics.
"""
_HEALTH = """\
usage: health [--help] [--ros-args [-p patience:=S] [-r __ns:=/NAMESPACE]]

Wait for the next diagnostics of the axis in this namespace.  Exit code 0: no errors; 1: errors, or no diagnostics.
"""
_CONTROLLER_NODE = """\
usage: controller_node [--help] --controller FILE.py:NAME [--gain NAME=VALUE]... [--setpoint FILE.csv] [--rate HZ]
                       [--duration S] [--ros-args [-r __ns:=/NAMESPACE]]

Drive the axis in this namespace with your own controller (node own_controller), the one of stickslip close-loop: in
real time, or with time.mode lockstep by stepping the axis itself after a reset.  The axis needs
joint_interface.enabled:=true.  The drive stops after --duration, on Ctrl-C, or if the controller fails.
"""
_CONTROLLER = """\
usage: {0} [--help] [--ros-args [-p NAME:=VALUE]... [-r __ns:=/NAMESPACE]]

{1}
It reads joint_states and writes joint_commands; start the axis with joint_interface.enabled:=true.
"""


def sim_node(args: Sequence[str] | None = None) -> int:
    """Run until SIGINT or SIGTERM; return the exit code: 0 ended, 1 internal error, 2 refused start or broken bag."""
    def run(given: 'GivenParameters', signals: Signals) -> None:
        from .node.feed_axis import FeedAxis
        from .programs import spin

        node = FeedAxis(given, lambda: signals.stop)
        spin(node, signals, lambda: node.loop.crash is not None, node.log.write)
        if node.loop.crash is not None:
            raise node.loop.crash

    return _live('sim_node', _SIM_NODE, run, args)


def replay_node(args: Sequence[str] | None = None) -> int:
    """Run to the end of the recording, or until SIGINT or SIGTERM; return the exit code as `sim_node` does."""
    def run(given: 'GivenParameters', signals: Signals) -> None:
        from .programs import spin
        from .replay.node import Replay

        node = Replay(given)
        spin(node, signals, lambda: node.player.is_over)
        if node.player.crash is not None:
            raise node.player.crash

    return _live('replay_node', _REPLAY_NODE, run, args)


def health(args: Sequence[str] | None = None) -> int:
    """Ask once; return the exit code: 0 well, 1 unwell or not there, 2 refused start."""
    def run(given: 'GivenParameters', signals: Signals) -> None:
        from .health_node import Listener
        from .programs import spin

        listener = Listener(given)
        spin(listener, signals, lambda: listener.is_over)
        sys.stdout.write(listener.verdict() + '\n')

    return _live('health', _HEALTH, run, args)


def cascade_controller(args: Sequence[str] | None = None) -> int:
    """Run until SIGINT or SIGTERM; return the exit code: 0 ended, 1 internal error, 2 refused start."""
    what = 'Follow positioning moves with a cascade: P position, PI velocity, velocity feed-forward.'
    return _controller('cascade_controller', what, False, args)


def compensating_controller(args: Sequence[str] | None = None) -> int:
    """Run as `cascade_controller` does, with the friction compensated."""
    what = 'Follow positioning moves with a cascade and friction compensation.'
    return _controller('compensating_controller', what, True, args)


def controller_node(args: Sequence[str] | None = None) -> int:
    """Run a controller of the user; return the exit code: 0 ended, 1 internal error or no axis, 2 refused or failed."""
    def run(given: 'GivenParameters', signals: Signals) -> None:
        from .controllers.own_controller_node import OwnControllerNode
        from .programs import spin

        node = OwnControllerNode(given, lambda: signals.stop)
        spin(node, signals, node.turn)

    options = '--controller', '--gain', '--setpoint', '--rate', '--duration'
    return _live('controller_node', _CONTROLLER_NODE, run, args, options)


def _controller(name: str, what: str, compensates: bool, args: Sequence[str] | None) -> int:
    def run(given: 'GivenParameters', signals: Signals) -> None:
        from .controllers.controller_node import ControllerNode
        from .programs import spin

        spin(ControllerNode(name, compensates, given), signals)

    return _live(name, _CONTROLLER.format(name, what), run, args)


def _live(name: str, usage: str, run: 'Callable[[GivenParameters, Signals], None]', args: Sequence[str] | None,
          options: Sequence[str] = ()) -> int:
    signals = Signals()
    from .programs import Program, live

    return live(sys.argv[1:] if args is None else args, signals, Program(name, usage, run, options))
