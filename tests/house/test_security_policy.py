# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The permissions for SROS 2 are those that the programs need: no endpoint is missing, none is too many."""

import xml.etree.ElementTree as ET
from collections.abc import Iterator
from contextlib import ExitStack
from fnmatch import fnmatchcase
from typing import NamedTuple

import pytest

from stickslip_sim.cli.main import run
from tests.support.node_processes import running
from tests.support.repository import ROOT
from tests.support.ros_nodes import Client, client
from tests.support.waiting import wait_for

pytestmark = pytest.mark.ros

FILE = ROOT / 'stickslip_sim/security/stickslip.policy.xml'
POLICY = ET.parse(FILE).getroot()
# What `ros2 security` takes of a policy: the children of each element, and the attributes that some must or may have.
CHILDREN = {'policy': {'enclaves'}, 'enclaves': {'enclave'}, 'enclave': {'profiles'}, 'profiles': {'profile'},
            'profile': {'topics', 'services'}, 'topics': {'topic'}, 'services': {'service'}}
NEEDED = {'policy': {'version'}, 'enclave': {'path'}, 'profile': {'ns', 'node'}}
ACTS = {'topics': {'publish', 'subscribe'}, 'services': {'request', 'reply'}}
BAG = 'bag'
OWN_CONTROLLER = f'{ROOT}/tests/support/own_controllers.py:Cascade'
UNUSED = {    # by a controller of the user until it pushes, or hears an axis in real time; or not by the examples
    'controller': {('publish', 'drive_velocity'), ('subscribe', 'slider_state'), ('subscribe', 'mode_event')},
    'own_controller': {('publish', 'external_force'), ('subscribe', 'slider_state'), ('subscribe', 'joint_states')},
}

Act = tuple[str, str]    # publish, subscribe, request or reply; the name of a topic or service, or an expression


class Started(NamedTuple):
    """A program in a namespace, with what makes it use all that it can."""

    enclave: str
    executable: str
    node: str
    namespace: str
    parameters: tuple[str, ...]
    options: tuple[str, ...] = ()


PROGRAMS = [
    Started('feed_axis', 'sim_node', 'feed_axis', '/', ('time.mode:=lockstep', 'joint_interface.enabled:=true')),
    Started('feed_axis', 'sim_node', 'feed_axis', '/press', ('use_sim_time:=true',)),
    Started('controller', 'cascade_controller', 'cascade_controller', '/', ('use_sim_time:=true',)),
    Started('controller', 'compensating_controller', 'compensating_controller', '/press', ()),
    Started('own_controller', 'controller_node', 'own_controller', '/nowhere', ('use_sim_time:=true',),
            ('--controller', OWN_CONTROLLER)),
    Started('replay', 'replay_node', 'replay', '/', (f'bag:={BAG}', 'clock:=10.0', 'start_paused:=true')),
    Started('replay', 'replay_node', 'replay', '/press', (
        f'bag:={BAG}', 'mode:=commands', 'axis:=feed_axis', 'start_paused:=true', 'use_sim_time:=true')),
    Started('health', 'health', 'health', '/nowhere', ('patience:=3600.0', 'use_sim_time:=true')),
]


def granted(enclave: str, namespace: str = '/') -> dict[Act, Act]:
    """Return what an enclave may do, as it is written and as it means with its profiles in a namespace."""
    return {(act, place.text or ''): (act, resolved(place.text or '', namespace, profile.attrib['node']))
            for profile in POLICY.findall(f".//enclave[@path='/stickslip/{enclave}']//profile")
            for group in profile for act in group.attrib for place in group}


def resolved(name: str, namespace: str, node: str) -> str:
    return name if name.startswith('/') else f'{namespace.rstrip("/")}/{name.replace("~", node)}'


def names(enclave: str, act: str) -> set[str]:
    return {name for what, name in granted(enclave) if what == act}


def endpoints(look: Client, node: str, namespace: str) -> set[Act]:
    """Return what a node has on the graph; nothing while it is not there."""
    if (node, namespace) not in look.node.get_node_names_and_namespaces():
        return set()
    acts = {'publish': 'publisher', 'subscribe': 'subscriber', 'reply': 'service', 'request': 'client'}
    return {(act, name) for act, kind in acts.items()
            for name, _ in getattr(look.node, f'get_{kind}_names_and_types_by_node')(node, namespace)}


def covers(expression: Act, endpoint: Act) -> bool:
    return expression[0] == endpoint[0] and fnmatchcase(endpoint[1], expression[1])


def test_structure() -> None:
    assert POLICY.attrib == {'version': '0.2.0'}
    for element in POLICY.iter():
        assert {child.tag for child in element} <= CHILDREN.get(element.tag, set()), element.tag
        if element.tag in ACTS:
            assert set(element.attrib) <= ACTS[element.tag]
            assert set(element.attrib.values()) == {'ALLOW'}
        else:
            assert set(element.attrib) == NEEDED.get(element.tag, set())
        if element.tag not in CHILDREN:
            assert element.text
            assert element.text == element.text.strip()


def test_ros2_security_takes_each_child_for_an_enclave() -> None:
    """It asks each one for its path; a comment has none, and nothing is generated."""
    with_comments = ET.XMLParser(target=ET.TreeBuilder(insert_comments=True))
    (enclaves,) = ET.parse(FILE, with_comments).getroot().iterfind('enclaves')
    assert all(enclave.get('path') for enclave in enclaves)
    assert any(callable(child.tag) for enclave in enclaves for child in enclave), 'no comment was read'


@pytest.fixture(scope='module')
def look(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Client]:
    """Return one who sees the graph of all programs; they run at once."""
    folder = tmp_path_factory.mktemp('policy')
    assert run(['simulate', 'positioning', '--duration', '0.1', '--bag', str(folder / BAG)]) == 0
    with client() as looking, ExitStack() as stack:
        for program in PROGRAMS:
            parameters = (word for value in program.parameters for word in ('-p', value))
            stack.enter_context(running('-r', f'__ns:={program.namespace}', *parameters, options=program.options,
                                        program=program.executable, folder=folder))
        yield looking


@pytest.mark.parametrize('enclave', ['feed_axis', 'controller', 'own_controller', 'replay', 'health'])
def test_programs_have_what_they_need_and_no_more(look: Client, enclave: str) -> None:
    there = {program: set[Act]() for program in PROGRAMS if program.enclave == enclave}

    def unused() -> set[Act]:
        for program in there:
            there[program] |= endpoints(look, program.node, program.namespace)
        return {written for program, found in there.items() for written, meant in granted(enclave, program.namespace)
                .items() if any(covers(meant, endpoint) for endpoint in found)} ^ set(granted(enclave))

    wait_for(lambda: unused() == UNUSED.get(enclave, set()) and all(there.values()), f'the endpoints of {enclave}')
    for program, found in there.items():
        allowed = granted(enclave, program.namespace).values()
        assert not {endpoint for endpoint in found if not any(covers(meant, endpoint) for meant in allowed)}, program


def test_controller_and_operator_talk_to_the_node_alone() -> None:
    """Beside the log and parameter events, which every node has."""
    common = {'/rosout', '/parameter_events'}
    published, heard = names('feed_axis', 'publish'), names('feed_axis', 'subscribe') - {'/clock'}
    assert names('controller', 'publish') - common < heard
    assert names('controller', 'subscribe') < published
    assert not names('controller', 'request')
    assert names('operator', 'publish') == heard | common
    assert names('operator', 'subscribe') == published
    assert names('operator', 'request') >= {'feed_axis/*'}
