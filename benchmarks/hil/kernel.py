# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""What the kernel itself gives: cyclictest of rt-tests, on the same machine at the same time."""

import json
import shutil
import subprocess
import tempfile
from pathlib import Path

import numpy as np

_LONGEST = 20_000    # µs in the histogram; what is later counts there


def is_there() -> bool:
    """Return whether cyclictest can be run."""
    return shutil.which('cyclictest') is not None


def measure(rate: float, seconds: float, priority: int) -> dict[str, float]:
    """Return the lateness of the wake-ups of cyclictest at a rate, s; raises CalledProcessError."""
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder, 'found.json')
        subprocess.run(['cyclictest', '--mlockall', f'--priority={priority}', f'--interval={round(1e6 / rate)}',
                        f'--duration={max(round(seconds), 1)}', '--quiet', f'--histogram={_LONGEST}',
                        f'--json={file}'], check=True, capture_output=True)
        return figures(json.loads(file.read_text())['thread']['0'], 1.0 / rate)


def figures(thread: dict[str, object], period: float) -> dict[str, float]:
    """Return the figures of a thread of cyclictest, s; a wake-up later than the histogram reaches is at its end."""
    histogram = thread['histogram']
    assert isinstance(histogram, dict)
    late = np.array(list(map(int, histogram))) * 1e-6
    counts = np.array(list(histogram.values()))
    cycles = int(str(thread['cycles']))
    beyond = cycles - int(counts.sum())
    late, counts = np.append(late, float(str(thread['max'])) * 1e-6), np.append(counts, beyond)
    reached = np.cumsum(counts) / cycles
    return {'lateness_p50': float(late[np.searchsorted(reached, 0.5)]),
            'lateness_p99': float(late[np.searchsorted(reached, 0.99)]), 'lateness_max': float(late[-1]),
            'overruns': float(counts[late > period].sum() / cycles)}
