# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The node `health`: hears /diagnostics until the axis of its namespace has said how it is."""

import time
from collections.abc import Sequence
from typing import cast

from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus

from ..bags.topics import DIAGNOSTICS
from ..core.errors import StickslipError
from ..scene.load import NODE
from ..scene.parameter import Parameter
from .node.endpoints import subscription
from .node.parameters import ListedNode
from .programs import GivenParameters

_PATIENCE = Parameter('patience', 'double', 8.0, 's', 'Time to wait for the axis; discovery may take 3 s.', 1.0, 3600.0)


class Listener(ListedNode):
    """Hears the statuses of one axis; raises InputError when its parameters are wrong."""

    def __init__(self, given: GivenParameters) -> None:
        super().__init__('health', [_PATIENCE], given)
        self.patience = cast(float, self.values[_PATIENCE.name])
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

    def verdict(self) -> str:
        """Return how the axis is in one line; raises StickslipError when it is not well, or said nothing."""
        if not self.statuses:
            raise StickslipError(f'{self.axis} published nothing on {DIAGNOSTICS.name} within {self.patience:g} s; is'
                                 ' it running, in this namespace and ROS_DOMAIN_ID?')
        return health_of(self.axis, self.statuses)


def health_of(axis: str, statuses: Sequence[DiagnosticStatus]) -> str:
    """Return how an axis is in one line, by the worst of its statuses; raises StickslipError when it is not well."""
    worst, own = max(status.level for status in statuses), f'{axis}: '
    report = '; '.join(f'{status.name.removeprefix(own)}: {status.message}' for status in statuses
                       if status.level == worst)
    if worst >= DiagnosticStatus.ERROR:
        raise StickslipError(f'{axis} is not well: {report}')
    return f'{axis} is well{"" if worst == DiagnosticStatus.OK else ", with warnings"}: {report}'
