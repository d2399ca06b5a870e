# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Runs on disk: written by the node and the tool, read back whole or cut off.  The file format is in `bags`."""

from ..bags.bag import BagWriter, Split
from ..bags.bag_files import RecordedMessage
from ..bags.schemas import MessageCodec, Schema, flat_layout, schema
from ..bags.topics import DIAGNOSTICS, RECORDED, QosProfile, Topic, recorded_topics
from .measured_run import MeasuredRun, read_run, run_of, write_measured
from .offline_bag import OfflineBag, samples_of, write_bag
from .reader import Bag, open_bag
from .recorded_run import RecordedRun
from .recordings import RecorderThread
from .run import RunFacts, checkpoint_file, open_run, receipt_file

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
    'run_of',
    'samples_of',
    'schema',
    'write_bag',
    'write_measured',
]
