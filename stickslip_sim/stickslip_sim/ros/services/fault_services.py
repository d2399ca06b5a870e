# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The services that let things go wrong: ~/inject_fault, ~/clear_faults."""

from collections.abc import Callable
from typing import Any

from std_srvs.srv import Trigger

from stickslip_msgs.srv import InjectFault

from ...core.errors import InputError
from ...realtime.step_loop import StepLoop
from ...rig import Fault
from ...rig.faults import value_of_kind
from ..node.parameters import SceneNode
from .answers import BUSY, answer

_CLEAR = 'clear'
_TIMEOUT = 'the command time-out (the drive takes commands again)'


class FaultServices:
    """Faults on request; they take effect with the next step."""

    def __init__(self, node: SceneNode, loop: StepLoop) -> None:
        self._loop, self._log = loop, node.get_logger()
        for fault in node.scene.rig.faults:
            self._warn(fault)
        node.create_service(InjectFault, '~/inject_fault', self._inject)
        node.create_service(Trigger, '~/clear_faults', self._clear_all)

    def _inject(self, request: Any, response: Any) -> Any:
        rig = self._loop.rig
        response.id = request.id
        if request.kind == _CLEAR:
            return self._at_boundary(response, lambda: rig.clear_fault(request.id), lambda: f'{request.id} cleared')
        asked = Fault(request.id, request.kind, request.start, request.duration, request.value)

        def inject() -> None:
            response.id = rig.inject(asked).id

        what = f'{asked.kind} {asked.value:g}' if value_of_kind(asked.kind) else asked.kind
        return self._at_boundary(response, inject, lambda: (
            f'{response.id} ({what}) begins {asked.start:g} s from now{self._warn(asked)}'))

    def _warn(self, fault: Fault) -> str:
        """Log that a fault does nothing; return that for an answer."""
        reason = self._loop.rig.idle_reason(fault)
        if not reason:
            return ''
        self._log.warning(reason)
        return f'; {reason}'

    def _clear_all(self, _: Any, response: Any) -> Any:
        cleared: list[str] = []

        def clear() -> None:
            rig = self._loop.rig
            of_timeout = [_TIMEOUT] if rig.has_failed else []
            cleared.extend(rig.clear_faults() + of_timeout)

        return self._at_boundary(response, clear, lambda: f'cleared: {", ".join(cleared) or "there were none"}')

    def _at_boundary(self, response: Any, action: Callable[[], object], report: Callable[[], str]) -> Any:
        refusals: list[InputError] = []

        def do() -> None:
            try:
                action()
            except InputError as error:
                refusals.append(error)

        if not self._loop.at_boundary(do):
            return answer(response, False, BUSY)
        return answer(response, not refusals, str(refusals[0]) if refusals else report())
