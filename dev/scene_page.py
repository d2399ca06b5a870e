# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The tables of docs/scene.md: every parameter of a scene, from the schema."""

import re
from collections.abc import Callable
from dataclasses import replace
from itertools import groupby

from benchmarks.page import replaced
from stickslip_sim.report.text import markdown_table
from stickslip_sim.scene.parameter import Parameter, When, yaml_word
from stickslip_sim.scene.schema import BACKWARD, BY_NAME, PARAMETERS, backward_name
from stickslip_sim.scene.values import yaml_value

from .files import ROOT

_DEFAULT, MOST_WORDS = ' Default: ', 3    # in a description; of a default that goes into its column
_LIKE = {'force': 'drive', 'normal_load': 'force'}    # sections that share parameters with another one


def page() -> str:
    """Return the text of the page with the tables of today; raises ValueError where it has no place for them."""
    tables = [('' if section.endswith(f'.{BACKWARD}') else f'## {section}\n\n') + _section(section, [*entries])
              for section, entries in groupby(PARAMETERS, lambda entry: entry.name.rpartition('.')[0] or entry.name)]
    return replaced((ROOT / 'docs/scene.md').read_text(encoding='utf-8'), 'parameters', '\n'.join(tables))


def _section(section: str, entries: list[Parameter]) -> str:
    forward, _, last = section.rpartition('.')
    model = forward if last == BACKWARD else _LIKE.get(section, '')
    same = [entry for entry in entries if model and _is_same(entry, section, model)]
    table = _table([entry for entry in entries if entry not in same])
    if not same:
        return table
    if last == BACKWARD:
        rest = f'`{section}`: ' + ', '.join(f'`{entry.name.rpartition(".")[2]}`' for entry in same) + '.\n'
    else:
        rest = f'As in `{model}`: ' + ', '.join(f'`{entry.name}`' for entry in same) + '.\n'
    return '\n'.join(filter(None, (table, rest)))


def _is_same(entry: Parameter, section: str, model: str) -> bool:
    """Return whether a parameter differs from that of the model in nothing but its place; backwards, in the default."""
    other = BY_NAME.get(f'{model}.{entry.name.rpartition(".")[2]}')
    if other is None:
        return False
    when = entry.when and When(entry.when.name.replace(f'{section}.', f'{model}.', 1), entry.when.values)
    if when and other.when and set(other.when.values) - set(when.values) == {'position'}:    # of the drive alone
        when = other.when
    if when and {*when.values} == {*BY_NAME[when.name].choices}:    # with any choice
        when = None
    moved = replace(entry, name=other.name, when=when)
    if entry.name == backward_name(other.name):
        moved = replace(moved, default=other.default, required=other.required, description=other.description)
    return moved == other


def _table(entries: list[Parameter]) -> str:
    """Return the table of some parameters, without columns that are empty in all of them; '' for no parameter."""
    columns: dict[str, Callable[[Parameter], str]] = {
        'name': lambda entry: f'`{entry.name}`', 'type': _type, 'default': _default, 'range': _range, 'with': _when,
        'meaning': _meaning}
    filled = {name: shown for name, shown in columns.items() if any(map(shown, entries))}
    rows = [[shown(entry) for shown in filled.values()] for entry in entries]
    return '\n'.join([*markdown_table([*filled], rows), '']) if rows else ''


def _type(entry: Parameter) -> str:
    """Return the type, which goes without saying for a double and a choice, and the unit."""
    is_plain = entry.choices or entry.type == 'double'
    kind = '' if is_plain else entry.type.replace('double_', '').replace('_', ' ')
    return ', '.join(filter(None, (kind, entry.unit, 'live' * entry.live)))


def _range(entry: Parameter) -> str:
    """Return the choices or the interval, `(` and `)` without its end; in the words of the schema if it is neither."""
    if entry.choices:
        return ', '.join(f'`{choice}`' for choice in entry.choices)
    low, joined, high = entry.range.partition(' and <= ')
    if not joined:
        return entry.range
    end, _, infinite = high.partition(', or ')
    return (f'{"(" if entry.low_open else "["}{low.removeprefix("> ").removeprefix(">= ")}, {end}]'
            + f' or {infinite}' * bool(infinite)).replace('e+', 'e')


def _when(entry: Parameter) -> str:
    """Return the choice that gives a parameter a meaning, the shorter way: with which values, or with which not."""
    if entry.when is None:
        return ''
    name = entry.when.name.removeprefix(f'{entry.name.rpartition(".")[0]}.')
    others = [choice for choice in BY_NAME[entry.when.name].choices if choice not in entry.when.values]
    if 0 < len(others) < len(entry.when.values):
        return f'`{name}` not ' + ' or '.join(f'`{other}`' for other in others)
    return f'`{name}`: ' + ', '.join(map(yaml_word, entry.when.values))


def _default(entry: Parameter) -> str:
    """Return the default; of a parameter that may be absent, the one in its description if it is a few words."""
    if entry.default is not None:
        return f'`{yaml_value(entry, entry.default)}`'
    if entry.required:
        return '*needed*'
    words = entry.description.partition(_DEFAULT)[2].removesuffix('.').split()
    if len(words) > MOST_WORDS:
        return ''
    return f'`{words[0]}`' if len(words) == 1 else ' '.join(words)


def _meaning(entry: Parameter) -> str:
    """Return the description, with links to pages, without its default where that has a column."""
    meaning, _, default = entry.description.partition(_DEFAULT)
    shown = meaning if 0 < len(default.split()) <= MOST_WORDS else entry.description
    return re.sub(r'docs/((\w+)\.md[#\w-]*)', r'[\2](\1)', shown)
