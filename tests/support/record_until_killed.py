# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""A program for tests: records a message every millisecond and says on standard output how many it handed over."""

import sys
import time

from stickslip_sim.recording import RecorderThread, Split, open_run
from tests.support.recorded_runs import FACTS


def main(folder: str, max_duration: str = '0') -> None:
    recorder = RecorderThread(open_run(folder, FACTS, split=Split(max_duration=int(max_duration) or None)))
    start = time.monotonic()
    step = 0
    while True:
        while step < (time.monotonic() - start) * 1000.0:
            step += 1
            recorder.put(0, step.to_bytes(8, 'little') * 12, step * 1_000_000, step * 1_000_000, step)
            if step % 50 == 0:
                sys.stdout.write(f'{step}\n')
                sys.stdout.flush()
        time.sleep(0.001)


main(*sys.argv[1:])
