# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""One factor on all of friction: in a scene, in a study, and in the scenes that advise and compare derive."""

import numpy as np
import pytest

from stickslip_sim.advise.friction_parts import friction_parts
from stickslip_sim.compare.conventional import characteristics_beside
from stickslip_sim.inputs import load_scene
from stickslip_sim.runs import simulate_events
from stickslip_sim.scene import changed, scene_names
from stickslip_sim.study import EvenGrid, Study, variation

SCALED = {'friction.scale': 1.25}


def test_a_scene_without_it_says_nothing_of_it() -> None:
    assert all('friction.scale' not in load_scene(name).values for name in scene_names())


@pytest.mark.parametrize('name', ['paper_fig7', 'paper_fig8', 'stribeck'])
def test_all_coefficients_are_scaled_as_by_the_fault(name: str) -> None:
    fault = {'faults.ids': ['dry'], 'faults.kinds': ['friction_scale'], 'faults.starts': [0.0],
             'faults.durations': [1e6], 'faults.values': [1.25]}
    scaled, faulty = (simulate_events(load_scene(name, changes), 3.0) for changes in (SCALED, fault))
    assert len(scaled.events) > 5
    assert [event.kind for event in scaled.events] == [event.kind for event in faulty.events]
    assert [event.time for event in scaled.events] == pytest.approx([event.time for event in faulty.events], rel=1e-9)


def test_more_friction_is_as_a_heavier_load() -> None:
    """Both times a power of two, so that the products are the same doubles."""
    scaled, loaded = (simulate_events(load_scene('paper_fig8', change), 3.0).events for change in (
        {'friction.scale': 2.0}, {'axis.normal_force': 2.0 * 3432.3275}))
    assert [event.time for event in scaled] == pytest.approx([event.time for event in loaded], rel=1e-12)


def test_a_study_varies_it_beside_static_friction() -> None:
    study = Study(load_scene('paper_fig8').values, EvenGrid((variation('friction.scale=0.8:1.2:3'),
                                                          variation('friction.static.limit=0.2:0.28:3'))))
    found = study.figures(0, study.count).break_away_force
    alone = [simulate_events(study.scene_at(point), 20.0).summary.last for point in study.points(0, study.count)]
    assert found == pytest.approx([cycle.break_away_force for cycle in alone if cycle], rel=1e-6)
    assert len(np.unique(found)) == study.count


def test_scenes_made_from_a_scaled_one_are_scaled_once() -> None:
    scene = changed(load_scene('paper_fig8'), SCALED)
    at_rest = scene.axis.friction.kinetic.coefficients[0]
    assert characteristics_beside(scene)['constant kinetic friction'].axis.friction.kinetic.coefficients == (at_rest,)
    part = next(part for part in friction_parts(scene) if part.name == 'speed dependence of mu_k')
    flat = changed(scene, part.variants[0].changes(dict(scene.values)))
    assert set(flat.axis.friction.kinetic.coefficients) == {at_rest}
