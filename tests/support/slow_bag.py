# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""A program: sim_node with a disk that takes half a second to open a bag; prints by how much its stamps lag, s."""

import sys
import time
from typing import Any

from stickslip_sim.core.types import Sample
from stickslip_sim.recording import open_run, recordings
from stickslip_sim.ros import executables
from stickslip_sim.ros.node.publishers import Publishers
from stickslip_sim.ros.stop_signals import Signals
from tests.support.forked_programs import ros_args

SIGNALS = Signals()
LAGS: list[int] = []


def slow_open_run(*args: Any) -> Any:
    time.sleep(0.5)
    return open_run(*args)


def sample(publishers: Publishers, _: int, state: Sample) -> None:
    LAGS.append(time.time_ns() - publishers.start_ns - state.instant.nanoseconds)
    SIGNALS.stop = len(LAGS) > 300


if __name__ == '__main__':
    recordings.open_run = slow_open_run    # type: ignore[assignment, attr-defined]
    Publishers.sample = sample             # type: ignore[assignment, method-assign]
    executables.Signals = lambda: SIGNALS  # type: ignore[assignment, attr-defined]
    code = executables.sim_node(ros_args(*sys.argv[1:]))
    print(min(LAGS) * 1e-9)
    sys.exit(code)
