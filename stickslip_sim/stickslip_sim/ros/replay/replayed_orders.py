# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""What a recording says of the orders that its axis got: commands, faults, parameters."""

from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

from ...core.errors import InputError, RecordingError
from ...recording import Topic
from ...recording.playback import Recording
from ...recording.topics import DRIVE_VELOCITY, EXTERNAL_FORCE, PARAMETER_EVENTS, RIG_EVENT, SLIDER_STATE
from ...rig import RigEventKind
from ...scene.schema import BY_NAME
from ..node.endpoints import deserialized

COMMANDS = (DRIVE_VELOCITY, EXTERNAL_FORCE)
_CLEAR = 'clear'    # what ~/inject_fault calls the end of a fault


class Request(NamedTuple):
    """A call of a service of the axis."""

    service: str
    fields: Mapping[str, Any]


def order_topics(recording: Recording, wanted: Sequence[str]) -> dict[str, Topic]:
    """Return which recorded topics hold orders, among those wanted; raises RecordingError without commands."""
    kinds = {kind.type: kind for kind in (*COMMANDS, RIG_EVENT, PARAMETER_EVENTS)}
    found = {name: kinds[recording.topics[name].type] for name in wanted if recording.topics[name].type in kinds}
    if not any(kind in COMMANDS for kind in found.values()):
        raise RecordingError(f'{recording.path}: no drive velocities and no forces in it; give a recording of an axis')
    for kind in kinds.values():
        _check_single(kind, [name for name, its in found.items() if its is kind])
    return found


def state_topic(recording: Recording) -> str:
    """Return the one topic of states; raises RecordingError when there are none, InputError when there are more."""
    names = [name for name, topic in recording.topics.items() if topic.type == SLIDER_STATE.type]
    if not names:
        raise RecordingError(f'{recording.path}: no states in it, so nobody knows its steps; replay it in real time')
    _check_single(SLIDER_STATE, names)
    return names[0]


def order_of(kind: Topic, data: bytes) -> Any:
    """Return the message that a recorded order is; raises RecordingError on bytes that are none."""
    try:
        return deserialized(kind, data)
    except ValueError:
        raise RecordingError(f'{kind.name}: {len(data)} recorded bytes are no {kind.type}; the recording is damaged: '
                             'play what is before with playback_duration') from None


def request_of(kind: Topic, data: bytes) -> Request | None:
    """Return how an order other than a command is given to an axis; None where it follows from the others."""
    message = order_of(kind, data)
    if kind is PARAMETER_EVENTS:
        changed = [parameter for parameter in message.changed_parameters if parameter.name in BY_NAME]
        return Request('set_parameters_atomically', {'parameters': changed}) if changed else None
    if message.kind == RigEventKind.FAULT_INJECTED:
        return Request('inject_fault', {'id': message.id, 'kind': message.fault, 'start': message.start,
                                        'duration': message.duration, 'value': message.value})
    if message.kind == RigEventKind.FAULT_CLEARED and message.id:
        return Request('inject_fault', {'id': message.id, 'kind': _CLEAR})
    if message.kind == RigEventKind.FAULT_CLEARED:
        return Request('clear_faults', {})
    return None


def is_timeout(kind: Topic, data: bytes) -> bool:
    """Return whether a recorded message reports a command time-out."""
    return kind is RIG_EVENT and bool(order_of(kind, data).kind == RigEventKind.COMMAND_TIMEOUT)


def refusal_in(response: Any) -> str:
    """Return why an axis did not do as it was ordered; empty when it did."""
    if hasattr(response, 'result'):
        return '' if response.result.successful else str(response.result.reason)
    return '' if response.success else str(response.message)


def _check_single(kind: Topic, names: Sequence[str]) -> None:
    if len(names) > 1:
        raise InputError('topics', list(names), f'one of type {kind.type}', 'the recording is of several axes: name'
                         ' the topics of one')
