# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The limits in docs/security.md are those of the code."""


import pytest

from stickslip_sim.config import parameter, ros_yaml
from stickslip_sim.core.input_profile import MAX_SINUSOIDS
from stickslip_sim.friction.kinetic import MAX_BREAKPOINTS
from stickslip_sim.inputs import csv_table
from stickslip_sim.recording import mcap_records, opening, reader, schemas
from stickslip_sim.rig.faults import MAX_FAULTS
from stickslip_sim.runs import samples, simulated
from stickslip_sim.scene import profile_schema
from stickslip_sim.study import folder
from stickslip_sim.verify import recorded_steps
from tests.support.repository import ROOT

ROWS = [line for line in (ROOT / 'docs/security.md').read_text().splitlines() if '|' in line]


@pytest.mark.parametrize(('what', 'limits'), [
    ('a scene, limits or other', (ros_yaml.SIZE_LIMIT, ros_yaml.MOST_NODES, ros_yaml.MOST_LEVELS,
                                  ros_yaml.MOST_NUMBERS, ros_yaml.LISTS_LIMIT)),
    ('points of a profile', (profile_schema.MOST_POINTS, csv_table.MOST_BYTES)),
    ('a text in a scene', (parameter.TEXT_LIMIT,)),
    ('breakpoints of a friction table', (MAX_BREAKPOINTS, MAX_SINUSOIDS, MAX_FAULTS)),
    ('a record of a bag', (mcap_records.RECORD_LIMIT >> 20,)),
    ('schemas, attachments', (opening.MOST_BESIDE >> 20,)),
    ('a definition', (schemas.LONGEST_DEFINITION, schemas.MOST_ELEMENTS)),
    ('a topic of a bag', (reader.MOST_TOPIC_BYTES >> 20,)),
    ('the description of a sweep', (folder.LONGEST_SIDECAR >> 20,)),
    ('steps that a recording may lack', (recorded_steps.MOST_MISSING,)),
    ('samples and events', (simulated.MAX_SAMPLES, samples.MOST_IN_MEMORY, simulated.MAX_EVENTS)),
])
def test_limits(what: str, limits: tuple[int, ...]) -> None:
    (row,) = [row for row in ROWS if row.startswith(f'| {what}')]
    given = [int(word) for word in row.split('|')[2].replace(';', ' ').replace(',', ' ').split() if word.isdecimal()]
    assert tuple(given) == limits


def test_limits_of_the_node() -> None:
    pytest.importorskip('rclpy')
    from stickslip_msgs.srv import Step
    from stickslip_sim.ros.node.bounded_node import MOST_PARAMETERS
    from stickslip_sim.ros.node.endpoints import COMMAND_SIZE

    page = '\n'.join(ROWS)
    assert f'| a message on a command topic | {COMMAND_SIZE} bytes |' in page
    assert f'| steps of one `~/step` | {Step.Request.MAX_STEPS} |' in page
    assert f'| parameters that one request sets or asks for | {MOST_PARAMETERS} |' in page
