# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Proof: cases that break other simulators, and the judges of this one; `extremes` measures them by name."""
