# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The tables of docs/scene.md: every parameter of a scene, from the schema."""

from dataclasses import replace
from itertools import groupby

from benchmarks.page import replaced
from stickslip_sim.scene.parameter import Parameter, When
from stickslip_sim.scene.schema import BACKWARD, BY_NAME, PARAMETERS, backward_name
from stickslip_sim.scene.values import yaml_value

from .files import ROOT

_HEAD = '| name | type | default | range | with | meaning |\n|---|---|---|---|---|---|\n'
_LIKE = {'force': 'drive', 'normal_load': 'force'}    # sections that share parameters with another one


def page() -> str:
    """Return the text of the page with the tables of today; raises ValueError where it has no place for them."""
    tables = [f'## {section}\n\n{_section(section, [*entries])}'
              for section, entries in groupby(PARAMETERS, lambda entry: entry.name.rpartition('.')[0] or entry.name)]
    return replaced((ROOT / 'docs/scene.md').read_text(encoding='utf-8'), 'parameters', '\n'.join(tables))


def _section(section: str, entries: list[Parameter]) -> str:
    forward, _, last = section.rpartition('.')
    model = forward if last == BACKWARD else _LIKE.get(section, '')
    same = [entry for entry in entries if model and _is_same(entry, section, model)]
    rows = ''.join(_row(entry) for entry in entries if entry not in same)
    table = f'{_HEAD}{rows}' if rows else ''
    if not same:
        return table
    listed = ', '.join(f'`{entry.name}`' for entry in same)
    rest = (f'For motion along -x; type, unit, range and meaning are those of `{model}`, whose value is the default: '
            f'{listed}.\n' if last == BACKWARD else f'As in `{model}`: {listed}.\n')
    return '\n'.join(filter(None, (table, rest)))


def _is_same(entry: Parameter, section: str, model: str) -> bool:
    """Return whether a parameter differs from that of the model in nothing but its place; backwards, in the default."""
    other = BY_NAME.get(f'{model}.{entry.name.rpartition(".")[2]}')
    if other is None:
        return False
    when = entry.when and When(entry.when.name.replace(f'{section}.', f'{model}.', 1), entry.when.values)
    if when and other.when and set(other.when.values) - set(when.values) == {'position'}:    # of the drive alone
        when = other.when
    moved = replace(entry, name=other.name, when=when)
    if entry.name == backward_name(other.name):
        moved = replace(moved, default=other.default, required=other.required, description=other.description)
    return moved == other


def _row(entry: Parameter) -> str:
    choices = ', '.join(f'`{choice}`' for choice in entry.choices)
    kind = ', '.join(filter(None, (entry.type.replace('_', ' '), entry.unit, 'live' * entry.live)))
    cells = [f'`{entry.name}`', kind, _default(entry), choices or _range(entry), _when(entry), entry.description]
    return '| ' + ' | '.join(cell.replace('|', '\\|') for cell in cells) + ' |\n'


def _range(entry: Parameter) -> str:
    """Return bounds as `0 to 1e+12`, and others in the words of the schema."""
    low, joined, high = entry.range.partition(' and <= ')
    if not joined:
        return entry.range
    return f'above {low.removeprefix("> ")}, up to {high}' if entry.low_open else f'{low.removeprefix(">= ")} to {high}'


def _when(entry: Parameter) -> str:
    """Return the choice that gives a parameter a meaning, the shorter way: with which values, or with which not."""
    if entry.when is None:
        return ''
    name = entry.when.name.removeprefix(f'{entry.name.rpartition(".")[0]}.')
    others = [choice for choice in BY_NAME[entry.when.name].choices if choice not in entry.when.values]
    if 0 < len(others) < len(entry.when.values):
        return f'`{name}` not ' + ' or '.join(f'`{other}`' for other in others)
    return f'`{When(name, entry.when.values)}`'


def _default(entry: Parameter) -> str:
    if entry.default is None:
        return '*needed*' if entry.required else '*none*'
    return f'`{yaml_value(entry, entry.default)}`'
