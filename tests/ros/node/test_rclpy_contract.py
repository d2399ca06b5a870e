# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""What the node uses of rclpy without a promise of it: each in one file, and as it is in the rclpy that is installed.

Where one of these tests fails after an upgrade of rclpy, its message names the file to change.
"""

import ast
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
import rclpy.node
from rcl_interfaces.srv import GetParameters, SetParameters, SetParametersAtomically
from rclpy.context import Context
from rclpy.executors import SingleThreadedExecutor
from rclpy.experimental import EventsExecutor
from rclpy.node import Node
from rclpy.parameter import Parameter
from rclpy.serialization import deserialize_message
from std_msgs.msg import Float64

import stickslip_sim
from stickslip_sim.ros.node.parameters import _REQUEST_LISTS
from stickslip_sim.ros.node.subscribers import HidingNode, Inbox
from tests.support.ros_nodes import bare_nodes
from tests.support.waiting import wait_for

pytestmark = pytest.mark.ros

PACKAGE = Path(stickslip_sim.__file__).parent
INBOX, BOUNDED, PROGRAM = 'ros/node/subscribers.py', 'ros/node/parameters.py', 'ros/programs.py'
# What rclpy has without documenting it, or as experimental: attributes, methods, modules; and the file that uses each.
PLACES = {'take_message': INBOX, 'handle': INBOX, 'subscriptions': INBOX, 'create_service': BOUNDED,
          'rclpy.experimental': PROGRAM}
NAMED_TUPLES = {'_replace', '_asdict', '_fields', '_make'}
TAKING = f'rclpy takes messages otherwise: see _take and Inbox in {INBOX}; commands are heard by callbacks until then'
HIDING = f'this executor of rclpy serves a hidden subscription: see HidingNode in {INBOX}; commands come out of order'
SERVING = f'rclpy makes its services for parameters otherwise: see create_service in {BOUNDED}; requests are unbounded'
SETTING = 'rclpy serves parameters past the method of the node: see ros/node/parameters.py; values are not checked'


class Pair:
    """A node with two subscriptions, one of them hidden, and a node that sends to both."""

    def __init__(self, node: Any, sender: Any) -> None:
        self.node, self.sender, self.context = node, sender, node.context
        self.served: list[str] = []
        self.hidden, _ = (
            self.node.create_subscription(Float64, name, lambda _, name=name: self.served.append(name), 10, raw=True)
            for name in ('hidden', 'visible'))
        self.node.hide([self.hidden])
        self.out = {name: self.sender.create_publisher(Float64, name, 10) for name in ('hidden', 'visible')}
        for out in self.out.values():
            wait_for(out.get_subscription_count, 'the subscription')

    def take(self, raw: bool) -> Any:
        """Take the next message of the hidden subscription as rclpy gives it."""
        def taken() -> Any:
            with self.hidden.handle:
                return self.hidden.handle.take_message(Float64, raw)

        return wait_for(taken, 'a message')

@pytest.fixture
def pair() -> Iterator[Pair]:
    with bare_nodes('hears', 'sends', kind=HidingNode) as nodes:
        yield Pair(*nodes)


def test_messages_are_taken_as_bytes_or_as_such_with_the_time_of_reception(pair: Pair) -> None:
    with pair.hidden.handle:
        assert pair.hidden.handle.take_message(Float64, True) is None, TAKING
    before = time.time_ns()
    for _ in range(2):
        pair.out['hidden'].publish(Float64(data=0.25))
    data, info = pair.take(True)
    assert isinstance(data, bytes), TAKING
    assert deserialize_message(data, Float64).data == 0.25, TAKING
    assert before - 1e9 < info['received_timestamp'] < time.time_ns() + 1e9, TAKING    # on the clock of the day
    assert isinstance(pair.take(False)[0], Float64), TAKING


@pytest.mark.parametrize('kind', [EventsExecutor, SingleThreadedExecutor])
def test_executors_leave_a_hidden_subscription_alone(pair: Pair, kind: Any) -> None:
    executor = kind(context=pair.context)
    executor.add_node(pair.node)
    try:
        pair.out['hidden'].publish(Float64(data=0.5))
        inbox = Inbox(pair.hidden, 10)    # asked last: what an executor has served is gone

        def other_came() -> bool:
            pair.out['visible'].publish(Float64())
            executor.spin_once(timeout_sec=0.1)
            return pair.served.count('visible') > 5

        wait_for(other_came, 'the other subscription')
        assert 'hidden' not in pair.served, HIDING
        taken = wait_for(lambda: inbox.take(0, time.monotonic_ns(), 0), 'the message')
        assert [deserialize_message(message.data, Float64).data for message in taken] == [0.5], HIDING
    finally:
        executor.shutdown()


class Recording(Node):  # type: ignore[misc]
    """A node that notes which of its methods rclpy calls for its own services."""

    def __init__(self, name: str, context: Context) -> None:
        self.offered: dict[str, Any] = {}
        self.called: list[str] = []
        super().__init__(name, context=context)
        self.declare_parameter('gain', 1.0)
        self.called.clear()

    def create_service(self, srv_type: Any, srv_name: str, callback: Any, **options: Any) -> Any:
        self.offered[srv_name.split('/')[-1]] = callback
        return super().create_service(srv_type, srv_name, callback, **options)

    def get_parameter(self, name: str) -> Any:
        self.called.append('get_parameter')
        return super().get_parameter(name)

    def set_parameters_atomically(self, parameter_list: Any) -> Any:
        self.called.append('set_parameters_atomically')
        return super().set_parameters_atomically(parameter_list)


class TestParameterServices:
    @pytest.fixture
    def node(self) -> Iterator[Recording]:
        with bare_nodes('notes', kind=Recording) as (node,):
            yield node

    def test_are_made_by_create_service(self, node: Recording) -> None:
        assert set(node.offered) >= {
            'describe_parameters', 'get_parameters', 'get_parameter_types', 'list_parameters', 'set_parameters',
            'set_parameters_atomically'}, SERVING

    @pytest.mark.parametrize(('kind', 'name', 'method'), [
        (GetParameters, 'get_parameters', 'get_parameter'),
        (SetParameters, 'set_parameters', 'set_parameters_atomically'),
        (SetParametersAtomically, 'set_parameters_atomically', 'set_parameters_atomically')])
    def test_ask_the_methods_of_the_node(self, node: Recording, kind: Any, name: str, method: str) -> None:
        request = kind.Request()
        if name == 'get_parameters':
            request.names = ['gain']
        else:
            request.parameters = [Parameter('gain', value=2.0).to_parameter_msg()]
        node.offered[name](request, kind.Response())
        assert node.called == [method], SETTING

    def test_a_request_has_one_of_the_lists_that_are_bounded(self) -> None:
        for kind in (GetParameters, SetParameters, SetParametersAtomically):
            assert set(_REQUEST_LISTS) & set(kind.Request.get_fields_and_field_types()), SERVING


def trees() -> Iterator[tuple[str, ast.Module]]:
    for file in sorted((PACKAGE / 'ros').rglob('*.py')):
        yield file.relative_to(PACKAGE).as_posix(), ast.parse(file.read_text(encoding='utf-8'))


def used(tree: ast.AST) -> Iterator[str]:
    """Yield what a file reads of other objects, the methods and properties it overrides, and what it imports."""
    for part in ast.walk(tree):
        if isinstance(part, ast.Attribute) and ast.unparse(part.value) not in ('self', 'cls', 'os'):
            yield part.attr
        elif isinstance(part, ast.ImportFrom):
            yield part.module or ''
            yield from (f'{part.module}.{name.name}' for name in part.names)


def overridden(tree: ast.AST) -> set[str]:
    """Return the methods of our nodes that rclpy's Node has, public or not, but the constructor."""
    return {part.name for ours in nodes(tree) for part in ours.body
            if isinstance(part, ast.FunctionDef) and hasattr(Node, part.name)} - {'__init__'}


def is_undocumented(name: str) -> bool:
    """Return whether an attribute or a module is one that rclpy does not promise."""
    first, _, rest = name.partition('.')
    if first == 'rclpy':
        return name == 'rclpy.experimental' or rest.startswith(('_', 'impl'))
    is_private = name.startswith('_') and not name.startswith('__') and name not in NAMED_TUPLES
    return is_private or name in ('take_message', 'handle')


def test_each_undocumented_name_stands_in_one_file() -> None:
    places: dict[str, set[str]] = {}
    for file, tree in trees():
        for name in {*filter(is_undocumented, used(tree)), *(overridden(tree) & {'subscriptions', 'create_service'})}:
            places.setdefault(name, set()).add(file)
    assert places == {name: {file} for name, file in PLACES.items()}


def attributes(tree: ast.AST) -> set[str]:
    """Return what is set or read of `self` or a parent class, and the names of the methods."""
    return {part.attr for part in ast.walk(tree) if isinstance(part, ast.Attribute)
            and ast.unparse(part.value) in ('self', 'super()')} | {
        part.name for part in ast.walk(tree) if isinstance(part, ast.FunctionDef)}


def nodes(tree: ast.AST) -> list[ast.ClassDef]:
    """Return our classes whose base has Node in its name."""
    return [part for part in ast.walk(tree) if isinstance(part, ast.ClassDef)
            and any('Node' in ast.unparse(base) for base in part.bases)]


@pytest.mark.parametrize('ours', [ours for _, tree in trees() for ours in nodes(tree)], ids=lambda ours: ours.name)
def test_nothing_private_to_rclpy_is_touched(ours: ast.ClassDef) -> None:
    theirs = attributes(ast.parse(Path(rclpy.node.__file__).read_text(encoding='utf-8')))
    private = {name for name in theirs if name.startswith('_') and not name.startswith('__')}
    assert '_publishers' in private
    assert attributes(ours) & private == set()
