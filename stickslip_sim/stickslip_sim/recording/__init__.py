# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Runs on disk as ROS bags: written by the node and by the offline tool, read back whole or cut off."""

from .bag import BagWriter, Split
from .measured_bag import write_measured
from .measured_run import MeasuredRun
from .offline_bag import OfflineBag, samples_of, write_bag
from .opening import open_bag
from .reader import Bag
from .recorded_run import RecordedRun
from .run import RunFacts, checkpoint_file, open_run, receipt_file
from .run_reading import read_run
from .schemas import MessageCodec, Schema, flat_layout, schema
from .thread import RecorderThread
from .topic_columns import RecordedMessage
from .topics import DIAGNOSTICS, RECORDED, QosProfile, Topic, recorded_topics

__all__ = [
    'DIAGNOSTICS',
    'RECORDED',
    'Bag',
    'BagWriter',
    'MeasuredRun',
    'MessageCodec',
    'OfflineBag',
    'QosProfile',
    'RecordedMessage',
    'RecordedRun',
    'RecorderThread',
    'RunFacts',
    'Schema',
    'Split',
    'Topic',
    'checkpoint_file',
    'flat_layout',
    'open_bag',
    'open_run',
    'read_run',
    'receipt_file',
    'recorded_topics',
    'samples_of',
    'schema',
    'write_bag',
    'write_measured',
]
