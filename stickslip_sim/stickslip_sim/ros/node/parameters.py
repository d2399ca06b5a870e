# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The scene as ROS parameters: declared from the one schema, and checked together whenever any of them changes."""

import math
from collections.abc import Mapping, Sequence
from contextlib import nullcontext

from rcl_interfaces.msg import FloatingPointRange, IntegerRange, ParameterDescriptor, SetParametersResult
from rclpy.node import Node
from rclpy.parameter import Parameter

from ...config.parameter import Parameter as Entry
from ...core.did_you_mean import suggestion
from ...core.errors import InputError
from ...inputs.profile_file import sections_with_file
from ...inputs.scene_files import load_scene, scene_with_profiles
from ...recording.topics import CLOCK
from ...scene.load import DEFAULT_SCENE, ENDINGS, named, scene_from_values, scene_names
from ...scene.model import Scene
from ...scene.plausible import OF_NODE, check_plausible
from ...scene.schema import BY_NAME, NULL, PARAMETERS
from ...scene.sections import of_a_scene
from ..process.given_parameters import GivenParameters, NodeParameters
from .bounded_node import SIM_TIME, BoundedNode
from .clock import check_sim_time
from .parameter_requests import changes_of

_MEANT = Entry('meant', 'string_array', None, '', 'parameters of the scene whose values are meant, however unusual',
               live=True)
_TYPES = {
    'double': Parameter.Type.DOUBLE, 'double_array': Parameter.Type.DOUBLE_ARRAY, 'string': Parameter.Type.STRING,
    'bool': Parameter.Type.BOOL, 'integer': Parameter.Type.INTEGER, 'string_array': Parameter.Type.STRING_ARRAY,
}


class SceneNode(BoundedNode):
    """A node whose parameters are a scene; `scene` is the one in force.

    Raises InputError when the parameters given at the start are no scene.
    """

    scene: Scene

    def __init__(self, name: str, given: GivenParameters) -> None:
        super().__init__(name, given)
        meant = self.given.values.get(_MEANT.name, NULL)
        declare(self, [_MEANT], {} if meant == NULL else {_MEANT.name: _MEANT.checked(meant)})
        with named(self.given.source) if self.given.source else nullcontext():
            self.scene = scene_at_start(self.given)
            check_plausible(self.scene.values, self._meant(), OF_NODE)
        name, given_names = self.scene.name, self.given.values
        if name == given_names.get('scene') and name not in scene_names() and not any(
                each.startswith('friction.') for each in given_names):
            self.get_logger().warning(f'the scene {name} leaves out the friction: the axis has none; '
                                      + suggestion(name, scene_names(), 'name a shipped scene, or give it its own'))
        declare(self, PARAMETERS, self.scene.values)
        self._warn(check_sim_time(self.scene.time, self.get_parameter(SIM_TIME).value))

    def check_change(self, scene: Scene) -> None:
        """Raise InputError on a scene that this node cannot change to; for the heir."""

    def scene_changed(self, scene: Scene, changed: Sequence[Parameter]) -> None:
        """Let a change take effect; for the heir."""

    def set_parameters_atomically(self, parameter_list: list[Parameter]) -> SetParametersResult:
        """Set all or none; refused with one line that says what, why and what to do."""
        try:
            wanted = changes_of(self, parameter_list, {**BY_NAME, _MEANT.name: _MEANT},
                                {**self.scene.values, _MEANT.name: self._meant()})
            ours = {parameter.name: parameter.value for parameter in wanted
                    if parameter.name in BY_NAME or not self.has_parameter(parameter.name)}
            scene = scene_from_values({**self.scene.values, **ours}) if ours else self.scene
            check_plausible({name: scene.values.get(name) for name in ours}, self._meant(wanted), OF_NODE)
            self.check_change(scene)
            warnings = [check_sim_time(scene.time, parameter.value, self.get_parameter(SIM_TIME).value,
                                       self.count_publishers(CLOCK.name) > 0)
                        for parameter in wanted if parameter.name == SIM_TIME]
        except InputError as error:
            return SetParametersResult(successful=False, reason=str(error))
        if not wanted:
            return SetParametersResult(successful=True)
        result = super().set_parameters_atomically(wanted)
        if result.successful:
            self._warn(*warnings)
        if result.successful and ours:
            self.scene = scene
            self.scene_changed(scene, [parameter for parameter in wanted if parameter.name in ours])
        return result

    def _meant(self, changes: Sequence[Parameter] = ()) -> Sequence[str]:
        """Return the names of what is meant, with changes."""
        latest = [self.get_parameter(_MEANT.name), *(each for each in changes if each.name == _MEANT.name)][-1]
        return tuple(latest.value or ())

    def _warn(self, *texts: str) -> None:
        for text in filter(None, texts):
            self.get_logger().warning(text)


def scene_at_start(given: NodeParameters) -> Scene:
    """Return the scene of the parameters given at the start, read as the tool reads a scene file; raises InputError."""
    in_files, single = of_a_scene(given.in_files), of_a_scene(given.single)
    name = str(single.get('scene', '' if in_files else DEFAULT_SCENE))
    if in_files and not name.endswith(ENDINGS):
        folders = {section: given.folders[f'{section}.file'] for section in sections_with_file(in_files)}
        return scene_with_profiles(in_files, single, folders)
    return load_scene(name, {key: value for key, value in {**in_files, **single}.items() if key != 'scene'})


def declare(node: Node, entries: Sequence[Entry], values: Mapping[str, object]) -> None:
    """Declare the parameters of a list with their descriptions; one without a value has its type only."""
    for entry in entries:
        value = _plain(values.get(entry.name))
        node.declare_parameter(entry.name, _TYPES[entry.type] if value in (None, []) else value, describe(entry),
                               ignore_override=True)


def describe(entry: Entry) -> ParameterDescriptor:
    """Return the ROS description of a parameter."""
    descriptor = ParameterDescriptor(
        description=entry.description + (f' [{entry.unit}]' if entry.unit else ''),
        additional_constraints=entry.allowed + (f'; only with {entry.when}' if entry.when else ''),
        read_only=not entry.live)
    if entry.low is not None and entry.high is not None:
        if entry.type == 'double':
            high = math.inf if entry.infinite else entry.high
            descriptor.floating_point_range = [FloatingPointRange(from_value=entry.low, to_value=high)]
        if entry.type == 'integer':
            descriptor.integer_range = [IntegerRange(from_value=int(entry.low), to_value=int(entry.high), step=1)]
    return descriptor


def _plain(value: object) -> object:
    return list(value) if isinstance(value, (list, tuple)) else value
