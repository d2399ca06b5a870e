# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The scene as ROS parameters: declared from the one schema, and checked together whenever any of them changes."""

import math
from collections.abc import Mapping, Sequence
from contextlib import nullcontext
from pathlib import Path
from typing import NamedTuple

from rcl_interfaces.msg import FloatingPointRange, IntegerRange, ParameterDescriptor, SetParametersResult
from rclpy.exceptions import ParameterException
from rclpy.node import Node
from rclpy.parameter import Parameter

from ...config.parameter import Parameter as Entry
from ...core.errors import InputError
from ...inputs.profile_file import sections_with_file
from ...inputs.scene_files import load_scene, scene_with_profiles
from ...scene.load import named, read_parameters, scene_from_values, scene_names
from ...scene.model import Scene
from ...scene.plausible import OF_NODE, check_plausible
from ...scene.schema import BY_NAME, PARAMETERS
from ...scene.sections import describes_an_axis, of_a_scene
from ...scene.values import stated
from ..process.environment import refusing, variables
from .bounded_node import BoundedNode
from .clock import check_sim_time
from .parameter_requests import changes_of

_SIM_TIME = 'use_sim_time'
DEFAULT_SCENE = 'paper_fig8'
_MEANT = Entry('meant', 'string_array', None, '', 'parameters of the scene whose values are meant, however unusual',
               live=True)
_TYPES = {
    'double': Parameter.Type.DOUBLE, 'double_array': Parameter.Type.DOUBLE_ARRAY, 'string': Parameter.Type.STRING,
    'bool': Parameter.Type.BOOL, 'integer': Parameter.Type.INTEGER, 'string_array': Parameter.Type.STRING_ARRAY,
}


class FileParameters(NamedTuple):
    """What parameter files give of a scene, by dotted name; `source` names the files, and is empty without any.

    `folders`, by section of the scene, are those of the files that name a profile in a file.
    """

    source: str
    values: Mapping[str, object]
    folders: Mapping[str, Path]

    @classmethod
    def read(cls, paths: Sequence[str]) -> 'FileParameters':
        """Return what files give, read as the tool does; a later one wins.  Raises InputError."""
        values: dict[str, object] = {}
        folders: dict[str, Path] = {}
        for path in paths:
            given = of_a_scene(read_parameters(path))
            values |= given
            folders |= dict.fromkeys(sections_with_file(given), Path(path).parent)
        return cls(' + '.join(paths), stated(values), folders)


class SceneNode(BoundedNode):
    """A node whose parameters are a scene; `scene` is the one in force.

    Raises InputError when the parameters given at the start are no scene.
    """

    scene: Scene

    def __init__(self, name: str, files: FileParameters) -> None:
        with refusing('ROS parameters or environment', variables(), ParameterException):
            super().__init__(name)
        # rclpy has no public way to see what was given but never declared
        given = {name: parameter.value for name, parameter in self._parameter_overrides.items()}
        declare(self, [_MEANT], {'meant': _MEANT.checked(given['meant'])} if 'meant' in given else {})
        given = of_a_scene(given)
        with named(files.source) if files.source else nullcontext():
            self._check_addressed(files, given)
            self.scene = scene_at_start(given, files)
            check_plausible(self.scene.values, self._meant(), OF_NODE)
        if files.values and not describes_an_axis(given) and self.scene.name not in scene_names():
            self.get_logger().warning('the parameters say nothing of an axis: it stands still, without friction')
        declare(self, PARAMETERS, self.scene.values)
        self._warn(check_sim_time(self.scene.time, self.get_parameter(_SIM_TIME).value))

    def _check_addressed(self, files: FileParameters, given: Mapping[str, object]) -> None:
        """Raise InputError when a section of the files is for a node by another name, which ROS passes over."""
        for name, value in files.values.items():
            if name not in given:
                raise InputError(name, value, f'in a section of {self.get_fully_qualified_name()}',
                                 'name the section /**, or as this node')

    def check_change(self, scene: Scene) -> None:
        """Raise InputError on a scene that this node cannot change to; for the heir."""

    def scene_changed(self, scene: Scene, changed: Sequence[Parameter]) -> None:
        """Let a change take effect; for the heir."""

    def get_parameter(self, name: str) -> Parameter:
        """Return a parameter; one without a value as such, where rclpy would refuse all that is asked for with it."""
        if self.has_parameter(name):
            return self.get_parameter_or(name)
        parameter: Parameter = super().get_parameter(name)
        return parameter

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
            warnings = [check_sim_time(scene.time, parameter.value) for parameter in wanted
                        if parameter.name == _SIM_TIME]
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


def scene_at_start(given: Mapping[str, object], files: FileParameters) -> Scene:
    """Return the scene of the parameters given at the start, of which some are in files; raises InputError.

    Files that describe an axis are a whole scene, as for the tool; `scene` is just its name.  Otherwise `scene` is a
    shipped one or a file, and what else is given changes it.
    """
    in_files = files.values
    changes = {name: value for name, value in given.items() if name not in in_files or value != in_files[name]}
    if in_files and (describes_an_axis(in_files) or 'scene' not in changes):
        return scene_with_profiles(in_files, changes, files.folders)
    rest = {name: value for name, value in given.items() if name != 'scene'}
    return load_scene(str(given.get('scene', DEFAULT_SCENE)), rest)


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
