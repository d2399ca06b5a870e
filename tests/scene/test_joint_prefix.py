# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""joint_interface.prefix: what may stand before the names of joints and frames."""

import pytest

from stickslip_sim.inputs import load_scene
from stickslip_sim.scene import scene_from_values
from tests.support.scene_files import refusal

PREFIX = 'joint_interface.prefix'


@pytest.mark.parametrize('prefix', ['', 'x_', 'y', 'left/', 'Press-2/axis_1_', 'x' * 200])
def test_taken(prefix: str) -> None:
    scene = scene_from_values({PREFIX: prefix})
    assert scene.joint_prefix == prefix


@pytest.mark.parametrize('prefix', ['/x_', '_x', '1_', '-x', 'x.', 'x y_', 'x\n', 'ä_', 'x[', '<x>', '"', 'x:',
                                    'x' * 201, 7, True, ['x_']])
def test_refused(prefix: object) -> None:
    """TF takes no name that begins with a slash, ros2_control has dots in the names of its parameters."""
    found = refusal(scene_from_values, {PREFIX: prefix})
    assert found.name == PREFIX
    assert 'empty, or a letter' in found.allowed


def test_left_out_there_is_none_and_the_scene_is_what_it_was() -> None:
    scene = load_scene('paper_fig8')
    assert scene.joint_prefix == ''
    assert PREFIX not in scene.values    # it would change the hash of each scene that was ever recorded
