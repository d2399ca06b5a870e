# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Runs on disk as ROS bags: written by the node and by the offline tool, read back whole or cut off."""

from .bag import BagWriter
from .offline_bag import OfflineBag, samples_of, write_bag
from .opening import read_run
from .reader import RecordedMessage, Run
from .run import RunFacts, checkpoint_file, open_run, receipt_file
from .schemas import MessageCodec, Schema, flat_layout, schema
from .tables import columns_of, events_of, name_of
from .thread import RecorderThread
from .topics import DIAGNOSTICS, RECORDED, QosProfile, Topic, recorded_topics

__all__ = [
    'DIAGNOSTICS',
    'RECORDED',
    'BagWriter',
    'MessageCodec',
    'OfflineBag',
    'QosProfile',
    'RecordedMessage',
    'RecorderThread',
    'Run',
    'RunFacts',
    'Schema',
    'Topic',
    'checkpoint_file',
    'columns_of',
    'events_of',
    'flat_layout',
    'name_of',
    'open_run',
    'read_run',
    'receipt_file',
    'recorded_topics',
    'samples_of',
    'schema',
    'write_bag',
]
