# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Steps that keep the time of a clock, without ROS: pacing, commands, timing statistics.  The node is in `ros`."""
