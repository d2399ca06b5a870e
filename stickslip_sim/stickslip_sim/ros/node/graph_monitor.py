# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The graph monitor: who else publishes on the topics of this node, looked at once a second.

ROS lets anyone publish anywhere: two nodes on one topic are no error to it, but seldom what was meant.
"""

from collections.abc import Sequence

from rclpy.node import Node

from ...bags import topics
from ...bags.topics import Topic
from ...realtime.commands import CommandSlot
from ...realtime.step_loop import StepLoop
from ...scene.model import Scene
from ...simulation import SILENT_BRIDGE

_OUTPUTS = (topics.SLIDER_STATE, topics.FRICTION_FORCE, topics.MODE_EVENT, topics.RIG_EVENT, topics.TIMING,
            topics.RUN_INFO)
_PATIENCE = 3            # looks at a bridge that sends nothing, or at a publisher whose node is not known
_UNKNOWN = '_UNKNOWN_'   # in the name of such a node: ROS hears of it a moment after its topics, and never of plain DDS


class GraphMonitor:
    """Logs what changed since the look before, and returns what is not as it should be."""

    def __init__(self, node: Node, scene: Scene, loop: StepLoop) -> None:
        velocity, force = loop.slots
        outputs, commands = [*_OUTPUTS], [topics.DRIVE_VELOCITY]
        self._watched: list[_Output | _Input | _Bridge] = []
        if scene.time.makes_clock:
            outputs.append(topics.CLOCK)
        if scene.rig.measures:
            if not scene.joint_prefix:    # with one, the axes of a robot share the topic
                outputs.append(topics.JOINT_STATES)
            commands.append(topics.JOINT_COMMANDS)
            self._watched.append(_Bridge(node, velocity))
        self._watched += [_Output(node, topic) for topic in outputs]
        self._watched += [_VelocityInput(node, commands, velocity, loop, scene.command.timeout),
                          _Input(node, [topics.EXTERNAL_FORCE], force)]

    def look(self) -> list[str]:
        """Look around; return the troubles, each in a line."""
        return [trouble for watched in self._watched if (trouble := watched.look())]


class PublisherWatch:
    """Which nodes publish on some topics; their names cost ten times the count and are asked for when that changed.

    For `patience` looks a publisher whose node is not known yet counts as none.
    """

    def __init__(self, node: Node, topics: Sequence[Topic], patience: int = _PATIENCE) -> None:
        self._node, self._patience = node, patience
        self._topics = [node.resolve_topic_name(topic.name) for topic in topics]
        self._counts: list[int] = []
        self._unnamed = 0    # looks
        self.nodes: list[str] = []

    def have_changed(self) -> bool:
        """Look, and return whether the nodes are others than before."""
        counts = [self._node.count_publishers(topic) for topic in self._topics]
        if counts == self._counts:
            return False
        nodes = sorted(f'{info.node_namespace.rstrip("/")}/{info.node_name}' for topic in self._topics
                       for info in self._node.get_publishers_info_by_topic(topic))
        self._unnamed = self._unnamed + 1 if any(_UNKNOWN in node for node in nodes) else 0
        if 0 < self._unnamed < self._patience:
            return False
        before, self._counts, self.nodes = self.nodes, counts, nodes
        return nodes != before


class _Output:
    """A topic that is this node's."""

    def __init__(self, node: Node, topic: Topic) -> None:
        self._log, self._own = node.get_logger(), node.get_fully_qualified_name()
        self._topic = node.resolve_topic_name(topic.name)
        self._publishers = PublisherWatch(node, [topic])
        self._trouble = ''

    def look(self) -> str:
        if self._publishers.have_changed():
            others = list(self._publishers.nodes)
            if self._own in others:
                others.remove(self._own)    # once: a stranger may bear its name
            self._log_change(f'{", ".join(others)} publishes on {self._topic} too' if others else '')
        return self._trouble

    def _log_change(self, trouble: str) -> None:
        if trouble:
            self._log.warning(f'{trouble}: who listens there hears both')
        elif self._trouble:
            self._log.info(f'{self._topic} has one publisher again')
        self._trouble = trouble


class _Input:
    """The topics of one kind of command, of which one controller at a time makes sense."""

    def __init__(self, node: Node, topics: Sequence[Topic], slot: CommandSlot) -> None:
        self._log, self._slot = node.get_logger(), slot
        self._topics = ', '.join(node.resolve_topic_name(topic.name) for topic in topics)
        self._publishers = PublisherWatch(node, topics)
        self._trouble = ''

    def look(self) -> str:
        if self._publishers.have_changed():
            self._log_change(self._publishers.nodes)
        elif not self._publishers.nodes and not self._left_behind():
            self._trouble = ''
        return self._trouble

    def _log_change(self, nodes: list[str]) -> None:
        self._trouble = ''
        if len(nodes) > 1:
            self._trouble = f'{len(nodes)} controllers at once on {self._topics}: {", ".join(nodes)}'
            self._log.warning(f'{self._trouble}; the latest {self._slot.name} counts')
        elif nodes:
            self._log.info(f'{nodes[0]} alone commands the {self._slot.name}')
        else:
            self._log_gone()

    def _log_gone(self) -> None:
        if self._slot.latest is not None:
            self._log.info(f'nobody commands the {self._slot.name} any more: the latest acts until the next')

    def _left_behind(self) -> str:
        """Return the trouble that a controller leaves which is gone."""
        return ''


class _VelocityInput(_Input):
    """The drive velocity, of which a controller that dies leaves the latest in force until a time-out."""

    def __init__(self, node: Node, topics: Sequence[Topic], slot: CommandSlot, loop: StepLoop, timeout: float
                 ) -> None:
        super().__init__(node, topics, slot)
        self._loop, self._timeout = loop, timeout

    def _log_gone(self) -> None:
        self._trouble = self._left_behind()
        if self._trouble:
            self._log.warning(f'{self._trouble} (command.timeout ends that'
                              f'{f" after {self._timeout:g} s" if self._timeout else ""})')
        elif self._loop.rig.is_silent:
            self._log.info('the controller of the velocity is gone, and the command time-out has struck')

    def _left_behind(self) -> str:
        held = self._loop.held[0]
        if held is None or self._loop.rig.is_silent:    # since a reset; since the time-out
            return ''
        return f'the controller of the velocity is gone, and its {held:g} stays in force'


class _Bridge:
    """A topic-based hardware interface that is there but sends nothing."""

    def __init__(self, node: Node, slot: CommandSlot) -> None:
        self._log, self._slot = node.get_logger(), slot
        self._publishers = PublisherWatch(node, [topics.JOINT_COMMANDS])
        self._silent = 0     # looks

    def look(self) -> str:
        self._publishers.have_changed()
        nodes = self._publishers.nodes
        self._silent = self._silent + 1 if nodes and not self._slot.received else 0
        if self._silent < _PATIENCE:
            return ''
        trouble = f'{", ".join(nodes)} sends nothing on {topics.JOINT_COMMANDS.name}: {SILENT_BRIDGE}'
        if self._silent == _PATIENCE:
            self._log.warning(trouble)
        return trouble
