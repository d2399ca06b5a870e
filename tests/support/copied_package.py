# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The package folder `stickslip_sim` as it is committed, to be built elsewhere."""

import shutil
from pathlib import Path

from tests.support.repository import ROOT


def copy_package(folder: Path) -> Path:
    """Copy it, without what was built there; return the copy."""
    built = shutil.ignore_patterns('build', '_hot*', '_text*', '_standstill*', '*.egg-info', '__pycache__')
    return Path(shutil.copytree(ROOT / 'stickslip_sim', folder / 'sources', ignore=built))
