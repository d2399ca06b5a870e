# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Every topic of the node, once: name, type and quality of service.  ROS endpoints and bags are built from this."""

from typing import NamedTuple

Yaml = dict[str, object]

# What ROS writes for "no deadline": the largest duration, in two parts.
_INFINITE: Yaml = {'sec': 9223372036, 'nsec': 854775807}


class QosProfile(NamedTuple):
    """Quality of service; history is always "keep last" with `depth` messages."""

    depth: int
    reliability: str = 'reliable'  # or best_effort
    durability: str = 'volatile'   # or transient_local

    def as_yaml(self) -> Yaml:
        """Return the profile as rosbag2 writes it since version 9 of its metadata."""
        return {
            'history': 'keep_last',
            'depth': self.depth,
            'reliability': self.reliability,
            'durability': self.durability,
            'deadline': _INFINITE,
            'lifespan': _INFINITE,
            'liveliness': 'automatic',
            'liveliness_lease_duration': _INFINITE,
            'avoid_ros_namespace_conventions': False,
        }


class Topic(NamedTuple):
    """A topic; its name is relative to the node's namespace unless it begins with a slash.

    `qos` is that of who sends.  Of a topic of commands the node keeps `kept` messages for a step; 0: the node sends.
    """

    name: str
    type: str
    qos: QosProfile
    kept: int = 0

    @property
    def qos_of_node(self) -> QosProfile:
        """The quality of service that the node sends or hears with."""
        return self.qos._replace(depth=self.kept) if self.kept else self.qos

    def resolved(self, namespace: str = '/') -> 'Topic':
        """Return the topic with its name resolved in a namespace."""
        if self.name.startswith('/'):
            return self
        return self._replace(name=f'{namespace.rstrip("/")}/{self.name}')


_COMMAND = QosProfile(1, reliability='best_effort')
_KEPT = 64   # commands that may come within a step; of more the latest count
_STATE = QosProfile(10)

SLIDER_STATE = Topic('slider_state', 'stickslip_msgs/msg/SliderState', _STATE)
FRICTION_FORCE = Topic('friction_force', 'stickslip_msgs/msg/FrictionForce', _STATE)
MODE_EVENT = Topic('mode_event', 'stickslip_msgs/msg/ModeEvent', QosProfile(1000))
DRIVE_VELOCITY = Topic('drive_velocity', 'stickslip_msgs/msg/DriveVelocity', _COMMAND, _KEPT)
EXTERNAL_FORCE = Topic('external_force', 'stickslip_msgs/msg/ExternalForce', _COMMAND, _KEPT)
RUN_INFO = Topic('run_info', 'stickslip_msgs/msg/RunInfo', QosProfile(1, durability='transient_local'))
RIG_EVENT = Topic('rig_event', 'stickslip_msgs/msg/RigEvent', QosProfile(1000))
TIMING = Topic('timing', 'stickslip_msgs/msg/StepTiming', _STATE)
PARAMETER_EVENTS = Topic('/parameter_events', 'rcl_interfaces/msg/ParameterEvent', QosProfile(1000))
CLOCK = Topic('/clock', 'rosgraph_msgs/msg/Clock', QosProfile(1))
JOINT_STATES = Topic('joint_states', 'sensor_msgs/msg/JointState', _STATE)
JOINT_COMMANDS = Topic('joint_commands', 'sensor_msgs/msg/JointState', _COMMAND, _KEPT)
DIAGNOSTICS = Topic('/diagnostics', 'diagnostic_msgs/msg/DiagnosticArray', _STATE)

# What a bag holds; `BagWriter.write` takes the place in this list.
RECORDED = (
    SLIDER_STATE, FRICTION_FORCE, MODE_EVENT, DRIVE_VELOCITY, EXTERNAL_FORCE, RIG_EVENT, RUN_INFO, TIMING,
    PARAMETER_EVENTS,
)


def recorded_topics(namespace: str = '/') -> list[Topic]:
    """Return the topics of a bag with their names resolved in a namespace."""
    return [topic.resolved(namespace) for topic in RECORDED]
