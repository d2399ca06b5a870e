# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""A few tests of the installed package, for `colcon test`; the suite of the repository has the details."""

import os
import subprocess
from collections.abc import Callable
from pathlib import Path

import pytest
from ament_index_python.packages import PackageNotFoundError, get_package_prefix

# Only this machine, and a domain of its own unless one is set.
os.environ.setdefault('ROS_DOMAIN_ID', str(1 + os.getpid() % 100))
os.environ.setdefault('ROS_AUTOMATIC_DISCOVERY_RANGE', 'LOCALHOST')


@pytest.fixture(scope='session')
def prefix() -> Path:
    """Return where the package is installed."""
    try:
        return Path(get_package_prefix('stickslip_sim'))
    except PackageNotFoundError:
        pytest.exit('stickslip_sim is not installed, or setup.bash not sourced: colcon build, then colcon test', 1)


@pytest.fixture
def tool(prefix: Path, tmp_path: Path) -> Callable[..., subprocess.CompletedProcess[str]]:
    """Return a function that runs the tool in an empty folder, out of sight of the sources."""

    def run(*arguments: str | Path) -> subprocess.CompletedProcess[str]:
        return subprocess.run([prefix / 'lib/stickslip_sim/stickslip', *arguments], cwd=tmp_path, capture_output=True,
                              text=True, timeout=60, check=False)

    return run
