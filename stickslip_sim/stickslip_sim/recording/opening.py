# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Reads any run folder: of a simulation, or of a measurement."""

import warnings
from pathlib import Path

from ..bags.bag import METADATA
from ..core.errors import RecordingWarning
from .measured_run import MEASURED, MeasuredRun
from .reader import Bag
from .recorded_run import RecordedRun


def read_run(path: Path | str) -> RecordedRun:
    """Return the run in a folder, or in an MCAP file by itself; raises RecordingError when there is none, or damaged.

    A run without an end (its process was killed, its disk was full, or it is still being written) is read as far as it
    goes, with a RecordingWarning; its `notes` say so too.  One that was measured is a MeasuredRun.
    """
    bag = Bag(path)
    is_measured = bag.metadata.get(METADATA, {}).get('origin') == MEASURED
    run = MeasuredRun(bag, path) if is_measured else RecordedRun(bag, path)
    for note in bag.shortfalls:
        warnings.warn(note, RecordingWarning, stacklevel=2)
    return run
