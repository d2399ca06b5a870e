# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Bytes that are nearly recorded orders: an order for an axis, or refused in one line."""

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

pytest.importorskip('rclpy')

from rcl_interfaces.msg import Parameter, ParameterEvent, ParameterType, ParameterValue
from rclpy.serialization import serialize_message

from stickslip_sim.bags.topics import PARAMETER_EVENTS, RIG_EVENT
from stickslip_sim.core.errors import RecordingError
from stickslip_sim.recording import Topic
from stickslip_sim.ros.replay.orders import Request, is_timeout, request_of
from stickslip_sim.simulation import RigEventKind
from tests.support.refusals import accepts_or_refuses

from stickslip_msgs.msg import RigEvent  # isort: skip

# lark, which rosidl's Python brings in, imports modules that Python wants to rename.
pytestmark = pytest.mark.filterwarnings("ignore:module 'sre_:DeprecationWarning")

MASS = Parameter(name='axis.mass', value=ParameterValue(type=ParameterType.PARAMETER_DOUBLE, double_value=300.0))


@pytest.fixture(scope='module')
def orders() -> list[tuple[Topic, bytes]]:
    fault = RigEvent(kind=int(RigEventKind.FAULT_INJECTED), id='dry', fault='friction_scale')
    change = ParameterEvent(node='/feed_axis', changed_parameters=[MASS])
    return [(RIG_EVENT, serialize_message(fault)), (PARAMETER_EVENTS, serialize_message(change))]


@settings(max_examples=300)
@given(place=st.integers(0, 200), cut=st.integers(0, 9), data=st.binary(max_size=9))
def test_orders(orders: list[tuple[Topic, bytes]], place: int, cut: int, data: bytes) -> None:
    for kind, whole in orders:
        assert isinstance(request_of(kind, whole), Request)
        for sent in (whole[:place], whole[:place] + data + whole[place + cut:], data):
            accepts_or_refuses(request_of, kind, sent)
            accepts_or_refuses(is_timeout, kind, sent)


@pytest.mark.parametrize('data', [b'', b'\x00\x01\x00\x01'])   # no header; padding where there is no content
def test_no_order_is_refused_with_what_to_do(data: bytes) -> None:
    for kind in (RIG_EVENT, PARAMETER_EVENTS):
        with pytest.raises(RecordingError, match='is damaged: play what is before with playback_duration'):
            request_of(kind, data)
