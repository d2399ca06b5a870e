# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The robot descriptions: what urdfdom takes, and what the node, RViz and robot_state_publisher find in them."""

import xml.etree.ElementTree as ET
from pathlib import Path

import pytest
import yaml

from tests.support.repository import ROOT
from tests.support.robot_descriptions import checked, expanded

pytest.importorskip('rclpy')

from stickslip_sim.ros.node.joints import JointNames

PACKAGE = ROOT / 'stickslip_sim'
ONE, TWO = (PACKAGE / 'urdf' / f'{name}.urdf.xacro' for name in ('feed_axis', 'cross_table'))
CONTROLLED = PACKAGE / 'ros2_control' / 'feed_axis.ros2_control.xacro'
EACH = [(ONE, ('',), ()), (ONE, ('x_',), ('prefix:=x_',)), (TWO, ('x_', 'y_'), ()),
        (CONTROLLED, ('',), ()), (CONTROLLED, ('left/',), ('prefix:=left/',))]


@pytest.mark.parametrize(('file', 'prefixes', 'words'), EACH)
def test_each_is_taken_and_has_what_the_messages_name(file: Path, prefixes: tuple[str, ...], words: tuple[str, ...],
                                                      tmp_path: Path) -> None:
    reported = checked(expanded(file, *words), tmp_path)
    assert 'root Link: world has 1 child(ren)' in reported
    assert all(f'  {prefix}{link}\n' in reported for prefix in prefixes for link in ('bed', 'drive_end', 'slider'))
    robot = ET.fromstring(expanded(file, *words))
    moving = {joint.get('name'): joint for joint in robot.findall('joint') if joint.get('type') == 'prismatic'}
    names = [JointNames.of(prefix) for prefix in prefixes]
    assert set(moving) == {joint for axis in names for joint in axis.joints}
    for axis in names:
        for joint in axis.joints:
            assert attribute(moving[joint], 'parent', 'link') == axis.bed
            assert attribute(moving[joint], 'axis', 'xyz') == '1 0 0'
            assert moving[joint].find('origin') is None    # the frames coincide at 0: positions are x in the bed
    root, *links = sorted(robot.findall('link'), key=lambda link: link.get('name') != 'world')
    assert (root.get('name'), len(root)) == ('world', 0)    # KDL, of robot_state_publisher, takes no root with inertia
    assert len(links) == 3 * len(prefixes)
    for link in links:
        assert link.find('visual/geometry/box') is not None
        assert float(attribute(link, 'inertial/mass', 'value')) > 0.0
        x, y, z = sorted(float(attribute(link, 'inertial/inertia', name)) for name in ('ixx', 'iyy', 'izz'))
        assert 0.0 < x <= y <= z < x + y    # as of a body


def test_the_mass_of_the_slider() -> None:
    robot = ET.fromstring(expanded(ONE, 'mass:=200'))
    slider, = (link for link in robot.findall('link') if link.get('name') == 'slider')
    assert float(attribute(slider, 'inertial/mass', 'value')) == 200.0


def test_two_axes_of_one_prefix_are_noticed(tmp_path: Path) -> None:
    with pytest.raises(AssertionError, match='not unique'):
        checked(expanded(TWO).replace('y_', 'x_'), tmp_path)


def test_the_snippet_of_the_page(tmp_path: Path) -> None:
    """An axis with its hardware in a description of one's own, as docs/ros2_control.md has it."""
    lines = [line for line in (ROOT / 'docs' / 'ros2_control.md').read_text(encoding='utf-8').splitlines()
             if line.startswith('    <xacro:')]
    assert len(lines) == 3
    text = '\n'.join(['<robot name="own" xmlns:xacro="http://www.ros.org/wiki/xacro">', '<link name="world"/>', *lines,
                      '</robot>'])
    file = tmp_path / 'own.xacro'
    file.write_text(text.replace('$(find stickslip_sim)', str(PACKAGE)), encoding='utf-8')
    urdf = expanded(file)
    assert '  x_slider\n' in checked(urdf, tmp_path)
    assert [tag.text for tag in ET.fromstring(urdf).findall('ros2_control/hardware/param')][:2] == [
        '/x/joint_states', '/x/joint_commands']


def test_rviz_shows_it_on_the_frame_that_is_its_root() -> None:
    shown = yaml.safe_load((PACKAGE / 'rviz' / 'feed_axis.rviz').read_text(encoding='utf-8'))['Visualization Manager']
    assert shown['Global Options']['Fixed Frame'] == 'world'
    model, = (display for display in shown['Displays'] if display['Class'] == 'rviz_default_plugins/RobotModel')
    assert model['Description Topic']['Value'] == '/robot_description'
    assert model['Description Topic']['Durability Policy'] == 'Transient Local'    # it is sent once


def attribute(element: ET.Element, path: str, name: str) -> str:
    """Return an attribute of what is found at a path, which must be there."""
    found = element.find(path)
    assert found is not None, path
    return found.attrib[name]
