# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Message definitions as bags carry them, their type hashes, and CDR encoding; no ROS needed."""

import os
import re
from collections.abc import Iterable, Iterator, Mapping
from contextlib import contextmanager
from functools import cache, lru_cache
from pathlib import Path
from typing import Any, NamedTuple

from rosbags.interfaces import Nodetype
from rosbags.typesys import Stores, get_types_from_msg, get_typestore
from rosbags.typesys.base import TypesysError
from rosbags.typesys.store import Typestore as Typestore

from ..core.errors import RecordingError
from .message_layout import Layout, number_fields

# The definitions of message types: those of the sourced workspace, and without ROS those that travel along.
#
# `stickslip_msgs/` beside this file has copies of the .msg files of the package of that name; rosbags knows the
# types of ROS 2 itself.  Types and hashes are the same, so that a bag made without ROS is one like any other.

OWN_PACKAGE = 'stickslip_msgs'
_OWN = Path(__file__).with_name(OWN_PACKAGE)


def definition(type_name: str) -> str:
    """Return the text that defines 'package/msg/Name', without what it depends on; raises RecordingError."""
    package, kind, name = type_name.split('/')
    files = [Path(prefix, 'share', package, kind, f'{name}.msg')
             for prefix in os.environ.get('AMENT_PREFIX_PATH', '').split(os.pathsep) if prefix]
    if package == OWN_PACKAGE:
        files.append(_OWN / f'{name}.msg')
    for file in files:
        if file.is_file():
            return file.read_text(encoding='utf-8')
    try:
        text, _ = _types_of_ros().generate_msgdef(type_name, ros_version=2)
    except TypesysError:
        raise RecordingError(f'no definition of {type_name} in AMENT_PREFIX_PATH; source the setup.bash of the '
                             'workspace') from None
    return text.partition('=' * 80)[0]


@cache
def _types_of_ros() -> Typestore:
    return get_typestore(Stores.ROS2_JAZZY)


LONGEST_DEFINITION = 128 * 1024    # letters of a definition: a second or two of reading
MOST_ELEMENTS = 1000    # of arrays of fixed length in a type, of texts and messages
_RULE = '=' * 80
_TYPE_OF_FIELD = re.compile(r'^\s*([A-Za-z]\w*(?:/\w+)*)(?:<=\d+)?(?:\[[^\]]*\])?\s+\w', re.MULTILINE)
_PRIMITIVE = frozenset(
    ['bool', 'byte', 'char', 'string', 'wstring', 'float32', 'float64']
    + [f'{sign}int{bits}' for sign in ('', 'u') for bits in (8, 16, 32, 64)]
)
_INSTALLED = get_typestore(Stores.EMPTY)   # the types of `schema`, each made once: that takes milliseconds


class Schema(NamedTuple):
    """A message type: its name, its definition with all that it depends on, and its RIHS01 hash."""

    type: str
    text: str
    hash: str


@cache
def schema(type_name: str) -> Schema:
    """Return the schema of 'package/msg/Name'; raises RecordingError when its definition is not installed."""
    text = _full_text(type_name, set())
    _add(_INSTALLED, {type_name: text})
    return Schema(type_name, text, _INSTALLED.hash_rihs01(type_name))


def store_of(definitions: Mapping[str, str]) -> Typestore:
    """Return a rosbags type store made of definitions like `Schema.text`, by type name; raises RecordingError."""
    return _store_of(tuple(definitions.items()))


@lru_cache(maxsize=64)   # most bags have the same definitions, and each takes as long as reading a thousand messages
def _store_of(definitions: tuple[tuple[str, str], ...]) -> Typestore:
    store = get_typestore(Stores.EMPTY)
    _add(store, dict(definitions))
    return store


def _add(store: Typestore, definitions: Mapping[str, str]) -> None:
    """Add the types of definitions to a store, but for those that it has; raises RecordingError."""
    types: dict[str, Any] = {}
    for name, text in definitions.items():
        if len(text) > LONGEST_DEFINITION:
            raise RecordingError(f'{name}: {len(text)} characters; at most {LONGEST_DEFINITION} are read')
        with understood(f'the definition of {name}'):
            types.update(get_types_from_msg(text, name))
    _check_arrays(types)
    with understood(f'the definition of {", ".join(definitions)}'):
        store.register({name: fields for name, fields in types.items() if name not in store.fielddefs})


@contextmanager
def understood(what: str, kind: type[Exception] = Exception) -> Iterator[None]:
    """Turn an error into a RecordingError; rosbags raises any, for it makes Python code of definitions, and runs it."""
    try:
        yield
    except kind as error:
        reason, *_ = str(error).splitlines() or [type(error).__name__]
        raise RecordingError(f'{what} cannot be read: {reason.rstrip(":")}') from None


@cache
def flat_layout(type_name: str) -> Layout:
    """Return the layout of an installed type that is a header without a frame and numbers."""
    schema(type_name)
    return Layout(number_fields(_INSTALLED, type_name))


class MessageCodec:
    """Encodes messages given as mappings, and decodes them; bytes as rclpy makes them (padding zero)."""

    def __init__(self, type_names: Iterable[str]) -> None:
        self._store = _INSTALLED
        for name in type_names:
            schema(name)

    def encode(self, type_name: str, values: Mapping[str, Any]) -> bytes:
        """Return the CDR bytes of a message with all its fields given.

        Nested messages are mappings too, lists of numbers numpy arrays.
        """
        return bytes(self._store.serialize_cdr(self._message(type_name, values), type_name, little_endian=True))

    def decode(self, type_name: str, data: bytes) -> Any:
        """Return the message as an object with the fields as attributes."""
        return self._store.deserialize_cdr(data, type_name)

    def _message(self, type_name: str, values: Mapping[str, Any]) -> Any:
        arguments = dict(values)
        for field, (node, inner) in self._store.fielddefs[type_name][1]:
            value = arguments.get(field)
            if node == Nodetype.NAME and isinstance(value, Mapping):
                arguments[field] = self._message(str(inner), value)
            elif node == Nodetype.SEQUENCE and inner[0][0] == Nodetype.NAME and isinstance(value, list):
                arguments[field] = [self._message(str(inner[0][1]), item) for item in value]
        create: Any = self._store.types[type_name]
        return create(**arguments)


def _check_arrays(types: Mapping[str, Any]) -> None:
    """Raise RecordingError when arrays of fixed length have too many elements: each becomes a line of code."""
    for name, (_, fields) in types.items():
        count = sum(inner[1] for _, (node, inner) in fields if node == Nodetype.ARRAY and not _is_number(inner[0]))
        if count > MOST_ELEMENTS:
            raise RecordingError(f'{name} has arrays of {count} elements; at most {MOST_ELEMENTS} are read')


def _is_number(element: tuple[Nodetype, Any]) -> bool:
    return element[0] == Nodetype.BASE and element[1][0] != 'string'


def _full_text(type_name: str, seen: set[str]) -> str:
    """Put the definitions one after the other as rosbag2_storage_mcap does: depth first, each once."""
    package = type_name.split('/')[0]
    text = definition(type_name)
    names = {name for name in _TYPE_OF_FIELD.findall(text) if name not in _PRIMITIVE}
    for name in sorted(name if '/' in name else f'{package}/{name}' for name in names):
        if name not in seen:
            seen.add(name)
            owner, short = name.split('/')[0], name.split('/')[-1]
            text += f'\n{_RULE}\nMSG: {name}\n' + _full_text(f'{owner}/msg/{short}', seen)
    return text
