# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The values of a scene, completed: names known, types and ranges right, defaults in place."""

import difflib
import json
import math
import re
from collections.abc import Mapping
from functools import cache
from typing import Any

from ..core.errors import InputError
from .parameter import Parameter, When, yaml_word
from .schema import BY_NAME, NULL, PARAMETERS


def complete_values(values: Mapping[str, object]) -> dict[str, Any]:
    """Return the value of every parameter that has a meaning, in the order of the schema; None counts as not given.

    Raises InputError on unknown names, wrong types and ranges, missing parameters, and those that contradict a choice.
    """
    given = {name: value for name, value in values.items() if value is not None}
    for name, value in given.items():
        if name not in BY_NAME:
            raise _unknown(name, value)
    complete: dict[str, object] = {}
    for entry in PARAMETERS:   # a choice stands before the parameters that depend on it
        if entry.name in given:
            complete[entry.name] = _checked(entry, given[entry.name], complete)
        elif entry.when is None or entry.when.holds(complete):
            _leave_out(entry, complete)
    return complete


def section_of(values: Mapping[str, Any], section: str) -> dict[str, Any]:
    """Return the values of a section (`friction.static`) by their names in it, those of sections inside it too."""
    return {short: values[name] for name, short in _names_in(section) if name in values}


@cache
def _names_in(section: str) -> tuple[tuple[str, str], ...]:
    prefix = f'{section}.'
    return tuple((name, name[len(prefix):]) for name in BY_NAME if name.startswith(prefix))


def stated(values: Mapping[str, object]) -> dict[str, object]:
    """Return values by dotted name without those that are left out in a file as `null`, which ROS reads as a text.

    `ros2 param dump` writes it for every parameter that has no value.  Unknown names stay, to be refused.
    """
    return {name: value for name, value in values.items() if value != NULL or name not in BY_NAME}


def overridden(base: Mapping[str, object], changes: Mapping[str, object]) -> dict[str, object]:
    """Return base values with changes; a changed choice drops the parameters of the old one in the base."""
    kept = {name: value for name, value in base.items() if not _outlived(name, changes)}
    return {**kept, **changes}


def _outlived(name: str, changes: Mapping[str, object]) -> bool:
    entry = BY_NAME.get(name)
    if entry is None or entry.when is None:
        return False
    if entry.when.name not in changes:
        return _outlived(entry.when.name, changes)   # that choice may depend on another
    return changes[entry.when.name] not in entry.when.values


def _checked(entry: Parameter, value: object, values: Mapping[str, object]) -> object:
    checked = entry.checked(value)
    if entry.when is not None and not entry.when.holds(values):
        when = _deciding(entry.when, values)
        choice = f'with {when.name}: {yaml_word(values[when.name])}' if when.name in values else f'without {when.name}'
        raise InputError(entry.name, value, f'omitted {choice}', f'drop it, or set {when}')
    return checked


def _deciding(when: When, values: Mapping[str, object]) -> When:
    """Return the condition that fails: a choice that is not there itself depends on another."""
    above = BY_NAME[when.name].when
    return when if when.name in values or above is None else _deciding(above, values)


def _leave_out(entry: Parameter, values: dict[str, object]) -> None:
    if entry.default is not None:
        values[entry.name] = entry.default
    elif entry.required:
        raise InputError(entry.name, None, f'given with {entry.when}: {entry.allowed}', 'add it')


def _unknown(name: str, value: object) -> InputError:
    """Return the error for a name that no parameter has, with the names there are and the most likely one."""
    section = name
    while section and not any(known.startswith(f'{section}.') for known in BY_NAME):
        section = section.rpartition('.')[0]
    if section:
        names = [known for known in BY_NAME if known.startswith(f'{section}.')]
        allowed = f'one of the parameters in {section}: ' + ', '.join(known[len(section) + 1:] for known in names)
    else:
        names = list(BY_NAME)
        allowed = 'in one of the sections ' + ', '.join(dict.fromkeys(known.partition('.')[0] for known in names))
    close = difflib.get_close_matches(name, names, 1) or difflib.get_close_matches(name, BY_NAME, 1)
    fix = f'did you mean {close[0]}?' if close and close[0] != name else 'there is no such parameter yet; drop it'
    if section == name:
        fix = 'it is a section: give one of its parameters'
    return InputError(name, value, allowed, fix)


# A scene as text: one canonical ROS 2 parameter file for one set of values.

_WHOLE = re.compile(r'(?<![.\d])(\d+)(?=e)')   # of a number without a dot


def scene_text(values: Mapping[str, object], remarks: Mapping[str, str] | None = None) -> str:
    """Return complete values as a scene file, in the order of the schema; equal values give equal text.

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
    """Return a value as it is written in a scene file, or `null`."""
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
