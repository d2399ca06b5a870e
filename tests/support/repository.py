# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Where this repository is."""

from pathlib import Path

ROOT = Path(__file__).parents[2]
