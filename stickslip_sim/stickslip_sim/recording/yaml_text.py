# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Plain data as YAML text in block style, the way rosbag2 writes its metadata."""

import json
import re
from collections.abc import Iterator, Mapping

_PLAIN = re.compile(r'[A-Za-z/][\w/. -]*[\w/.-]|[A-Za-z/]')
_OTHER_THAN_TEXT = frozenset(['true', 'false', 'null', 'yes', 'no', 'on', 'off', 'y', 'n', 'nan', 'inf'])


def to_yaml(data: object) -> str:
    """Return mappings, lists, texts, integers, booleans and None as YAML, without a line end at the end."""
    return '\n'.join(_lines(data))


def _lines(data: object) -> Iterator[str]:
    if isinstance(data, Mapping) and data:
        for key, value in data.items():
            yield from _entry(f'{_scalar(str(key))}:', value)
    elif isinstance(data, list) and data:
        for item in data:
            first, *rest = _lines(item)
            yield f'- {first}'
            yield from (f'  {line}' for line in rest)
    else:
        yield _scalar(data)


def _entry(key: str, value: object) -> Iterator[str]:
    if isinstance(value, (Mapping, list)) and value:
        yield key
        yield from (f'  {line}' for line in _lines(value))
    else:
        yield f'{key} {_scalar(value)}'


def _scalar(value: object) -> str:
    if value is None:
        return '~'
    if isinstance(value, str) and _PLAIN.fullmatch(value) and value.lower() not in _OTHER_THAN_TEXT:
        return value
    return json.dumps(value, ensure_ascii=False)  # JSON is YAML: quoted texts, numbers, true, {} and []
