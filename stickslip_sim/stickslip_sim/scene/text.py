# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""A scene as text: one canonical ROS 2 parameter file for one set of effective values."""

import json
import math
import re
from collections.abc import Mapping

from ..config.parameter import Parameter, yaml_word
from .schema import NULL, PARAMETERS

_WHOLE = re.compile(r'(?<![.\d])(\d+)(?=e)')   # of a number without a dot


def scene_text(values: Mapping[str, object], remarks: Mapping[str, str] | None = None) -> str:
    """Return effective values as a scene file, in the order of the schema; equal values give equal text.

    `remarks` are put behind parameters, by their names, as comments.
    """
    lines = ['/**:', '  ros__parameters:']
    inside: list[str] = []
    for entry in PARAMETERS:
        if entry.name not in values:
            continue
        *sections, leaf = entry.name.split('.')
        for depth, section in enumerate(sections):
            if inside[:depth + 1] != sections[:depth + 1]:
                lines.append(f'{_indent(depth)}{section}:')
        inside = sections
        remark = (remarks or {}).get(entry.name)
        lines.append(f'{_indent(len(sections))}{leaf}: {yaml_value(entry, values[entry.name])}'
                     + (f'    # {remark}' if remark else ''))
    return '\n'.join(lines) + '\n'


def file_name(name: str) -> str:
    """Return a name from outside as a part of a file name: it leads nowhere else."""
    return re.sub(r'[^\w.+-]+', '_', name)


def _indent(depth: int) -> str:
    return '  ' * (depth + 2)


def yaml_value(entry: Parameter, value: object) -> str:
    """Return an effective value as it is written in a scene file, or `null`."""
    if value == NULL:
        return NULL
    if isinstance(value, tuple) and entry.type == 'double_array':
        return _doubles(value)
    if isinstance(value, tuple):
        return '[' + ', '.join(yaml_value(entry, item) for item in value) + ']'
    if isinstance(value, float):
        return _double(value)
    if isinstance(value, str) and not entry.choices:
        return json.dumps(value, ensure_ascii=False)
    return yaml_word(value)


def _doubles(values: tuple[float, ...]) -> str:
    """Return a list of doubles, as `_double` writes them."""
    return _WHOLE.sub(r'\1.0', str([*values])).replace('inf', '.inf')


def _double(value: float) -> str:
    """Return the shortest text of the same double, with a dot, so that every YAML reader sees a double."""
    if math.isinf(value):
        return '.inf' if value > 0.0 else '-.inf'
    mantissa, e, exponent = repr(value).partition('e')
    return mantissa + ('' if '.' in mantissa else '.0') + e + exponent
