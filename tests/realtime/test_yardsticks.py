# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""What is measured beside the node: cyclictest as it writes its figures, and the lateness of a bare loop."""

import json
import subprocess
import sys

import pytest

from benchmarks.hil import kernel
from benchmarks.hil.lateness import Lateness


def test_a_histogram_of_cyclictest_as_lateness() -> None:
    thread = {'histogram': {'10': 90, '20': 8, '1500': 1}, 'cycles': 100, 'min': 10, 'max': 25_000, 'avg': 12.0}
    figures = kernel.figures(thread, period=1e-3)
    assert figures['lateness_p50'] == pytest.approx(10e-6)
    assert figures['lateness_p99'] == pytest.approx(1500e-6)
    assert figures['lateness_max'] == pytest.approx(25e-3)    # beyond the histogram
    assert figures['overruns'] == pytest.approx(0.02)


def test_lateness_in_figures() -> None:
    lateness = Lateness()
    for value in (1000, 3000, 2000):
        lateness.add(value)
    lateness.overruns = 1
    figures = lateness.figures()
    assert figures['lateness_p50'] == pytest.approx(2e-6)
    assert figures['lateness_max'] == pytest.approx(3e-6)
    assert figures['overruns'] == pytest.approx(1 / 3)


def test_the_bare_loop_makes_its_steps() -> None:
    done = subprocess.run([sys.executable, '-m', 'benchmarks.hil.bare_loop', '--rate', '500', '--seconds', '0.2'],
                          check=True, capture_output=True, text=True)
    figures = json.loads(done.stdout)
    assert 0.0 < figures['lateness_p50'] <= figures['lateness_p99'] <= figures['lateness_max']
