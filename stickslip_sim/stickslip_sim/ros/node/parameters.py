# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The scene as ROS parameters: declared from the one schema, and checked together whenever any of them changes."""

import difflib
import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from contextlib import nullcontext, suppress
from typing import Any

from rcl_interfaces.msg import FloatingPointRange, IntegerRange, ParameterDescriptor, SetParametersResult
from rclpy.exceptions import ParameterException
from rclpy.node import Node
from rclpy.parameter import Parameter

from ...bags.topics import CLOCK
from ...core.errors import InputError, suggestion
from ...inputs.profile_file import sections_with_file
from ...inputs.scene_files import load_scene, scene_with_profiles
from ...realtime.scheduling import Scheduling
from ...scene.build import scene_from_values
from ...scene.load import DEFAULT_SCENE, ENDINGS, named, of_a_scene, scene_names, without_those_of_ros
from ...scene.model import Scene, TimeSettings
from ...scene.parameter import Parameter as Entry
from ...scene.plausible import OF_NODE, check_plausible
from ...scene.schema import BY_NAME, NULL, PARAMETERS
from ...scene.values import yaml_value
from ..environment import refusing, variables
from ..programs import GivenParameters, NodeParameters
from .clock import check_sim_time

# A node that answers no endless request: it hears no command, and no Ctrl-C, while it answers one.

SIM_TIME = 'use_sim_time'
MOST_PARAMETERS = 1000   # that one request may set or ask for: a second or two
_REQUEST_LISTS = ('parameters', 'names', 'prefixes')

_Answer = Callable[[Any, Any], Any]


class BoundedNode(Node):  # type: ignore[misc]
    """A node with bounded requests, also of the services for parameters, which rclpy makes.

    `given` are its parameters on the command line.  Raises InputError when ROS refuses name, parameters or environment.
    """

    def __init__(self, name: str, given: GivenParameters) -> None:
        with refusing('ROS parameters or environment', variables(), ParameterException):
            super().__init__(name)
        self.given = given.of(self.get_fully_qualified_name())
        for path in self.given.passed_over:
            self.get_logger().warning(f'{path} has no section for {self.get_fully_qualified_name()}')
        sim_time = self.given.values.get(SIM_TIME)
        if sim_time not in (None, self.get_parameter(SIM_TIME).value):    # rclpy chose another section
            super().set_parameters_atomically([Parameter(SIM_TIME, value=sim_time)])

    def is_ready(self) -> bool:
        """Return whether it may begin."""
        return True

    def get_parameter(self, name: str) -> Parameter:
        """Return a parameter; one without a value as such, where rclpy would refuse all that is asked for with it."""
        if self.has_parameter(name):
            return self.get_parameter_or(name)
        parameter: Parameter = super().get_parameter(name)
        return parameter

    def create_service(self, srv_type: Any, srv_name: str, callback: _Answer, **options: Any) -> Any:
        """Offer a service; a request with too long a list gets the answer without results, and a warning in the log."""
        def answer(request: Any, response: Any) -> Any:
            count = max(len(getattr(request, name, ())) for name in _REQUEST_LISTS)
            if count <= MOST_PARAMETERS:
                return callback(request, response)
            self.get_logger().warning(f'{srv_name} = {count} parameters is refused: must be at most {MOST_PARAMETERS}'
                                      ' in one request; send several', throttle_duration_sec=1.0)
            return response

        return super().create_service(srv_type, srv_name, answer, **options)


# What a request to set parameters changes, and how it is refused what may not change; the same for every node.

_NOTHING = (None, 'None', 'null')   # what `ros2 param load` sends for a parameter that had no value
# What may stand for a list of doubles; param load sends some as one text.
_LISTS = Parameter.Type.INTEGER_ARRAY, Parameter.Type.STRING_ARRAY, Parameter.Type.STRING


def changes_of(node: Node, request: Sequence[Parameter], entries: Mapping[str, Entry],
               in_force: Mapping[str, object]) -> list[Parameter]:
    """Return the parameters that a request sets, without those that may not change and stay as they are.

    So `ros2 param load` takes what `ros2 param dump` wrote.  Raises InputError on one that may not change and would.
    """
    wanted = [promoted(parameter, entries.get(parameter.name)) for parameter in request]
    return [parameter for parameter in wanted
            if not _stays(node, parameter, entries.get(parameter.name), in_force.get(parameter.name))]


def promoted(parameter: Parameter, entry: Entry | None) -> Parameter:
    """Return the doubles that are meant by whole numbers, as in a scene file, and by texts of `ros2 param load`."""
    value: Any = parameter.value
    kind = entry and entry.type
    if kind == 'double' and (parameter.type_ == Parameter.Type.INTEGER or _is_loaded(value)):
        return Parameter(parameter.name, Parameter.Type.DOUBLE, float(value))
    if kind == 'double_array' and parameter.type_ in _LISTS:
        numbers = value[1:-1].split(', ') if isinstance(value, str) else value
        if numbers and (parameter.type_ == Parameter.Type.INTEGER_ARRAY or all(map(_is_loaded, numbers))):
            return Parameter(parameter.name, Parameter.Type.DOUBLE_ARRAY, [float(number) for number in numbers])
    return parameter


def _is_loaded(value: object) -> bool:
    """Return whether this is Python's text of a double: `param load` sends inf and 1e-06 as such, and lists of them."""
    with suppress(ValueError):
        return isinstance(value, str) and repr(float(value)) == value
    return False


def _stays(node: Node, parameter: Parameter, entry: Entry | None, now: object) -> bool:
    """Return whether to pass a parameter over, whose value is `now`; raises InputError when it may not change."""
    name, value = parameter.name, parameter.value
    if entry is None:
        if not node.has_parameter(name) or not node.describe_parameter(name).read_only:
            return False
        now = node.get_parameter(name).value
        is_same, text = value == now, str(now).lower()
    elif now in (None, ()) and value in _NOTHING:
        return True
    elif entry.live:
        return False
    else:
        is_same, text = _is_same(entry, value, now), 'omitted' if now is None else yaml_value(entry, now)
    if not is_same:
        raise InputError(name, value, f'{text}, as at the start',
                         'it cannot change while the node runs: start the node with another')
    return True


def _is_same(entry: Entry, value: object, now: object) -> bool:
    try:
        return entry.checked(value) == now
    except InputError:
        return False


_MEANT = Entry('meant', 'string_array', None, '', 'Scene parameters whose implausible values are intended.',
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


# A node whose parameters are those of a list, checked as those of a scene are.

class ListedNode(BoundedNode):
    """A node with the parameters of a list; `values` are those in force.

    Raises InputError when those given at the start are wrong.
    """

    def __init__(self, name: str, entries: Sequence[Entry], given: GivenParameters) -> None:
        super().__init__(name, given)
        self._entries = {entry.name: entry for entry in entries}
        self.values = values_at_start(self._entries, without_those_of_ros(self.given.values))
        declare(self, entries, self.values)

    def values_changed(self) -> None:
        """Let changed values take effect; for the heir."""

    def set_parameters_atomically(self, parameter_list: list[Parameter]) -> SetParametersResult:
        """Set all or none; refused with one line that says what, why and what to do."""
        try:
            wanted = changes_of(self, parameter_list, self._entries, self.values)
            ours = {parameter.name: parameter.value for parameter in wanted
                    if parameter.name in self._entries or not self.has_parameter(parameter.name)}
            values = self.values | checked_values(self._entries, ours)
        except InputError as error:
            return SetParametersResult(successful=False, reason=str(error))
        if not wanted:
            return SetParametersResult(successful=True)
        result = super().set_parameters_atomically(wanted)
        if result.successful and ours:
            self.values = values
            self.values_changed()
        return result


def values_at_start(entries: Mapping[str, Entry], given: Mapping[str, object]) -> dict[str, object]:
    """Return the value of every parameter, given or default; raises InputError."""
    defaults = {name: entry.default for name, entry in entries.items()}
    return defaults | checked_values(entries, {name: value for name, value in given.items()
                                               if value != NULL or name not in entries})


def checked_values(entries: Mapping[str, Entry], given: Mapping[str, object]) -> dict[str, object]:
    """Return the values that are given as the types of their parameters; raises InputError."""
    for name, value in given.items():
        if name not in entries:
            close = difflib.get_close_matches(name, entries, 1, cutoff=0.5)
            raise InputError(name, value, 'one of ' + ', '.join(entries),
                             f'did you mean {close[0]}?' if close else 'drop it')
    return {name: entries[name].checked(value) for name, value in given.items()}


# The parameters that say how the kernel should treat the step thread; of the machine, and so no part of a scene.

_ENTRIES = (
    Entry('thread_priority', 'integer', 0, '', 'SCHED_FIFO priority of the step thread; 0 disables it.', 0, 99),
    Entry('lock_memory', 'bool', False, '', 'Lock all memory of the process in RAM.'),
    Entry('require_real_time', 'bool', False, '', 'Refuse to start unless thread_priority, lock_memory and'
          ' cpu_affinity are granted.'),
)
_CORES = 'cpu_affinity'
_ANY_CORE = -1


def scheduling_of(node: Node, given: Mapping[str, object], time: TimeSettings) -> Scheduling:
    """Declare the parameters, of which some are given; return what they want.  Raises InputError."""
    values: dict[str, Any] = {entry.name: entry.checked(given.get(entry.name, entry.default)) for entry in _ENTRIES}
    cores = cores_of(given.get(_CORES, _ANY_CORE))
    declare(node, _ENTRIES, values)
    node.declare_parameter(_CORES, list(cores) if len(cores) > 1 else next(iter(cores), _ANY_CORE), ParameterDescriptor(
        description='Core or cores of the step thread; -1: any.', read_only=True,
        dynamic_typing=True), ignore_override=True)
    _check_mode(values, time)
    return Scheduling(values['thread_priority'], values['lock_memory'], cores, values['require_real_time'])


def _check_mode(values: Mapping[str, Any], time: TimeSettings) -> None:
    """Raise InputError on a priority for steps that nothing paces: they would keep a core for themselves."""
    if values['thread_priority'] and not time.is_paced:
        mode = f'time.mode: {time.mode}' + ('' if time.mode == 'lockstep' else ' and time.factor: .inf')
        raise InputError('thread_priority', values['thread_priority'], f'0 with {mode}',
                         'steps without waiting would never yield the core')


def cores_of(value: object) -> tuple[int, ...]:
    """Return the cores of an integer or of a list of them; raises InputError."""
    if type(value) is int and value == _ANY_CORE:
        return ()
    cores: list[Any] = [value] if isinstance(value, str) or not isinstance(value, Iterable) else list(value)
    if not cores or not all(type(core) is int and core >= 0 for core in cores):
        raise InputError(_CORES, value, 'a core or a list of cores, as in 1 or [0, 1]', 'give whole numbers >= 0')
    return tuple(sorted(set(cores)))
