# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The extremes: cases that break other simulators, measured on this one against a mark each."""
