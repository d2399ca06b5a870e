# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""What every node loads and works out at its start: for the process that nodes are forked from, and for no other."""

import gc
import importlib
import inspect
import warnings

with warnings.catch_warnings():   # rclpy loads it at the first message, and it loads what Python wants to be rid of
    warnings.simplefilter('ignore')
    importlib.import_module('rosidl_generator_py')

from stickslip_sim.bags import topics
from stickslip_sim.recording import flat_layout, schema
from stickslip_sim.ros.node.endpoints import message_type

for module in ('executables', 'programs', 'node.feed_axis', 'controllers.controller_node',
               'controllers.own_controller_node', 'replay.node', 'health_node'):
    importlib.import_module(f'stickslip_sim.ros.{module}')
for topic in topics.RECORDED:
    schema(topic.type)
    type(message_type(topic)).__import_type_support__()
for topic in (topics.SLIDER_STATE, topics.FRICTION_FORCE, topics.MODE_EVENT, topics.DRIVE_VELOCITY,
              topics.EXTERNAL_FORCE):
    flat_layout(topic.type)
inspect.getmodule(inspect.currentframe())    # it keeps what rclpy is to ask with the first line of a log
gc.collect()
gc.freeze()    # a collection by a node leaves it alone, and so the pages of memory shared
