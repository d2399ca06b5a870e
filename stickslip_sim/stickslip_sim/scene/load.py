# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Scenes from text or values, and what the file of a scene says."""

import os
import pathlib
import re
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from functools import cache
from typing import NamedTuple

from ..core.errors import InputError, not_utf8, paths_beside, suggestion
from .build import scene_from_values
from .model import Scene
from .ros_yaml import LISTS_LIMIT, read_yaml
from .schema import BY_NAME, NULL
from .values import overridden, stated

# The sections of nodes in a ROS 2 parameter file, and which of their parameters are those of a scene.

NODE = 'feed_axis'
_ALL_NODES = ('/**', '/*', '/**/' + NODE)
_PARAMETERS = 'ros__parameters'
_WILDCARDS = {'*': r'/\w+', '**': r'(/\w+)*'}   # one word of a name, or any number of them
_OF_THE_NODE = ('thread_priority', 'lock_memory', 'cpu_affinity', 'require_real_time', 'meant')
_OF_ROS = ('use_sim_time', 'start_type_description_service', 'qos_overrides.')   # any node has them


class Section(NamedTuple):
    """The parameters of a file for the nodes whose full names fit a pattern, such as `/x/feed_axis` or `/**`."""

    pattern: str
    values: Sequence[tuple[str, object]]   # by dotted name

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


def values_of(document: object) -> dict[str, object]:
    """Return the values for the node of the axis by dotted name, from a file that is for one axis only.

    Sections that match (`/**`, `/feed_axis`, in any namespace) are merged, and none may repeat what another gives, so
    that their order does not matter.  Raises InputError on anything else in the file.
    """
    values: dict[str, object] = {}
    for section in sections_of(document):
        if section.pattern not in _ALL_NODES and not section.pattern.endswith(f'/{NODE}'):
            raise InputError('node', section.pattern, f'/** or {NODE}',
                             'a scene file holds the parameters of one axis only')
        for name, value in section.values:
            if name in values:
                raise InputError(name, value, 'given once', 'it stands in this file twice; drop one')
            values[name] = value
    if not values:
        raise InputError('parameters', None, f'given in a section /**: {_PARAMETERS}:', 'see the shipped scenes')
    return values


def without_those_of_ros(values: Mapping[str, object]) -> dict[str, object]:
    """Return the values that are of a scene and not of every node."""
    return {name: value for name, value in values.items() if not name.startswith(_OF_ROS)}


def of_a_scene(values: Mapping[str, object]) -> dict[str, object]:
    """Return the values that are of a scene: neither of every node, nor of the node of an axis alone."""
    return {name: value for name, value in without_those_of_ros(values).items() if name not in _OF_THE_NODE}


def sections_of(document: object) -> list[Section]:
    """Return the sections of a parameter file, for all nodes; raises InputError on anything else in it."""
    return [*_sections(document, '')]


def _sections(tree: object, path: str) -> Iterator[Section]:
    if not isinstance(tree, Mapping):
        raise InputError(path or 'file', tree, f'a section /**: with {_PARAMETERS}: in it', 'see the shipped scenes')
    for key, inner in tree.items():
        if key != _PARAMETERS:
            yield from _sections(inner, f'{path}/{key.strip("/")}')
        elif not path or not isinstance(inner, Mapping):
            raise InputError(key, inner, 'a mapping inside /**:', f'write /**: and below it {_PARAMETERS}:')
        else:
            yield Section(path, [*_flat(inner, '')])


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


_SHIPPED = pathlib.Path(__file__).parent.parent / 'scenes'
ENDINGS = ('.yaml', '.yml')
_NEEDED = ('friction.static', 'friction.kinetic')   # of a scene without a name
DEFAULT_SCENE = 'paper_fig8'


class SceneFile(NamedTuple):
    """What a scene file says: unchecked `values` by dotted name, one line for people, and the folder that it is in."""

    values: dict[str, object]
    summary: str
    folder: pathlib.Path


def scene_names() -> list[str]:
    """Return the names of the shipped scenes."""
    return sorted(path.stem for path in _SHIPPED.glob('*.yaml'))


def read_scene(name_or_path: str) -> SceneFile:
    """Return what the file of a shipped scene, or another one, says; raises InputError."""
    path = _find(name_or_path)
    text = read_text(path)
    values = _shipped_values(text) if path.parent == _SHIPPED else values_of(read_yaml(text))
    return SceneFile(values, _first_comment(text), path.parent)


def parse_scene(text: str) -> Scene:
    """Return the scene whose own text this is, `Scene.text`, with all of its values; raises InputError."""
    return scene_from_values(stated(of_a_scene(values_of(read_yaml(text)))), _first_comment(text))


def named_scene(values: Mapping[str, object], name: object = None) -> dict[str, object]:
    """Return the values that the parameters of a file change: those of the shipped scene that they name, or none.

    `name` takes the place of their `scene`.  Under a name of one's own they are a whole scene: what they leave out is
    not modelled.  Raises InputError on parameters without a name that leave out the friction.
    """
    name = name or values.get('scene')
    if name in scene_names():
        return _shipped_values(read_text(_find(str(name))))
    if isinstance(name, str) and name.endswith(ENDINGS):
        raise InputError('scene', name, 'a name in a file', 'give the file of that scene itself')
    left_out = [part for part in _NEEDED if not any(key.startswith(part) for key in values)]
    if name is None and left_out:
        raise InputError('scene', None, f'given in a file without {left_out[0]}',
                         f'name the shipped scene that it changes, as in scene: {DEFAULT_SCENE}, or give it its own')
    return {}


def values_in_file(scene: Scene) -> dict[str, object]:
    """Return what a file gives to be read as a scene: its values, and `null` for others of the shipped one it names."""
    others = [name for name in named_scene(scene.values) if name not in scene.values
              and ((entry := BY_NAME[name]).when is None or entry.when.holds(scene.values))]
    return {**scene.values, **dict.fromkeys(others, NULL)}


def changed(scene: Scene, changes: Mapping[str, object]) -> Scene:
    """Return a scene with changes by dotted name; the parameters of a changed choice go.  Raises InputError."""
    return scene_from_values(overridden(scene.values, changes)) if changes else scene


def unscaled(scene: Scene) -> Scene:
    """Return a scene without its factor `friction.scale`: the coefficients of its axis are those of its parameters."""
    return changed(scene, {'friction.scale': 1.0}) if 'friction.scale' in scene.values else scene


def parse_override(text: str) -> tuple[str, object]:
    """Return name and value of `a.b=value`, the value as in a scene file; raises InputError."""
    name, equals, word = text.partition('=')
    name = name.strip()
    if not equals or not name or not word.strip():
        raise InputError('--set', text, 'A.B=VALUE', 'for example axis.mass=400.0')
    with named(text):
        value = read_yaml(word)
    if isinstance(value, dict) or value is None:
        raise InputError(name, word.strip(), 'a number, a word, or a list of numbers', 'give one parameter at a time')
    return name, value


def _shipped_values(text: str) -> dict[str, object]:
    """Return the values of a shipped scene; each is parsed once, which takes most of the time of loading it."""
    return {name: list(value) if isinstance(value, list) else value for name, value in _parsed(text).items()}


@cache
def _parsed(text: str) -> dict[str, object]:
    return values_of(read_yaml(text))


def _find(name: str) -> pathlib.Path:
    """Return the file of a shipped name or path; a shipped name wins over a file of the same name."""
    if name in scene_names():
        return _SHIPPED / f'{name}.yaml'
    path = pathlib.Path(name)
    if name.endswith(ENDINGS) or os.sep in name or path.is_file():
        return path
    names = scene_names()
    raise InputError('scene', name, 'a file or one of ' + ', '.join(names),
                     suggestion(name, [*names, *paths_beside(path, ENDINGS)], 'check the name'))


def read_text(path: pathlib.Path, what: str = 'scene') -> str:
    """Return the text of a file of a scene, or of `what`; raises InputError."""
    try:
        with path.open('rb') as file:
            data = file.read(LISTS_LIMIT + 1)
        text = data.decode('utf-8-sig')
    except UnicodeDecodeError as error:
        raise InputError(what, path.name, 'text in UTF-8', not_utf8(error, what)) from None
    except (OSError, ValueError) as error:
        reason = error.strerror if isinstance(error, OSError) and error.strerror else str(error)
        beside = [place.rpartition(os.sep)[2] for place in paths_beside(path, [path.suffix or ENDINGS[0]])]
        raise InputError(what, path.name, 'a readable file', f'{reason}; ' + (
            'check path and permissions' if path.exists() else
            suggestion(path.name, beside, 'check path and permissions'))) from None
    if len(data) > LISTS_LIMIT:
        raise InputError(what, path.name, f'a file of at most {LISTS_LIMIT} bytes', f'is this a {what}?')
    return text


def _first_comment(text: str) -> str:
    """Return the comment in the first line, the description of the scene; empty without one."""
    first = text.partition('\n')[0].strip()
    return first.lstrip('#').strip() if first.startswith('#') else ''


@contextmanager
def named(source: str) -> Iterator[None]:
    """Put the source in front of the text of an InputError."""
    try:
        yield
    except InputError as error:
        error.args = (f'{" ".join(source.split())}: {error}',)
        raise
