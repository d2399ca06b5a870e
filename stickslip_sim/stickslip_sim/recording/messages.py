# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The messages of a run, made from the outputs of the simulation; stamps in ns."""

from collections.abc import Iterable, Mapping
from operator import attrgetter
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..bags.message_layout import FixedLayout, Layout
from ..bags.schemas import MessageCodec, flat_layout
from ..bags.topics import JOINT_STATES, Topic
from ..core.time_grid import NANOSECONDS
from ..core.types import Event, Sample
from ..core.version import __version__
from ..simulation import Fault, RigEvent
from .run import RunFacts

Fields = dict[str, object]

_NAMES = {'force': 'friction_force', 'coefficient': 'friction_coefficient'}   # for the fields with names of their own


def numbers_of_steps(names: Iterable[str], steps: NDArray[np.int64], columns: Mapping[str, NDArray[Any]]
                     ) -> dict[str, NDArray[Any]]:
    """Return the fields of messages of steps: the number of the step, then fields named as in Sample."""
    of_step, *others = names
    known = {**columns, 'time': columns['second'] + columns['fraction']}
    return {of_step: steps, **{name: known[_NAMES.get(name, name)] for name in others}}


class Packer:
    """Makes the bytes of a type of message with the number of a step, then fields that are named as in Sample or Event.

    The order of the fields is that of `layout`, by default the installed definition.
    """

    def __init__(self, topic: Topic, layout: Layout | None = None) -> None:
        self._layout = layout or flat_layout(topic.type)
        _, *names = self._layout.names
        self._numbers = attrgetter(*(_NAMES.get(name, name) for name in names))

    def pack(self, stamp_ns: int, step: int, output: Sample | Event) -> bytes:
        """Return the CDR bytes of the message."""
        return self._layout.pack(stamp_ns, step, *self._numbers(output))


# Where the slider should be, and how fast, in the bag of a closed loop.

SETPOINT = JOINT_STATES._replace(name='setpoint')


def slider_joint(prefix: str) -> str:
    """Return the joint of the slider of an axis."""
    return f'{prefix}axis_slider'


_ENDS = {'position': 28, 'velocity': 12}    # bytes from the end: each behind the length of its list, no effort


def setpoint_layout(joint: str) -> FixedLayout:
    """Return the layout of a setpoint: a JointState of this joint, with its position (m) and velocity (m/s)."""
    one, none = np.zeros(1), np.zeros(0)
    fields = {'header': header(0), 'name': [joint], 'position': one, 'velocity': one, 'effort': none}
    return FixedLayout(MessageCodec([SETPOINT.type]).encode(SETPOINT.type, fields), _ENDS)


def time_message(nanoseconds: int) -> Fields:
    """Return the fields of builtin_interfaces/Time."""
    sec, nanosec = divmod(nanoseconds, NANOSECONDS)
    return {'sec': sec, 'nanosec': nanosec}


def header(stamp_ns: int, frame: str = '') -> Fields:
    """Return the fields of std_msgs/Header."""
    return {'stamp': time_message(stamp_ns), 'frame_id': frame}


def rig_event(step: int, time_ns: int, stamp_ns: int, event: RigEvent) -> Fields:
    """Return the fields of RigEvent of what holds from the start of a step, at that simulation time."""
    fault = event.fault or Fault('', '', 0.0, 0.0, 0.0)
    return {
        'header': header(stamp_ns), 'step': step, 'time': time_ns * 1e-9, 'kind': int(event.kind), 'id': event.id,
        'fault': fault.kind, 'start': fault.start, 'duration': fault.duration, 'value': event.value,
        'count': event.number, 'text': event.text,
    }


def run_info(facts: RunFacts, stamp_ns: int, start_ns: int, bag_path: str) -> Fields:
    """Return the fields of RunInfo; `start_ns` is the stamp of simulation time 0."""
    return {
        'header': header(stamp_ns),
        'version': __version__,
        'scene': facts.scene,
        'scene_hash': facts.scene_hash,
        'solver': facts.solver,
        'seed': facts.seed,
        'bag_path': bag_path,
        'rate': facts.rate,
        'start_time': time_message(start_ns),
    }
