# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Pass or fail: what an axis did, recorded or simulated, against the limits in a file."""
