# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The tool `stickslip`: one file for each verb, which prints what the rooms below find."""

from .main import main

__all__ = ['main']
