# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""A run against limits, and a recorded run made again.  Comparing with the paper is in `compare`."""
