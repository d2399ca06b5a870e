# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Exact, event-driven simulation of a feed axis with stick-slip friction."""

__version__ = '0.1.0'
