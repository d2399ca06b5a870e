# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The executables of the example controllers as programs."""

from typing import TYPE_CHECKING

from ..process.program import Program, spin

if TYPE_CHECKING:
    from ..process.given_parameters import GivenParameters
    from ..process.stop_signals import Signals

_USAGE = """\
usage: {0} [--help] [--ros-args [-p NAME:=VALUE]... [-r __ns:=/NAMESPACE]]

{1}
Hears joint_states and answers on joint_commands, which the axis speaks with joint_interface.enabled:=true.
"""
_WHAT = {
    False: 'Lets the slider follow positioning moves with a cascade: P position, PI velocity, velocity feed-forward.',
    True: 'Lets the slider follow positioning moves with a cascade whose friction is compensated.',
}


def controller_program(name: str, compensates: bool) -> Program:
    """Return the program of that name."""

    def run(given: 'GivenParameters', signals: 'Signals') -> None:
        from .controller_node import ControllerNode

        spin(ControllerNode(name, compensates, given), signals)

    return Program(name, _USAGE.format(name, _WHAT[compensates]), run)
