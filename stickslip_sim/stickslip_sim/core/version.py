# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The version of the package."""

__version__ = '2.0.0'
