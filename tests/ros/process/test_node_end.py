# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The end of a node whose middleware does not end: bounded, with a whole bag."""

import ctypes
from pathlib import Path

import pytest

from stickslip_sim.recording import open_bag
from tests.support.tool import restore_interrupt

from tests.support.node_processes import recording_into, running  # isort: skip  # skips without ROS
from tests.support.ros_nodes import client  # isort: skip

pytestmark = pytest.mark.ros


def never_destroyed(*_: object) -> None:
    ctypes.PyDLL(None).pause()    # like a lock of Fast DDS: it keeps the interpreter


def with_a_middleware_that_does_not_end() -> None:
    """For `prepare`."""
    from rclpy.node import Node

    restore_interrupt()
    Node.destroy_node = never_destroyed


def test_a_node_ends_whose_middleware_does_not(tmp_path: Path) -> None:
    bag = tmp_path / 'run'
    with running(*recording_into(bag), prepare=with_a_middleware_that_does_not_end) as process:
        with client() as axis:
            axis.connect()
        code, errors = process.end()
    assert code == 1
    assert 'Timeout (0:00:10)!' in errors
    assert 'in never_destroyed' in errors
    assert open_bag(bag).is_complete
