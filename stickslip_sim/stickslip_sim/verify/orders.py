# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""What was ordered in a recorded run, done again to a rig."""

from collections.abc import Collection
from typing import Any

from ..core.errors import InputError, RecordingError
from ..recording import Bag, RecordedMessage
from ..recording.topics import DRIVE_VELOCITY, EXTERNAL_FORCE, PARAMETER_EVENTS, RIG_EVENT
from ..rig import Fault, Rig, RigEventKind, StepResult
from ..scene import Scene, scene_from_values

_ORDERS = RigEventKind.COMMAND_TIMEOUT, RigEventKind.FAULT_INJECTED, RigEventKind.FAULT_CLEARED
_VALUES = {1: 'bool_value', 2: 'integer_value', 3: 'double_value', 4: 'string_value', 5: 'byte_array_value',
           6: 'bool_array_value', 7: 'integer_array_value', 8: 'double_array_value', 9: 'string_array_value'}


def is_order(bag: Bag, message: RecordedMessage) -> bool:
    """Return whether a rig event was ordered from outside; the others follow by themselves."""
    return bag.decode(message).kind in _ORDERS


class Orders:
    """Orders to a rig of a scene; `fixed` parameters stay as they are when others were changed while the axis ran."""

    def __init__(self, bag: Bag, scene: Scene, rig: Rig, fixed: Collection[str]) -> None:
        self._bag, self._rig, self._fixed = bag, rig, fixed
        self._velocity: float | None = None    # for the next step, m/s
        self._force: float | None = None       # N
        self._values = scene.values
        self._doers = {DRIVE_VELOCITY.type: self._command_velocity, EXTERNAL_FORCE.type: self._command_force,
                       RIG_EVENT.type: self._event, PARAMETER_EVENTS.type: self._change}

    def give(self, message: RecordedMessage) -> None:
        """Order what a message says; raises RecordingError when the rig refuses."""
        try:
            self._doers[message.type](self._bag.decode(message))
        except InputError as error:
            raise self._refused(message.sequence, error) from None

    def make_step(self) -> StepResult:
        """Make the next step, under the commands given before it; raises RecordingError when the rig refuses them."""
        velocity, force, self._velocity, self._force = self._velocity, self._force, None, None
        try:
            return self._rig.make_step(velocity, force)
        except InputError as error:
            raise self._refused(self._rig.step + 1, error) from None

    def _refused(self, step: int, error: InputError) -> RecordingError:
        return RecordingError(f'{self._bag.path}: the order before step {step} is refused: {error}')

    def _command_velocity(self, message: Any) -> None:
        self._velocity = message.velocity

    def _command_force(self, message: Any) -> None:
        self._force = message.force

    def _event(self, message: Any) -> None:
        if message.kind == RigEventKind.COMMAND_TIMEOUT:
            self._rig.time_out(message.value)
        elif message.kind == RigEventKind.FAULT_INJECTED:
            self._rig.inject(Fault(message.id, message.fault, message.start, message.duration, message.value))
        elif message.id:
            self._rig.clear_fault(message.id)
        else:
            self._rig.clear_faults()

    def _change(self, message: Any) -> None:
        self._values = self._values | {parameter.name: _value(parameter.value)
                                       for parameter in message.changed_parameters if parameter.name not in self._fixed}
        self._rig.change_axis(scene_from_values(self._values).axis)


def _value(value: Any) -> object:
    """Return the value of a parameter; None when it has none."""
    found: Any = getattr(value, _VALUES[value.type]) if value.type in _VALUES else None
    return found.tolist() if hasattr(found, 'tolist') else found
