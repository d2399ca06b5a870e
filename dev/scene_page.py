# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The tables of docs/scene.md: every parameter of a scene, from the schema."""

from itertools import groupby

from benchmarks.page import replaced
from stickslip_sim.scene.parameter import Parameter
from stickslip_sim.scene.schema import PARAMETERS
from stickslip_sim.scene.values import yaml_value

from .files import ROOT

_HEAD = '| name | type | unit | default | range | with | live | meaning |\n|---|---|---|---|---|---|---|---|\n'


def page() -> str:
    """Return the text of the page with the tables of today; raises ValueError where it has no place for them."""
    tables = [f'## {section}\n\n{_HEAD}{"".join(map(_row, entries))}'
              for section, entries in groupby(PARAMETERS, lambda entry: entry.name.rpartition('.')[0] or entry.name)]
    return replaced((ROOT / 'docs/scene.md').read_text(encoding='utf-8'), 'parameters', '\n'.join(tables))


def _row(entry: Parameter) -> str:
    limits = ', '.join(f'`{choice}`' for choice in entry.choices) or entry.range
    cells = [f'`{entry.name}`', entry.type.replace('_', ' '), entry.unit, _default(entry), limits,
             f'`{entry.when}`' if entry.when else '', 'yes' if entry.live else '', entry.description]
    return '| ' + ' | '.join(cell.replace('|', '\\|') for cell in cells) + ' |\n'


def _default(entry: Parameter) -> str:
    if entry.default is None:
        return '*needed*' if entry.required else '*none*'
    return f'`{yaml_value(entry, entry.default)}`'
