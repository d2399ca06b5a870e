# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""docs/api.md: its lists are those of the code, and what it says beside them is so."""

import re

import pytest

import stickslip_sim
from dev.api import LISTS, PAGE, page, quality
from stickslip_sim.core import errors
from stickslip_sim.recording import topics
from tests.support.repository import ROOT


@pytest.fixture(scope='module')
def text() -> str:
    return PAGE.read_text(encoding='utf-8')


def test_the_lists_are_those_of_the_code(text: str) -> None:
    """`python3 -m dev.api` writes them; a line that goes or changes breaks the promise, and needs a major version."""
    assert page(text) == text


@pytest.mark.parametrize('name', LISTS)
def test_a_page_without_a_place_for_a_list_is_refused(name: str, text: str) -> None:
    with pytest.raises(ValueError, match=f'lacks <!-- {name}: begin'):
        page(text.replace(f'<!-- {name}: end -->', ''))


def test_each_list_has_what_users_meet() -> None:
    """Once for each way to find the names: a pattern that matches nothing would empty the list in silence."""
    assert '| `call inject-fault` | `KIND` |' in LISTS['verbs']()
    assert '| `simulate` | `SCENE` | `--duration`,' in LISTS['verbs']()
    assert "| `critical` | `scene, name, between=None, accuracy=1e-09, progress=None` |" in LISTS['python']().replace(
        '`(', '`').replace(')`', '`')
    assert '| `Cycle` | a tuple of `begin`,' in LISTS['python']()
    assert '| `/clock` | `rosgraph_msgs/msg/Clock` | out | reliable, keep last 1 | no |' in LISTS['topics']()
    assert '| `sim_node` | `~/step` | `stickslip_msgs/srv/Step` |' in LISTS['services']()
    assert '`simulation_interfaces/srv/StepSimulation`' in LISTS['services']()
    assert '| `replay_node` | `~/stop` | `std_srvs/srv/Trigger` |' in LISTS['services']()
    assert 'KIND_TIME_LOST 9' in LISTS['messages']()
    assert '`velocity` float64, `force` float64 → `success` bool' in LISTS['messages']()
    assert '| `axis` | `mass`, `drive_stiffness`,' in LISTS['parameters']()


def test_the_pages_of_topics_say_the_quality_of_service_of_the_node() -> None:
    assert '| `drive_velocity` | `stickslip_msgs/msg/DriveVelocity` | in | best effort, keep last 64 | yes |' in (
        LISTS['topics']())
    joints, loop = ((ROOT / 'docs' / name).read_text(encoding='utf-8') for name in ('ros2_control.md', 'hil.md'))
    for topic in (topics.JOINT_STATES, topics.JOINT_COMMANDS):
        assert f'\n`{topic.name}`, {quality(topic)}' in joints
    assert f'up to {topics.DRIVE_VELOCITY.kept} of' in loop


def test_the_exit_codes_are_those_of_the_errors(text: str) -> None:
    listed = {int(code) for code in re.findall(r'^\| (\d) \|', text, re.MULTILINE)}
    kinds = {one.exit_code for one in vars(errors).values()
             if isinstance(one, type) and issubclass(one, errors.StickslipError)}
    assert listed == kinds | {0}


def test_the_parameters_of_scheduling_are_as_many_as_it_says(text: str) -> None:
    source = (ROOT / 'stickslip_sim/stickslip_sim/ros/node/scheduling_parameters.py').read_text(encoding='utf-8')
    page_of_them = (ROOT / 'docs/realtime.md').read_text(encoding='utf-8')
    names = [*re.findall(r"Entry\('(\w+)'", source), 'cpu_affinity']
    assert len(names) == 4
    assert 'and four of [scheduling](realtime.md)' in text
    assert all(f'| `{name}` |' in page_of_them for name in names)


def test_every_public_name_has_a_row(text: str) -> None:
    for name in stickslip_sim.__all__:
        assert f'| `{name}` |' in text
