# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The sections of nodes in a ROS 2 parameter file, and which of their parameters are those of a scene."""

import re
from collections.abc import Iterator, Mapping, Sequence
from typing import NamedTuple

from ..core.errors import InputError

NODE = 'feed_axis'
_ALL_NODES = ('/**', '/*', '/**/' + NODE)
_PARAMETERS = 'ros__parameters'
_WILDCARDS = {'*': r'/\w+', '**': r'(/\w+)*'}   # one word of a name, or any number of them
_OF_THE_NODE = ('thread_priority', 'lock_memory', 'cpu_affinity', 'require_real_time', 'meant')
_OF_ROS = ('use_sim_time', 'start_type_description_service', 'qos_overrides.')   # any node has them


class Section(NamedTuple):
    """The parameters of a file for the nodes whose full names fit a pattern, such as `/x/feed_axis` or `/**`."""

    pattern: str
    parameters: Sequence[tuple[str, object]]   # by dotted name

    def fits(self, node: str) -> bool:
        """Return whether a node has these parameters, by its full name."""
        names = ''.join(_WILDCARDS.get(word, '/' + re.escape(word)) for word in self._words)
        return re.fullmatch(names, node) is not None

    @property
    def specificity(self) -> tuple[int, int]:
        """What is larger for a pattern that fits fewer nodes."""
        return sum(word not in _WILDCARDS for word in self._words), -self._words.count('**')

    @property
    def _words(self) -> list[str]:
        return self.pattern.strip('/').split('/')


def parameters_of(document: object) -> dict[str, object]:
    """Return the parameters for the node of the axis by dotted name, from a file that is for one axis only.

    Sections that match (`/**`, `/feed_axis`, in any namespace) are merged, and none may repeat what another gives, so
    that their order does not matter.  Raises InputError on anything else in the file.
    """
    values: dict[str, object] = {}
    for section in sections_of(document):
        if section.pattern not in _ALL_NODES and not section.pattern.endswith(f'/{NODE}'):
            raise InputError('node', section.pattern, f'/** or {NODE}',
                             'a scene file holds the parameters of one axis only')
        for name, value in section.parameters:
            if name in values:
                raise InputError(name, value, 'given once', 'it stands in this file twice; drop one')
            values[name] = value
    if not values:
        raise InputError('parameters', None, f'given in a section /**: {_PARAMETERS}:', 'see the shipped scenes')
    return values


def without_those_of_ros(values: Mapping[str, object]) -> dict[str, object]:
    """Return the parameters that are of a scene and not of every node."""
    return {name: value for name, value in values.items() if not name.startswith(_OF_ROS)}


def of_a_scene(values: Mapping[str, object]) -> dict[str, object]:
    """Return the parameters that are of a scene: neither of every node, nor of the node of an axis alone."""
    return {name: value for name, value in without_those_of_ros(values).items() if name not in _OF_THE_NODE}


def sections_of(document: object) -> list[Section]:
    """Return the sections of a parameter file, for all nodes; raises InputError on anything else in it."""
    return [*_sections(document, '')]


def _sections(tree: object, path: str) -> Iterator[Section]:
    if not isinstance(tree, Mapping):
        raise InputError(path or 'file', tree, f'a section /**: with {_PARAMETERS}: in it', 'see the shipped scenes')
    for key, inner in tree.items():
        if key != _PARAMETERS:
            yield from _sections(inner, _joined(path, key))
        elif not path or not isinstance(inner, Mapping):
            raise InputError(key, inner, 'a mapping inside /**:', f'write /**: and below it {_PARAMETERS}:')
        else:
            yield Section(path, [*_flat(inner, '')])


def _joined(path: str, key: str) -> str:
    return f'{path}/{key.strip("/")}'


def _fix_of_list(values: list[object]) -> str:
    """Return how a list of several types becomes one of one type."""
    others = [item for item in values if isinstance(item, bool) or not isinstance(item, int | float)]
    if others and len(others) < len(values):
        return f'{others[0]!r} is no number, and others are; correct it'
    return 'ROS wants 0.0, not 0, beside other numbers with a dot'


def _flat(tree: Mapping[str, object], path: str) -> Iterator[tuple[str, object]]:
    for key, value in tree.items():
        name = f'{path}.{key}' if path else key
        if isinstance(value, Mapping):
            yield from _flat(value, name)
            continue
        if isinstance(value, list) and len({type(item) for item in value}) > 1:
            raise InputError(name, value, 'a list of one type', _fix_of_list(value))
        yield name, value
