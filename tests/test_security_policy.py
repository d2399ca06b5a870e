# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The permissions for SROS 2 are those that the node needs: no endpoint is missing, none is too many."""

import xml.etree.ElementTree as ET
from pathlib import Path

import pytest

from tests.ros_nodes import client, running
from tests.waiting import wait_for

pytestmark = pytest.mark.ros

POLICY = ET.parse(Path(__file__).parents[1] / 'stickslip_sim/security/stickslip.policy.xml').getroot()


def allowed(enclave: str, kind: str, act: str) -> set[str]:
    """Return the names that an enclave may publish, subscribe, reply to or request."""
    found = [place.text or '' for group in POLICY.findall(f".//enclave[@path='/stickslip/{enclave}']//{kind}s[@{act}]")
             for place in group.findall(kind) if group.get(act) == 'ALLOW']
    assert len(found) == len(set(found))
    return set(found)


def test_the_node_has_what_it_needs_and_no_more(tmp_path: Path) -> None:
    with client() as axis, running('-p', 'joint_interface.enabled:=true', '-p', 'time.mode:=lockstep', folder=tmp_path):
        axis.connect(is_moving=False)
        look = axis.node

        def names(endpoints: list[tuple[str, list[str]]]) -> set[str]:
            return {name for name, _ in endpoints}

        wait_for(lambda: names(look.get_publisher_names_and_types_by_node('feed_axis', '/'))
                 == allowed('feed_axis', 'topic', 'publish'), 'the published topics of the policy')
        wait_for(lambda: names(look.get_subscriber_names_and_types_by_node('feed_axis', '/'))
                 == allowed('feed_axis', 'topic', 'subscribe'), 'the heard topics of the policy')
        wait_for(lambda: names(look.get_service_names_and_types_by_node('feed_axis', '/'))
                 == allowed('feed_axis', 'service', 'reply'), 'the services of the policy')


def test_controller_and_operator_talk_to_the_node_alone() -> None:
    """Beside the log and parameter events, which every node has."""
    common = {'/rosout', '/parameter_events'}
    published, heard = allowed('feed_axis', 'topic', 'publish'), allowed('feed_axis', 'topic', 'subscribe')
    for enclave in ('controller', 'operator'):
        assert allowed(enclave, 'topic', 'publish') - common <= heard
        assert allowed(enclave, 'topic', 'subscribe') <= published
    assert allowed('operator', 'service', 'request') == allowed('feed_axis', 'service', 'reply')
    assert not allowed('controller', 'service', 'request')
