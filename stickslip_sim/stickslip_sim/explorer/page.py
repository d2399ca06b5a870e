# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The page as one text: template, engine, script, and what they need to know of scenes and of a measured run."""

import json
import zlib
from collections.abc import Mapping
from dataclasses import asdict
from pathlib import Path
from typing import Any

from ..core.arrays import Numbers
from ..core.errors import InputError
from ..core.hot_path import UNIT, hot_path
from ..core.version import __version__
from ..scene import Scene, scene_names
from ..scene.parameter import Parameter
from ..scene.schema import PARAMETERS
from ..scene.values import scene_text
from ..solvers.exact.axis_figures import AxisFigures

_HERE = Path(__file__).parent
_SCRIPTS = 'scene.js', 'motion.js', 'views.js', 'page.js'
COLUMNS = 'time', 'position', 'velocity', 'drive_force'
_MOST_ROWS, _DIGITS = 5000, 7   # of a measured run, as it is drawn


def thinned(columns: Mapping[str, Numbers]) -> dict[str, list[float]]:
    """Return those of COLUMNS that there are, of at most 5,000 rows, as evenly as they come."""
    every = -(-len(columns['time']) // _MOST_ROWS)
    return {name: [float(f'{value:.{_DIGITS}g}') for value in columns[name][::every].tolist()]
            for name in COLUMNS if name in columns}


def page_of(scene: Scene, beside: Mapping[str, list[float]] | None = None) -> str:
    """Return the page that opens with a scene, and `thinned` columns of a run behind; raises InputError."""
    if UNIT is None:
        raise InputError('hot path', hot_path(), 'compiled: it carries its script',
                         'build the package with a C compiler, and leave STICKSLIP_COMPILED=0 out')
    for name, value in scene.values.items():
        if _is_beyond(name, value):
            raise InputError(name, value, 'omitted in a page', 'docs/explore.md says what a page can run')
    data = json.dumps({
        'version': __version__, 'scene': scene_text(scene.values), 'beside': beside,
        'shipped': {one: _shipped(one) for one in scene_names()}, 'figures': asdict(AxisFigures()),
        'schema': [_entry(entry) for entry in PARAMETERS],
    }, ensure_ascii=False, separators=(',', ':')).replace('</', '<\\/').replace('<!--', '<\\!--')
    scripts = (zlib.decompress(UNIT.SCRIPT).decode(), f'const PAGE = {data};', *map(_text, _SCRIPTS))
    return _text('page.html').replace('/* STYLE */', _text('page.css')).replace('/* SCRIPT */', '\n'.join(scripts))


def _is_beyond(name: str, value: object) -> bool:
    """Return whether a page cannot run this; it says so itself of scenes that are opened there."""
    only = {'solver.name': 'exact', 'friction.scale': 1.0, 'friction.static.scatter': 0.0,
            'friction.static.scatter_run': 0.0}
    return (value != only.get(name, value) or (name, value) == ('drive.course', 'position') or '.backward.' in name
            or name in ('normal_load.course', 'faults.kinds'))


def _entry(entry: Parameter) -> dict[str, Any]:
    """Return what the page needs of a parameter; it knows what is left out."""
    told = {'name': entry.name, 'type': entry.type, 'unit': entry.unit or None, 'low': entry.low, 'high': entry.high,
            'lowOpen': entry.low_open or None, 'infinite': entry.infinite or None, 'choices': entry.choices or None,
            'when': entry.when and [entry.when.name, entry.when.values], 'required': entry.required or None,
            'allowed': entry.allowed, 'default': entry.default}
    return {name: value for name, value in told.items() if value is not None}


def _shipped(name: str) -> str:
    """Return a shipped scene without its remarks."""
    lines = (_HERE.parent / 'scenes' / f'{name}.yaml').read_text(encoding='utf-8').splitlines()
    return '\n'.join(line for line in lines if not line.lstrip().startswith('#'))


def _text(name: str) -> str:
    return (_HERE / name).read_text(encoding='utf-8')
