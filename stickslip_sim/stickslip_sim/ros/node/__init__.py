# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The node `feed_axis`: its parameters, topics and bags around the step loop."""
