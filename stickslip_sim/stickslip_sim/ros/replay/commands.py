# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Recorded orders into a live axis: by time or by step, as the clock of the axis wants it."""

from collections.abc import Iterator, Mapping
from threading import Event

from rclpy.node import Node

from ...core.errors import InputError
from ...recording.reader import Recording
from ...scene import Scene
from ...scene.load import NODE
from ...scene.schema import BY_NAME
from .live_axis import LiveAxis
from .orders import COMMANDS, InLockStep, InRealTime, order_topics
from .player import Act, Script
from .span import PlayedSpan, Settings, chosen_topics

# What a live axis has other than the scene that travels in a recording.

_SHOWN = 3
_ELSEWHERE = ('scene', 'time', 'clock', 'record', 'timing', 'joint_interface')   # sections without a say in the motion


def compared_names(scene: Scene) -> list[str]:
    """Return the parameters of a recorded scene that decide the motion."""
    return [name for name in scene.values if name in BY_NAME and name.partition('.')[0] not in _ELSEWHERE]


def difference_between(recorded: Scene, live: Mapping[str, object]) -> str:
    """Return in which parameters a live axis differs from the recorded scene, for people; empty where in none."""
    found = [f'{name} is {_plain(value)}, not {_plain(recorded.values[name])}' for name, value in live.items()
             if _plain(value) != _plain(recorded.values[name])]
    more = f', and {len(found) - _SHOWN} more' if len(found) > _SHOWN else ''
    return ', '.join(found[:_SHOWN]) + more


def _plain(value: object) -> object:
    """Return a value as ROS and scenes both have it: an empty list is none."""
    listed = list(value) if hasattr(value, '__iter__') and not isinstance(value, str) else value
    return None if listed == [] else listed


_STRIDE = 0.02    # s of the steady clock that pass with one call of ~/step


class Commands:
    """The script of all orders."""

    def __init__(self, node: Node, recording: Recording, settings: Settings, span: PlayedSpan, stop: Event) -> None:
        self.begin = span.begin
        self._node, self._recording, self._settings, self._span, self._stop = node, recording, settings, span, stop
        self._orders = order_topics(recording, chosen_topics(recording, settings.topics))
        self._axis = LiveAxis(node, settings.axis or self._recorded_axis(), stop)
        self._script: Script | None = None

    def prepare(self) -> None:
        """Ask the axis for its clock the first time; raises InputError when it is not there or goes its own way."""
        if self._script is None:
            self._script = self._make_script(*self._axis.parameters('time.mode', 'time.rate'))
            self._compare_scenes()
        self._script.prepare()

    def acts(self) -> Iterator[Act]:
        """Yield what happens, in the order of time."""
        return self._script.acts() if self._script else iter(())

    def _make_script(self, mode: str, rate: float) -> Script:
        if mode == 'realtime':
            return InRealTime(self._node, self._axis, self._recording, self._orders, self._span, self._stop)
        if mode != 'lockstep':
            raise InputError('time.mode', mode, 'realtime or lockstep for an axis that takes recorded commands',
                             'start it so')
        if self._settings.start_offset:
            raise InputError('start_offset', self._settings.start_offset, '0 in lock-step',
                             'in lock-step a run is repeated from its start')
        return InLockStep(self._node, self._axis, self._recording, self._orders, self._span, rate,
                          _STRIDE * max(1.0, self._settings.rate))

    def _compare_scenes(self) -> None:
        """Warn where the axis is not the one that was recorded: it will move in another way."""
        scene = self._recording.scene
        if scene is None:
            return
        names = compared_names(scene)
        if difference := difference_between(scene, dict(zip(names, self._axis.parameters(*names)))):
            self._node.get_logger().warning(
                f'{self._axis.name} has another scene than the recorded one: {difference}; it will not do what it did'
                ' then (docs/replay.md has how to start it with the recorded scene)')

    def _recorded_axis(self) -> str:
        command = next(name for name, kind in self._orders.items() if kind in COMMANDS)
        return f'{command.rpartition("/")[0]}/{NODE}'
