"""The executable `health` as a program: hears /diagnostics until the axis of its namespace has said how it is."""

import sys
import time
from collections.abc import Sequence
from typing import TYPE_CHECKING, cast

from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
from rclpy.node import Node

from ..errors import StickslipError
from ..recording.topics import DIAGNOSTICS
from ..scene.parameter import Parameter
from ..scene.sections import NODE, without_those_of_ros
from .controller_parameters import values_at_start
from .environment import refusing, variables
from .life import Program, spin
from .topics import subscription

if TYPE_CHECKING:
    from .sim_node import Signals

_USAGE = """\
usage: health [--help] [--ros-args [-p patience:=S] [-r __ns:=/NAMESPACE]]

Waits for what the axis in this namespace says of itself in /diagnostics, once a second.  Exit code 0: all is well, or
there are warnings; 1: there is an error, or it says nothing.
"""
_PATIENCE = Parameter('patience', 'double', 8.0, 's', 'to wait for the axis; finding it may take 3 s', 1.0, 3600.0)


class Listener(Node):  # type: ignore[misc]
    """Hears the statuses of one axis; raises InputError when its parameters are wrong."""

    def __init__(self) -> None:
        with refusing('ROS environment', variables()):
            super().__init__('health')
        given = {name: parameter.value for name, parameter in self._parameter_overrides.items()}
        values = values_at_start({_PATIENCE.name: _PATIENCE}, without_those_of_ros(given))
        self.patience = cast(float, values[_PATIENCE.name])
        self.axis = f'{self.get_namespace().rstrip("/")}/{NODE}'
        self.statuses: list[DiagnosticStatus] = []
        subscription(self, DIAGNOSTICS, self._hear)

    @property
    def is_over(self) -> bool:
        """Whether the axis was heard, or was given long enough."""
        return bool(self.statuses) or time.monotonic() > self._end

    def begin(self) -> None:
        """Let the patience begin."""
        self._end = time.monotonic() + self.patience

    def end(self) -> None:
        """Leave nothing behind."""

    def _hear(self, message: DiagnosticArray) -> None:
        self.statuses += [status for status in message.status if status.hardware_id == self.axis]


def judge(axis: str, statuses: Sequence[DiagnosticStatus]) -> str:
    """Return how an axis is in one line, by the worst of its statuses; raises StickslipError when it is not well."""
    worst = max(status.level for status in statuses)
    told = '; '.join(f'{status.name}: {status.message}' for status in statuses if status.level == worst)
    if worst >= DiagnosticStatus.ERROR:
        raise StickslipError(f'{axis} is not well: {told}')
    return f'{axis} is well{"" if worst == DiagnosticStatus.OK else ", with warnings"}: {told}'


def _run(_: None, signals: 'Signals') -> str:
    listener = Listener()
    spin(listener, signals, lambda: listener.is_over)
    if not listener.statuses:
        raise StickslipError(f'{listener.axis} said nothing on {DIAGNOSTICS.name} within {listener.patience:g} s;'
                             ' does it run, in this namespace and ROS_DOMAIN_ID?')
    sys.stdout.write(judge(listener.axis, listener.statuses) + '\n')
    return ''


def _nothing(_: Sequence[str]) -> None:
    """Look at no arguments before ROS does."""


PROGRAM = Program('health', _USAGE, _nothing, _run)
