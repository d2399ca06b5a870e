# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Trial values of smooth laws of friction as tables."""

from dataclasses import replace

import pytest

from stickslip_sim.axis import Friction
from stickslip_sim.identification.axis_model import with_table
from stickslip_sim.scene import Scene, scene_from_values
from stickslip_sim.scene.build import friction_of

BACKWARDS: dict[str, object] = {
    'friction.static.backward.limit': 0.25, 'friction.kinetic.backward.initial': 0.13,
    'friction.kinetic.backward.stribeck_velocity': 0.02}


def scene(**changes: object) -> Scene:
    return scene_from_values({
        'scene': 'both_ways', 'axis.mass': 100.0, 'axis.drive_stiffness': 3e5, 'axis.normal_force': 1000.0,
        'friction.static.law': 'exponential', 'friction.static.initial': 0.15, 'friction.static.limit': 0.2,
        'friction.static.time_constant': 0.2, 'friction.kinetic.law': 'stribeck', 'friction.kinetic.initial': 0.12,
        'friction.kinetic.limit': 0.07, 'friction.kinetic.stribeck_velocity': 0.01, 'friction.kinetic.viscous': 0.2,
        **changes})


def by_table(friction: Friction) -> Friction:
    """Return friction whose kinetic tables do not know which law they stand for."""
    kinetic = replace(friction.kinetic, law=None, error=0.0, tolerance=0.0)
    return replace(friction, kinetic=kinetic, backward=friction.backward and by_table(friction.backward))


@pytest.mark.parametrize('accelerates', [False, True])
@pytest.mark.parametrize('backwards', [{}, BACKWARDS])
def test_the_table_of_a_smooth_law_is_that_of_the_scene_in_each_direction(backwards: dict[str, object],
                                                                          accelerates: bool) -> None:
    given = scene(**backwards, **{'friction.acceleration_dependence': accelerates})
    law = given.axis.friction.kinetic.law
    assert law is not None
    found = by_table(friction_of(with_table(dict(given.values), law.shape)))
    true = by_table(given.axis.friction)
    assert (found.backward is None) == (not backwards)
    for one, other in ((found, true), (found.backward or found, true.backward or true)):
        assert one.static == other.static
        assert one.kinetic.velocities == pytest.approx(other.kinetic.velocities)
        assert one.kinetic.coefficients == pytest.approx(other.kinetic.coefficients)
        assert (one.excess is None) == (other.excess is None) == (not accelerates)
        if one.excess is not None and other.excess is not None:
            assert one.excess.velocities == pytest.approx(other.excess.velocities)
