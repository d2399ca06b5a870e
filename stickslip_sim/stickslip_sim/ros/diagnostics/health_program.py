# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The executable `health` as a program."""

import sys
from typing import TYPE_CHECKING

from ..process.program import Program, spin

if TYPE_CHECKING:
    from ..process.given_parameters import GivenParameters
    from ..process.stop_signals import Signals

_USAGE = """\
usage: health [--help] [--ros-args [-p patience:=S] [-r __ns:=/NAMESPACE]]

Waits for what the axis in this namespace says of itself in /diagnostics, once a second.  Exit code 0: all is well, or
there are warnings; 1: there is an error, or it says nothing.
"""


def _run(given: 'GivenParameters', signals: 'Signals') -> None:
    from .health_node import Listener

    listener = Listener(given)
    spin(listener, signals, lambda: listener.is_over)
    sys.stdout.write(listener.verdict() + '\n')


PROGRAM = Program('health', _USAGE, _run)
