# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""ROS reads scene files as this package does: the parser of rcl says so."""

import array
import pathlib
from importlib.resources import files

import pytest

from stickslip_sim.inputs import load_scene
from stickslip_sim.scene import scene_from_values, scene_names
from stickslip_sim.scene.ros_yaml import plain_value
from tests.support.scene_files import HEAD, write

rclpy = pytest.importorskip('rclpy')

pytestmark = [pytest.mark.ros, pytest.mark.filterwarnings('ignore:module .sre_:DeprecationWarning')]   # lark's

WORDS = ('350', '350.', '.5', '6e5', '-1E-3', '.inf', '-.inf', 'inf', '0x10', '010', '08', '1_000', '1:30', 'null', '~',
         '2020-01-01', '1e400', '1e-320', 'yes', 'Off', 'y', '1.0f', '9223372036854775808', 'rigid', '+5', '-0', '00',
         '+.INF')
OF_ROS = ('use_sim_time', 'start_type_description_service')


def parameters(path: str) -> dict[str, object]:
    """Return the parameters that a node gets from a file."""
    from rclpy.context import Context
    from rclpy.node import Node

    context = Context()
    rclpy.init(args=['--ros-args', '--params-file', path], context=context)
    node = Node('feed_axis', context=context, automatically_declare_parameters_from_overrides=True,
                start_parameter_services=False, enable_rosout=False)
    values = {name: parameter.value for name, parameter in node.get_parameters_by_prefix('').items()}
    node.destroy_node()
    rclpy.shutdown(context=context)
    return {name: tuple(value) if isinstance(value, (list, array.array)) else value
            for name, value in values.items() if name not in OF_ROS}


@pytest.mark.parametrize('name', scene_names())
def test_a_node_gets_the_same_scene(name: str, tmp_path: pathlib.Path) -> None:
    scene = load_scene(name)
    assert scene_from_values(parameters(str(files('stickslip_sim') / 'scenes' / f'{name}.yaml'))) == scene
    assert parameters(write(tmp_path, scene.text, '')) == scene.values


def test_plain_words_have_the_same_types(tmp_path: pathlib.Path) -> None:
    read = parameters(write(tmp_path, ''.join(f'    a{i}: {word}\n' for i, word in enumerate(WORDS)), HEAD))
    expected = {f'a{i}': plain_value(word) for i, word in enumerate(WORDS)}
    assert read == expected
    assert [type(read[name]) for name in expected] == [type(value) for value in expected.values()]


def test_extreme_values_survive(tmp_path: pathlib.Path) -> None:
    scene = load_scene('paper_fig8', {'scene': 'a "q" \\ é 😀 #: y', 'axis.mass': 1e-9, 'seed': 2**63 - 1,
                                      'axis.drive_stiffness': 1e18, 'axis.drive_damping': 2.3e-308})
    assert parameters(write(tmp_path, scene.text, '')) == scene.values
