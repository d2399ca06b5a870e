# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""A node whose parameters are those of a list, checked as those of a scene are."""

import difflib
from collections.abc import Mapping, Sequence

from rcl_interfaces.msg import SetParametersResult
from rclpy.parameter import Parameter

from ...config.parameter import Parameter as Entry
from ...core.errors import InputError
from ...scene.schema import NULL
from ...scene.sections import without_those_of_ros
from ..process.given_parameters import GivenParameters
from .bounded_node import BoundedNode
from .parameter_requests import changes_of
from .parameters import declare


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
