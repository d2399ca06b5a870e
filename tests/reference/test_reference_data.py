# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The stored runs of the reference simulator: what it computes today, of the scenes as they are."""

from __future__ import annotations

import json

import pytest

mpmath = pytest.importorskip('mpmath')

from tests.reference.scenes import random_scenes, shipped_scenes  # noqa: E402
from tests.support.stored_objects import exact_run as simulate  # noqa: E402
from tests.support.stored_runs import stored  # noqa: E402


def test_stored_data_is_not_stale() -> None:
    name = next(n for n in stored() if n.startswith('random'))
    seed, index = (int(part) for part in name.split('_')[1:])
    scene, data = random_scenes(index + 1, seed)[index], stored()[name]
    assert json.loads(json.dumps(scene.parameters)) == data['parameters']
    run, events = simulate(data['parameters'], data['duration']), data['events']
    assert [e.kind for e in run] == events['kind']
    for column in ('time', 'position', 'velocity', 'drive_force'):
        assert [mpmath.nstr(getattr(e, column), 25) for e in run] == events[column]


def test_stored_runs_are_of_the_shipped_scenes_as_they_are() -> None:
    """Else: python -m tests.reference.make_data --only NAME."""
    for scene in shipped_scenes():
        assert stored()[scene.name]['duration'] == scene.duration
        assert json.loads(json.dumps(scene.parameters)) == stored()[scene.name]['parameters'], scene.name


def test_stored_data_holds_enough() -> None:
    names = list(stored())
    assert len([n for n in names if n.startswith('random')]) >= 40
    assert {'paper_fig7', 'paper_fig8', 'conventional_rigid', 'A', 'B', 'C', 'D'} <= set(names)
