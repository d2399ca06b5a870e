# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The solvers that a scene is tried with, each with settings from quick to careful."""

from ..scene import Scene
from .part import Changes

EXACT = 'exact'


def solver_settings(scene: Scene) -> dict[str, Changes]:
    """Return the changes to a scene that choose each solver, by a name for people; that of the scene is among them."""
    found: dict[str, Changes] = {EXACT: {'solver.name': EXACT}}
    for method, steps in (('euler', (1e-3, 1e-4, 1e-5)), ('rk4', (1e-3, 1e-4))):
        for step in steps:
            _add(found, {'solver.name': 'fixed_step', 'solver.method': method, 'solver.step': step})
    for tolerance in (1e-6, 1e-9, 1e-12):
        _add(found, {'solver.name': 'adaptive', 'solver.method': 'DOP853', 'solver.rtol': tolerance,
                     'solver.atol': tolerance})
    if scene.solver.name != EXACT:
        _add(found, {'solver.name': scene.solver.name,
                     **{f'solver.{name}': value for name, value in scene.solver.settings.items()}})
    return found


def _add(found: dict[str, Changes], changes: Changes) -> None:
    found[_label(**{name.removeprefix('solver.'): value for name, value in changes.items()})] = changes


def _label(name: str, method: str, step: float | None = None, rtol: float | None = None,
           atol: float | None = None) -> str:
    if step is not None:
        return f'{name} {method}, step {step * 1e3:g} ms'
    return f'{name} {method}, {rtol:g}' if rtol == atol else f'{name} {method}, rtol {rtol:g}, atol {atol:g}'
